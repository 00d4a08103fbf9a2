"""Heads and their vertices."""
import numpy as np
import pytest

import animeme
from conftest import random_clip


@pytest.fixture(scope="module", params=["woman", "man", "child"])
def head(request):
    return animeme.Head(request.param)


def fap(name, value):
    values = np.zeros(68)
    values[animeme.FAP_NAMES.index(name)] = value
    return values


def test_the_mesh(head):
    n = len(head.vertices)
    assert head.vertices.shape == (n, 3) and head.vertices.dtype == np.float32
    assert head.triangles.dtype == np.uint32 and head.triangles.max(
        ) < n and not head.triangles.flags.writeable
    assert head.colours.shape == (n, 3) and 0 <= head.colours.min() <= head.colours.max() <= 1
    parts = sorted((p.start, p.stop) for p in head.parts.values())
    assert parts[0][0] == 0 and parts[-1][1] == n and "skin" in head.parts and head.notes == []
    assert all(a[1] == b[0] for a, b in zip(parts, parts[1:]))
    for part in head.parts.values():  # no triangle goes from one part to another
        inside = (head.triangles >= part.start) & (head.triangles < part.stop)
        assert (inside.all(axis=1) == inside.any(axis=1)).all()


def test_faps_move_it(head):
    assert np.array_equal(head.pose(np.zeros(68)), head.vertices)
    jaw = head.pose(fap("open_jaw", 600)) - head.vertices
    assert jaw.shape == head.vertices.shape and jaw[:, 1].min() < -0.8  # the chin, cm
    assert np.abs(jaw[head.parts["upper_teeth"]]).max() == 0
    gaze = head.pose(fap("yaw_l_eyeball", 30000)) - head.vertices
    assert np.abs(gaze[head.parts["left_eye"]]).max() > 0.2
    assert np.abs(gaze[head.parts["right_eye"]]).max() == 0
    # Lids follow the gaze unless somebody moves them, if only to 0.
    down = fap("pitch_l_eyeball", 20000)
    skin = head.parts["skin"]
    assert not np.array_equal(head.pose(down)[skin], head.pose(down, np.ones(68, bool))[skin])
    assert np.array_equal(head.pose(down, follow=False)[skin],
        head.pose(down, np.ones(68, bool))[skin])


def test_clips_are_posed_frame_by_frame(head):
    clip = random_clip(2, frames=5, largest=100)
    posed = head.pose(clip)
    assert posed.shape == (5, *head.vertices.shape)
    for i in range(5):
        # Masks of a clip are filled: who never moved is at 0.
        shown = clip.fill(complete=True)
        assert np.array_equal(posed[i], head.pose(shown.values[i], shown.mask[i]))


def test_heads_as_files(tmp_path):
    head = animeme.Head()
    clip = animeme.Clip([fap("open_jaw", 400 * i) for i in range(2)])
    head.save(clip, tmp_path / "talk.glb")
    again = animeme.Head(tmp_path / "talk.glb")
    moved = again.pose(fap("open_jaw", 400)) - again.vertices
    expected = head.pose(fap("open_jaw", 400)) - head.vertices
    assert len(again.vertices) > 1000 and 0.5 < moved[:, 1].min() / expected[:, 1].min() < 1.5


def test_what_is_no_head_is_an_error(tmp_path, head):
    with pytest.raises(animeme.Error) as caught:
        animeme.Head("nobody")
    assert caught.value.code == "invalid_argument"
    (tmp_path / "bad.glb").write_bytes(b"glTF, not")
    with pytest.raises(animeme.Error) as caught:
        animeme.Head(tmp_path / "bad.glb")
    assert caught.value.position.file == str(tmp_path / "bad.glb")
    for wrong in (np.zeros(67), np.zeros((2, 68)), np.full(68, np.nan)):
        with pytest.raises(ValueError):
            head.pose(wrong)
    with pytest.raises(TypeError):
        head.pose(random_clip(1), np.ones(68))


def test_names_of_shapes(tmp_path):
    """What shapes with other names mean: a dictionary, or a table in a file."""
    me = tmp_path / "me.glb"
    animeme.Head("child").save(animeme.Clip([np.zeros(68)]), me)
    swapped = {"eyeBlinkLeft": "eyeBlinkRight", "eyeBlinkRight": "eyeBlinkLeft"}
    table = tmp_path / "names.csv"
    table.write_text("shape,meaning\n" + "".join(f"{a},{b}\n" for a, b in swapped.items()))

    def side(names):
        """Where FAP 19 moves most: above 0 is the person's left."""
        head = animeme.Head(me, shape_names=names)
        moved = np.linalg.norm(head.pose(fap("close_t_l_eyelid", 1024)) - head.vertices, axis=1)
        return (moved * head.vertices[:, 0]).sum() / moved.sum()

    assert side(None) > 1
    assert side(swapped) < -1 and side(table) == side(swapped)
    with pytest.raises(animeme.Error):
        animeme.Head(me, shape_names={"jawOpen": "nothing known"})
    with pytest.raises(animeme.Error):
        animeme.Head(me, shape_names={"noSuchShape": "jawOpen"})
