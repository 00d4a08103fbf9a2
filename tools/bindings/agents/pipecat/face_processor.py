"""A face for Pipecat: a processor in front of the transport's output, which sends the face that
belongs to the sound as messages of the transport.

    pipeline = Pipeline([transport.input(), stt, users, llm, tts, FaceProcessor(),
                         transport.output(), assistants])

Written for Pipecat 0.0.85 and later (`pipecat.processors.frame_processor`, `pipecat.frames.frames`).
Its transports send JSON: a message is {"label": "rtvi-ai", "type": "server-message", "data":
{"topic": "animeme.face", "base64": ...}}, which Pipecat's clients hand to onServerMessage, and whose
data FaceReceiver.takeMessage() takes.
"""
from __future__ import annotations

import asyncio
import base64
import functools
import json
import logging
import time
import uuid
from concurrent.futures import ThreadPoolExecutor
from typing import Optional

import numpy as np
from pipecat.frames.frames import (BotStartedSpeakingFrame, BotStoppedSpeakingFrame, CancelFrame,
                                   EndFrame, Frame, InterruptionFrame,
                                   OutputTransportMessageFrame,
                                   OutputTransportMessageUrgentFrame, TTSAudioRawFrame,
                                   TTSStoppedFrame)
from pipecat.processors.frame_processor import FrameDirection, FrameProcessor

from face_track import CLOCK_TOPIC, TOPIC, FaceHistory, FaceTrack, Unit

logger = logging.getLogger("animeme.face")


class FaceProcessor(FrameProcessor):
    """Passes all frames on and adds messages of the face.

    wall: seconds of a clock that never goes back. options: of FaceTrack.

    Units go ahead of the sound, as urgent messages. Where a segment of sound begins, a message that
    is none waits among the sound until that is played: it tells pages the clock.
    """

    def __init__(self, *, wall=time.monotonic, **options) -> None:
        super().__init__()
        self._face_wall = wall
        self._face_options = options
        self._face_track: Optional[FaceTrack] = None
        self._face_history = FaceHistory(wall)
        # One job after the other, also those that nobody waits for any more.
        self._face_thread = ThreadPoolExecutor(1)
        self._face_generation = 0  # grows with each interruption: what is older is dropped
        # Of what the bot says: [begin on the clock, seconds].
        self._face_turn: list[list[float]] = []
        self._face_late = False  # the sound came too late, and the clock of pages has run on
        self._face_playing_since: Optional[float] = None
        self._face_failed = False

    async def process_frame(self, frame: Frame, direction: FrameDirection) -> None:
        await super().process_frame(frame, direction)
        if isinstance(frame, TTSAudioRawFrame) and direction == FrameDirection.DOWNSTREAM:
            await self._face_hear(frame)
        elif isinstance(frame, InterruptionFrame):
            self._face_generation += 1
            await self.push_frame(frame, direction)
            await self._face_cut()
        else:
            if isinstance(frame, BotStartedSpeakingFrame) and self._face_playing_since is None:
                self._face_playing_since = self._face_wall()
            elif isinstance(frame, BotStoppedSpeakingFrame):
                self._face_silent()
            await self.push_frame(frame, direction)
            if isinstance(frame, TTSStoppedFrame):
                await self._face_make(lambda track: track.end())
            elif isinstance(frame, (EndFrame, CancelFrame)):
                self._face_thread.shutdown(wait=False)

    async def greet(self) -> None:
        """For the transport's on_client_connected: who joins in the middle of an utterance sees
        it."""
        if self._face_track is None:
            return
        if self._face_playing_since is not None and self._face_turn:
            told = self._face_told(playing=self._face_heard())
            self._face_history.keep(CLOCK_TOPIC, True, told)
        for topic, message in self._face_history.messages(self._face_track):
            await self._face_send(topic, True, message, keep=False)

    # --- what happens to the sound

    async def _face_hear(self, frame: TTSAudioRawFrame) -> None:
        if self._face_failed:
            return await self.push_frame(frame)
        generation = self._face_generation
        try:
            begin = await self._face_begin(frame)
        except Exception:
            self._face_fail()
            return await self.push_frame(frame)
        for topic, message in begin:
            await self._face_send(topic, True, message)
        if begin or self._face_late:  # it waits behind the sound before this one
            self._face_late = False
            told = self._face_told(playing=self._face_end())
            await self.push_frame(
                OutputTransportMessageFrame(message=self._face_message(CLOCK_TOPIC, told)))
        # The sound never waits for its own face.
        await self.push_frame(frame)
        if generation != self._face_generation:
            return
        samples = np.frombuffer(frame.audio, np.int16)
        if frame.num_channels > 1:
            samples = samples.reshape(-1, frame.num_channels).mean(axis=1).astype(np.int16)
        self._face_turn[-1][1] += len(samples) / frame.sample_rate
        await self._face_make(lambda track: track.push(samples, frame.sample_rate))

    async def _face_begin(self, frame: TTSAudioRawFrame) -> list[tuple]:
        """What is sent before the first sound of a segment."""
        if self._face_track is None:
            make = functools.partial(FaceTrack, frame.sample_rate, **self._face_options)
            self._face_track = await self._face_run(make)
        if self._face_track.speaking and self._face_turn:
            return []
        await self._face_run(self._face_track.start)
        self._face_turn.append([self._face_track.begins, 0.0])
        told = self._face_told(begins=self._face_track.begins)
        return [(TOPIC, self._face_track.hello()), (CLOCK_TOPIC, told)]

    async def _face_make(self, job) -> None:
        """Units of the face, unless somebody has interrupted meanwhile."""
        if self._face_failed or self._face_track is None:
            return
        generation = self._face_generation
        try:
            units = await self._face_run(functools.partial(job, self._face_track))
        except Exception:
            return self._face_fail()
        if generation == self._face_generation:
            await self._face_send_units(units)

    def _face_end(self) -> int:
        """Where on the clock the sound so far ends."""
        begin, seconds = self._face_turn[-1]
        return begin + round(seconds * self._face_track.sample_rate)

    def _face_silent(self) -> None:
        """All the sound that there was has been played."""
        speaking = self._face_track is not None and self._face_track.speaking and self._face_turn
        self._face_turn = [[self._face_end(), 0.0]] if speaking else []
        self._face_late, self._face_playing_since = bool(speaking), None

    def _face_heard(self) -> int:
        """The sample on the clock that is heard now. Pipecat does not tell, so it is as much as has
        passed since the bot began to speak."""
        since, track = self._face_playing_since, self._face_track
        passed = 0.0 if since is None else self._face_wall() - since
        at = track.begins
        for begin, seconds in self._face_turn:
            at = begin + round(min(passed, seconds) * track.sample_rate)
            if passed <= seconds:
                break
            passed -= seconds
        return at

    async def _face_cut(self) -> None:
        """The queue of the output is dropped: the mouth closes from the face that is heard."""
        track = self._face_track
        if self._face_failed or track is None:
            return
        at, spoken = self._face_heard(), bool(self._face_turn)
        self._face_turn, self._face_playing_since, self._face_late = [], None, False
        try:
            units = await self._face_run(
                lambda: track.cut(at - track.begins) if spoken or track.speaking else [])
        except Exception:
            return self._face_fail()
        if units:
            await self._face_send(TOPIC, True, track.hello())
            told = self._face_told(begins=track.begins, cut=units[0].time)
            await self._face_send(CLOCK_TOPIC, True, told)
            await self._face_send_units(units)

    async def _face_run(self, job):
        return await asyncio.get_running_loop().run_in_executor(self._face_thread, job)

    def _face_fail(self) -> None:
        logger.exception("the face has stopped; the sound goes on")
        self._face_failed = True

    # --- messages

    def _face_told(self, **what) -> bytes:
        return json.dumps({"segment": self._face_track.segment, **what}).encode()

    @staticmethod
    def _face_message(topic: str, message: bytes) -> dict:
        return {"label": "rtvi-ai", "type": "server-message", "id": uuid.uuid4().hex[:8],
                "data": {"topic": topic, "base64": base64.b64encode(message).decode()}}

    async def _face_send(self, topic: str, intra: bool, message: bytes, keep: bool = True) -> None:
        if keep:
            self._face_history.keep(topic, intra, message)
        await self.push_frame(OutputTransportMessageUrgentFrame(
            message=self._face_message(topic, message)))

    async def _face_send_units(self, units: list[Unit]) -> None:
        for unit in units:
            await self._face_send(TOPIC, unit.intra, unit.message)
