"""Motions to more than 20 digits, computed by other means than the package's, and errors.

The error of an attitude is the angle of the rotation that would correct it, in rad. It is
2 |q - q_exact|, with the sign of q that makes it smaller.
"""

from __future__ import annotations

import json
from dataclasses import dataclass
from decimal import Decimal
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from symtop_ros.arrays import Real
from symtop_ros.physics import Friction, State, Top
from symtop_ros.report.peers.peer import NO_TORQUE, Task
from symtop_ros.report.taylor import TaylorMotion

FILE = Path(__file__).with_name("reference.json")
FRICTION = Friction(axial=2e-6, transverse=1e-5)  # of the article's top with friction, N m s
EPS = 2.0**-52
PARTS = "article", "hard", "driven"


@dataclass(frozen=True)
class Problem:
    """A motion to compute, and its exact orientations."""

    name: str  # the motion, or the family of a hard case
    small: float | None  # distance of a hard case from the singular one
    task: Task  # top, start and friction; the numbers are taken as exact
    # times in s, up to very long ones, at which the exact orientations are stored
    times: tuple[float, ...]
    # change of the attitude in rad at these times if every input changes by half an ulp;
    # empty under friction
    limits: tuple[float, ...]
    _exact: dict[float, tuple[Real, Real]]

    def error(self, t: float, orientation: ArrayLike) -> float:
        """Return the error in rad at one of the stored times.

        The exact quaternion is stored as the sum of two doubles. Rounded to one double it would
        itself be off by as much as the smallest of the errors that are measured.
        """
        return float(_angles(np.asarray(orientation, dtype=float), *self._exact[t]))

    def errors(self, times: ArrayLike, orientations: ArrayLike) -> Real:
        """Return the errors (n,) in rad at any times (n,) in s, which are taken as exact.

        The exact motion comes from `TaylorMotion`. It is computed as far as is asked for, at a
        third of a second for a second of the article's top, and kept.
        """
        high, low = self._motion.at(np.asarray(times, dtype=float))
        return _angles(np.asarray(orientations, dtype=float), high, low)

    @cached_property
    def _motion(self) -> TaylorMotion:
        return TaylorMotion(self.task)

    def limit(self, t: float) -> float:
        """Return the limit in rad at one of the times; 0 if it is unknown."""
        return dict(zip(self.times, self.limits, strict=False)).get(t, 0.0)


@dataclass(frozen=True)
class Reference:
    """The reference motions that the package ships."""

    article: list[Problem]  # the article's seven motions, and its cusps with friction
    hard: list[Problem]  # the hard cases
    # motions with friction or an applied torque, in 14 families; the name is the family
    driven: list[Problem]

    @classmethod
    def read(cls) -> Reference:
        """Read the file that is shipped with the package."""
        data = json.loads(FILE.read_text(encoding="utf-8"))
        return cls(**{part: [_problem(each) for each in data[part]] for part in PARTS})


def _angles(orientations: Real, high: Real, low: Real) -> Real:
    """Return the errors (...) in rad of quaternions (..., 4); high + low is the exact one."""
    distances = [np.linalg.norm((sign * orientations - high) - low, axis=-1) for sign in (1, -1)]
    return np.asarray(2 * np.minimum(*distances))


def _problem(data: dict[str, Any]) -> Problem:
    start = State(data["orientation"], data["angular_velocity"])
    return Problem(
        data["name"],
        data.get("small"),
        Task(
            Top(data["Ix"], data["Iz"], data["Mgl"]),
            start,
            Friction(*data["friction"]),
            tuple(data.get("torque", NO_TORQUE)),
        ),
        tuple(data["t"]),
        tuple(2 * each for each in data["limit"] or ()),  # stored as distances of quaternions
        dict(zip(data["t"], map(_two_doubles, data["exact"]), strict=True)),
    )


def _two_doubles(decimals: list[str]) -> tuple[Real, Real]:
    """Return arrays whose sum is a list of decimals to about 32 digits."""
    high = [float(each) for each in decimals]
    low = [
        float(Decimal(each) - Decimal(double)) for each, double in zip(decimals, high, strict=True)
    ]
    return np.array(high), np.array(low)
