"""Clips as arrays."""
import copy
import pickle
from fractions import Fraction

import numpy as np
import pytest

import animeme
from conftest import random_clip


def test_arrays_have_the_shapes_that_the_docstrings_say(sample_clip):
    n = len(sample_clip)
    assert sample_clip.values.shape == (n, 68) and sample_clip.values.dtype == np.int32
    assert sample_clip.mask.shape == (n, 68) and sample_clip.mask.dtype == np.bool_
    assert sample_clip.viseme.shape == (n, 4) and sample_clip.expression.shape == (n, 6)
    assert sample_clip.numbers.shape == sample_clip.times.shape == (n,)
    assert sample_clip.rate == 25.0 and sample_clip.exact_rate == Fraction(25)
    assert sample_clip.times[1] == 1 / 25 and sample_clip.duration == n / 25
    assert not sample_clip.values[~sample_clip.mask].any()


def test_names_are_those_of_the_standard(sample_clip):
    assert len(animeme.FAP_NAMES) == 68 and animeme.FAP_NAMES[2] == "open_jaw"
    assert len(animeme.ARKIT_NAMES) == 61 and "jawOpen" in animeme.ARKIT_NAMES
    assert len(animeme.VISEME_NAMES) == 15 and animeme.VISEME_NAMES[0] == "viseme_sil"
    assert (sample_clip["open_jaw"] == sample_clip.values[:, 2]).all()
    with pytest.raises(KeyError):
        sample_clip["open_door"]


def test_columns_are_assigned_and_changed_in_place():
    clip = random_clip(1)
    before = clip.values.copy()
    absent = ~clip.mask[:, 2]
    clip["open_jaw"] *= 2
    assert (clip["open_jaw"] == before[:, 2] * 2).all() and (clip.mask[:, 2] == ~absent).all()
    column = clip["open_jaw"]
    clip["open_jaw"] = column[::-1]  # reads what it writes
    assert (clip["open_jaw"] == before[::-1, 2] * 2).all()
    clip["open_jaw"] = 1.6  # rounded, and there in every frame
    assert (clip["open_jaw"] == 2).all() and clip.mask[:, 2].all()
    clip["lower_t_midlip"] = np.arange(len(clip))
    assert (clip.values[:, 3] == np.arange(len(clip))).all()
    others = [i for i in range(68) if i not in (2, 3)]
    assert (clip.values[:, others] == before[:, others]).all()
    for name, value, error in (("open_door", 1, KeyError), ("viseme", 1, KeyError),
                               ("open_jaw", np.zeros(len(clip) + 1), ValueError),
                               ("open_jaw", np.nan, ValueError)):
        with pytest.raises(error):
            clip[name] = value
    with pytest.raises(TypeError):
        clip[1:2] = 0
    assert (clip["open_jaw"] == 2).all()


def test_content_changes_in_place_and_shapes_do_not():
    clip = random_clip(1)
    clip["open_jaw"][:] = 7
    clip.values[0, 2] = 8
    clip.values *= 2
    clip.mask[:, 5] = True
    assert clip.values[0, 2] == 16 and clip.values[1, 2] == 14 and clip.mask[:, 5].all()
    clip.values = clip.values * 0.6  # rounded as a new clip's are
    assert clip.values[0, 2] == 10 and clip.values[1, 2] == 8
    for bad in (np.nan, 2.0**40):
        with pytest.raises(ValueError, match="32 bits"):
            clip.values = bad
    kept = clip.values
    with pytest.raises(ValueError):
        clip.values = np.zeros((3, 68))
    with pytest.raises(ValueError):
        clip.mask.resize(1)
    kept.shape = (68, len(clip))  # the view's own
    spoilt = random_clip(1)
    spoilt.mask.base.resize(1, refcheck=False)
    with pytest.raises(ValueError, match="resized"):
        spoilt.fill()
    assert clip.values.shape == (len(clip), 68)
    del clip
    assert kept[0, 2] == 10  # arrays outlive their clip


def test_numbers_are_rounded_and_checked():
    values = np.zeros((1, 68))
    values[0, 2:5] = 1.5, -1.5, 1.4
    assert list(animeme.Clip(values).values[0, 2:5]) == [2, -2, 1]
    for bad in (np.nan, np.inf, 2.0**31):
        values[0, 2] = bad
        with pytest.raises(ValueError):
            animeme.Clip(values)
    for shape in ((68,), (2, 67), (2, 2, 68)):
        with pytest.raises(ValueError, match="68"):
            animeme.Clip(np.zeros(shape))
    with pytest.raises(ValueError, match="mask"):
        animeme.Clip(np.zeros((2, 68)), np.ones((3, 68)))
    with pytest.raises(ValueError, match="ascend"):
        animeme.Clip(np.zeros((2, 68)), numbers=[3, 3])
    with pytest.raises(ValueError, match="viseme"):
        animeme.Clip(np.zeros((2, 68)), viseme=np.zeros((3, 4)))


@pytest.mark.parametrize("given, exact", [
    (25, Fraction(25)), (12.5, Fraction(25, 2)), (29.97, Fraction(30000, 1001)),
    (30000 / 1001, Fraction(30000, 1001)), ("30000/1001", Fraction(30000, 1001)),
    (Fraction(24000, 1001), Fraction(24000, 1001)), (np.float32(30), Fraction(30)),
    (np.int64(50), Fraction(50)), (1e9, Fraction(10**9))])
def test_rates_are_exact(given, exact):
    assert animeme.Clip(np.zeros((1, 68)), rate=given).exact_rate == exact


@pytest.mark.parametrize("given", [0, -25, float("nan"), "fast", "0", Fraction(1, 2**40), 2**40])
def test_rates_that_are_none_are_refused(given):
    with pytest.raises(ValueError, match="rate"):
        animeme.Clip(np.zeros((1, 68)), rate=given)


@pytest.mark.parametrize("given", [None, [], object()])
def test_what_is_no_number_at_all_is_no_rate(given):
    with pytest.raises(TypeError):
        animeme.Clip(np.zeros((1, 68)), rate=given)


def test_slices_begin_at_0_and_keep_gaps():
    clip = animeme.Clip(np.zeros((4, 68)), numbers=[2, 3, 7, 8])
    part = clip[1:]
    assert list(part.numbers) == [0, 4, 5] and part.rate == clip.rate
    assert len(clip[4:]) == 0 and len(clip[-1:]) == 1
    for wrong in (slice(0, 4, 2), slice(4, 0, -1)):
        with pytest.raises(ValueError):
            clip[wrong]
    with pytest.raises(TypeError):
        clip[0]


def test_copies_equal_and_stand_alone(sample_clip):
    decoded = animeme.decode(animeme.encode(sample_clip))
    for twin in (copy.deepcopy(decoded), pickle.loads(pickle.dumps(decoded)), decoded[:]):
        assert twin == decoded and twin != sample_clip
        assert twin.fill(complete=True) == decoded.fill(complete=True)  # rules of absent FAPs, too
        twin.values[0, 2] += 1
        assert twin != decoded
    assert decoded != "a clip"


def test_high_level_faps_have_their_parts():
    viseme = [[1, 2, 63, 0], [3, 0, 10, 1]]
    clip = animeme.Clip(np.zeros((2, 68)), np.eye(68, dtype=bool)[0], viseme=viseme)
    again = animeme.decode(animeme.encode(clip, preset="plain"))
    assert (again.viseme == viseme).all() and again.mask[:, 0].all() and not again.mask[:, 1:].any()
    assert again.fill().mask[:, 2:].any()  # shown by low-level FAPs
    assert animeme.Clip(np.zeros((2, 68)), expression=np.zeros((2, 6))).mask[:, 1].all()


def test_resampled_clips_last_as_long(sample_clip):
    for rate in (30, 60, "30000/1001"):
        other = sample_clip.resample(rate)
        assert abs(other.duration - sample_clip.duration) <= 0.5 / other.rate + 1e-9
    half = sample_clip.resample(12.5)
    assert (half["open_jaw"] == sample_clip["open_jaw"][::2][: len(half)]).all()
