"""A face for LiveKit Agents: an audio output that stands in front of the room's and sends the face
that belongs to the
sound on a data channel.

    await session.start(agent=agent, room=ctx.room)
    session.output.audio = FaceOutput(session.output.audio, ctx.room)

Written for `livekit.agents.voice.io.AudioOutput` with label, capabilities and next_in_chain
(livekit/agents, pull requests 3269 and 4211) and `LocalParticipant.publish_data` of livekit-rtc.
README.md tells what pages do with it.
"""
from __future__ import annotations

import asyncio
import json
import logging
from collections import deque
from typing import Optional

import numpy as np
from livekit import rtc
from livekit.agents.voice import io

from face_track import CLOCK_TOPIC, TOPIC, FaceHistory, FaceTrack, Unit, mark_missed

logger = logging.getLogger("animeme.face")

JOIN = "join"  # no topic: who has joined is to be sent what is said now
PAUSE = "pause"  # no topic: a message of the clock that waits for no other


class FaceOutput(io.AudioOutput):
    """Hands all sound on and sends the face to it.

    next_in_chain: the output that plays the sound: its playback events tell what was heard.
    room: to whose participants the face is sent.
    destinations: identities of those who get it; none: all.
    waiting: pieces of sound that may wait to be listened to, and messages to be sent; then
    capture_frame() waits, too. options: of FaceTrack.
    """

    def __init__(self, next_in_chain: io.AudioOutput, room: rtc.Room, *,
        destinations: tuple[str, ...] = (),
                 waiting: int = 256, **options) -> None:
        super().__init__(label="AnimemeFace", capabilities=io.AudioOutputCapabilities(pause=True),
                         next_in_chain=next_in_chain, sample_rate=next_in_chain.sample_rate)
        self._room = room
        self._destinations = list(destinations)
        self._options = options
        self._waiting = waiting
        self._track: Optional[FaceTrack] = None
        self._work: deque = deque()  # what the face has to do, in order
        self._out: deque = deque()  # what is to be sent: (topic, intra, message)
        self._changed = asyncio.Condition()
        self._generation = 0  # grows with each interruption: what is older is dropped
        self._tasks: list[asyncio.Task] = []
        self._busy = 0  # jobs and messages that are neither waiting nor done
        self._capturing = False
        self._segment = 0  # number of the one that is or was captured
        # of the one that the face has heard of, and of the one that plays
        self._listened = self._played = 0
        self._uncut = False  # an interruption that the face does not know yet
        self._missed = False  # messages that were not sent
        self._failed = False
        self._history = FaceHistory()
        self._pause_wanted = False  # between pause() and what ends it
        self._pause_at: Optional[int] = None  # the sample that was heard then
        room.on("participant_connected", self._on_participant)

    async def capture_frame(self, frame: rtc.AudioFrame) -> None:
        generation = self._generation
        if not self._tasks:
            self._tasks = [asyncio.create_task(self._listen()), asyncio.create_task(self._send())]
        if self._uncut:  # nobody has told how much was heard of what was interrupted
            self._cut(None)
        if not self._capturing:
            self._segment += 1
        self._capturing = True
        # The sound never waits for its own face. First of all, so that both count the same segments
        # (livekit/agents, pull request 4211).
        await self.next_in_chain.capture_frame(frame)
        await super().capture_frame(frame)
        if self._failed:
            return
        async with self._changed:
            # The next piece of sound waits where the face or the network is slower than the voice.
            await self._changed.wait_for(lambda: generation != self._generation or self._failed
                                         or max(len(self._work), len(self._out)) < self._waiting)
            if generation == self._generation and not self._failed:
                self._work.append((generation, "sound", (self._segment, frame)))
                self._changed.notify_all()

    def flush(self) -> None:
        super().flush()
        self.next_in_chain.flush()
        if self._capturing:
            self._do("end", None)
        self._capturing = False

    def clear_buffer(self) -> None:
        """What was not sent yet is dropped; how much was heard comes with
        on_playback_finished()."""
        self._generation += 1
        self._pause_wanted = False
        self._capturing, self._uncut = False, bool(self._tasks)
        self._work = deque(job for job in self._work if job[1] == "cut")
        self._out.clear()
        self._wake()
        self.next_in_chain.clear_buffer()

    def pause(self) -> None:
        """The sound stops, as somebody may have begun to speak: pages close the mouth and hold the
        clock. resume() goes on, clear_buffer() ends it."""
        self.next_in_chain.pause()
        if not self._pause_wanted:
            self._pause_wanted = True
            track = self._track
            self._pause_at = None if track is None else self._history.heard(track.sample_rate)
            self._hold()

    def resume(self) -> None:
        """Nobody has interrupted: the sound goes on where it stopped."""
        self.next_in_chain.resume()
        if self._pause_wanted:
            self._pause_wanted = False
            self._hold()

    def on_playback_started(self, *, created_at: float) -> None:
        super().on_playback_started(created_at=created_at)
        self._do("playing", self._segment)

    def on_playback_finished(self, *, playback_position: float, interrupted: bool, **more) -> None:
        super().on_playback_finished(playback_position=playback_position, interrupted=interrupted,
            **more)
        if interrupted and self._uncut:
            self._cut(playback_position)

    async def aclose(self) -> None:
        """Stops the face; the sound goes on."""
        self._room.off("participant_connected", self._on_participant)
        for task in self._tasks:
            task.cancel()
        await asyncio.gather(*self._tasks, return_exceptions=True)

    async def drained(self) -> None:
        """Returns when all that was captured has been listened to and sent."""
        async with self._changed:
            await self._changed.wait_for(lambda: not (self._work or self._out or self._busy)
                or self._failed)

    # --- what happens in tasks

    def _cut(self, heard: Optional[float]) -> None:
        self._uncut = False
        self._do("cut", (self._segment, heard))

    def _do(self, what: str, value) -> None:
        if self._tasks:
            self._work.append((self._generation, what, value))
            self._wake()

    def _hold(self) -> None:
        """Tells pages to hold their clock or to let it go, as is right when it is sent."""
        if self._track is not None and not (self._out and self._out[0][0] == PAUSE):
            self._out.appendleft((PAUSE, True, b""))
            self._wake()

    def _wake(self) -> None:
        async def notify() -> None:
            async with self._changed:
                self._changed.notify_all()

        if self._tasks:
            asyncio.ensure_future(notify())

    def _on_participant(self, participant: object = None) -> None:
        if self._track is None:
            return
        identity = getattr(participant, "identity", "")
        if not identity:  # all know it already, or ignore it
            self._out.appendleft((TOPIC, True, self._track.hello()))
        elif not self._destinations or identity in self._destinations:
            self._out.appendleft((JOIN, True, identity.encode()))
        self._wake()

    def _clock(self, **what) -> tuple:
        return (CLOCK_TOPIC, True, json.dumps({"segment": self._track.segment, **what}).encode())

    async def _take(self, queue: str):
        async with self._changed:
            await self._changed.wait_for(lambda: getattr(self, queue))
            self._busy += 1
            taken = getattr(self, queue).popleft()
            self._changed.notify_all()
            return taken

    async def _done(self, messages: list[tuple] = ()) -> None:
        async with self._changed:
            self._busy -= 1
            self._out.extend(messages)
            self._changed.notify_all()

    async def _listen(self) -> None:
        """One job after the other; the face stops where one fails, the sound does not."""
        try:
            while True:
                generation, what, value = await self._take("_work")
                messages = await self._job(what, value)
                # Interrupted meanwhile: nobody is to see it.
                await self._done(messages if what == "cut" or generation == self._generation
                    else [])
        except asyncio.CancelledError:
            raise
        except Exception:
            logger.exception("the face has stopped")
            self._failed = True
            await self._done()

    async def _job(self, what: str, value) -> list[tuple]:
        track = self._track
        if what == "sound":
            return await self._hear(*value)
        if what == "playing":
            self._played = value  # if the face has not heard of it, it is told when it does
            return [self._clock(playing=track.begins)] if value == self._listened else []
        if track is None:
            return []
        if what == "end":
            return self._messages(await asyncio.to_thread(track.end))
        segment, heard = value
        if segment != self._listened:  # the face had not begun: there is none to stop
            return []
        units = track.cut(None if heard is None else round(heard * track.sample_rate))
        if not units:
            return []
        return [(TOPIC, True, track.hello()), self._clock(begins=track.begins, cut=units[0].time),
                *self._messages(units)]

    async def _hear(self, segment: int, frame: rtc.AudioFrame) -> list[tuple]:
        if self._track is None:
            self._track = FaceTrack(frame.sample_rate, **self._options)
        samples = np.frombuffer(bytes(frame.data), np.int16)
        if frame.num_channels > 1:
            samples = samples.reshape(-1, frame.num_channels).mean(axis=1).astype(np.int16)
        begin, self._listened = [], segment
        if not self._track.speaking:
            self._track.start()
            begin = [(TOPIC, True, self._track.hello()), self._clock(begins=self._track.begins)]
            if self._played == segment:
                begin.append(self._clock(playing=self._track.begins))
        return begin + self._messages(await asyncio.to_thread(self._track.push, samples,
                                                              frame.sample_rate))

    @staticmethod
    def _messages(units: list[Unit]) -> list[tuple]:
        return [(TOPIC, unit.intra, unit.message) for unit in units]

    async def _send(self) -> None:
        while True:
            await self._publish(*await self._take("_out"))
            await self._done()

    async def _publish_pause(self) -> None:
        """One of a segment that does not play yet follows its first `playing`."""
        heard = self._history.heard(self._track.sample_rate)
        if heard is None or self._history.paused == self._pause_wanted:
            return
        what = "paused" if self._pause_wanted else "playing"
        if self._pause_wanted and self._pause_at is not None:
            heard = self._pause_at
        await self._publish(*self._clock(**{what: heard}))

    async def _greet(self, identity: str) -> None:
        for topic, message in self._history.messages(self._track):
            await self._room.local_participant.publish_data(message, reliable=True, topic=topic,
                                                            destination_identities=[identity])

    async def _publish(self, topic: str, intra: bool, message: bytes) -> None:
        if topic == JOIN:
            try:
                await self._greet(message.decode())
            except Exception as problem:
                logger.debug("who has joined was not greeted: %s", problem)
            return
        if topic == PAUSE:
            return await self._publish_pause()
        unit = topic == TOPIC and message[0] != 0x41
        if unit and self._missed:
            if not intra:
                return
            message, self._missed = mark_missed(message), False
        try:
            await self._room.local_participant.publish_data(message, reliable=True, topic=topic,
                                                            destination_identities=self._destinations)
            self._history.keep(topic, intra, message)
            if topic == CLOCK_TOPIC and self._pause_wanted and b'"playing"' in message:
                await self._publish_pause()
        # not connected just now: on with the next plane where one can begin
        except Exception as problem:
            logger.debug("a message of the face was not sent: %s", problem)
            self._missed = self._missed or unit
