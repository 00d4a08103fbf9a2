"""Of livekit-rtc what FaceOutput and its tests use: frames of sound, events, a room that keeps what
was published."""
import asyncio
from collections import defaultdict
from typing import Generic, TypeVar

T = TypeVar("T")


class EventEmitter(Generic[T]):
    def __init__(self):
        self._callbacks = defaultdict(list)

    def on(self, event, callback):
        self._callbacks[event].append(callback)
        return callback

    def off(self, event, callback):
        self._callbacks[event].remove(callback)

    def emit(self, event, *arguments):
        for callback in list(self._callbacks[event]):
            callback(*arguments)


class AudioFrame:
    def __init__(self, data, sample_rate, num_channels, samples_per_channel):
        if len(data) < num_channels * samples_per_channel * 2:
            raise ValueError("too few bytes")
        self._data = bytearray(data)
        self.sample_rate = sample_rate
        self.num_channels = num_channels
        self.samples_per_channel = samples_per_channel

    @property
    def data(self):
        return memoryview(self._data).cast("h")

    @property
    def duration(self):
        return self.samples_per_channel / self.sample_rate


class LocalParticipant:
    identity = "agent"

    def __init__(self):
        self.published = []  # (topic, bytes), to all
        self.sent_to = defaultdict(list)  # the same, to one alone
        self.gate = asyncio.Event()  # closed: the network is slow
        self.gate.set()
        self.broken = False

    async def publish_data(self, payload, *, reliable=True, destination_identities=[], topic=""):
        await self.gate.wait()
        if self.broken:
            raise ConnectionError("not connected")
        assert isinstance(payload, bytes) and reliable
        if destination_identities:
            for identity in destination_identities:
                self.sent_to[identity].append((topic, payload))
        else:
            self.published.append((topic, payload))


class Room(EventEmitter):
    def __init__(self):
        super().__init__()
        self.local_participant = LocalParticipant()
        self.removed = []  # identities of participants that were removed
