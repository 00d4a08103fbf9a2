"""Of livekit-agents (livekit/agents/voice/io.py of 2026) the audio output: how segments, playback
and outputs in front of
outputs go together."""
import asyncio
from abc import ABC, abstractmethod
from dataclasses import dataclass
from typing import Optional

from livekit import rtc


@dataclass
class PlaybackFinishedEvent:
    playback_position: float
    interrupted: bool
    synchronized_transcript: Optional[str] = None


@dataclass
class PlaybackStartedEvent:
    created_at: float


@dataclass
class AudioOutputCapabilities:
    pause: bool


class AudioOutput(ABC, rtc.EventEmitter[str]):
    def __init__(self, *, label, capabilities, next_in_chain=None, sample_rate=None):
        super().__init__()
        self.label = label
        self._capabilities = capabilities
        self._next = next_in_chain
        self._rate = sample_rate
        self._in_segment = False
        self._begun = self._finished = 0
        self._news = asyncio.Event()
        self._last = PlaybackFinishedEvent(0, False)
        if next_in_chain is not None:
            next_in_chain.on("playback_finished",
                lambda event: self.on_playback_finished(**vars(event)))
            next_in_chain.on("playback_started",
                lambda event: self.on_playback_started(**vars(event)))

    @property
    def next_in_chain(self):
        return self._next

    @property
    def sample_rate(self):
        return self._rate

    @property
    def can_pause(self):
        return self._capabilities.pause and (self._next is None or self._next.can_pause)

    def on_playback_started(self, *, created_at):
        self.emit("playback_started", PlaybackStartedEvent(created_at))

    def on_playback_finished(self, *, playback_position, interrupted, synchronized_transcript=None):
        assert self._finished < self._begun, "finished more often than begun"
        self._finished += 1
        self._last = PlaybackFinishedEvent(playback_position, interrupted, synchronized_transcript)
        self._news.set()
        self.emit("playback_finished", self._last)

    async def wait_for_playout(self):
        wanted = self._begun
        while self._finished < wanted:
            await self._news.wait()
            self._news.clear()
        return self._last

    @abstractmethod
    async def capture_frame(self, frame):
        if not self._in_segment:
            self._in_segment = True
            self._begun += 1

    @abstractmethod
    def flush(self):
        self._in_segment = False

    @abstractmethod
    def clear_buffer(self): ...

    def pause(self):
        if self._next:
            self._next.pause()

    def resume(self):
        if self._next:
            self._next.resume()

    def on_attached(self):
        if self._next:
            self._next.on_attached()

    def on_detached(self):
        if self._next:
            self._next.on_detached()
