"""Onto heads of our own, read by Blender's own importer of glTF: bones beside shapes, and the head
that is made.

The files have an animation of the program's own, which is looked at before the add-on's takes its
place.
"""

import math
import os
import sys

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from support import *  # noqa: F403

BONES = ("neck_bone", "jaw_bone", "left_eye_bone", "right_eye_bone")


def read_glb(clip, *options):
    """Objects of a head that shows a clip, by the names of its parts; the scene has nothing
    else."""
    animeme("export", clip, *options, "-o", place("head.glb"))
    clean()
    bpy.context.scene.render.fps = 25
    sys.modules["animeme_face"].own_head._old_names()
    bpy.ops.import_scene.gltf(filepath=place("head.glb"))
    return {item.name.split(".")[0]: item for item in bpy.data.objects if item.type != "EMPTY"}


def poses(armature, count):
    """Of each bone, a matrix a frame, in the space of the armature."""
    found = {bone: [] for bone in BONES}
    meshes = [item for item in bpy.data.objects if item.type == "MESH"]
    for mesh in meshes:  # which take ten times as long as bones
        mesh.hide_viewport = True
    for frame in range(count):
        bpy.context.scene.frame_set(frame)
        for bone in BONES:
            found[bone].append(armature.pose.bones[bone].matrix.copy())
    for mesh in meshes:
        mesh.hide_viewport = False
    return found


def apart(a, b):
    """Degrees between two turns."""
    angle = math.degrees(a.to_quaternion().rotation_difference(b.to_quaternion()).angle)
    return min(angle, 360 - angle)


def paths(armature):
    return {made.data_path.split('"')[1] for made in armature.animation_data.action.fcurves}


def shapes_and_bones_are_those_of_our_own_animation():
    write("talk.fap", fap_text())
    animeme("encode", place("talk.fap"), "-o", place("talk.fba"))
    parts = read_glb(place("talk.fba"), "--head", "woman")
    wanted = poses(parts["Armature"], FRAMES)
    # It may stand anywhere, and look anywhere.
    parts["Armature"].rotation_mode = "XYZ"
    parts["Armature"].rotation_euler.z = 0.7
    bpy.context.view_layer.update()
    select(parts["skin"])
    load(place("talk.fba"), frame_start=0)
    table = told(place("talk.fba"))
    seen = 0
    for item in parts.values():
        for key in item.data.shape_keys.key_blocks[
            1:] if item.type == "MESH" and item.data.shape_keys else []:
            seen += 1
            for frame in range(FRAMES):
                near(key_curve(item, key.name).evaluate(frame), table[key.name.lower()][frame],
                    key.name)
    assert seen > 80, seen
    made = poses(parts["Armature"], FRAMES)
    for bone in ("neck_bone", "left_eye_bone", "right_eye_bone"):
        assert max(apart(pose, wanted[bone][0]) for pose in wanted[bone]) > 5, bone
        for frame in range(FRAMES):
            off = apart(made[bone][frame], wanted[bone][frame])
            assert off < 0.02, (bone, frame, off)
    only_what_is_wanted_turns(parts)
    an_eye_with_shapes_is_not_turned_twice(parts)


def only_what_is_wanted_turns(parts):
    armature = parts["Armature"]
    for options, turned in (({}, set(BONES)), ({"head": "NONE"}, set(BONES) - {"neck_bone"}),
                            ({"head": "HEAD", "use_jaw": False},
                            {"left_eye_bone", "right_eye_bone"}),
                            ({"head": "NECK", "eyes": "SHAPES", "use_jaw": False}, {"neck_bone"}),
                            ({"eyes": "NONE"}, {"neck_bone", "jaw_bone"})):
        select(armature)
        load(place("talk.fba"), **options)
        assert paths(armature) == turned, (options, paths(armature))
        curves = parts["skin"].data.shape_keys.animation_data.action.fcurves
        assert any("eyeLook" in made.data_path for made
            in curves) == (options.get("eyes") != "NONE"), options
    # Other modes of bones.
    load(place("talk.fba"))
    wanted = poses(armature, FRAMES)["neck_bone"]
    for mode in ("XYZ", "AXIS_ANGLE"):
        armature.pose.bones["neck_bone"].rotation_mode = mode
        load(place("talk.fba"), frame_start=0)
        bpy.context.scene.frame_set(20)
        assert apart(armature.pose.bones["neck_bone"].matrix, wanted[21]) < 0.02, mode


def an_eye_with_shapes_is_not_turned_twice(parts):
    eye = parts["left_eye"]
    eye.shape_key_add(name="Basis")
    eye.shape_key_add(name="eyeLookInLeft")
    load(place("talk.fba"))
    assert "left_eye_bone" not in paths(parts["Armature"]) and "right_eye_bone" in paths(
        parts["Armature"])
    assert key_curve(eye, "eyeLookInLeft")
    load(place("talk.fba"), eyes="BONES")
    assert "left_eye_bone" in paths(parts["Armature"])
    assert eye.data.shape_keys.animation_data.action.name.startswith("talk left_eye")


def the_jaw_bone_follows_the_shape_of_the_jaw():
    # Ten frames to open, then held forward, then to the left.
    rows = [(i / 10, 0, 0) for i in range(11)] + [(0, 1, 0)] * 5 + [(0, 0, 1)] * 5
    table = "".join(f"{i / 25},{a},{b},{c}\n" for i, (a, b, c) in enumerate(rows))
    parts = read_glb(write("jaw.csv", "time_s,jawOpen,jawForward,jawLeft\n" + table))
    wanted = poses(parts["Armature"], len(rows))["jaw_bone"]
    select(parts["skin"])
    load(place("jaw.csv"), frame_start=0)
    made = poses(parts["Armature"], len(rows))["jaw_bone"]
    assert apart(wanted[0], wanted[10]) > 12
    for frame in range(11):
        assert apart(made[frame], wanted[frame]) < 1.5, (frame, apart(made[frame], wanted[frame]))
    for frame, axis, sign in ((15, 1, -1), (20, 0, 1)):
        is_, whole = (item[frame].translation - item[0].translation for item in (made, wanted))
        assert sign * whole[axis] > 0.006 and (is_ - whole).length < 0.004, (frame, is_, whole)


def fap_keys_are_those_of_our_own_animation():
    parts = read_glb(place("talk.fba"), "--head", "woman", "--morphs", "fap")
    data = parts["skin"].data.shape_keys
    before = data.animation_data.action
    wanted = poses(parts["Armature"], FRAMES)["jaw_bone"]
    select(parts["skin"])
    load(place("talk.fba"), frame_start=0)
    assert data.animation_data.action != before
    moving = 0
    for old in before.fcurves:
        moving += len(old.keyframe_points) == FRAMES
        for frame in range(FRAMES):
            near(curve(data, old.data_path).evaluate(frame), old.evaluate(frame),
                f"{old.data_path} {frame}", 4e-6)
    assert moving > 20, moving
    # Of FAP 3 alone, whose skin is a small part of the chin.
    made = poses(parts["Armature"], FRAMES)["jaw_bone"]
    assert max(apart(made[frame], wanted[frame]) for frame in range(FRAMES)) < 3


def a_head_is_made_where_none_is_selected():
    clean()
    bpy.context.scene.render.fps = 25
    load(place("talk.fba"), own_head="child")
    meshes = [item for item in bpy.data.objects if item.type == "MESH"]
    assert len(meshes) > 8
    table = told(place("talk.fba"))["jawopen"]
    skin = next(item for item in meshes if item.data.shape_keys
        and len(item.data.shape_keys.key_blocks) > 45)
    for frame in range(FRAMES):
        near(key_curve(skin, "jawOpen").evaluate(1 + frame), table[frame], "jawOpen")
    assert all(action.name.startswith("talk ") for action
        in bpy.data.actions), list(bpy.data.actions)


run(shapes_and_bones_are_those_of_our_own_animation, the_jaw_bone_follows_the_shape_of_the_jaw,
    fap_keys_are_those_of_our_own_animation, a_head_is_made_where_none_is_selected)
