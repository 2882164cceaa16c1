"""Outcomes: what each event led to, as a record.

`wording.write` makes a sentence of it, by the template of the event's name (`words/en.json`).
"""

import math
from dataclasses import dataclass, replace
from typing import Literal

from symtop_ros.base.arrays import Vector
from symtop_ros.physics import (
    ClampVerdict,
    ExactTimes,
    KickVerdict,
    Kind,
    Motion,
    Pushes,
    State,
    Verdict,
    clamp_verdict,
    perrys_rule,
    push_axle,
)
from symtop_ros.run.simulation.changes.decay import Decay
from symtop_ros.run.simulation.changes.seen import Solved
from symtop_ros.run.wire.layout import NANOSECONDS
from symtop_ros.words import write

MILLI = 1000
ROUNDING = 1e-9  # of |Mgl|; a smaller change counts as none


@dataclass(frozen=True, slots=True)
class Neglected:
    """Forces that act, but that a verdict does not consider."""

    forces: Literal["friction", "torque", "both"]

    @classmethod
    def of(cls, motion: Motion) -> "Neglected | None":
        """Return those that act on a motion; None for gravity alone."""
        if not any(motion.applied_torque):
            return cls("friction") if motion.friction else None
        return cls("both" if motion.friction else "torque")


@dataclass(frozen=True, slots=True)
class Start:
    """A motion that begins: its kind and what follows from its start."""

    motion: Kind
    neglected: Neglected | None  # None if only gravity acts
    verdict: Verdict | None  # None for a motion whose precession is held
    clamp: ClampVerdict | None = None  # for a motion whose precession is held
    decay: Decay | None = None  # None if friction does not change the precession
    solved: Solved | None = None  # None if the start was not asked for by what is seen

    @property
    def kind(self) -> Literal["solved"] | None:
        """Kind of its sentence."""
        return "solved" if self.solved else None

    @classmethod
    def of(cls, motion: Motion, solved: Solved | None = None) -> "Start":
        """Return the outcome of the start of a motion."""
        if motion.clamped:
            held = clamp_verdict(motion.top, motion.start)
            return cls(motion.kind, None, None, held, solved=solved)
        verdict = perrys_rule(motion.top, motion.start)
        neglected = Neglected.of(motion)
        if solved and neglected:
            solved = replace(solved, caveat=neglected.forces)
        return cls(motion.kind, neglected, verdict, decay=Decay.of(motion), solved=solved)


@dataclass(frozen=True, slots=True)
class Means:
    """Mean phi' in rad/s without pushes and after them."""

    before: float
    after: float


@dataclass(frozen=True, slots=True)
class Gain:
    """Gain or loss (mJ) of the mean potential energy in time over a nutation."""

    kind: Literal["gained", "lost", "kept"]
    amount: float


@dataclass(frozen=True, slots=True)
class Pushed:
    """Consequences of pushes on the axle, if nothing else happens until the last one.

    For a driven motion the sentence only states that there were pushes, because friction and
    torques change the energy and the turning angles, too.
    """

    number: int
    # s of the motion from the first to the last push; None for a single push
    duration: float | None
    driven: bool
    turning_angles: tuple[float, float] | None = None  # rad, after the last one
    former_angles: tuple[float, float] | None = None  # without them
    means: Means | None = None  # also None if phi' is undefined at a time
    work: float | None = None  # mJ
    weight: Gain | None = None

    @classmethod
    def of(cls, motion: Motion, pushes: Pushes, before: State) -> "Pushed":
        """Return the outcome of the pushes of a motion, with the state before the first one."""
        duration = pushes.last_time / NANOSECONDS if pushes.number > 1 else None
        given = pushes.number, duration, motion.is_driven
        if motion.is_driven:
            return cls(*given)
        top = motion.top
        former = Motion(motion.top, before)
        last = motion.piece_at(ExactTimes(pushes.last_time)).motion
        rates = former.mean_precession_rate, last.mean_precession_rate
        return cls(
            *given,
            last.turning_angles,
            former.turning_angles,
            None if any(map(math.isnan, rates)) else Means(*rates),
            MILLI * float(top.energy(last.start) - top.energy(before)),
            _find_gain(top.Mgl * (last.mean_cosine - former.mean_cosine), top.Mgl),
        )

    @classmethod
    def of_given(cls, motion: Motion, pushes: Pushes) -> "Pushed":
        """Return the outcome of pushes that have ended, from the motion alone."""
        return cls.of(motion, pushes, push_axle(motion.top, motion.start, -pushes.impulse))


def _find_gain(change: float, Mgl: float) -> Gain:
    amount = MILLI * abs(change)
    if abs(change) <= ROUNDING * abs(Mgl):
        return Gain("kept", amount)
    return Gain("gained" if change > 0 else "lost", amount)


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
    """The real-time factor changed, and why.

    "slowed": the motion is too fast to be computed. "starved": other programs have the processor;
    `got` and `needed` are CPU times in percent of one core.
    """

    kind: Literal["slowed", "starved", "changed"]
    before: float
    after: float
    got: float = 0.0
    needed: float = 0.0


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
    """An unexpected exception in an action, or in what led up to it."""

    action: str
    error: str  # type of the exception
    text: str

    def __str__(self) -> str:
        """Return the failure in words."""
        return write("failure", self)


Outcome = (
    Start
    | KickVerdict
    | Pushed
    | ClampVerdict
    | Pause
    | Step
    | ClockJump
    | Pace
    | Torque
    | Parameters
    | Record
    | Failure
)
# By the name of the event.
OUTCOMES: dict[str, type[Outcome]] = {
    "start": Start,
    "reset": Start,
    "kick": KickVerdict,
    "push": Pushed,
    "release": Pushed,
    "clamp": ClampVerdict,
    "unclamp": Start,
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
