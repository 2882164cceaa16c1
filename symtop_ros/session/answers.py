"""Answers to requests that lead to no event."""

from dataclasses import dataclass
from typing import Literal

from symtop_ros.wording import write


@dataclass(frozen=True, slots=True)
class Answer:
    """An answer; `str` of it is its text."""

    kind: Literal["recorded", "recording", "not_recording", "paused", "running"]
    path: str = ""  # of the log

    def __str__(self) -> str:
        """Return the answer in words."""
        return write("answer", self)
