"""Onto a mesh with ARKit's shapes: values, rates, actions, sound."""

import os
import sys
from array import array
from fractions import Fraction
import wave

import bpy

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from support import *  # noqa: F403

NAMES = None


def clips():
    global NAMES
    text = write("talk.fap", fap_text())
    animeme("encode", text, "-o", place("talk.fba"))
    click("voice.wav")
    animeme("mux", place("talk.fba"), place("voice.wav"), "-o", place("talk.mp4"))
    NAMES = sys.modules["animeme_face"].names.ARKIT


def every_value_is_the_programs():
    for ending in ("fap", "fba", "mp4"):
        clean()
        item = mesh_with(NAMES)
        bpy.context.scene.render.fps = 25
        load(place("talk." + ending))
        table = told(place("talk." + ending))
        moving = 0
        for name in NAMES:
            values = table[name.lower()]
            made = key_curve(item, name)
            for frame in range(FRAMES):
                near(made.evaluate(1 + frame), values[frame], f"{ending} {name} {frame}")
            moves = max(values) > min(values)
            moving += moves
            assert len(made.keyframe_points) == (FRAMES if moves else 1), name
        assert moving > 15, moving
        assert len(bpy.data.actions) == 1 and bpy.data.actions[0].name == "talk"
        bpy.context.scene.frame_set(20)
        near(item.data.shape_keys.key_blocks["jawOpen"].value, table["jawopen"][19], "shown")


def spellings():
    clean()
    names = ["JawOpen", "Wolf3D.eyeBlink_L", "blendShape1.mouthPucker", "ARKit_mouthFunnel",
        "browInnerUp_R", "Blink",
             "nothing known"]
    item = mesh_with(names)
    bpy.context.scene.render.fps = 25
    load(place("talk.fba"))
    table = told(place("talk.fba"))
    for name, shape in (("JawOpen", "jawopen"), ("Wolf3D.eyeBlink_L", "eyeblinkleft"),
                        ("blendShape1.mouthPucker", "mouthpucker"),
                        ("ARKit_mouthFunnel", "mouthfunnel"),
                        ("browInnerUp_R", "browinnerup")):
        for frame in range(FRAMES):
            near(key_curve(item, name).evaluate(1 + frame), table[shape][frame], name)
    # The left lid has a key of its own: what names both is left alone.
    assert len(bpy.data.actions[0].fcurves) == 5


def visemes_where_there_is_no_jaw():
    clean()
    names = ["viseme_PP", "viseme_aa", "Fcl_MTH_U", "Fcl_EYE_Close", "mouthOpen"]
    item = mesh_with(names)
    bpy.context.scene.render.fps = 25
    load(place("talk.fba"))
    out = place("told.visemes.csv")
    animeme("export", place("talk.fba"), "-o", out)
    with open(out, encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    table = told(place("talk.fba"))
    for frame in range(FRAMES):
        for name, viseme in (("viseme_PP", "viseme_PP"), ("viseme_aa", "viseme_aa"),
            ("Fcl_MTH_U", "viseme_U")):
            near(key_curve(item, name).evaluate(1 + frame), float(rows[frame][viseme]), name, 6e-5)
        both = (table["eyeblinkleft"][frame] + table["eyeblinkright"][frame]) / 2
        near(key_curve(item, "Fcl_EYE_Close").evaluate(1 + frame), both, "lids")
    assert len(bpy.data.actions[0].fcurves) == 4  # the visemes open the mouth
    # Beside ARKit's jaw they rest.
    clean()
    item = mesh_with(["viseme_PP", "jawOpen"])
    load(place("talk.fba"))
    assert [made.data_path for made in bpy.data.actions[0].fcurves] == [
        'key_blocks["jawOpen"].value']


def the_scenes_rate():
    table = None
    for fps, base in ((24, 1), (25, 1), (30, 1), (60, 1), (30, 1.001)):
        clean()
        item = mesh_with(["jawOpen"])
        render = bpy.context.scene.render
        render.fps, render.fps_base = fps, base
        load(place("talk.mp4"), frame_start=7)
        assert (render.fps, render.fps_base) == (fps, bpy.context.scene.render.fps_base)
        table = table or told(place("talk.mp4"))["jawopen"]
        made = key_curve(item, "jawOpen")
        step = Fraction(25) / rate()
        last = 7 + int(-(-(FRAMES - 1) // step))
        for frame in range(7, last + 1):
            near(made.evaluate(frame), at(table, (frame - 7) * step), f"{fps}/{base} {frame}", 4e-6)
        places = [point.co[0] for point in made.keyframe_points]
        assert places == list(range(7, last + 1)), (fps, places[0], places[-1])
        strip = strips()[0]
        assert strip.frame_final_start == 7 and strip.type == "SOUND"
        near(strip.frame_final_duration / float(rate()), 1.2, "seconds of sound", 2 / fps)


def the_clips_rate():
    for told_rate, wanted, fps in (("25", Fraction(25), 25), ("30", Fraction(30000, 1001), 30),
        ("60", 60, 60)):
        clean()
        item = mesh_with(["jawOpen"])
        text = fap_text(told_rate).replace("2.1 made 30 ", "2.1 made@29.97fps 30 ")
        load(write("rated.fap", text), rate="SET")
        assert rate() == wanted and bpy.context.scene.render.fps == fps, rate()
        assert len(key_curve(item, "jawOpen").keyframe_points) == FRAMES
        assert not strips()


def twice_is_two_actions():
    clean()
    item = mesh_with(["jawOpen"])
    load(place("talk.fba"))
    first = item.data.shape_keys.animation_data.action
    load(place("talk.mp4"), frame_start=101)
    assert len(bpy.data.actions) == 2 and first.use_fake_user
    assert item.data.shape_keys.animation_data.action != first
    assert [point.co[0] for point in first.fcurves[0].keyframe_points][0] == 1
    assert not item.data.shape_keys.animation_data.nla_tracks
    # What somebody animated by hand goes on below.
    clean()
    item = mesh_with(["jawOpen", "own"])
    item.data.shape_keys.key_blocks["own"].value = 0.5
    item.data.shape_keys.key_blocks["own"].keyframe_insert("value", frame=1)
    item.data.shape_keys.key_blocks["own"].value = 0
    load(place("talk.fba"))
    bpy.context.scene.frame_set(10)
    near(item.data.shape_keys.key_blocks["own"].value, 0.5, "of the animation before")


def the_click_is_heard_where_it_belongs():
    clean()
    mesh_with(["jawOpen"])
    scene = bpy.context.scene
    scene.frame_end = 5
    load(place("talk.mp4"), frame_start=11, rate="SET")
    strip = strips()[0]
    assert (strip.frame_final_start, strip.channel, strip.name) == (11, 1, "talk")
    assert scene.frame_end == 11 + FRAMES - 1 and scene.sync_mode == "AUDIO_SYNC"
    near(heard(), 0.5 + 10 / 25, "seconds of the click", 0.002)
    # A second one on top goes to the next channel, one behind it beside the first.
    load(place("talk.mp4"), frame_start=12)
    load(place("talk.mp4"), frame_start=201)
    assert [strip.channel for strip in sorted(strips(), key=lambda strip: strip.frame_start)] == [1,
        2, 1]


def heard():
    """Seconds of the click in Blender's own mixdown."""
    bpy.ops.sound.mixdown(filepath=place("mixed.wav"), container="WAV", codec="PCM", format="S16")
    with wave.open(place("mixed.wav")) as file:
        samples = array("h", file.readframes(file.getnframes()))[:: file.getnchannels()]
        return next(i for i, value in enumerate(samples) if abs(value) > 5000) / file.getframerate()


def sound_of_other_files_is_cut_and_packed():
    for name, more in (("parts.mp4", ["--fragmented"]), ("talk.mkv", []), ("talk.ts", []),
                       ("opus.mkv", ["--audio-codec", "opus"])):
        clean()
        mesh_with(["jawOpen"])
        animeme("mux", place("talk.fba"), place("voice.wav"), *more, "-o", place(name))
        load(place(name), frame_start=11, rate="SET")
        strip = strips()[0]
        assert strip.frame_final_start == 11 and strip.sound.packed_file and not os.path.exists(
            strip.sound.filepath)
        near(heard(), 0.5 + 10 / 25, name, 0.002)


def sound_beside_the_clip_and_by_name():
    clean()
    mesh_with(["jawOpen"])
    load(place("talk.fba"))
    assert not strips()
    click("talk.wav")
    load(place("talk.fba"))
    assert bpy.path.abspath(strips()[0].sound.filepath) == place("talk.wav")
    load(place("talk.mp4"), sound_path=place("voice.wav"))
    assert sorted(os.path.basename(strip.sound.filepath) for strip in strips()) == ["talk.wav",
        "voice.wav"]
    load(place("talk.mp4"), use_sound=False)
    assert len(strips()) == 2


run(clips, every_value_is_the_programs, spellings, visemes_where_there_is_no_jaw, the_scenes_rate,
    the_clips_rate,
    twice_is_two_actions, the_click_is_heard_where_it_belongs,
    sound_of_other_files_is_cut_and_packed,
    sound_beside_the_clip_and_by_name)
