"""From values a frame of a clip to keyframes at whole frames of a scene."""

from fractions import Fraction

import bpy

LINEAR = 1  # of a keyframe's interpolation
MARK = "animeme"  # property of actions that were imported here


def rate_of(scene):
    """Frames a second, exactly: 30 over a base of 1.001 is 30000/1001."""
    return Fraction(scene.render.fps) / Fraction(scene.render.fps_base).limit_denominator(10000)


def set_rate(scene, rate):
    scene.render.fps = -(-rate.numerator // rate.denominator)
    scene.render.fps_base = float(scene.render.fps / rate)


class Times:
    """Frames of a scene, from `start` to the last of a clip, and where in the clip each of them
    is."""

    def __init__(self, start, count, clip_rate, scene_rate):
        step = clip_rate / scene_rate
        last = count - 1
        # The one behind the last, too, which holds it: the end is not cut off.
        many = -(-Fraction(last) // step) + 1
        self.frames = range(start, start + int(many))
        self.places = []
        for i in range(int(many)):
            at = min(i * step, Fraction(last))
            whole = min(int(at), max(last - 1, 0))
            self.places.append((whole, float(at - whole)))

    def sample(self, values):
        """The clip's values there, on lines between its frames."""
        if len(values) == 1:
            return [values[0]] * len(self.places)
        return [values[i] if part == 0 else values[i] * (1 - part) + values[i + 1] * part for i,
            part in self.places]


def new_action(owner, name):
    """An action of its own for `owner`. One of an earlier import stays in the file, others play on
    below as strips."""
    data = owner.animation_data or owner.animation_data_create()
    if data.action and MARK not in data.action:
        track = data.nla_tracks.new()
        track.name = data.action.name
        track.strips.new(data.action.name, int(data.action.frame_range[0]), data.action)
    action = bpy.data.actions.new(name)
    action.use_fake_user = True
    action[MARK] = name
    data.action = action
    return action


def write(action, path, index, group, frames, values):
    """A curve with a key a frame; one key where it stands still."""
    if max(values) == min(values):
        frames, values = frames[:1], values[:1]
    curve = action.fcurves.new(path, index=index, action_group=group)
    curve.keyframe_points.add(len(values))
    curve.keyframe_points.foreach_set("co", [number for pair in zip(frames, values) for number
        in pair])
    curve.keyframe_points.foreach_set("interpolation", [LINEAR] * len(values))
    curve.update()
    return curve
