"""Motions to 25 digits, computed by other means than the package's, and distances from them."""

from __future__ import annotations

import json
from dataclasses import dataclass
from decimal import Decimal
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from symtop_ros.physics import Friction, State, Top

FILE = Path(__file__).with_name("reference.json")
FRICTION = Friction(axial=2e-6, transverse=1e-5)  # of the article's top with friction
EPS = 2.0**-52
Real = NDArray[np.float64]


@dataclass(frozen=True)
class Problem:
    """A motion to compute, with what is right.

    Attributes
    ----------
    name : str
        The motion, or the family of a hard case.
    small : float or None
        How near a hard case is to the singular one.
    top, start, friction
        What is given; the numbers are taken as exact.
    times : tuple of float
        In s, at which the right states are known.
    limits : tuple of float
        What half an ulp of every input changes in the orientation at these times; empty under
        friction.
    """

    name: str
    small: float | None
    top: Top
    start: State
    friction: Friction
    times: tuple[float, ...]
    limits: tuple[float, ...]
    _exact: dict[float, tuple[Real, Real]]

    def error(self, t: float, orientation: Any) -> float:
        """Return the distance of a quaternion (w, x, y, z) from the right one, up to sign.

        The right one is the sum of two doubles, so that it is rounded far below the distance.
        """
        high, low = self._exact[t]
        q = np.asarray(orientation, dtype=float)
        distances = (np.linalg.norm((sign * q - high) - low) for sign in (1, -1))
        return float(min(distances))

    def limit(self, t: float) -> float:
        """Return the limit of double precision at one of the times; 0 where it is unknown."""
        return dict(zip(self.times, self.limits, strict=False)).get(t, 0.0)


@dataclass(frozen=True)
class Reference:
    """The article's seven motions and its cusps with friction, and the hard cases."""

    article: list[Problem]
    hard: list[Problem]

    @classmethod
    def read(cls) -> Reference:
        """Return what is shipped with the package."""
        data = json.loads(FILE.read_text(encoding="utf-8"))
        return cls(*([_problem(each) for each in data[part]] for part in ("article", "hard")))


def _problem(data: dict[str, Any]) -> Problem:
    return Problem(
        data["name"],
        data.get("small"),
        Top(data["Ix"], data["Iz"], data["Mgl"]),
        State(data["orientation"], data["angular_velocity"]),
        Friction(*data["friction"]),
        tuple(data["t"]),
        tuple(data["limit"] or ()),
        dict(zip(data["t"], map(_two_doubles, data["exact"]), strict=True)),
    )


def _two_doubles(decimals: list[str]) -> tuple[Real, Real]:
    high = [float(each) for each in decimals]
    low = [
        float(Decimal(each) - Decimal(double)) for each, double in zip(decimals, high, strict=True)
    ]
    return np.array(high), np.array(low)
