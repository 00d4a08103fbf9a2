"""What is wrong is told with file and remedy, and changes nothing; what was done is undone."""

import os
import sys

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from support import *  # noqa: F403


def files_that_are_no_face():
    write("talk.fap", fap_text())
    animeme("encode", place("talk.fap"), "-o", place("talk.fba"))
    click("voice.wav")
    animeme("mux", place("talk.fba"), place("voice.wav"), "-o", place("talk.mp4"))
    mesh_with(["jawOpen", "open_jaw", "viseme_aa"])
    refuses(["nowhere.fba", "no such file"], place("nowhere.fba"))
    for ending in ("fba", "fap", "mp4"):
        with open(place("noise." + ending), "wb") as file:
            file.write(bytes((i * i * 7 + i) % 251 for i in range(5000)))
        refuses(["noise." + ending], place("noise." + ending))
        open(place("empty." + ending), "wb").close()
        refuses(["empty." + ending], place("empty." + ending))
    refuses(["bad.fap:6:"], write("bad.fap", fap_text()[:600] + " x\n"))
    with open(place("talk.mp4"), "rb") as file, open(place("cut.mp4"), "wb") as out:
        out.write(file.read()[:700])
    refuses(["cut.mp4"], place("cut.mp4"))
    refuses(["voice.wav"], place("voice.wav"))
    refuses(["gone.wav", "no such sound"], place("talk.fba"), sound_path=place("gone.wav"))


def nobody_to_move():
    clean()
    mesh_with(["smirk", "second"])
    refuses(["jawOpen", "select nothing"], place("talk.fba"))
    select()
    refuses(["Select a mesh"], place("talk.fba"), own_head="none")


def no_program():
    clean()
    mesh_with(["jawOpen"])
    settings = bpy.context.preferences.addons["animeme_face"].preferences
    settings.program = place("nothing_here")
    refuses(["nothing_here", "Preferences"], place("talk.fba"))
    settings.program = place("talk.fap")  # no program at all
    refuses(["talk.fap", "Preferences"], place("talk.fba"))
    settings.program = ""
    path, os.environ["PATH"] = os.environ["PATH"], FOLDER
    refuses(["PATH", "Preferences"], place("talk.fba"))
    # Beside the add-on.
    beside = os.path.join(os.path.dirname(sys.modules["animeme_face"].__file__), "animeme")
    os.symlink(PROGRAM, beside)
    load(place("talk.fba"))
    os.remove(beside)
    # In PATH, and in a folder that is set.
    os.environ["PATH"] = os.path.dirname(PROGRAM)
    load(place("talk.fba"))
    os.environ["PATH"] = FOLDER
    settings.program = os.path.dirname(PROGRAM)
    load(place("talk.fba"))
    os.environ["PATH"] = path


def undone():
    clean()
    item = mesh_with(["jawOpen"])
    bpy.context.scene.frame_end = 3
    bpy.ops.ed.undo_push(message="before")
    load(place("talk.mp4"), rate="SET", frame_start=3)
    assert len(bpy.data.actions) == 1 and len(strips()) == 1 and bpy.context.scene.render.fps == 25
    bpy.ops.ed.undo()
    item = bpy.data.objects["face"]
    assert len(bpy.data.actions) == 0 and not strips(
        ) and item.data.shape_keys.animation_data is None
    assert bpy.context.scene.frame_end == 3 and bpy.context.scene.render.fps == 24
    bpy.ops.ed.redo()
    assert len(bpy.data.actions) == 1 and len(strips()) == 1


def names_of_all_kinds():
    clean()
    item = mesh_with(['jaw"Open', "jawOpen", "mouth\\Pucker"])
    bpy.context.scene.render.fps = 25
    with open(place("talk.fba"), "rb") as file, open(place("Grüße 'n \"so\" 100%.fba"),
        "wb") as out:
        out.write(file.read())
    load(place("Grüße 'n \"so\" 100%.fba"))
    action = bpy.data.actions[0]
    assert action.name.startswith("Grüße"), action.name
    bpy.context.scene.frame_set(12)
    shown = item.data.shape_keys.key_blocks
    assert shown["jawOpen"].value > 0
    near(shown['jaw"Open'].value, shown["jawOpen"].value, "a name with a quote")
    assert all(made.is_valid for made in action.fcurves) and len(action.fcurves) == 3


def off_and_on_again():
    bpy.ops.preferences.addon_disable(module="animeme_face")
    assert not hasattr(bpy.types, "IMPORT_SCENE_OT_animeme")
    install()
    mesh_with(["jawOpen"])
    load(place("talk.fba"))
    # A new version over it.
    old = sys.modules["animeme_face"].operators.ImportFace
    bpy.ops.preferences.addon_install(filepath=place("animeme_face.zip"))
    install()
    assert sys.modules["animeme_face"].operators.ImportFace is not old
    load(place("talk.fba"))


run(files_that_are_no_face, nobody_to_move, no_program, undone, names_of_all_kinds,
    off_and_on_again)
