"""Motions to more than 20 digits, computed by other means than the package's, and errors.

The error of an attitude is the angle of the rotation that would correct it, in rad: for small
errors 2 |q - q_exact|, with the sign of q that makes it smaller.
"""

import json
import lzma
from collections.abc import Iterable
from dataclasses import dataclass
from functools import cache, cached_property
from pathlib import Path
from typing import Any

import numpy as np
from mpmath import mp
from numpy.typing import ArrayLike

from symtop_ros.base.arrays import Real
from symtop_ros.physics import Friction, Motion, State, Top
from symtop_ros.physics.arguments import NO_TORQUE
from symtop_ros.physics.reference.series import Inputs
from symtop_ros.truth.testset.score import measure_angles, read_problems, split_decimals
from workshop.digits import Series
from workshop.speed.peers.peer import initial_values

FILE = Path(__file__).with_name("reference.json.xz")
FRICTION = Friction(axial=2e-6, transverse=1e-5)  # of the article's top with friction, N m s
EPS = 2.0**-52
DIGITS = 32  # of an integration
PARTS = "article", "hard", "driven"


def integrate(task: Motion) -> Series:
    """Return the motion of a task by Taylor series, to more than 20 digits."""
    friction = task.friction.axial, task.friction.transverse
    *q, wx, wy, wz = initial_values(task)
    inputs = Inputs.exact(*task.top.moments, q, (wx, wy, wz))
    return Series(inputs, DIGITS, friction, task.applied_torque)


def split_orientations(series: Series, times: Iterable[float]) -> tuple[Real, Real]:
    """Return orientations (n, 4) at times in s as sums of two doubles, high and low."""
    with mp.workdps(DIGITS):
        exact = [series.at(t).orientation for t in times]
        high = [[float(each) for each in q] for q in exact]
        pairs = (zip(q, doubles, strict=True) for q, doubles in zip(exact, high, strict=True))
        low = [[float(each - double) for each, double in pair] for pair in pairs]
        return np.array(high), np.array(low)


@dataclass(frozen=True, eq=False)
class ReferenceMotion:
    """A motion to compute, and its exact orientations."""

    name: str  # the motion, the family of a hard case, or the problem of the test set
    task: Motion  # its numbers are taken as exact
    # times in s, up to very long ones, at which the exact orientations are stored
    times: tuple[float, ...]
    # Exact quaternions as sums of two doubles, each (n, 4). Rounded to one double they would
    # themselves be off by as much as the smallest of the errors that are measured.
    exact: tuple[Real, Real]
    # change of the attitude in rad at these times if every input changes by half an ulp;
    # empty under friction
    limits: tuple[float, ...]
    small: float | None = None  # distance of a hard case from the singular one
    level: int = 0  # of a problem of the test set

    @classmethod
    def read(cls, facts: dict[str, Any]) -> "ReferenceMotion":
        """Return the motion of an entry in reference.json."""
        # stored as distances of quaternions
        limits = tuple(2 * each for each in facts["limit"] or ())
        task = _read_task(facts)
        exact = split_decimals(facts["exact"])
        return cls(facts["name"], task, tuple(facts["t"]), exact, limits, facts.get("small"))

    def error(self, t: float, orientation: ArrayLike) -> float:
        """Return the error in rad at one of the stored times."""
        high, low = (part[self.times.index(t)] for part in self.exact)
        return float(measure_angles(np.asarray(orientation, dtype=float), high, low))

    def errors(self, times: ArrayLike, orientations: ArrayLike) -> Real:
        """Return the errors (n,) in rad at any times (n,) in s, which are taken as exact.

        The exact motion comes from a Taylor series. It is computed as far as is asked for, at a
        third of a second for a second of the article's top, and kept, as are its states: at most
        settings of a peer the times are the same.
        """
        asked = np.asarray(times, dtype=float)
        if (key := asked.tobytes()) not in self._known:
            self._known[key] = split_orientations(self._motion, asked.tolist())
        return measure_angles(np.asarray(orientations, dtype=float), *self._known[key])

    @cached_property
    def _motion(self) -> Series:
        return integrate(self.task)

    @cached_property
    def _known(self) -> dict[bytes, tuple[Real, Real]]:
        return {}

    def limit(self, t: float) -> float:
        """Return the limit in rad at one of the times; 0 if it is unknown."""
        return dict(zip(self.times, self.limits, strict=False)).get(t, 0.0)


@dataclass(frozen=True)
class Reference:
    """The reference motions of the report."""

    # the article's seven motions, two next to a pole, and its cusps with friction
    article: list[ReferenceMotion]
    hard: list[ReferenceMotion]  # the hard cases
    # motions with friction or an applied torque, in 14 families; the name is the family
    driven: list[ReferenceMotion]

    @classmethod
    @cache
    def read(cls) -> "Reference":
        """Return what the file of the reference has; it is read once."""
        data = read_entries()
        return cls(**{part: [ReferenceMotion.read(each) for each in data[part]] for part in PARTS})


def read_entries() -> dict[str, list[dict[str, Any]]]:
    """Return the entries of reference.json by its parts."""
    entries: dict[str, list[dict[str, Any]]] = json.loads(lzma.decompress(FILE.read_bytes()))
    return entries


def read_testset() -> list[ReferenceMotion]:
    """Return the problems of the test set, in their order."""
    return [
        ReferenceMotion(
            each.facts["name"],
            _read_task(each.facts),
            tuple(each.facts["times"]),
            split_decimals(each.facts["orientations"]),
            tuple(each.facts["orientation_limits"]),
            level=each.facts["level"],
        )
        for each in read_problems().values()
    ]


def _read_task(facts: dict[str, Any]) -> Motion:
    top = Top(facts["Ix"], facts["Iz"], facts["Mgl"])
    drive = Friction(*facts.get("friction", ())), facts.get("torque", NO_TORQUE)
    return Motion(top, State(facts["orientation"], facts["angular_velocity"]), *drive)
