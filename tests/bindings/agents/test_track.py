"""The face beside the sound, by itself: times, ends, cuts."""
import struct
from fractions import Fraction

import numpy as np
import pytest

import animeme
from conftest import UnitDecoder
from face_track import FaceTrack, mark_missed


def parsed(unit):
    time, duration, flags = struct.unpack_from(">QIB", unit.message)
    assert time == unit.time and bool(flags & 1) == unit.intra
    return time, duration, unit.message[13:]


def test_hello_is_that_of_the_web_server():
    hello = FaceTrack(24000).hello()
    letter, version, profile, sound, ticks, size = struct.unpack_from(">BBBBIH", hello)
    assert (letter, version, sound, ticks) == (0x41, 1, 0, 24000) and 0x61 <= profile <= 0x64
    assert size == len(hello) - 10 and hello[10:].startswith(bytes([0, 0, 1, 0xB0, profile, 0, 0, 1,
        0xB5]))


@pytest.mark.parametrize("rate, sample_rate", [(25, 22050), ("30000/1001", 22050), (30, 44100),
    (60, 16000)])
def test_times_are_those_of_samples(voice, rate, sample_rate):
    samples, _ = voice
    track = FaceTrack(sample_rate, rate=Fraction(rate))
    units = track.push(samples) + track.end()
    a_frame = sample_rate / Fraction(rate)
    decoder = UnitDecoder()
    for number, unit in enumerate(units):
        time, duration, data = parsed(unit)
        assert time == int(number * a_frame) and time + duration == int((number + 1) * a_frame)
        plane = decoder.decode(data)
    assert units[0].intra and not plane.values.any()  # closed
    heard = int(len(samples) / a_frame)
    assert heard <= len(units) - max(1, round(0.2 * Fraction(rate))) <= heard + 1
    again = track.push(samples)
    assert again[0].time == int(len(units) * a_frame) == track.begins and again[
        0].intra and track.segment == 1


def test_the_face_is_that_of_the_voice_however_it_is_cut(voice):
    samples, rate = voice
    model = animeme.builtin_model()
    stream = animeme.VoiceStream(model, rate)
    rows = np.concatenate([stream.push(samples), stream.finish()])
    columns = [int(name[3:].split("_")[0]) - 1 for name in model.controls]
    track, units = FaceTrack(rate, quant=0), []
    for begin in range(0, len(samples), 441):
        units += track.push(samples[begin:begin + 441])
    units += track.end()
    decoder = UnitDecoder()
    faces = np.array([decoder.decode(parsed(unit)[2]).values for unit in units])
    assert (faces[:len(rows), columns] == np.round(rows)).all()
    assert np.abs(faces[:, columns]).max() > 100  # it spoke


def test_phones_take_the_place_of_sound(voice):
    _, rate = voice
    model = animeme.builtin_model()
    phones = [(0, 4410, "SIL"), (4410, 6615, "P"), (6615, 11025, "AA"), (11025, 13230, "M"),
        (13230, 17640, "IY")]
    stream = animeme.SpeechStream(model)
    rows = np.concatenate([*(stream.push(a / rate, b / rate, phone) for a, b, phone in phones),
        stream.finish()])
    columns = [int(name[3:].split("_")[0]) - 1 for name in model.controls]
    track = FaceTrack(rate, quant=0)
    for _ in range(2):  # the second like the first
        units = [unit for phone in phones for unit in track.say(*phone)] + track.end()
        decoder = UnitDecoder()
        faces = np.array([decoder.decode(parsed(unit)[2]).values for unit in units])
        assert (faces[:len(rows), columns] == np.round(rows)).all() and not faces[-1].any()
        assert [unit.time for unit in units] == [track.begins + 882 * i for i
            in range(len(rows) + 5)]
    track.say(*phones[0])
    assert [unit.time for unit in track.cut(1000)] == [track.begins + 882 * i for i in range(2, 7)]


@pytest.mark.parametrize("ended", [False, True])
@pytest.mark.parametrize("heard", [0, 1, 881, 882, 883, 20000, 40000])
def test_a_cut_closes_the_mouth_from_what_was_heard(voice, ended, heard):
    samples, rate = voice
    assert rate == 22050
    track = FaceTrack(rate)
    track.push(samples)
    if ended:
        track.end()
    units = track.cut(heard)
    assert [unit.time for unit in units] == [882 * (heard // 882 + 1 + i) for i in range(5)]
    assert units[0].intra
    decoder = UnitDecoder()
    opened = [np.abs(decoder.decode(parsed(unit)[2]).values).sum() for unit in units]
    assert opened[-1] == 0 and opened == sorted(opened, reverse=True)
    assert track.cut(heard) == [] and track.end() == []  # it is over
    assert track.push(samples)[0].time == units[-1].time + 882


def test_a_cut_of_what_was_not_heard_of_yet(voice):
    samples, rate = voice
    track = FaceTrack(rate)
    assert track.cut(0) == []  # nothing was said
    track.push(samples[:1000])  # too little for a face
    units = track.cut(1000)
    assert [unit.time for unit in units] == [882 * i for i in range(2, 7)]


def test_lost_units_are_told():
    track = FaceTrack(16000)
    units = track.push(np.zeros(16000, np.int16))
    assert mark_missed(units[0].message)[12] == 3 and mark_missed(units[0].message)[13:] == units[
        0].message[13:]
