"""Starts from what is seen: a tilt and the time of one turn, a dip, constants of the motion.

The questions are those of `physics.solve_start`. Which of several solutions is started, and all of
them, are part of the outcome, so that a client need not compute anything.
"""

import math
from collections.abc import Mapping
from dataclasses import astuple, dataclass
from typing import Any, Literal

from symtop_ros.base.refusals import RefusedError, number, refuse, validate_names
from symtop_ros.base.units import QUANTITIES
from symtop_ros.physics import QUESTIONS, Solution, State, Top, solve_start
from symtop_ros.run.simulation.settings import MAX_ANGLE, MAX_RATE, InitialConditions

KNOWN = tuple(dict.fromkeys(name for each in QUESTIONS for name in each.split()))
# A tilt and a spin alone are read as angles and rates, unless `solution` is given.
PLAIN = ("theta", "psi_dot")
SEEN = tuple(name for name in KNOWN if name not in PLAIN)
SOLUTION = "solution"
BESIDE = ("phi", "psi")  # angles that no question knows
PER_MINUTE = 30 / math.pi  # turns, of rad/s


@dataclass(frozen=True, slots=True)
class Found:
    """A start that has what was asked for: tilt in rad, rates in rad/s."""

    number: int  # from 1 on
    theta: float
    theta_dot: float | None  # None: 0
    phi_dot: float
    psi_dot: float

    @classmethod
    def of(cls, number: int, start: Solution) -> "Found":
        """Return a solution with its number."""
        return cls(number, start.theta, start.theta_dot or None, start.phi_dot, start.psi_dot)

    @property
    def phi_turns(self) -> float:
        """Precession rate in turns a minute."""
        return self.phi_dot * PER_MINUTE

    @property
    def psi_turns(self) -> float:
        """Spin rate in turns a minute."""
        return self.psi_dot * PER_MINUTE

    def start(self, phi: float, psi: float) -> State:
        """Return the state with the angles (rad) that no question knows."""
        return State.from_euler(
            theta=self.theta,
            phi=phi,
            psi=psi,
            theta_dot=self.theta_dot or 0.0,
            phi_dot=self.phi_dot,
            psi_dot=self.psi_dot,
        )


@dataclass(frozen=True, slots=True)
class Solved:
    """All starts that have what was asked for, and which of them was taken."""

    taken: int  # its number, from 1 on
    phi: float  # rad; angles of the start, which no question knows
    psi: float
    Ix: float  # of the top for which it was solved
    Iz: float
    Mgl: float
    found: tuple[Found, ...]
    # what acts besides gravity, of which the solutions know nothing; "held" by initial.clamped
    caveat: Literal["friction", "torque", "both", "held"] | None = None

    @property
    def count(self) -> int:
        """Number of solutions."""
        return len(self.found)

    @property
    def start(self) -> State:
        """The state of the one that was taken."""
        return self.found[self.taken - 1].start(self.phi, self.psi)


def asks_to_solve(request: Mapping[str, Any]) -> bool:
    """Return True if a start has to be found from what is seen."""
    return SOLUTION in request or any(name in request for name in SEEN)


def solve_request(
    top: Top, defaults: InitialConditions, request: Mapping[str, Any], names: tuple[str, ...]
) -> Solved:
    """Return the starts that a request asks for; `names` are those of a start without a question.

    Raises
    ------
    RefusedError
        If a name is unknown, or not one of a question and its angles; if there is no such motion,
        or not the solution that is asked for.
    """
    validate_names(request, dict.fromkeys((*names, *KNOWN, SOLUTION)))
    asked = [name for name in request if name in SEEN] or [SOLUTION]
    for name in request:
        if name not in (*KNOWN, SOLUTION, *BESIDE):
            raise RefusedError(f"{name} must be given without {', '.join(asked)}, got both")
    given = [name for name in KNOWN if name in request]
    if not any({*given} == {*each.split()} for each in QUESTIONS):
        rows = " / ".join(each.replace(" ", ", ") for each in QUESTIONS)
        raise RefusedError(f"a start must have one of {rows}, got {', '.join(given) or 'none'}")
    found = find_starts(top, request)
    if any(abs(rate) > MAX_RATE for each in found for rate in astuple(each)[2:] if rate):
        condition = f"such that no rate exceeds {MAX_RATE:g} rad/s"
        raise refuse(asked[0], condition, request[asked[0]])
    taken = number(SOLUTION, request.get(SOLUTION, 1), "", 1, len(found))
    if not taken.is_integer():
        raise refuse(SOLUTION, f"a whole number up to {len(found)}", request[SOLUTION])
    angles = {name: request.get(name, getattr(defaults, name)) for name in BESIDE}
    phi, psi = (number(name, angles[name], "rad", -MAX_ANGLE, MAX_ANGLE) for name in BESIDE)
    return Solved(int(taken), phi, psi, *top.moments, found)


def find_starts(top: Top, request: Mapping[str, Any]) -> tuple[Found, ...]:
    """Return the starts that have what a request knows, numbered from 1 on."""
    known: dict[str, Any] = {
        name: number(name, request[name], QUANTITIES[name]) for name in KNOWN if name in request
    }
    return tuple(Found.of(place, each) for place, each in enumerate(solve_start(top, **known), 1))
