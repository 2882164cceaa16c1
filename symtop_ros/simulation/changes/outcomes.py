"""Outcomes: what each event led to, as a record.

`wording.write` makes a sentence of it, by the template of the event's name (`wording/en.json`).
"""

from dataclasses import dataclass
from typing import Literal

from symtop_ros.arrays import Vector
from symtop_ros.physics import KickVerdict, Kind, Motion, Verdict, perrys_rule
from symtop_ros.wording import write


@dataclass(frozen=True, slots=True)
class Start:
    """A motion that begins: its kind and what follows from its start."""

    motion: Kind
    verdict: Verdict

    @classmethod
    def of(cls, motion: Motion) -> "Start":
        """Return the outcome of the start of a motion."""
        return cls(motion.kind, perrys_rule(motion.top, motion.start))


@dataclass(frozen=True, slots=True)
class Pause:
    """The motion stopped or continues at a time (s of the motion)."""

    time: float


@dataclass(frozen=True, slots=True)
class Step:
    """A paused motion advanced to a time (s of the motion); None: by less than 1 ns."""

    kind: Literal["stepped", "none"]
    time: float | None = None


@dataclass(frozen=True, slots=True)
class ClockJump:
    """The clock jumped between two stamps in ns."""

    before: int
    after: int


@dataclass(frozen=True, slots=True)
class Pace:
    """The real-time factor changed; "slowed" if the motion is too fast to be computed."""

    kind: Literal["slowed", "changed"]
    before: float
    after: float


@dataclass(frozen=True, slots=True)
class Torque:
    """The applied torque (N m, world frame) changed, and why."""

    kind: Literal["applied", "released", "steady"]
    torque: Vector


@dataclass(frozen=True, slots=True)
class Setting:
    """A parameter and its new value as text."""

    name: str
    value: str


@dataclass(frozen=True, slots=True)
class Parameters:
    """Parameters that changed."""

    changes: tuple[Setting, ...]


@dataclass(frozen=True, slots=True)
class Record:
    """A recording began, was ended, or stopped by itself; `path` is its file."""

    kind: Literal["begun", "ended", "stopped"]
    path: str = ""
    failure: str = ""


@dataclass(frozen=True, slots=True)
class Failure:
    """An unexpected exception in an action; the motion keeps running."""

    action: str
    error: str  # type of the exception
    text: str

    def __str__(self) -> str:
        """Return the failure in words."""
        return write("failure", self)


Outcome = (
    Start | KickVerdict | Pause | Step | ClockJump | Pace | Torque | Parameters | Record | Failure
)
# By the name of the event.
OUTCOMES: dict[str, type[Outcome]] = {
    "start": Start,
    "reset": Start,
    "kick": KickVerdict,
    "pause": Pause,
    "resume": Pause,
    "step": Step,
    "clock": ClockJump,
    "pace": Pace,
    "torque": Torque,
    "parameters": Parameters,
    "record": Record,
    "failure": Failure,
}
