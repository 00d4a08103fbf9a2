"""Of Pipecat's frames those that FaceProcessor and its tests use, by their public reference
(docs.pipecat.ai, frames)."""
from dataclasses import dataclass, field
from typing import Any, Optional


@dataclass
class Frame:
    pts: Optional[int] = field(init=False, default=None)


@dataclass
class SystemFrame(Frame):
    """Overtakes others; an interruption does not drop it."""


@dataclass
class DataFrame(Frame):
    """In order; an interruption drops those that wait."""


@dataclass
class ControlFrame(Frame):
    """As data."""


@dataclass
class StartFrame(SystemFrame):
    audio_out_sample_rate: int = 24000


@dataclass
class CancelFrame(SystemFrame):
    pass


@dataclass
class EndFrame(ControlFrame):
    pass


@dataclass
class InterruptionFrame(SystemFrame):
    pass


@dataclass
class BotStartedSpeakingFrame(SystemFrame):
    pass


@dataclass
class BotStoppedSpeakingFrame(SystemFrame):
    pass


@dataclass
class OutputAudioRawFrame(DataFrame):
    audio: bytes
    sample_rate: int
    num_channels: int


@dataclass
class TTSAudioRawFrame(OutputAudioRawFrame):
    pass


@dataclass
class TTSStartedFrame(ControlFrame):
    pass


@dataclass
class TTSStoppedFrame(ControlFrame):
    pass


@dataclass
class OutputTransportMessageFrame(DataFrame):
    message: Any


@dataclass
class OutputTransportMessageUrgentFrame(SystemFrame):
    message: Any
