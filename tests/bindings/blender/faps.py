"""Onto shape keys that are called like FAPs."""

import os
import re
import sys

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from support import *  # noqa: F403


def of_text(path):
    """{FAP: a value a frame} of a text, read here; what no mask shows is 0."""
    with open(path, encoding="utf-8") as file:
        lines = file.read().splitlines()[1:]
    values = {fap: [] for fap in range(3, 69)}
    for flags, numbers in zip(lines[::2], lines[1::2]):
        shown = [fap for fap, flag in enumerate(flags.split(), 1) if flag == "1"]
        row = dict(zip(shown, map(int, numbers.split()[1:])))
        for fap in values:
            values[fap].append(row.get(fap, 0))
    return values


def names():
    return list(sys.modules["animeme_face"].names.FAPS)


def the_table_is_the_standards():
    with open(os.path.join(SOURCE, "fap/tables.cpp"), encoding="utf-8") as file:
        row = r'\{(\d+), "(\w+)", Unit::\w+, Motion::\w+,\s*\w+, \d+, \d+, \d+,\s*"[^"]*",\s*(\d+),\s*(\d+),'
        rows = re.findall(row, file.read())
    assert len(rows) == 68
    wanted = {name: int(step) * int(end) for number, name, step, end in rows if int(number) > 2}
    assert wanted == sys.modules["animeme_face"].names.FAPS
    assert list(wanted) == names()
    for name in names():
        meaning = sys.modules["animeme_face"].names.meaning_of(name)
        assert meaning.kind == "fap" and meaning.curves == (name,), name


def every_value_is_the_texts():
    text = write("talk.fap", fap_text())
    animeme("encode", text, "-o", place("talk.fba"))
    animeme("decode", place("talk.fba"), "-o", place("shown.fap"))
    for clip, shown in (("talk.fap", "talk.fap"), ("talk.fba", "shown.fap")):
        clean()
        item = mesh_with(names())
        bpy.context.scene.render.fps = 25
        load(place(clip))
        values = of_text(place(shown))
        for fap, name in enumerate(names(), 3):
            made = key_curve(item, name)
            for frame in range(FRAMES):
                near(made.evaluate(1 + frame), values[fap][frame] / 1024, f"{clip} {name} {frame}",
                    4e-5)
        # Beyond 0 and 1 a key would stop at the ends of its slider.
        key = item.data.shape_keys.key_blocks["raise_b_midlip"]
        lowest = min(range(FRAMES), key=lambda frame: values[5][frame])
        assert values[5][lowest] < -100
        bpy.context.scene.frame_set(1 + lowest)
        near(key.value, values[5][lowest] / 1024, "shown below 0", 4e-5)


def other_scales():
    clean()
    item = mesh_with(["FAP03_open_jaw", "Open Jaw.001"])
    bpy.context.scene.render.fps = 25
    values = of_text(place("talk.fap"))[3]
    load(place("talk.fap"), fap_units=350)
    near(key_curve(item, "FAP03_open_jaw").evaluate(9), values[8] / 350, "units")
    load(place("talk.fap"), fap_scale="RANGE")
    near(key_curve(item, "FAP03_open_jaw").evaluate(9), values[8] / 4320, "range")


def frames_that_are_skipped_are_held():
    text = fap_text().splitlines()
    kept = [text[0].replace(str(FRAMES), "4")]
    for frame in (0, 1, 4, 5):
        kept += text[1 + 2 * frame: 3 + 2 * frame]
    clean()
    item = mesh_with(["open_jaw", "jawOpen"])
    bpy.context.scene.render.fps = 25
    load(write("gaps.fap", "\n".join(kept) + "\n"))
    values = of_text(place("talk.fap"))[3]
    shapes = told(place("gaps.fap"))["jawopen"]
    assert len(shapes) == 6
    for frame, shown in enumerate((0, 1, 1, 1, 4, 5)):
        near(key_curve(item, "open_jaw").evaluate(1 + frame), values[shown] / 1024, f"held {frame}")
        near(key_curve(item, "jawOpen").evaluate(1 + frame), shapes[frame], f"shape {frame}")


run(the_table_is_the_standards, every_value_is_the_texts, other_scales,
    frames_that_are_skipped_are_held)
