"""Which way a top goes when it is let go with theta' = 0: asked three times."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from symtop_ros.physics import State, Top, motion
from symtop_ros.physics.perry import Direction
from symtop_ros.report.article.equations import theta_acceleration

SHORT = 0.02  # of a nutation
ROUNDING = 1e-12  # rad, or of the largest acceleration that any term of the equation makes


@dataclass(frozen=True, slots=True)
class Departure:
    """What theta does from a start with theta' = 0.

    Attributes
    ----------
    acceleration : float
        theta'' at the start in rad/s^2, by the article's equation.
    rounding : float
        What rounding may make of an acceleration that is none, rad/s^2.
    after : float
        A short time in s, a fiftieth of a nutation.
    moved : float
        Change of theta in that time in rad, by the motion.
    turning : (float, float)
        Smallest and largest theta less that of the start, in rad.
    """

    acceleration: float
    rounding: float
    after: float
    moved: float
    turning: tuple[float, float]

    @classmethod
    def of(cls, top: Top, start: State) -> Departure:
        """Return what follows from one state."""
        path, theta, rates = motion(top, start), start.euler_angles.theta, start.euler_rates
        after = SHORT * path.nutation_period
        low, high = path.turning_angles
        terms = abs(top.Iz * rates.phi * rates.psi) + abs(top.Mgl)
        return cls(
            acceleration=float(theta_acceleration(top, theta, rates.phi, rates.psi)),
            rounding=ROUNDING * float(np.sin(theta)) / top.Ix * terms,
            after=after,
            moved=float(path.at(after).euler_angles.theta) - theta,
            turning=(low - theta, high - theta),
        )

    @property
    def directions(self) -> tuple[Direction, Direction, Direction]:
        """Which way it goes by the equation, by the motion and by the turning angles."""
        low, high = self.turning
        farther = low if abs(low) > abs(high) else high
        return (
            _direction(self.acceleration, self.rounding),
            _direction(self.moved, ROUNDING),
            _direction(farther, ROUNDING),
        )

    def __str__(self) -> str:
        """Return the three answers with their numbers."""
        low, high = self.turning
        return (
            f"theta'' = {self.acceleration:.3g} rad/s^2 by the equation; theta changes by "
            f"{self.moved:.3g} rad in {self.after * 1e3:.1f} ms, and altogether from {low:+.3g} "
            f"to {high:+.3g} rad"
        )


def _direction(change: float, rounding: float) -> Direction:
    """The axis rises where theta sinks."""
    if abs(change) <= rounding:
        return "stays"
    return "rises" if change < 0 else "falls"
