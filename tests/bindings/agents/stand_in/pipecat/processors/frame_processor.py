"""Of Pipecat the processor of frames: system frames in one task, all others in another, which an
interruption cancels with all that waits."""
import asyncio
from enum import Enum

from pipecat.frames.frames import InterruptionFrame, SystemFrame


class FrameDirection(Enum):
    DOWNSTREAM = 1
    UPSTREAM = 2


class FrameProcessor:
    def __init__(self, *, name=None, **_):
        self.name = name or type(self).__name__
        self._clock = "a clock of the pipeline"  # names that subclasses must leave alone
        self._prev = self._next = self._observer = self._metrics = None
        self.__system = asyncio.Queue()
        self.__waiting = asyncio.Queue()
        self.__system_task = self.__task = None

    def link(self, processor):
        self._next, processor._prev = processor, self

    async def setup(self, _=None):
        self.__system_task = asyncio.create_task(self.__work(self.__system))
        self.__task = asyncio.create_task(self.__work(self.__waiting))

    async def cleanup(self):
        for task in (self.__system_task, self.__task):
            task.cancel()
        await asyncio.gather(self.__system_task, self.__task, return_exceptions=True)

    async def queue_frame(self, frame, direction=FrameDirection.DOWNSTREAM):
        queue = self.__system if isinstance(frame, SystemFrame) else self.__waiting
        await queue.put((frame, direction))

    async def idle(self):
        """Returns when all that was queued has been processed."""
        await asyncio.gather(self.__system.join(), self.__waiting.join())

    async def process_frame(self, frame, direction):
        if isinstance(frame, InterruptionFrame):
            self.__task.cancel()
            await asyncio.gather(self.__task, return_exceptions=True)
            while not self.__waiting.empty():
                self.__waiting.get_nowait()
                self.__waiting.task_done()
            self.__task = asyncio.create_task(self.__work(self.__waiting))

    async def push_frame(self, frame, direction=FrameDirection.DOWNSTREAM):
        other = self._next if direction == FrameDirection.DOWNSTREAM else self._prev
        if other is not None:
            await other.queue_frame(frame, direction)

    async def __work(self, queue):
        while True:
            frame, direction = await queue.get()
            try:
                await self.process_frame(frame, direction)
            finally:
                queue.task_done()
