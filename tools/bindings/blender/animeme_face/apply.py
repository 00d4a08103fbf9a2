"""A clip on a character: actions with keyframes for its shape keys and its bones."""

from dataclasses import dataclass

from . import bones, character, keys
from .names import FAPS

GAZE = "eyeLook"


@dataclass
class Options:
    head: str = "BOTH"  # BOTH, NECK, HEAD, NONE
    eyes: str = "AUTO"  # AUTO, BONES, SHAPES, NONE
    jaw: bool = True
    fap_units: float = 1024  # at 1 of a key; None: the end of each FAP's range


def apply(scene, who, clip, name, start, options, progress):
    """Last frame, and the number of curves."""
    times = keys.Times(start, clip.frames, clip.rate, keys.rate_of(scene))
    eyes = _eye_bones(who, options)
    curves = 0
    for i, mesh in enumerate(who.meshes):
        own = name if len(who.meshes) == 1 else f"{name} {mesh.name}"
        curves += _shape_keys(who, mesh, clip, times, own, options, eyes)
        progress((i + 1) / (len(who.meshes) + 1))
    if who.armature:
        curves += _bones(who, clip, times, f"{name} {who.armature.name}", options, eyes)
    return times.frames[-1], curves


def _is_gaze(meaning):
    return all(curve.startswith(GAZE) for curve in meaning.curves)


def _eye_bones(who, options):
    """Roles of the eyes that bones turn."""
    if options.eyes in ("SHAPES", "NONE"):
        return []
    roles = [role for role in ("left_eye", "right_eye") if role in who.bones]
    turned = [mesh for mesh in who.meshes
              if any(_is_gaze(who.meanings[key.name]) for key in character.keys_of(mesh) if key.name
              in who.meanings)]
    if options.eyes == "AUTO":
        carried = lambda role, mesh: bones.carries(who.armature, who.bones[role],
            mesh)  # noqa: E731
        roles = [role for role in roles if not any(carried(role, mesh) for mesh in turned)]
    return roles


def _value(meaning, clip, fap_units):
    """Of a key, a value a frame of the clip."""
    curves = [clip.curve(curve) for curve in meaning.curves]
    if meaning.kind == "fap":
        unit = fap_units or FAPS[meaning.curves[0]]
        return [value / unit for value in curves[0]]
    if len(curves) == 1:
        return curves[0]
    return [sum(values) / len(values) for values in zip(*curves)]


def _shape_keys(who, mesh, clip, times, name, options, eyes):
    data = mesh.data.shape_keys
    action, count = None, 0
    # Shape keys that would turn an eye once more than its bone does.
    doubled = options.eyes == "NONE" or any(bones.carries(who.armature, who.bones[role], mesh)
        for role in eyes)
    for key in character.keys_of(mesh):
        meaning = who.meanings.get(key.name)
        if meaning is None or (doubled and _is_gaze(meaning)):
            continue
        values = times.sample(_value(meaning, clip, options.fap_units))
        # Beyond its slider a key would stop.
        key.slider_min = max(min(key.slider_min, min(values)), -10)
        key.slider_max = min(max(key.slider_max, max(values)), 10)
        action = action or keys.new_action(data, name)
        path = f'key_blocks["{_escape(key.name)}"].value'
        keys.write(action, path, 0, "Face", times.frames, values)
        count += 1
    return count


def _bones(who, clip, times, name, options, eyes):
    """Neck, head, eyes and jaw, as far as they are there and wanted."""
    frame = bones.axes(who.armature, who.bones)
    turns, shifts = {}, {}  # by bone: quaternions; places
    angles = lambda part: [times.sample(clip.curve(part + axis)) for axis
        in ("Pitch", "Yaw", "Roll")]  # noqa: E731
    chosen = {"BOTH": ("neck", "head"), "NECK": ("neck",), "HEAD": ("head",),
        "NONE": ()}[options.head]
    chosen = [who.bones[role] for role in chosen if role in who.bones]
    parts = [(bone, "head", 1 / len(chosen)) for bone in chosen]
    parts += [(who.bones[role], {"left_eye": "leftEye", "right_eye": "rightEye"}[role], 1) for role
        in eyes]
    for bone, part, share in parts:
        # Live Link Face turns to the person's right, and rolls to the left, where we turn left and
        # roll right.
        turns[bone] = [bones.turn(who.armature, bone, frame, pitch * share, -yaw * share,
            -roll * share)
                       for pitch, yaw, roll in zip(*angles(part))]
    if options.jaw and "jaw" in who.bones:
        _jaw(who, clip, times, frame, options, turns, shifts)
    if not turns:
        return 0
    action, count = keys.new_action(who.armature, name), 0
    for bone, quaternions in turns.items():
        count += _turns(action, who.armature.pose.bones[bone], quaternions, times)
    for bone, places in shifts.items():
        path = f'pose.bones["{_escape(bone)}"].location'
        for axis, values in enumerate(zip(*places)):
            keys.write(action, path, axis, bone, times.frames, values)
            count += 1
    return count


def _jaw(who, clip, times, frame, options, turns, shifts):
    """The jaw's bone, if a mesh that it does not carry has the shape of the open jaw."""
    bone = who.bones["jaw"]
    for mesh in who.meshes:
        found = {who.meanings[key.name].curves[0]: key for key in character.keys_of(mesh)
            if key.name in who.meanings}
        opening = found.get("jawOpen") or found.get("open_jaw")
        if opening is None or bones.carries(who.armature, bone, mesh):
            continue
        jaw = bones.Jaw(who.armature, bone, frame, mesh, opening)
        weights = lambda key: times.sample(_value(who.meanings[key.name], clip,
            options.fap_units))  # noqa: E731
        turns[bone] = [jaw.turn(weight) for weight in weights(opening)]
        aside = [(jaw.shift(found[name]), weights(found[name]))
                 for name in ("jawForward", "jawLeft", "jawRight", "thrust_jaw", "shift_jaw")
                 if name in found]
        shifts[bone] = [tuple(sum(step[axis] * values[i] for step, values in aside) for axis
            in range(3))
                        for i in range(len(times.frames))]
        return


def _turns(action, bone, quaternions, times):
    """Curves of a rotation in the mode of its bone."""
    path = f'pose.bones["{_escape(bone.name)}"].'
    if bone.rotation_mode == "AXIS_ANGLE":
        bone.rotation_mode = "QUATERNION"
    if bone.rotation_mode == "QUATERNION":
        path, rows = path + "rotation_quaternion", [tuple(q) for q in quaternions]
    else:
        path, rows, last = path + "rotation_euler", [], None
        for q in quaternions:
            last = q.to_euler(bone.rotation_mode, last) if last else q.to_euler(bone.rotation_mode)
            rows.append(tuple(last))
    for axis, values in enumerate(zip(*rows)):
        keys.write(action, path, axis, bone.name, times.frames, values)
    return len(rows[0])


def _escape(name):
    """Of a name in a path of data."""
    return name.replace("\\", "\\\\").replace('"', '\\"')
