"""Of livekit-agents (voice/avatar/_types.py of 2026) the base of avatars' sessions: it waits for a
participant with a video track, and removes that participant at the end."""
import asyncio
from abc import ABC, abstractmethod
from typing import Optional

from livekit import rtc


class AvatarSession(ABC, rtc.EventEmitter[str]):
    def __init__(self) -> None:
        super().__init__()
        self._wait_avatar_join_task: Optional[asyncio.Task] = None
        self._room = None
        self._agent_session = None

    @property
    @abstractmethod
    def avatar_identity(self) -> str: ...

    @property
    def provider(self) -> str:
        return "unknown"

    async def start(self, agent_session, room) -> None:
        self._room, self._agent_session = room, agent_session
        self._wait_avatar_join_task = asyncio.create_task(asyncio.Event().wait())

    async def wait_for_join(self, *, timeout=30.0) -> None:
        if self._wait_avatar_join_task is not None:
            await asyncio.wait_for(asyncio.shield(self._wait_avatar_join_task), timeout)

    async def aclose(self) -> None:
        if self._room is not None:
            self._room.removed.append(self.avatar_identity)
            self._room = self._agent_session = None
        if self._wait_avatar_join_task is not None:
            self._wait_avatar_join_task.cancel()
            self._wait_avatar_join_task = None
