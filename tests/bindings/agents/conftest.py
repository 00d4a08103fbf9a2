"""A room that plays sound when it is told to, a voice, and what a page does with messages."""
import asyncio
import os
import wave
from pathlib import Path

import numpy as np
import pytest
from livekit import rtc
from livekit.agents.voice import io

import animeme

SOURCE = Path(os.environ["ANIMEME_SOURCE_DIR"])


class RoomSound(io.AudioOutput):
    """The output of a room: keeps what it is given and has played as much of it as a test says."""

    def __init__(self, sample_rate):
        super().__init__(label="room", capabilities=io.AudioOutputCapabilities(pause=True),
            sample_rate=sample_rate)
        self.given = self.played = 0  # samples of the segment
        self.all_given = 0
        self.over = False
        self.paused = 0  # how often it was paused, less how often it went on

    def pause(self):
        self.paused += 1

    def resume(self):
        self.paused -= 1

    async def capture_frame(self, frame):
        await super().capture_frame(frame)
        if self.given == 0:
            self.on_playback_started(created_at=0.0)
        self.given += frame.samples_per_channel
        self.all_given += frame.samples_per_channel

    def flush(self):
        super().flush()
        self.over = self.given > 0

    def play(self, samples=None):
        """Plays samples, None: all; at the end of a segment that is over it says so."""
        self.played = self.given if samples is None else min(self.given, self.played + samples)
        if self.over and self.played == self.given:
            self._finish(False)

    def clear_buffer(self):
        if self.given:
            self.flush()
            asyncio.get_running_loop().call_soon(self._finish, True)

    def _finish(self, interrupted):
        played = self.played / self.sample_rate
        self.given = self.played = 0
        self.over = False
        self.on_playback_finished(playback_position=played, interrupted=interrupted)


class UnitDecoder:
    """Units to values as the npm package does it: each is given the start code of the next at
    once."""

    START = bytes([0, 0, 1, 0xBB])

    def __init__(self):
        self.decoder = None

    def decode(self, unit):
        if self.decoder and unit.startswith(self.START):
            self.decoder.push(unit[len(self.START):])
        else:
            assert unit.startswith(bytes([0, 0, 1, 0xBA]))
            self.decoder = animeme.Decoder()
            self.decoder.push(unit)
        self.decoder.push(self.START)
        planes = list(self.decoder)
        assert len(planes) == 1 and not self.decoder.warnings
        return planes[0]


@pytest.fixture(scope="session")
def voice():
    """(samples, sample rate) of a sentence."""
    with wave.open(str(SOURCE / "tools/release/samples/voice.wav")) as file:
        assert file.getnchannels() == 1 and file.getsampwidth() == 2
        return np.frombuffer(file.readframes(file.getnframes()), "<i2"), file.getframerate()


@pytest.fixture(scope="session", autouse=True)
def ears():
    try:
        animeme.VoiceStream(animeme.builtin_model(), 16000)
    except animeme.Error as error:
        pytest.skip(f"Animeme was built without ears: {error.message}")


def frame_of(samples, rate):
    return rtc.AudioFrame(samples.astype("<i2").tobytes(), rate, 1, len(samples))
