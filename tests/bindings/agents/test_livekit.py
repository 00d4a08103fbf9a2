"""FaceOutput in front of a room's output, by a stand-in for LiveKit: ten minutes of speech with
interruptions, a slow
network, one that breaks, and what must not stop the sound."""
import asyncio
import json
import random
import struct

import numpy as np

from conftest import RoomSound, UnitDecoder, frame_of
from face_output import CLOCK_TOPIC, TOPIC, FaceOutput
from livekit import rtc

A_FRAME = 882  # samples at 22050 Hz, 25 a second
CLOSING = 5


class Page:
    """What a page does with the messages: a line of faces, in which a unit replaces what was sent
    for later."""

    def __init__(self):
        self.decoder = UnitDecoder()
        self.faces = []  # (time, values)
        self.segments = []  # begins, times of its units, cut
        self.hellos = 0
        self.missed = 0

    def take(self, topic, message):
        if topic == CLOCK_TOPIC:
            told = json.loads(message)
            if "begins" in told and (not self.segments
                or self.segments[-1]["number"] != told["segment"]):
                self.segments.append({"number": told["segment"], "begins": told["begins"],
                    "times": [], "cut": None})
            if "cut" in told:
                assert told["segment"] == self.segments[-1]["number"]
                self.segments[-1]["cut"] = (told["cut"], len(self.segments[-1]["times"]))
            return
        assert topic == TOPIC
        if message[0] == 0x41:
            assert struct.unpack_from(">I", message, 4) == (22050,)
            self.hellos += 1
            return
        time, duration, flags = struct.unpack_from(">QIB", message)
        assert duration == A_FRAME and time % A_FRAME == 0
        self.missed += flags >> 1 & 1
        plane = self.decoder.decode(message[13:])
        assert plane.intra == bool(flags & 1)
        while self.faces and self.faces[-1][0] >= time:
            self.faces.pop()
        self.faces.append((time, plane.values))
        self.segments[-1]["times"].append(time)


async def say(face, samples, rate, chance, sizes=(220, 2205)):
    at = 0
    while at < len(samples):
        size = chance.randint(*sizes)
        await face.capture_frame(frame_of(samples[at:at + size], rate))
        at += size


def shown_of(room):
    page = Page()
    for topic, message in room.local_participant.published:
        page.take(topic, message)
    return page


def test_ten_minutes_with_interruptions(voice):
    samples, rate = voice
    chance = random.Random(7)
    long = np.tile(samples, 4)

    async def talk():
        room = rtc.Room()
        sound = RoomSound(rate)
        face = FaceOutput(sound, room)
        in_haste = 0
        said = []  # samples, what was heard of them if it was interrupted, the face they brought
        while sound.all_given < 600 * rate:
            begin = chance.randrange(len(samples))
            spoken = long[begin:begin + chance.randint(rate // 2, 6 * rate)]
            how = chance.choice(["whole", "whole", "while it is made", "when all is made"])
            if how == "while it is made":  # the rest is not made any more
                spoken = spoken[:len(spoken) // 2]
            await say(face, spoken, rate, chance)
            if how != "while it is made":
                face.flush()
            if how == "whole":
                sound.play()
                heard = None
            else:
                if chance.random() < 0.7:
                    await face.drained()  # the page has all of it
                else:  # some of it, or nothing
                    in_haste += 1
                    await asyncio.sleep(chance.choice([0, 0.02, 0.1]))
                sound.play(chance.randrange(len(spoken)))
                heard = sound.played
                if how == "while it is made" and chance.random() < 0.5:
                    face.flush()  # its task ends with that, before or after the buffer is cleared
                    face.clear_buffer()
                else:
                    face.clear_buffer()
                    face.flush()
            event = await face.wait_for_playout()
            assert event.interrupted == (how != "whole")
            await face.drained()
            said.append((len(spoken), heard, len(room.local_participant.published)))
        await face.aclose()
        return room, said, in_haste

    room, said, in_haste = asyncio.run(talk())
    page, expected, at, unseen = Page(), 0, 0, 0
    assert sum(heard is not None for _, heard, _ in said) > 30 < sum(heard is None for _, heard,
        _ in said)
    for number, (size, heard, to) in enumerate(said):
        if at == to:  # interrupted before the face had heard of it
            assert heard is not None
            unseen += 1
            continue
        for topic, message in room.local_participant.published[at:to]:
            page.take(topic, message)
        at, segment = to, page.segments[-1]
        times = segment["times"]
        assert segment["begins"] == expected and segment["number"] == number - unseen == len(
            page.segments) - 1
        if heard is None:
            assert segment["cut"] is None
            assert len(times) - CLOSING in (-(-size // A_FRAME), size // A_FRAME + 1)
            assert times == [expected + A_FRAME * i for i in range(len(times))]
        else:
            # Nothing of what was cancelled comes behind the cut: the mouth closes, and that is all.
            first, before = segment["cut"]
            assert first == expected + A_FRAME * (heard // A_FRAME + 1)
            assert times[before:] == [first + A_FRAME * i for i in range(CLOSING)]
            assert times[:before] == [expected + A_FRAME * i for i in range(before)]
        assert page.faces[-1][0] == times[-1] and not page.faces[-1][1].any()  # closed
        expected = times[-1] + A_FRAME
    assert unseen <= in_haste
    line = [time for time, _ in page.faces]
    assert line == sorted(set(line)) and page.missed == 0
    assert page.hellos >= len(page.segments)
    assert sum(np.abs(values).max() > 100 for _, values in page.faces) > 1000  # and it spoke


def test_a_slow_network_holds_the_voice_back_and_nothing_is_lost(voice):
    samples, rate = voice

    async def talk():
        room = rtc.Room()
        sound = RoomSound(rate)
        face = FaceOutput(sound, room, waiting=8)
        room.local_participant.gate.clear()
        speaking = asyncio.create_task(say(face, samples, rate, random.Random(1), (441, 441)))
        await asyncio.sleep(1)
        assert not speaking.done() and 0 < sound.all_given < len(samples)
        waiting = sound.all_given
        await asyncio.sleep(0.2)
        assert sound.all_given == waiting and room.local_participant.published == []
        room.local_participant.gate.set()
        await speaking
        face.flush()
        await face.drained()
        # And one that is interrupted while it waits goes on.
        room.local_participant.gate.clear()
        speaking = asyncio.create_task(say(face, samples, rate, random.Random(1), (441, 441)))
        await asyncio.sleep(0.5)
        face.clear_buffer()
        face.flush()
        room.local_participant.gate.set()
        await speaking
        await face.aclose()
        return room

    page = shown_of(asyncio.run(talk()))
    assert page.segments[1]["cut"][1] <= 1  # what waited to be sent is not sent any more
    assert len(page.segments[0]["times"]) - CLOSING in (-(-len(samples) // A_FRAME),
        -(-len(samples) // A_FRAME) + 1)
    assert page.missed == 0


def test_a_network_that_breaks_goes_on_where_decoding_can_begin(voice):
    samples, rate = voice

    async def talk():
        room = rtc.Room()
        face = FaceOutput(RoomSound(rate), room, intra_seconds=0.4)
        await say(face, samples[:rate], rate, random.Random(1))
        await face.drained()
        room.local_participant.broken = True
        await say(face, samples[rate:rate + rate // 4], rate, random.Random(1))
        await face.drained()
        room.local_participant.broken = False
        await say(face, samples[rate + rate // 4:], rate, random.Random(1))
        face.flush()
        await face.drained()
        await face.aclose()
        return room

    room = asyncio.run(talk())
    units = [message for topic, message in room.local_participant.published if topic == TOPIC
        and message[0] != 0x41]
    flags = [message[12] for message in units]
    assert flags.count(3) == 1 and 2 not in flags
    times = [struct.unpack_from(">Q", message)[0] for message in units]
    gap = flags.index(3)
    assert times[gap] - times[gap - 1] > A_FRAME
    assert all(b - a == A_FRAME for i, (a, b) in enumerate(zip(times, times[1:])) if i != gap - 1)


def test_what_the_face_cannot_do_does_not_stop_the_sound(voice):
    samples, rate = voice

    async def talk():
        room = rtc.Room()
        sound = RoomSound(rate)
        face = FaceOutput(sound, room)
        await say(face, samples[:4410], rate, random.Random(1))
        await face.capture_frame(frame_of(samples[:100], 2 * rate))  # another rate
        await face.drained()
        for _ in range(600):
            await face.capture_frame(frame_of(samples[:10], rate))
        face.flush()
        sound.play()
        assert not (await face.wait_for_playout()).interrupted
        assert sound.all_given == 4410 + 100 + 6000
        await face.aclose()

    asyncio.run(talk())


def test_an_output_that_does_not_tell_what_was_heard(voice):
    samples, rate = voice

    async def talk():
        room = rtc.Room()
        sound = RoomSound(rate)
        sound.clear_buffer = lambda: None
        face = FaceOutput(sound, room)
        for _ in range(2):
            await say(face, samples[:rate], rate, random.Random(1))
            await face.drained()
            face.clear_buffer()
            face.flush()
        await say(face, samples[:rate], rate, random.Random(1))
        await face.drained()
        await face.aclose()
        return room

    page = shown_of(asyncio.run(talk()))
    first, second, third = page.segments
    for segment, following in [(first, second), (second, third)]:
        cut, before = segment["cut"]  # where the next one began, from the last face that was sent
        assert segment["times"] == [segment["begins"] + A_FRAME * i for i
            in range(before + CLOSING)]
        assert cut == segment["times"][before] and following["begins"] == segment["times"][
            -1] + A_FRAME
    assert third["cut"] is None and len(third["times"]) > 10


def test_those_who_join_are_greeted_and_pages_are_told_the_clock(voice):
    samples, rate = voice

    async def talk():
        room = rtc.Room()
        sound = RoomSound(rate)
        face = FaceOutput(sound, room)
        await say(face, samples, rate, random.Random(1))
        face.flush()
        await face.drained()
        room.emit("participant_connected", object())
        await face.drained()
        assert room.local_participant.published[-1] == (TOPIC, face._track.hello())
        sound.play()
        await say(face, samples, rate, random.Random(1))
        await face.drained()
        await face.aclose()
        return [json.loads(message) for topic, message in room.local_participant.published
            if topic == CLOCK_TOPIC]

    clocks = asyncio.run(talk())
    begins = [clock["begins"] for clock in clocks if "begins" in clock]
    playing = [clock["playing"] for clock in clocks if "playing" in clock]
    assert begins[0] == 0 and begins[1] > len(samples) and begins == playing


def test_who_joins_in_the_middle_of_an_utterance_sees_it(voice):
    samples, rate = voice

    class Person:
        identity = "late"

    async def talk():
        room = rtc.Room()
        sound = RoomSound(rate)
        face = FaceOutput(sound, room, intra_seconds=0.4)
        await say(face, samples, rate, random.Random(1))
        face.flush()
        sound.play()
        await face.drained()
        # all of it is there long before it is heard
        await say(face, samples, rate, random.Random(1))
        face.flush()
        await face.drained()
        await asyncio.sleep(0.6)
        room.emit("participant_connected", Person())
        await face.drained()
        later = len(room.local_participant.published)
        await say(face, samples, rate, random.Random(1))
        face.flush()
        await face.drained()
        await face.aclose()
        return room, later

    room, later = asyncio.run(talk())
    page, everybody = Page(), shown_of(room)
    got = room.local_participant.sent_to["late"]
    for topic, message in got:
        page.take(topic, message)
    assert page.hellos == 1 and len(page.segments) == 1
    begins = page.segments[0]["begins"]
    assert begins == everybody.segments[1]["begins"] > 0
    playing, = [json.loads(m)["playing"] for t, m in got if t == CLOCK_TOPIC and "playing"
        in json.loads(m)]
    assert 0.5 * rate < playing - begins < 60 * rate
    # It begins at, or before, what is heard, less than an intra plane ago, and has all that is
    # still to come.
    times = page.segments[0]["times"]
    assert times and times[-1] == everybody.segments[1]["times"][-1]
    assert times[0] <= max(playing, begins) and (times[0] > begins or playing - begins < 0.5 * rate)
    line = dict(everybody.faces)
    assert all((values == line[time]).all() for time, values in page.faces)
    # Then it gets what all get.
    for topic, message in room.local_participant.published[later:]:
        page.take(topic, message)
    assert page.segments[-1]["times"] == everybody.segments[-1]["times"]
