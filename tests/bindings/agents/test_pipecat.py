"""FaceProcessor in a pipeline, by a stand-in for Pipecat: sentences, interruptions, sound that is
late, rates that change, and somebody who joins in the middle."""
import asyncio
import base64
import json
import struct

import numpy as np
from pipecat.frames.frames import (BotStartedSpeakingFrame, BotStoppedSpeakingFrame, EndFrame,
                                   InterruptionFrame, OutputTransportMessageFrame,
                                   OutputTransportMessageUrgentFrame, StartFrame,
                                   TTSAudioRawFrame, TTSStartedFrame, TTSStoppedFrame)
from pipecat.processors.frame_processor import FrameDirection, FrameProcessor

from conftest import UnitDecoder
from face_processor import FaceProcessor
from face_track import CLOCK_TOPIC, TOPIC, Resampler

A_FRAME = 882


class Output(FrameProcessor):
    """The end of a pipeline: sound and messages wait in one queue until they are played."""

    def __init__(self, wall):
        super().__init__()
        self.wall = wall
        self.queue = []
        self.sent = []  # (sample that is played then, topic, message)
        self.played = 0.0  # seconds of sound
        self.speaking = False
        self.heard = b""
        self.ended = False

    async def process_frame(self, frame, direction):
        await super().process_frame(frame, direction)
        if isinstance(frame, OutputTransportMessageUrgentFrame):
            self._send(frame.message)
        elif isinstance(frame, InterruptionFrame):
            self.queue.clear()
            await self._silent()
        elif isinstance(frame, (TTSAudioRawFrame, OutputTransportMessageFrame)):
            self.queue.append(frame)
        elif isinstance(frame, EndFrame):
            self.ended = True

    def _send(self, message):
        assert message["label"] == "rtvi-ai" and message["type"] == "server-message"
        json.dumps(message)  # it can be
        data = message["data"]
        self.sent.append((self.played, data["topic"], base64.b64decode(data["base64"])))

    async def _silent(self):
        if self.speaking:
            self.speaking = False
            await self.push_frame(BotStoppedSpeakingFrame(), FrameDirection.UPSTREAM)

    async def play(self, seconds=None):
        """Plays so much of what waits, None: all of it."""
        end = None if seconds is None else self.played + seconds
        while self.queue and (end is None or self.played < end - 1e-9):
            frame = self.queue.pop(0)
            if isinstance(frame, OutputTransportMessageFrame):
                self._send(frame.message)
                continue
            if not self.speaking:
                self.speaking = True
                await self.push_frame(BotStartedSpeakingFrame(), FrameDirection.UPSTREAM)
                await self._prev.idle()
            passed = len(frame.audio) / 2 / frame.sample_rate
            self.played += passed
            self.wall[0] += passed
            self.heard += frame.audio
        if not self.queue:
            await self._silent()


class Page:
    """Faces by their times, where a unit replaces what was sent for later, and the clock."""

    def __init__(self, messages):
        self.decoder, self.faces, self.told = UnitDecoder(), [], []
        for played, topic, message in messages:
            if topic == CLOCK_TOPIC:
                self.told.append((played, json.loads(message)))
            elif message[0] == 0x41:
                assert struct.unpack_from(">I", message, 4) == (22050,)
            else:
                assert topic == TOPIC
                time, _, flags = struct.unpack_from(">QIB", message)
                plane = self.decoder.decode(message[13:])
                assert plane.intra == bool(flags & 1)
                while self.faces and self.faces[-1][0] >= time:
                    self.faces.pop()
                self.faces.append((time, plane.values))
        self.times = [time for time, _ in self.faces]
        assert self.times == sorted(set(self.times))

    def playing(self):
        return [(round(played, 3), told["playing"]) for played, told in self.told
                if "playing" in told]


class Call:
    """A pipeline of the face and the output, which runs."""

    async def __aenter__(self):
        self.wall = [1000.0]
        self.face = FaceProcessor(wall=lambda: self.wall[0], intra_seconds=0.4)
        self.output = Output(self.wall)
        self.face.link(self.output)
        for one in (self.face, self.output):
            await one.setup()
        await self.face.queue_frame(StartFrame())
        return self

    async def __aexit__(self, *_):
        await self.face.queue_frame(EndFrame())
        await self.idle()
        assert self.output.ended
        for one in (self.face, self.output):
            await one.cleanup()

    async def idle(self):
        await self.face.idle()
        await self.output.idle()

    async def say(self, samples, rate, end=True, wait=True):
        await self.face.queue_frame(TTSStartedFrame())
        for begin in range(0, len(samples), 2000):
            piece = samples[begin:begin + 2000]
            await self.face.queue_frame(TTSAudioRawFrame(piece.astype("<i2").tobytes(), rate, 1))
        if end:
            await self.face.queue_frame(TTSStoppedFrame())
        if wait:
            await self.idle()

    def page(self, begin=0):
        return Page(self.output.sent[begin:])


def test_sentences_of_a_turn_and_the_clock(voice):
    samples, rate = voice

    async def talk():
        async with Call() as call:
            for part in (samples[:rate], samples[rate:2 * rate], samples[:rate // 2]):
                await call.say(part, rate)
            await call.output.play()
            await call.idle()
            await call.say(samples[:rate], rate)
            await call.output.play()
            return call.page(), call.output.heard

    page, heard = asyncio.run(talk())
    assert len(heard) == 2 * (3 * rate + rate // 2)  # the sound is whole
    begins = [told["begins"] for _, told in page.told if "begins" in told]
    # Each sentence tells the clock when its own sound begins, not when it was made.
    assert page.playing() == [(0.0, begins[0]), (1.0, begins[1]), (2.0, begins[2]),
                              (2.5, begins[3])]
    assert page.times == [A_FRAME * i for i in range(len(page.times))]
    for begin in begins[1:]:  # closed between them
        assert not dict(page.faces)[begin - A_FRAME].any()
    assert np.abs([values for _, values in page.faces]).max() > 100


def test_an_interruption_in_an_earlier_sentence(voice):
    samples, rate = voice

    async def talk(wait):
        async with Call() as call:
            await call.say(samples[:rate], rate)
            await call.say(samples[:rate], rate, wait=wait)
            await call.output.play(0.5)
            first = len(call.output.sent)
            await call.face.queue_frame(InterruptionFrame())
            await call.idle()
            cut = call.output.sent[first:]
            await call.say(samples[:rate], rate)
            await call.output.play()
            return call.page(), cut

    for wait in (True, False):
        page, cut = asyncio.run(talk(wait))
        told = [told for _, told in page.told if "cut" in told]
        assert len(told) == 1
        heard = page.playing()[0][1] + round(0.5 * rate)
        assert heard < told[0]["cut"] <= heard + 3 * A_FRAME  # pieces are 0.09 s long
        # The mouth closes within five faces, and the next sentence begins behind them.
        units = [struct.unpack_from(">Q", message)[0] for _, topic, message in cut
                 if topic == TOPIC and message[0] != 0x41]
        assert units[-5:] == [told[0]["cut"] + A_FRAME * i for i in range(5)]
        assert not dict(page.faces)[units[-1]].any()
        assert page.playing()[-1][1] == units[-1] + A_FRAME
        assert page.times == [A_FRAME * i for i in range(len(page.times))]


def test_an_interruption_at_any_moment_loses_no_later_sentence(voice):
    samples, rate = voice

    async def talk():
        async with Call() as call:
            for number in range(30):
                await call.say(samples[:rate], rate, wait=False)
                for _ in range(number % 7):
                    await asyncio.sleep(0)
                if number % 3:
                    await asyncio.sleep(0.003 * number)
                if number % 2:
                    await call.output.play(0.1 * (number % 5))
                await call.face.queue_frame(InterruptionFrame())
                await call.idle()
            await call.say(samples[:rate], rate)
            await call.output.play()
            return call.page(), call.output.heard

    page, heard = asyncio.run(talk())
    assert heard.endswith(samples[:rate].astype("<i2").tobytes())
    last = page.playing()[-1][1]
    spoken = [values for time, values in page.faces if time >= last]
    assert abs(len(spoken) - 30) <= 1 and np.abs(spoken).max() > 100 and not spoken[-1].any()


def test_sound_that_comes_too_late_tells_the_clock_again(voice):
    samples, rate = voice

    async def talk():
        async with Call() as call:
            await call.say(samples[:rate], rate, end=False)
            await call.output.play()  # it runs out
            call.wall[0] += 0.7
            await call.idle()
            await call.say(samples[rate:2 * rate], rate)
            await call.output.play()
            return call.page()

    page = asyncio.run(talk())
    assert page.playing() == [(0.0, 0), (1.0, rate)]
    assert [told for _, told in page.told if "begins" in told] == [{"segment": 0, "begins": 0}]


def test_rates_that_change(voice):
    samples, rate = voice

    async def talk():
        async with Call() as call:
            await call.say(samples[:rate], rate)
            await call.say(Resampler(rate, 16000).push(samples[:rate]), 16000)
            await call.output.play()
            return call.page()

    page = asyncio.run(talk())
    assert [played for played, _ in page.playing()] == [0.0, 1.0]
    assert page.times == [A_FRAME * i for i in range(len(page.times))]
    assert abs(len(page.times) - 2 * 31) <= 2


def test_who_joins_in_the_middle_of_an_utterance_sees_it(voice):
    samples, rate = voice

    async def talk():
        async with Call() as call:
            await call.face.greet()  # nothing was said
            await call.say(samples, rate)
            await call.output.play(1.5)
            first = len(call.output.sent)
            await call.face.greet()
            await call.idle()
            return call.page(), Page(call.output.sent[first:])

    everybody, page = asyncio.run(talk())
    (_, playing), = page.playing()
    assert 1.5 * rate <= playing <= 1.6 * rate
    assert page.times[-1] == everybody.times[-1] and 0 < page.times[0] <= playing
    assert playing - page.times[0] < 0.5 * rate
    line = dict(everybody.faces)
    assert all((values == line[time]).all() for time, values in page.faces)


def test_a_face_that_fails_does_not_stop_the_sound(voice):
    samples, rate = voice

    async def talk():
        async with Call() as call:
            await call.say(samples[:2000], rate)

            def broken(*_):
                raise RuntimeError("no ears")
            call.face._face_track.push = broken
            for _ in range(3):
                await call.say(samples[:2000], rate)
                await call.face.queue_frame(InterruptionFrame())
                await call.idle()
            await call.say(samples[:2000], rate)
            await call.output.play()
            return call.output.heard

    assert len(asyncio.run(talk())) == 2 * 2000
