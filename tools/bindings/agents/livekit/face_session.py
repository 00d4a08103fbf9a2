"""A face for LiveKit Agents as the avatars of its plugins are used: a session that is started
beside that of the agent.

    session = AgentSession(llm=..., tts=..., stt=...)
    await session.start(agent=MyAgent(), room=ctx.room)
    face = FaceSession()
    await face.start(session, room=ctx.room)

Written for `livekit.agents.voice.avatar.AvatarSession` (livekit/agents 1.x, voice/avatar/_types.py).
Other avatars join the room as participants of their own and send video. This one works in the
process of the agent: the sound stays the agent's, and its participant publishes data, so there is
nobody to be waited for, and nobody to be removed at the end.
"""
from __future__ import annotations

import asyncio
from typing import Optional

from livekit import rtc
from livekit.agents.voice import avatar

from face_output import FaceOutput


class FaceSession(avatar.AvatarSession):
    """options: of FaceOutput, and of FaceTrack."""

    def __init__(self, **options) -> None:
        super().__init__()
        self._options = options
        self._output: Optional[FaceOutput] = None
        self._agent = None
        self._running = asyncio.Event()

    @property
    def avatar_identity(self) -> str:
        # Nobody of this name is in the room: what the base class does with the avatar's participant
        # must not reach the agent.
        return "animeme-face"

    @property
    def provider(self) -> str:
        return "animeme"

    @property
    def output(self) -> Optional[FaceOutput]:
        """The audio output that makes the face; None: it was not started."""
        return self._output

    async def start(self, agent_session, room: rtc.Room) -> None:
        """Puts the face in front of the agent's audio output, which session.start() makes."""
        sound = agent_session.output.audio
        if sound is None:
            raise RuntimeError("the agent has no audio output yet; start its session first")
        if self._output is not None:
            raise RuntimeError("the face has been started already")
        await super().start(agent_session, room)
        self._agent = agent_session
        self._output = FaceOutput(sound, room, **self._options)
        agent_session.output.audio = self._output
        self._running.set()

    async def wait_for_join(self, *, timeout: Optional[float] = 30.0) -> None:
        """Returns when the face has been started."""
        await asyncio.wait_for(self._running.wait(), timeout)

    async def aclose(self) -> None:
        """Ends the face; the sound goes on without it."""
        output, self._output = self._output, None
        self._running.clear()
        if output is not None:
            if self._agent.output.audio is output:
                self._agent.output.audio = output.next_in_chain
            await output.aclose()
        await super().aclose()
