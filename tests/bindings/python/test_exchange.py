"""Files of all kinds, in and out."""
import json
import re
import subprocess
import uuid

import numpy as np
import pytest

import animeme
from conftest import PROGRAM, SAMPLE, SOURCE, random_clip


@pytest.mark.parametrize("ending", [".fba", ".fap", ".mp4", ".mkv", ".ts", ".m3u8"])
def test_what_is_saved_is_read_again(sample_clip, tmp_path, ending):
    path = tmp_path / f"talk{ending}"
    coded = animeme.decode(animeme.encode(sample_clip))
    coded.save(path)
    again = animeme.load(path)
    assert again.rate == 25 and len(again) == len(coded) and again.name == "talk"
    assert (again.fill(complete=True).values[coded.mask] == coded.values[coded.mask]).all()
    if ending in (".fba", ".fap"):
        assert again == coded
    if ending != ".m3u8":  # what it names lies beside it
        assert animeme.read(path.read_bytes()) == again


def test_curves_and_text_in_memory(sample_clip, tmp_path):
    sample_clip.save(tmp_path / "a.csv")
    assert animeme.load(str(tmp_path / "a.csv")) == sample_clip
    assert animeme.read((tmp_path / "a.csv").read_text()) == sample_clip
    assert animeme.read(sample_clip.to_text()) == sample_clip


def test_sound_goes_into_containers(sample_clip, tmp_path):
    import wave
    with wave.open(str(tmp_path / "beep.wav"), "wb") as file:
        file.setnchannels(1)
        file.setsampwidth(2)
        file.setframerate(16000)
        file.writeframes((8000 * np.sin(np.arange(48000) / 4)).astype("<i2").tobytes())
    sample_clip.save(tmp_path / "a.mp4", audio=tmp_path / "beep.wav")
    assert animeme.load(tmp_path / "a.mp4").duration == 3
    info = subprocess.run([PROGRAM, "info", "--json", tmp_path / "a.mp4"], capture_output=True,
        check=True)
    assert b"aac" in info.stdout
    with pytest.raises(animeme.Error) as caught:
        sample_clip.save(tmp_path / "b.mp4", audio=tmp_path / "none.wav")
    assert caught.value.code == "not_found" and not (tmp_path / "b.mp4").exists()


def test_arkit_there_and_back(tmp_path):
    frames = np.linspace(0, np.pi, 30)
    weights = np.zeros((30, 61))
    used = [animeme.ARKIT_NAMES.index(name) for name in ("jawOpen", "mouthSmileLeft", "headYaw")]
    weights[:, used] = np.transpose([0.5 * np.sin(frames), 0.6 + 0 * frames, 0.2 + 0 * frames])
    clip = animeme.Clip.from_arkit(weights, rate=30)
    shares = []
    again = clip.resample(60).arkit(progress=lambda share, stage: shares.append(share))
    assert again.shape == (60, 61) and np.abs(again[::2, used] - weights[:, used]).max() < 0.06
    assert np.abs(np.delete(again, used, axis=1)).max() < 0.25 and shares and shares[-1] <= 1
    two = animeme.Clip.from_arkit([[0.3, 0.1]] * 4, ["JawOpen", "eyeBlink_L"], rate=60)
    assert two["open_jaw"][0] > 0 and two["close_t_l_eyelid"][0] > 0
    clip.save(tmp_path / "a.livelink.csv")
    assert animeme.load(tmp_path / "a.livelink.csv").mask[0].sum() > 40
    clip.save(tmp_path / "a.json")
    assert np.shape(json.loads((tmp_path / "a.json").read_text())["frames"]) == (30, 61)
    with pytest.raises(KeyError):
        animeme.Clip.from_arkit(np.zeros((2, 1)), ["jawOpenWide"])
    with pytest.raises(ValueError):
        animeme.Clip.from_arkit(np.zeros((2, 2)), ["jawOpen"])


def test_visemes(sample_clip, tmp_path):
    weights = sample_clip.visemes()
    assert weights.shape == (len(sample_clip), 15) and np.allclose(weights.sum(axis=1), 1)
    for ending in (".visemes.json", ".visemes.csv", ".tsv", ".xml", ".dat", ".rhubarb.json",
        ".talkinghead.json"):
        sample_clip.save(tmp_path / f"a{ending}")
        assert (tmp_path / f"a{ending}").stat().st_size > 50


@pytest.mark.skipif(not PROGRAM.exists(), reason="the program is not built")
@pytest.mark.parametrize("ending", [".livelink.csv", ".json", ".visemes.csv", ".tsv"])
def test_exports_are_those_of_the_program(sample_clip, tmp_path, ending):
    sample_clip.save(tmp_path / f"ours{ending}")
    done = [PROGRAM, "export", SAMPLE / "fap/prac8p.csv", "-o", tmp_path / f"its{ending}"]
    subprocess.run(done, check=True, capture_output=True)
    assert (tmp_path / f"ours{ending}").read_bytes() == (tmp_path / f"its{ending}").read_bytes()


def test_errors_have_file_line_and_column(tmp_path):
    path = tmp_path / "broken.fap"
    path.write_text("2.1 clip 25 1\n" + "1 " * 67 + "x\n0 1\n")
    with pytest.raises(animeme.Error) as caught:
        animeme.load(path)
    error = caught.value
    assert error.code == "syntax" and error.position.file == str(path)
    assert error.position.line == 2 and error.position.column == 135 and error.position.bit is None
    assert str(error).startswith(f"{path}:2:135: ") and str(error).endswith(error.message)
    with pytest.raises(animeme.Error) as caught:
        animeme.read(path.read_text())
    assert caught.value.position == animeme.Position(line=2, column=135)
    with pytest.raises(animeme.Error) as caught:
        animeme.load(tmp_path / "none.fba")
    assert caught.value.code == "not_found" and "none.fba" in str(caught.value)
    with pytest.raises(animeme.Error) as caught:
        animeme.load(tmp_path)
    assert caught.value.code == "io"
    with pytest.raises(animeme.Error) as caught:
        random_clip(1).save(tmp_path / "nowhere/a.fba")
    assert caught.value.code == "io"
    with pytest.raises(animeme.Error) as caught:
        random_clip(1).save(tmp_path / "a.what")
    assert caught.value.code == "unsupported" and not list(tmp_path.glob("a.*"))


def test_errors_travel():
    import pickle
    try:
        animeme.decode(b"123")
    except animeme.Error as error:
        twin = pickle.loads(pickle.dumps(error))
        assert (str(twin), twin.code, twin.position) == (str(error), error.code, error.position)
    else:
        pytest.fail("that was no stream")


def test_odd_paths_and_odd_files(sample_clip, tmp_path):
    for name in ("blank and ü.fap", b"bytes\xff.fap".decode("utf-8", "surrogateescape")):
        sample_clip.save(tmp_path / name)
        assert len(animeme.load(tmp_path / name)) == len(sample_clip)
    text = sample_clip.to_text().replace("25 75", "25 70", 1)
    with pytest.warns(animeme.InputWarning, match="75"):
        assert len(animeme.read(text)) == 75


@pytest.mark.filterwarnings("ignore::animeme.InputWarning")
def test_files_of_trackers():
    read = 0
    for path in sorted((SOURCE / "tests/data/captures_broken").glob("*")):
        try:
            read += len(animeme.load(path)) > 0
        except animeme.Error as error:
            assert error.position.file == str(path)
    assert read > 5


def test_scripts(tmp_path):
    phones = animeme.read_script(SAMPLE / "phonemes/prac8p.tsv")
    assert phones[0].start == 0 and phones[0].label == "SIL" and any(p.word for p in phones)
    for ending in (".TextGrid", ".tsv", ".pho"):
        animeme.write_script(phones, tmp_path / f"a{ending}")
        again = animeme.read_script(tmp_path / f"a{ending}")
        assert [p.label for p in again] == [p.label for p in phones]
    for wrong, kind in (([(0, 1)], TypeError), ([(0, 1, "P"), (0.5, 2, "B")], animeme.Error),
                        ([(0, 1, "no such sound")], animeme.Error), (["P"], TypeError),
                        ([7], TypeError),
                        ([("a", 1, "P")], TypeError), ([(0, 1, 2)], TypeError), (3, TypeError)):
        with pytest.raises(kind):
            animeme.write_script(wrong, tmp_path / "b.tsv")
    (tmp_path / "bad.tsv").write_text("start_s\tend_s\tphone\n0\tx\tP\n")
    with pytest.raises(animeme.Error) as caught:
        animeme.read_script(tmp_path / "bad.tsv")
    assert caught.value.position.line == 2


def test_the_page_about_standards_tells_the_table_of_arkit_and_its_name():
    page = (SOURCE / "codec/standards.md").read_text()
    assert uuid.uuid5(uuid.NAMESPACE_OID, "1.0.14496.2").urn in page
    names = list(animeme.ARKIT_NAMES[:52])
    faces = animeme.Clip.from_arkit(np.eye(52), names).values
    told = re.findall(r"^\| (\w+) \| ([^|]*) \| (\d+) \|$", page, re.MULTILINE)
    assert [name for name, _, _ in told] == [name for name in names if not name.endswith("Right")]
    for name, entries, count in told:
        face = faces[names.index(name)]
        assert np.count_nonzero(face) == int(count), name
        for fap, value in re.findall(r"(\w+) ([+-]\d+)", entries):
            assert face[list(animeme.FAP_NAMES).index(fap)] == int(value), (name, fap)
