"""What the module raises, warns of and gives out: plain Python."""

from typing import NamedTuple, Optional


class Position(NamedTuple):
    """Where in the input an error was found; None where it does not apply."""

    file: Optional[str] = None  # path as the caller gave it
    line: Optional[int] = None  # 1 is the first line
    column: Optional[int] = None  # 1 is the first byte of the line
    bit: Optional[int] = None  # bits from the start of the stream


class Error(Exception):
    """A failure of Animeme: str() is one sentence with its place in front.

    code: "invalid_argument", "syntax", "out_of_range", "truncated", "unsupported",
    "not_found", "io" or "internal".
    message: the sentence alone.
    position: a Position: file, line and column, or bit.
    """

    def __init__(self, text, code="internal", message=None, position=Position()):
        super().__init__(text, code, message, position)
        self.code = code
        self.message = text if message is None else message
        self.position = position

    def __str__(self):
        return self.args[0]


class InputWarning(UserWarning):
    """What was odd about an input that was read all the same: one sentence."""


class Phone(NamedTuple):
    """A spoken sound: seconds, ARPAbet without stress or "SIL", the word it belongs to."""

    start: float
    end: float
    label: str
    word: str = ""
