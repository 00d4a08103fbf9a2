"""What a face does when it may have been interrupted, and with sound whose rate changes: the audio
output of LiveKit, the session of avatars, and a page."""
import asyncio
import base64
import json
import random
import shutil
import struct
import subprocess
from pathlib import Path

import numpy as np
import pytest

from conftest import SOURCE, RoomSound, UnitDecoder, frame_of
from face_output import CLOCK_TOPIC, TOPIC, FaceOutput
from face_session import FaceSession
from face_track import FaceTrack, Resampler
from livekit import rtc
from test_livekit import say


def clocks(room):
    return [json.loads(message) for topic, message in room.local_participant.published
            if topic == CLOCK_TOPIC]


async def speak(face, samples, rate):
    await say(face, samples, rate, random.Random(1))
    face.flush()
    await face.drained()


def test_a_false_interruption_holds_the_clock(voice):
    samples, rate = voice

    async def talk():
        room = rtc.Room()
        sound = RoomSound(rate)
        face = FaceOutput(sound, room)
        assert face.can_pause
        await speak(face, samples, rate)
        told = len(clocks(room))
        await asyncio.sleep(0.3)
        face.pause()
        face.pause()
        await face.drained()
        assert sound.paused == 2  # what is below decides itself what that means
        held = clocks(room)[told:]
        await asyncio.sleep(0.3)
        late = type("Person", (), {"identity": "late"})
        room.emit("participant_connected", late)
        await face.drained()
        face.resume()
        face.resume()
        await face.drained()
        resumed = clocks(room)[told + len(held):]
        # Twice at once: what counts is what it is at the end.
        face.pause()
        face.resume()
        await face.drained()
        still = clocks(room)[told + len(held) + len(resumed):]
        face.resume()  # nothing was paused
        sound.play()
        assert not (await face.wait_for_playout()).interrupted
        await face.aclose()
        return room, held, resumed, still

    room, held, resumed, still = asyncio.run(talk())
    begun = [one for one in clocks(room) if "playing" in one][0]["playing"]
    assert [set(one) for one in held] == [{"segment", "paused"}]
    assert 0.3 * rate <= held[0]["paused"] - begun < 3 * rate
    assert resumed == [{"segment": held[0]["segment"], "playing": held[0]["paused"]}]
    assert still == []
    joined = [json.loads(message) for topic, message in room.local_participant.sent_to["late"]
              if topic == CLOCK_TOPIC]
    assert [one.get("playing", one.get("paused")) for one in joined[1:]] == 2 * [
        held[0]["paused"]]


def test_an_interruption_that_was_one_ends_the_pause(voice):
    samples, rate = voice

    async def talk():
        room = rtc.Room()
        sound = RoomSound(rate)
        face = FaceOutput(sound, room)
        await speak(face, samples, rate)
        await asyncio.sleep(0.2)
        face.pause()
        await face.drained()
        sound.play(rate // 2)
        face.clear_buffer()
        assert (await face.wait_for_playout()).interrupted
        face.resume()  # so that the next segment is heard
        await face.drained()
        told = clocks(room)
        await speak(face, samples[:rate], rate)
        await face.aclose()
        return room, told

    room, told = asyncio.run(talk())
    assert [next(key for key in ("cut", "paused", "playing", "begins") if key in one)
            for one in told] == ["begins", "playing", "paused", "cut"]
    assert told[-1]["cut"] // 882 == rate // 2 // 882 + 1
    after = clocks(room)[len(told):]
    assert [set(one) for one in after] == [{"segment", "begins"}, {"segment", "playing"}]


def test_a_pause_before_the_face_knows_of_the_sound(voice):
    samples, rate = voice

    async def talk():
        room = rtc.Room()
        face = FaceOutput(RoomSound(rate), room)
        await speak(face, samples[:rate], rate)
        await face.aclose()
        room = rtc.Room()
        sound = RoomSound(rate)
        face = FaceOutput(sound, room)
        face.pause()
        await speak(face, samples[:rate], rate)
        face.resume()
        await face.drained()
        await face.aclose()
        return room

    keys = [next(iter(set(one) - {"segment"})) for one in clocks(asyncio.run(talk()))]
    assert keys == ["begins", "playing", "paused", "playing"]


@pytest.mark.parametrize("source, target", [(24000, 24000), (48000, 16000), (8000, 24000),
                                            (44100, 16000), (16000, 22050)])
def test_sound_at_another_rate(source, target):
    seconds = 2
    tone = np.round(9000 * np.sin(2 * np.pi * 300 * np.arange(source * seconds) / source))
    whole = Resampler(source, target).push(tone.astype(np.int16))
    parts, pieces, at = Resampler(source, target), [], 0
    chance = random.Random(3)
    while at < len(tone):
        size = chance.randint(1, 700)
        pieces.append(parts.push(tone[at:at + size].astype(np.int16)))
        at += size
    assert (np.concatenate(pieces) == whole).all()  # however it is cut
    assert abs(len(whole) - target * seconds) <= 2
    # It is the same tone: where it crosses zero tells its frequency.
    crossings = np.flatnonzero((whole[:-1] < 0) & (whole[1:] >= 0))
    assert abs(len(crossings) - 300 * seconds) <= 1
    assert 8000 < whole.max() <= 9000


def test_a_rate_that_changes_between_segments_and_within_one(voice):
    samples, rate = voice
    assert rate == 22050
    other = Resampler(rate, 16000).push(samples)
    same = FaceTrack(rate)
    wanted = same.push(samples) + same.end()
    track = FaceTrack(rate)
    first = track.push(samples) + track.end()
    begins = [track.begins]
    second = track.push(other, 16000)
    begins.append(track.begins)
    second += track.end()
    half = len(samples) // 2
    mixed = track.push(samples[:half], rate)
    begins.append(track.begins)
    mixed += track.push(Resampler(rate, 44100).push(samples[half:]), 44100) + track.end()
    assert [unit.message for unit in first] == [unit.message for unit in wanted]
    assert begins[0] < begins[1] < begins[2]

    def opened(units):
        decoder = UnitDecoder()
        return np.array([np.abs(decoder.decode(unit.message[13:]).values).sum()
                         for unit in units])
    for units, begin in ((second, begins[1]), (mixed, begins[2])):
        assert [unit.time for unit in units] == [begin + 882 * i for i in range(len(units))]
        assert abs(len(units) - len(first)) <= 1
        size = min(len(units), len(first))
        # The same voice opens the mouth at the same times.
        assert np.corrcoef(opened(units)[:size], opened(first)[:size])[0, 1] > 0.8


def test_a_room_whose_rate_changes(voice):
    samples, rate = voice

    async def talk():
        room = rtc.Room()
        face = FaceOutput(RoomSound(rate), room)
        await speak(face, samples[:rate], rate)
        await speak(face, Resampler(rate, 48000).push(samples[:rate]), 48000)
        await face.aclose()
        return room

    units = [message for topic, message in asyncio.run(talk()).local_participant.published
             if topic == TOPIC and message[0] != 0x41]
    times = [struct.unpack_from(">Q", message)[0] for message in units]
    assert times == [882 * i for i in range(len(times))] and abs(len(times) - 2 * 31) <= 2


class Agent:
    """What FaceSession uses of an AgentSession."""

    class Output:
        audio = None

    def __init__(self):
        self.output = self.Output()


def test_the_session_of_an_avatar(voice):
    samples, rate = voice

    async def talk():
        room, agent = rtc.Room(), Agent()
        session = FaceSession(intra_seconds=0.5)
        with pytest.raises(RuntimeError, match="start its session first"):
            await session.start(agent, room)
        with pytest.raises(asyncio.TimeoutError):
            await session.wait_for_join(timeout=0.05)
        sound = agent.output.audio = RoomSound(rate)
        await session.start(agent, room)
        await session.wait_for_join(timeout=0.05)  # nobody else has to come
        with pytest.raises(RuntimeError, match="already"):
            await session.start(agent, room)
        assert agent.output.audio is session.output and session.provider == "animeme"
        await say(agent.output.audio, samples[:rate], rate, random.Random(1))
        agent.output.audio.flush()
        await session.output.drained()
        await session.aclose()
        await session.aclose()
        assert agent.output.audio is sound and session.output is None
        await say(sound, samples[:100], rate, random.Random(1))  # the sound goes on
        # The agent's participant stays in the room.
        assert room.local_participant.identity not in room.removed
        return len(room.local_participant.published)

    assert asyncio.run(talk()) > 25


@pytest.mark.skipif(shutil.which("node") is None, reason="node is missing (Debian: nodejs)")
def test_a_page_closes_the_mouth_while_the_sound_is_paused(voice, tmp_path):
    samples, rate = voice
    track = FaceTrack(rate)
    units = track.push(samples) + track.end()
    messages = [(TOPIC, track.hello()),
                (CLOCK_TOPIC, json.dumps({"segment": 0, "begins": 0}).encode()),
                *((TOPIC, unit.message) for unit in units)]
    lines = [json.dumps([topic, base64.b64encode(message).decode()])
             for topic, message in messages]
    (tmp_path / "messages").write_text("\n".join(lines))
    done = subprocess.run(["node", Path(__file__).parent / "pause_test.mjs", tmp_path / "messages",
                           SOURCE / "tools/bindings/npm/src"],
                          capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
