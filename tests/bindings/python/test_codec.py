"""Streams: round trips, live, and the exceptions of broken ones."""
import mmap
import threading

import numpy as np
import pytest

import animeme
from conftest import random_clip


@pytest.mark.parametrize("seed", range(20))
def test_lossless_round_trip(seed):
    clip = random_clip(seed, largest=1800, rate=[25, 30, 12.5, "30000/1001"][seed % 4])
    again = animeme.decode(animeme.encode(clip, preset="plain", quant=0))
    assert again == clip
    small = animeme.decode(animeme.encode(clip, quant=0)).fill(complete=True)
    assert (small.values[clip.mask] == clip.values[clip.mask]).all()


@pytest.mark.parametrize("seed", range(5))
def test_an_error_that_is_allowed_is_kept_to(seed):
    clip = random_clip(seed)
    shares = []
    data = animeme.encode(clip, max_rms=4, progress=lambda share, stage: shares.append(share))
    shown = animeme.decode(data).fill(complete=True)
    angle = [any(word in name for word in ("yaw", "pitch", "roll")) for name in animeme.FAP_NAMES]
    counted = (clip.values.std(axis=0) > 0) & ~np.array(angle)
    error = (shown.values - clip.values)[:, counted]
    assert 2 < np.sqrt(np.mean(error**2)) < 4.2
    assert len(data) < len(animeme.encode(clip)) and shares == sorted(shares)


def test_gaps_and_names_stay():
    clip = animeme.Clip(random_clip(3, frames=3).values, numbers=[0, 4, 5])
    assert list(animeme.decode(animeme.encode(clip, preset="plain")).numbers) == [0, 4, 5]


def test_any_buffer_will_do(sample_clip, tmp_path):
    data = animeme.encode(sample_clip)
    expected = animeme.decode(data)
    (tmp_path / "a.fba").write_bytes(data)
    with open(tmp_path / "a.fba", "rb") as file:
        mapped = mmap.mmap(file.fileno(), 0, access=mmap.ACCESS_READ)
        buffers = (bytearray(data), memoryview(data), np.frombuffer(data, np.uint8), mapped)
        for buffer in buffers:
            assert animeme.decode(buffer) == expected
    for wrong in ("text", 3, None):
        with pytest.raises(TypeError):
            animeme.decode(wrong)
    with pytest.raises((ValueError, BufferError)):
        animeme.decode(np.frombuffer(data + data, np.uint8)[::2])


def test_pieces_give_the_planes_of_the_whole():
    clip = random_clip(5)
    data = animeme.encode(clip, preset="live")
    whole = animeme.decode(data)
    for size in (1, 7, 100, len(data)):
        decoder, planes = animeme.Decoder(), []
        for at in range(0, len(data), size):
            decoder.push(data[at : at + size])
            planes += decoder
        decoder.finish()
        planes += decoder
        assert decoder.ended and decoder.pull() is None and decoder.warnings == []
        assert (np.array([p.values for p in planes]) == whole.values).all()
        assert (np.array([p.mask for p in planes]) == whole.mask).all()
        assert [p.number for p in planes] == list(whole.numbers)
        assert planes[0].intra and planes[0].face and planes[0].body is None
        assert planes[0].bits[1] <= planes[1].bits[0]


def test_live_units_decode_one_by_one():
    clip = random_clip(6)
    encoder, decoder = animeme.Encoder(rate=30, quant=2, intra_seconds=0.5), animeme.Decoder()
    sent, planes = [], []
    for i, values in enumerate(clip.values):
        decoder.push(encoder.write(values, clip.mask[i], skip=1 if i == 3 else 0))
        sent.append((encoder.shown, encoder.intra))
        planes += decoder
        assert len(planes) >= i  # it waits for no more than the start of the next unit
    decoder.push(encoder.finish())
    decoder.finish()
    planes += decoder
    assert decoder.ended and [p.number for p in planes] == [0, 1, 2, 3, *range(5, len(clip) + 1)]
    for plane, mask, (shown, intra) in zip(planes, clip.mask, sent):
        assert (plane.values[mask] == shown[mask]).all(
            ) and plane.intra == intra and plane.rate == 30
    assert sum(intra for _, intra in sent) >= 3


def test_broken_streams_say_where(sample_clip):
    data = animeme.encode(sample_clip, preset="live")
    with pytest.raises(animeme.Error) as caught:
        animeme.decode(data[: len(data) // 2])
    error = caught.value
    assert error.code == "truncated" and 0 < error.position.bit <= 4 * len(data)
    assert error.position.file is error.position.line is error.position.column is None
    assert str(error) == f"bit {error.position.bit}: {error.message}"
    with pytest.raises(animeme.Error) as caught:
        animeme.decode(b"no stream at all")
    assert caught.value.code == "syntax" and caught.value.position.bit == 0
    with pytest.raises(animeme.Error, match="truncated|no|empty|ends"):
        animeme.decode(b"")


@pytest.mark.parametrize("seed", range(30))
def test_random_damage_is_an_error_or_another_clip(sample_clip, seed):
    random = np.random.default_rng(seed)
    data = np.frombuffer(animeme.encode(sample_clip, preset="live"), np.uint8).copy()
    data[random.integers(len(data), size=3)] ^= np.uint8(1 << random.integers(8))
    decoder = animeme.Decoder()
    decoder.push(data)
    decoder.finish()
    met = 0
    while not decoder.ended and met < 1000:
        try:
            decoder.pull()
        except animeme.Error as error:
            assert error.position.bit is not None
            assert error.code in ("syntax", "truncated", "out_of_range", "unsupported")
            met += 1
    assert decoder.ended


def test_settings_out_of_bounds_are_refused(sample_clip):
    for wrong in ({"quant": 32}, {"quant": -1}, {"intra_seconds": -1.0}, {"max_rms": float("nan")}):
        with pytest.raises(animeme.Error) as caught:
            animeme.encode(sample_clip, **wrong)
        assert caught.value.code == "invalid_argument"
    with pytest.raises(ValueError, match="preset"):
        animeme.encode(sample_clip, preset="archive")
    with pytest.raises(animeme.Error):
        animeme.Encoder(quant=99)
    with pytest.raises(ValueError):
        animeme.Encoder().write(np.zeros(67))
    with pytest.raises(animeme.Error) as caught:  # 0.1 cannot be coded
        animeme.encode(animeme.Clip(np.zeros((1, 68)), rate=0.01))
    assert caught.value.code == "unsupported"


def test_progress_may_end_a_search(sample_clip):
    def enough(share, stage):
        raise LookupError("enough")

    with pytest.raises(LookupError, match="enough"):
        animeme.encode(sample_clip, max_rms=1, progress=enough)


def test_threads_decode_at_once(sample_clip):
    data = animeme.encode(sample_clip)
    expected, got = animeme.decode(data), []
    threads = [threading.Thread(target=lambda: got.append(animeme.decode(data))) for _ in range(8)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert len(got) == 8 and all(clip == expected for clip in got)


def test_the_configuration_of_a_decoder():
    config = animeme.Encoder(rate=30, quant=3).config
    assert config[:4] == bytes([0, 0, 1, 0xB0]) and config[4] == 0x62 and config[5:9] == bytes([0,
        0, 1, 0xB5])
    encoder = animeme.Encoder()
    values = np.zeros(68)
    values[2] = 100
    decoder = animeme.Decoder()
    decoder.push(config + encoder.write(values) + encoder.finish())
    assert [plane.values[2] for plane in decoder] == [100] and not decoder.warnings
