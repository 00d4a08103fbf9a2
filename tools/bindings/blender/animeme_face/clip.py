"""A clip as values a frame, by name. The program decodes, fills and fits; here its outputs are
read."""

import json
import os
import tempfile
from dataclasses import dataclass, field
from fractions import Fraction

from .names import FAPS
from .program import Trouble, run


@dataclass
class Clip:
    """Curves by name, as long as each other: ARKit's shapes and angles, visemes, FAPs."""

    rate: Fraction  # frames a second
    frames: int
    curves: dict = field(default_factory=dict)

    def curve(self, name):
        return self.curves[name]


def read(program, path, wants, progress=lambda share: None):
    """Reads a file with a face. `wants`: any of "arkit", "visemes", "faps"; ARKit's curves are always there."""
    if not os.path.isfile(path):
        raise Trouble(f"{path}: there is no such file")
    with tempfile.TemporaryDirectory(prefix="animeme_") as folder:
        clip = _table(program, path, "arkit", folder)
        progress(0.4)
        if "visemes" in wants:
            _join(clip, _table(program, path, "visemes", folder), path)
        progress(0.6)
        if "faps" in wants:
            _join(clip, _faps(program, path, folder, clip.rate), path)
    return clip


def _table(program, path, what, folder):
    out = os.path.join(folder, what + ".json")
    run(program, "export", path, "--what", what, "-o", out)
    with open(out, encoding="utf-8") as file:
        table = json.load(file)
    if table["format"] != "animeme-" + what or table["version"] != 1:
        found = f"{table['format']} {table['version']}"
        raise Trouble(
            f"{path}: animeme writes {found}, which this add-on does not support; update it")
    rows = table["frames"]
    if not rows:
        raise Trouble(f"{path}: the face has no frame")
    return Clip(Fraction(*table["rate"]), len(rows), dict(zip(table["names"], zip(*rows))))


def _faps(program, path, folder, rate):
    """FAPs 3 to 68 of a text in which each frame has all of them: a line of flags, a line of
    values."""
    out = os.path.join(folder, "all.fap")
    run(program, "decode", path, "--fill", "--expand", "--exact", "-o", out)
    with open(out, encoding="utf-8") as file:
        lines = file.read().splitlines()[1:]
    rows = []
    for flags, values in zip(lines[::2], lines[1::2]):
        numbers = [int(value) for value in values.split()]
        if flags.split() != ["0", "0"] + ["1"] * 66:
            raise Trouble(f"{path}: animeme omitted FAPs; update it")
        # A number that is left out repeats the frame before.
        while rows and len(rows) < numbers[0]:
            rows.append(rows[-1])
        rows.append(numbers[1:])
    return Clip(rate, len(rows), dict(zip(FAPS, zip(*rows))))


def _join(clip, other, path):
    if other.frames != clip.frames or other.rate != clip.rate:
        raise Trouble(
            f"{path}: {clip.frames} frames of shapes, but {other.frames} of visemes or FAPs; update animeme")
    clip.curves.update(other.curves)
