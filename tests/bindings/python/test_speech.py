"""Speech from phones, texts and recordings."""
import subprocess
import wave

import numpy as np
import pytest

import animeme
from conftest import PROGRAM, SAMPLE, SOURCE, random_clip


@pytest.fixture(scope="module")
def model():
    return animeme.builtin_model()


@pytest.fixture(scope="module")
def phones():
    return animeme.read_script(SAMPLE / "phonemes/prac8p.tsv")


def sounds_of(phones):
    return [p.label for p in phones if p.label != "SIL"]


@pytest.fixture(scope="module")
def spoken(model):
    try:
        return model.speak("Please tell me a story about the sea")
    except animeme.Error as error:
        if error.code == "unsupported":
            pytest.skip("built without espeak-ng (Debian: libespeak-ng-dev)")
        raise


def test_phones_become_a_face(model, phones):
    speech = model.speak(phones, idle_motion=False, tongue=False)
    assert speech.names == model.controls and speech.values.shape == (len(speech.times),
        len(speech.names))
    assert speech.audio is None and speech.sample_rate == 0 and speech.phones == phones
    assert speech.rate == 25 and len(speech.clip) == len(speech.times)
    assert (speech.clip["open_jaw"] == np.round(speech.values[:,
        speech.names.index("fap3_open_jaw")])).all()
    assert len(model.speak(phones, rate=50).clip) == pytest.approx(2 * len(speech.clip), abs=1)
    still = model.speak([tuple(p)[:3] for p in phones], style=0, articulation=0, idle_motion=False,
        tongue=False).values
    assert np.ptp(still, axis=0).max() < np.ptp(speech.values, axis=0).max() / 2
    lively = model.speak(phones, seed=3)
    assert lively.names[
        : len(model.controls)] == model.controls and "fap19_close_t_l_eyelid" in lively.names


@pytest.mark.skipif(not PROGRAM.exists(), reason="the program is not built")
def test_the_face_is_that_of_the_program(model, phones, tmp_path):
    command = [PROGRAM, "speak", "--script", SAMPLE / "phonemes/prac8p.tsv", "-o",
        tmp_path / "a.fap", "--idle-motion"]
    subprocess.run(command, check=True, capture_output=True)
    theirs, ours = animeme.load(tmp_path / "a.fap"), model.speak(phones).clip
    assert (theirs.values == ours.values).all() and (theirs.mask == ours.mask).all()


def test_text_becomes_sound_and_face(spoken, tmp_path):
    assert spoken.audio.dtype == np.float32 and 0.05 < np.abs(spoken.audio).max() <= 1
    assert spoken.phones[-1].end == pytest.approx(len(spoken.audio) / spoken.sample_rate)
    assert {p.word.strip(",.") for p in spoken.phones} >= {"Please", "story",
        "sea"} and spoken.voice
    assert spoken.clip.duration == pytest.approx(len(spoken.audio) / spoken.sample_rate, abs=0.05)
    spoken.save(tmp_path / "a.mp4")
    carried = animeme.read_script(tmp_path / "a.mp4")
    assert sounds_of(carried) == sounds_of(spoken.phones)
    assert len(animeme.load(tmp_path / "a.mp4")) == len(spoken.clip)
    spoken.save(tmp_path / "a.fba", max_rms=3)
    assert len(animeme.load(tmp_path / "a.fba")) <= len(spoken.clip)


def test_a_recording_and_its_text(model, spoken, tmp_path):
    with wave.open(str(tmp_path / "voice.wav"), "wb") as file:
        file.setnchannels(1)
        file.setsampwidth(2)
        file.setframerate(spoken.sample_rate)
        file.writeframes((spoken.audio * 32767).astype("<i2").tobytes())
    # Idle motion follows the voice, and so its samples to the last bit.
    still = model.speak("Please tell me a story about the sea", idle_motion=False)
    beside = model.speak(still.phones, audio=tmp_path / "voice.wav", idle_motion=False)
    assert np.abs(beside.audio - spoken.audio).max() < 1e-3 and beside.clip == still.clip
    try:
        aligned = model.speak(audio=tmp_path / "voice.wav",
            transcript="Please tell me a story about the sea")
    except animeme.Error as error:
        assert error.code == "unsupported"
        pytest.skip("built without pocketsphinx (Debian: libpocketsphinx-dev)")
    assert sounds_of(aligned.phones)[0] == "P" and {p.word for p in aligned.phones} >= {"Please",
        "sea"}
    with pytest.raises(animeme.Error) as caught:
        model.speak(audio=tmp_path / "none.wav", transcript="x")
    assert caught.value.code == "not_found" and caught.value.position.file


def test_wrong_wishes(model, phones):
    for wrong in ({"said": "a", "audio": "a.wav"}, {"said": phones, "transcript": "a"}, {},
        {"said": 3}):
        with pytest.raises(TypeError):
            model.speak(**wrong)
    for wrong in ({"style": 2.0}, {"sharpness": -1.0}, {"articulation": float("nan")}):
        with pytest.raises(animeme.Error) as caught:
            model.speak(phones, **wrong)
        assert caught.value.code == "invalid_argument"
    with pytest.raises(animeme.Error):
        model.speak([(0, 0.1, "QQ")])
    with pytest.raises(animeme.Error) as caught:
        model.speak("hello", lang="martian")
    assert caught.value.code in ("not_found", "unsupported")


def test_streams_give_the_frames_of_the_whole(model, phones):
    whole = model.speak(phones, idle_motion=False, tongue=False).values
    stream = animeme.SpeechStream(model)
    pieces = [stream.push(*phone) for phone in phones]
    assert any(len(piece) for piece in pieces)
    pieces.append(stream.finish())
    assert np.array_equal(np.concatenate(pieces), whole)
    early = animeme.SpeechStream(model, look_ahead=0.05)
    assert sum(len(early.push(*phone)) for phone in phones) > sum(len(piece) for piece
        in pieces[:-1])
    with pytest.raises(animeme.Error):
        stream.push(0, 1, "P")
    with pytest.raises(animeme.Error):
        animeme.SpeechStream(model, style=9)


@pytest.mark.parametrize("mood", ["neutral", "joy", "sadness:0.5", "sleepy"])
def test_streams_with_a_tongue_and_a_mood(model, phones, mood):
    whole = model.speak(phones, idle_motion=False, mood=mood)
    stream = animeme.SpeechStream(model, tongue=True, mood=mood)
    made = np.concatenate([*[stream.push(*phone) for phone in phones], stream.finish()])
    assert made.shape == whole.values.shape and np.abs(made - whole.values).max() < 1e-6
    assert whole.names[len(model.controls)] == "fap44_raise_tongue_tip"
    assert np.ptp(whole.clip["raise_tongue_tip"]) > 100
    for wrong in ("jooy", "joy:3"):
        with pytest.raises(animeme.Error):
            animeme.SpeechStream(model, mood=wrong)


def test_models_of_other_rigs_have_values_alone(phones):
    random = np.random.default_rng(1)
    sentences = [animeme.Sentence(str(i), phones, random.random((75, 2)), ["antenna", "tail"]) for i
        in range(3)]
    with pytest.warns(animeme.InputWarning):
        rig = animeme.train(sentences, method="viseme")
    speech = rig.speak(phones)
    assert speech.names == ["antenna", "tail"] and speech.values.shape[1] == 2
    with pytest.raises(animeme.Error) as caught:
        speech.clip
    assert caught.value.code == "not_found"
    with pytest.raises(animeme.Error):
        rig.speak(phones, idle_motion=True)


@pytest.fixture(scope="module")
def voice():
    with wave.open(str(SOURCE / "tools/release/samples/voice.wav")) as file:
        return np.frombuffer(file.readframes(file.getnframes()), "<i2"), file.getframerate()


def voice_stream(*arguments, **options):
    try:
        return animeme.VoiceStream(*arguments, **options)
    except animeme.Error as error:
        if error.code == "unsupported":
            pytest.skip(f"built without ears: {error.message}")
        raise


def test_a_voice_is_followed_however_it_comes(model, voice):
    samples, rate = voice
    whole = voice_stream(model, rate)
    first = whole.push(samples)
    rows = np.concatenate([first, whole.finish()])
    assert rows.shape == (-(-len(samples) * 25 // rate),
        len(model.controls)) and rows.dtype == np.float64
    assert len(first) == pytest.approx(len(rows) - 0.25 * 25, abs=1.1)  # the delay
    assert np.ptp(rows[:, model.controls.index("fap3_open_jaw")]) > 50
    pieces = voice_stream(model, rate)
    again = [pieces.push(samples[i : i + 1000].astype(np.float64) / 32768) for i
        in range(0, len(samples), 1000)]
    assert (np.concatenate([*again, pieces.finish()]) == rows).all()
    still = voice_stream(model, rate, style=0, articulation=0)
    quiet = np.concatenate([still.push(samples), still.finish()])
    assert np.ptp(quiet, axis=0).max() < np.ptp(rows, axis=0).max() / 2
    assert len(voice_stream(model, rate, rate=50, delay=1.0).push(samples)) == pytest.approx(
        50 * (len(samples) / rate - 1), abs=1.1)


def test_a_voice_that_cannot_be_followed(model, voice):
    stream = voice_stream(model, 16000)
    with pytest.raises(TypeError):
        stream.push(np.zeros(10, np.int32))
    with pytest.raises(ValueError):
        stream.push(np.zeros((10, 2), np.int16))
    assert stream.push(np.zeros(0, np.int16)).shape == (0, len(model.controls))
    for wrong in [{"delay": 0.01}, {"style": 9.0}]:
        with pytest.raises(animeme.Error):
            animeme.VoiceStream(model, 16000, **wrong)
    with pytest.raises(animeme.Error):
        animeme.VoiceStream(model, 100)
