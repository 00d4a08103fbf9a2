"""Every stream of the conformance suite, value for value, against the texts beside it."""
import json
from fractions import Fraction

import numpy as np
import pytest

import animeme
from conftest import CASES

NAMES = sorted(path.parent.name for path in CASES.glob("*/case.json"))


def frames_of(path, count):
    """Masks, numbers and values of FAP or BAP text, read by hand: line by line."""
    lines = [line for line in path.read_text().splitlines() if line.strip()
        and not line.startswith("#")]
    frames = []
    for mask_line, value_line in zip(lines[1::2], lines[2::2]):
        mask = np.array(mask_line.split(), int).astype(bool)
        number, *values = map(int, value_line.split())
        frames.append((number, mask, values))
        assert len(mask) == count or count == 296
    return frames


def planes_of(data):
    """All planes that there are, fed in pieces, and the kinds of errors between them."""
    decoder, planes, errors = animeme.Decoder(), [], []
    for at in [*range(0, len(data), 333), None]:
        if at is None:
            decoder.finish()
        else:
            decoder.push(data[at : at + 333])
        while True:
            try:
                plane = decoder.pull()
            except animeme.Error as error:
                assert error.position.bit is not None
                errors.append(error.code)
                continue
            if plane is None:
                break
            planes.append(plane)
    assert decoder.ended
    return planes, errors


def coded(plane):
    """What the plane codes of the face as text has it: FAP 1 and 2 by their parts."""
    values = []
    if plane.mask[0]:
        values += plane.viseme
    if plane.mask[1]:
        values += plane.expression
    return values + list(plane.values[2:][plane.mask[2:]])


def test_the_suite_is_there():
    assert len(NAMES) >= 225


@pytest.mark.filterwarnings("ignore::animeme.InputWarning")
@pytest.mark.parametrize("name", NAMES)
def test_case(name):
    folder = CASES / name
    case = json.loads((folder / "case.json").read_text())
    data = (folder / f"{name}.fba").read_bytes()
    planes, errors = planes_of(data)
    damaged = case["expected"] == "error"
    assert bool(errors) == damaged and set(errors) <= set(case.get("errors", []))
    kind = "intact" if damaged else "dec"
    for suffix, count in (("fap", 68), ("bap", 296)):
        path = folder / f"{name}.{kind}.{suffix}"
        got = [p for p in planes if (p.face if suffix == "fap" else p.body is not None)]
        expected = frames_of(path, count) if path.exists() else []
        assert len(got) == len(expected)
        for plane, (number, mask, values) in zip(got, expected):
            assert plane.number == number
            if suffix == "fap":
                assert (plane.mask == mask).all() and coded(plane) == values
            else:
                body, present = plane.body
                assert (present[: len(mask)] == mask).all() and not present[len(mask) :].any()
                assert list(body[present]) == values
    if not damaged:
        assert planes[0].rate == pytest.approx(float(Fraction(case["rate"])), rel=2e-4)
        if case["object"] == "face":
            clip = animeme.decode(data)
            assert (clip.values == [p.values for p in planes if p.face]).all()
            assert clip == animeme.load(folder / f"{name}.fba")
    else:
        with pytest.raises(animeme.Error):
            animeme.decode(data)
