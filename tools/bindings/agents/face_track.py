"""A face beside the sound of an agent, timed by its samples: samples in, messages for a data
channel out.

    track = FaceTrack(24000)
    for unit in track.push(samples): send(unit.message)       # while the voice is made
    for unit in track.end(): send(unit.message)               # it has said it all
    for unit in track.cut(heard): send(unit.message)          # it was interrupted after `heard`
    samples

Where the voice tells its phones, `say(begin, end, phone)` takes the place of push().

The clock counts samples, never seconds: segment after segment of sound, and the rest behind each in
which the mouth closes. Messages are those of /face (tools/live/web/README.md) with one tick a
sample, so a time is the sample at which a face is to be shown. A segment begins with an intra plane
of a stream of its own (object start code), and so does what follows a cut: a unit whose time is not
behind the one before replaces all that was sent for its time and later.
"""
from __future__ import annotations

import json
import struct
import time
from fractions import Fraction
from typing import NamedTuple, Optional

import numpy as np

import animeme

FAPS = 68
TOPIC = "animeme.face"  # binary: the messages of /face
CLOCK_TOPIC = "animeme.clock"  # JSON: where on the clock of the face the sound is
PLANE = bytes([0, 0, 1, 0xBB])  # a unit begins with it, but for the first of a stream
PAST = 100  # segments that a cut may go back


class Unit(NamedTuple):
    """A message and what it says."""

    time: int  # samples on the clock of the track
    intra: bool  # decoding can begin here
    message: bytes


def mark_missed(message: bytes) -> bytes:
    """The message of an intra plane in front of which units were lost."""
    return message[:12] + bytes([message[12] | 2]) + message[13:]


class Resampler:
    """Sound at another rate, piece by piece, as well as a face needs it: the mean of what one
    sample stands for, and straight lines between."""

    def __init__(self, source: int, target: int) -> None:
        self.source = source
        self._step = source / target
        self._width = max(1, round(self._step))
        self._tail = np.zeros(self._width - 1, np.float32)
        self._last = np.zeros(0, np.float32)  # the means from the one before the next sample on
        self._next = 0.0  # place of the next sample among them

    def push(self, samples) -> np.ndarray:
        """Samples of full scale 32768, as they came."""
        whole = np.concatenate([self._tail, np.asarray(samples, np.float32)])
        if self._width > 1:
            self._tail = whole[len(whole) - self._width + 1:]
        means = np.convolve(whole, np.full(self._width, 1 / self._width, np.float32), "valid")
        means = np.concatenate([self._last, means.astype(np.float32)])
        count = max(0, int(np.floor((len(means) - 1 - self._next) / self._step)) + 1)
        places = self._next + self._step * np.arange(count)
        out = np.interp(places, np.arange(len(means)), means) if count else np.zeros(0)
        self._next += self._step * count
        gone = min(int(self._next), len(means))
        self._last, self._next = means[gone:], self._next - gone
        return np.clip(np.round(out), -32768, 32767).astype(np.int16)


class FaceTrack:
    """One face. Not thread safe, but its calls let other threads run while they listen.

    sample_rate: ticks a second of the clock, and samples of the sound if push() says no other.
    model: who speaks; None: the built-in one.
    rate, quant, intra_seconds: as of animeme.Encoder.
    lang: language of the voice.
    rest: seconds in which a mouth closes.

    Raises animeme.Error where Animeme was built without ears (pocketsphinx).
    """

    def __init__(self, sample_rate: int, model: Optional[animeme.Model] = None, *, rate=25,
        quant: int = 1,
                 intra_seconds: float = 1.0, lang: str = "en", rest: float = 0.2) -> None:
        self.sample_rate = int(sample_rate)
        self.begins = 0  # the sample of the clock at which the segment began that is or was spoken
        self.segment = 0  # number of it
        self._model = model or animeme.builtin_model()
        self._columns = [int(name[3:].split("_")[0]) - 1 for name in self._model.controls]
        self._rate = Fraction(rate).limit_denominator(1001)
        self._coding = {"rate": self._rate, "quant": quant, "intra_seconds": intra_seconds}
        self._lang = lang
        self._closing = max(1, round(rest * float(self._rate)))
        self._mask = np.zeros(FAPS, bool)
        self._mask[self._columns] = True
        self._voice_rate = self.sample_rate  # of what the ears hear
        self._resampler: Optional[Resampler] = None
        self._voice = self._listen()  # whoever has no ears is to know now
        self._script: Optional[animeme.SpeechStream] = None
        self._faces: list[np.ndarray] = []  # of the segment
        self._frame = 0  # number of its next one
        self._past: list[tuple[int, list]] = []  # of segments before it: begin and faces
        self._over, self._was_cut = True, False

    def hello(self) -> bytes:
        """The first message of /face, for those who join."""
        config = animeme.Encoder().config
        return struct.pack(">BBBBIH", 0x41, 1, config[4], 0, self.sample_rate, len(config)) + config

    @property
    def speaking(self) -> bool:
        """Whether a segment has begun and not ended."""
        return not self._over

    def start(self) -> None:
        """Begins a segment; push() does it by itself."""
        if not self._over:
            return
        if self._faces or self._frame:
            self._past = [*self._past[1 - PAST:], (self.begins, self._faces)]
            self.begins = self._time(self._frame)
            self.segment += 1
        self._voice, self._script = self._listen(), None
        self._resampler = None
        self._encoder = animeme.Encoder(**self._coding)
        self._faces, self._frame = [], 0
        self._over = self._was_cut = False

    def push(self, samples, sample_rate: Optional[int] = None) -> list[Unit]:
        """The next samples of the segment, (n,) int16 or floats; what can be told of its face.

        sample_rate: of these samples, None: that of the track. It may be another one each time; the
        clock stays what it is.
        """
        rate = int(sample_rate or self.sample_rate)
        if self._over and rate != self._voice_rate:
            self._voice_rate = rate
        self.start()
        if rate != self._voice_rate:  # in the middle of a segment
            samples = np.asarray(samples)
            if samples.dtype.kind == "f":
                samples = samples * 32768
            if self._resampler is None or self._resampler.source != rate:
                self._resampler = Resampler(rate, self._voice_rate)
            samples = self._resampler.push(samples)
        return self._send(self._voice.push(samples))

    def say(self, begin: int, end: int, phone: str, word: str = "") -> list[Unit]:
        """The next phone of the segment instead of its samples: from `begin` to `end`, samples of
        the segment; ARPAbet
        without stress or "SIL". Gaps are silence. A segment has phones or samples, not both."""
        self.start()
        if self._script is None:
            self._script = animeme.SpeechStream(self._model, rate=self._rate)
        return self._send(self._script.push(begin / self.sample_rate, end / self.sample_rate, phone,
            word))

    def end(self) -> list[Unit]:
        """The segment is over: the rest of its face, and the mouth closes."""
        return [] if self._over else self._send((self._script
            or self._voice).finish()) + self._close()

    def cut(self, heard: Optional[int] = None) -> list[Unit]:
        """The segment was interrupted, also if it had ended here: the mouth closes from the face
        that is shown when
        `heard` samples of it have been played, None: from the last one that was sent. Less than 0:
        while one of those before it was heard."""
        if self._was_cut or not (self._faces or self.speaking):
            return []
        while heard is not None and heard < 0 and self._past:
            at = self.begins + heard
            self.begins, self._faces = self._past.pop()
            heard = at - self.begins
        frame = self._frame - 1 if heard is None else self._frame_at(heard)
        shown = self._faces[min(frame,
            len(self._faces) - 1)] if self._faces and frame >= 0 else np.zeros(FAPS, np.int32)
        self._faces = [shown]
        self._frame = max(frame, -1) + 1
        self._encoder = animeme.Encoder(**self._coding)
        self._was_cut = True
        return self._close()

    def _listen(self) -> animeme.VoiceStream:
        return animeme.VoiceStream(self._model, self._voice_rate, lang=self._lang,
                                   rate=self._rate)

    def _time(self, frame: int) -> int:
        return self.begins + frame * self.sample_rate * self._rate.denominator // self._rate.numerator

    def _frame_at(self, sample: int) -> int:
        """The face that is shown at a sample of the segment."""
        frame = sample * self._rate.numerator // (self.sample_rate * self._rate.denominator)
        return frame + 1 if self._time(frame + 1) <= self.begins + sample else frame

    def _unit(self, values: np.ndarray) -> Unit:
        data = self._encoder.write(values, self._mask)
        time, intra = self._time(self._frame), self._encoder.intra
        header = struct.pack(">QIB", time, self._time(self._frame + 1) - time, intra)
        self._faces.append(values)
        self._frame += 1
        return Unit(time, intra, header + data)

    def _send(self, rows: np.ndarray) -> list[Unit]:
        units = []
        for row in rows:
            values = np.zeros(FAPS, np.int32)
            values[self._columns] = np.round(row)
            units.append(self._unit(values))
        return units

    def _close(self) -> list[Unit]:
        last = self._faces[-1] if self._faces else np.zeros(FAPS, np.int32)
        units = []
        for step in range(1, self._closing + 1):
            share = step / self._closing
            left = 1 - share * share * (3 - 2 * share)
            units.append(self._unit(np.round(last * left).astype(np.int32)))
        self._over = True
        return units


class FaceHistory:
    """What was sent of a segment, for those who join in the middle of it, and where its sound is.

    wall: seconds of a clock that never goes back.
    """

    def __init__(self, wall=time.monotonic) -> None:
        self._wall = wall
        self._begun: list[tuple] = []  # (topic, message): what begins the segment
        self._units: list[tuple] = []  # (time, intra, message)
        self._started: Optional[tuple[float, int]] = None  # at which instant which sample played
        self._paused: Optional[int] = None

    def keep(self, topic: str, intra: bool, message: bytes) -> None:
        """A message that was sent."""
        if topic == CLOCK_TOPIC:
            told = json.loads(message)
            if "playing" in told:
                self._started, self._paused = (self._wall(), told["playing"]), None
            elif "paused" in told:
                self._paused = told["paused"]
            elif "cut" in told:
                self._begun = [(topic, message)]
            else:
                self._begun, self._units = [(topic, message)], []
                self._started = self._paused = None
        elif message[0] != 0x41:
            at = int.from_bytes(message[:8], "big")
            while self._units and self._units[-1][0] >= at:
                self._units.pop()
            self._units.append((at, intra, message))

    @property
    def paused(self) -> bool:
        """Whether its sound is paused."""
        return self._paused is not None

    def heard(self, sample_rate: int) -> Optional[int]:
        """The sample that is heard now; None: the segment does not play."""
        if self._paused is not None:
            return self._paused
        if self._started is None:
            return None
        began, sample = self._started
        return sample + round((self._wall() - began) * sample_rate)

    def messages(self, track: FaceTrack) -> list[tuple]:
        """(topic, message) for somebody who has seen nothing: the segment from the face on that is
        to be seen now, as units are sent long before they are due."""
        shown = self.heard(track.sample_rate)
        messages = [(TOPIC, track.hello()), *self._begun]
        for name, sample in (("playing", shown), ("paused", self._paused)):
            if sample is not None:
                told = {"segment": track.segment, name: sample}
                messages.append((CLOCK_TOPIC, json.dumps(told).encode()))
        first = 0
        for number, (at, intra, _) in enumerate(self._units):
            if intra and (at <= (shown or 0) or number == 0):
                first = number
        units = [message for _, _, message in self._units[first:]]
        # in the middle of a stream: with what that began with
        if units and units[0][13:].startswith(PLANE):
            for _, _, message in reversed(self._units[:first]):
                if not message[13:].startswith(PLANE):
                    head = message[13:message.index(PLANE, 13)]
                    units[0] = units[0][:13] + head + units[0][13:]
                    break
        return messages + [(TOPIC, message) for message in units]
