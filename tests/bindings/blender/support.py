"""What the tests in Blender share: the add-on installed, clips made by the program, and its CSV to
compare with."""

import csv
import math
import os
import subprocess
import sys
import wave
from array import array
from fractions import Fraction

import bpy

PROGRAM, SOURCE, FOLDER = sys.argv[-3:]
FRAMES = 40


def animeme(*arguments):
    done = subprocess.run([PROGRAM, "-q", *arguments], check=False, capture_output=True)
    assert done.returncode == 0, (arguments, done.stderr.decode())
    return done.stdout.decode()


def place(name):
    return os.path.join(FOLDER, name)


def install():
    """As "Install..." in the preferences does."""
    if "animeme_face" not in sys.modules:
        bpy.ops.preferences.addon_install(filepath=place("animeme_face.zip"))
    bpy.ops.preferences.addon_enable(module="animeme_face")
    bpy.context.preferences.addons["animeme_face"].preferences.program = PROGRAM


def fap_text(rate="25", first=0):
    """A clip in which jaw, lips, lids, gaze, brows and head move, each at its own speed."""
    faps = list(range(3, 16)) + [ 19, 20, 23, 24, 25, 26, 31, 32, 48, 49, 50] + list(range(51, 61))
    flags = " ".join("1" if fap in faps else "0" for fap in range(1, 69))
    text = f"2.1 made {rate} {FRAMES}\n"
    for frame in range(FRAMES):
        text += flags + "\n" + str(first + frame)
        for fap in faps:
            size = {3: 700, 23: 30000, 24: 30000, 25: 20000, 26: 20000, 48: 20000, 49: 30000,
                50: 9000}.get(fap, 200)
            swing = math.sin(frame * (0.11 + 0.007 * fap) + fap)
            # The jaw opens only; lids close now and then.
            swing = abs(swing) if fap == 3 else 5 * max(0, swing - 0.2) if fap in (19,
                20) else swing
            text += f" {round(size * swing)}"
        text += "\n"
    return text


def write(name, text):
    with open(place(name), "w", encoding="utf-8") as file:
        file.write(text)
    return place(name)


def click(name, seconds=0.5, length=1.2):
    """A sound that is silent but for a click."""
    samples = array("h", [0] * int(16000 * length))
    for i in range(160):
        samples[int(16000 * seconds) + i] = 20000 if (i // 8) % 2 else -20000
    with wave.open(place(name), "wb") as file:
        file.setnchannels(1)
        file.setsampwidth(2)
        file.setframerate(16000)
        file.writeframes(samples.tobytes())
    return place(name)


def told(path):
    """The program's own table of a clip: {ARKit's name, small letters: a value a frame}."""
    out = place("told.csv")
    animeme("export", path, "-o", out)
    with open(out, encoding="utf-8") as file:
        rows = list(csv.reader(file))
    columns = {name.lower(): [float(row[i]) for row in rows[1:]] for i,
        name in enumerate(rows[0]) if i > 1}
    return columns


def at(values, place_):
    """On the line between two frames."""
    place_ = min(place_, len(values) - 1)
    i = min(int(place_), len(values) - 2)
    return values[i] + (values[i + 1] - values[i]) * float(place_ - i)


def clean():
    bpy.ops.wm.read_factory_settings(use_empty=True)
    install()


def mesh_with(names, name="face"):
    """A triangle with shape keys of these names, selected."""
    data = bpy.data.meshes.new(name)
    data.from_pydata([(0, 0, 0), (1, 0, 0), (0, 1, 0)], [], [(0, 1, 2)])
    item = bpy.data.objects.new(name, data)
    bpy.context.collection.objects.link(item)
    item.shape_key_add(name="Basis")
    for key in names:
        item.shape_key_add(name=key).data[0].co = (0, 0, 0.1)
    select(item)
    return item


def select(*items):
    for other in bpy.context.scene.objects:
        other.select_set(other in items)
    bpy.context.view_layer.objects.active = items[0] if items else None


def load(path, **options):
    # Blender remembers what an operator was told last.
    usual = dict(frame_start=1, rate="KEEP", use_sound=True, head="BOTH", eyes="AUTO", use_jaw=True,
        own_head="woman",
                 fap_scale="UNITS", fap_units=1024)
    result = bpy.ops.import_scene.animeme("EXEC_DEFAULT", True, filepath=path,
        **{**usual, **options})
    assert result == {"FINISHED"}, result


def curve(owner, path, index=0):
    found = owner.animation_data.action.fcurves.find(path, index=index)
    assert found, (path, index, [item.data_path for item in owner.animation_data.action.fcurves])
    return found


def key_curve(item, key):
    return curve(item.data.shape_keys, f'key_blocks["{key}"].value')


def near(is_, wanted, what, within=2e-6):
    assert abs(is_ - wanted) <= within, f"{what}: {is_}, not {wanted}"


def strips():
    editor = bpy.context.scene.sequence_editor
    return list(editor.sequences_all) if editor else []


def rate():
    render = bpy.context.scene.render
    return Fraction(render.fps) / Fraction(render.fps_base).limit_denominator(10000)


def refuses(words, path, **options):
    """The import ends with an error that has these words, and leaves everything as it was."""
    before = [len(bpy.data.actions), len(bpy.data.objects), len(strips())]
    try:
        bpy.ops.import_scene.animeme(filepath=path, **options)
    except RuntimeError as error:
        text = str(error)
        for word in words:
            assert word in text, f"{word!r} is not in {text!r}"
        assert "Traceback" not in text, text
        assert before == [len(bpy.data.actions), len(bpy.data.objects), len(strips())]
        return
    raise AssertionError(f"{path} is no error")


def run(*tests):
    clean()
    for test in tests:
        test()
        print("ok", test.__name__)
    print("ALL DONE")
