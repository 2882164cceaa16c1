"""The mean rates of a motion, in the world's own orientation."""

import math
from typing import NamedTuple, Protocol

from symtop_ros.physics.exact.kind import Kind


class Rates(NamedTuple):
    """Quantities that are the same in every nutation."""

    nutation_period: float  # s; infinite if theta does not return
    mean_precession_rate: float  # mean phi' in rad/s; nan if the axis meets the vertical
    mean_spin_rate: float  # mean psi' in rad/s; nan there as well
    precession_per_nutation: float  # in turns; nan there, and if theta does not return
    spin_reverses: bool  # True if psi' takes both signs


class Rated(Protocol):
    """A solved motion with Mgl >= 0."""

    @property
    def kind(self) -> Kind:
        """Name of the motion."""

    @property
    def nutation_period(self) -> float:
        """Period of theta in s."""

    @property
    def mean_rates(self) -> tuple[float, float]:
        """Mean phi' and psi' in rad/s."""

    @property
    def precession_per_nutation(self) -> float:
        """Turns of the precession in a nutation."""

    @property
    def spin_reverses(self) -> bool:
        """True if psi' takes both signs."""


def find_rates(motion: Rated, is_turned_over: bool) -> Rates:
    """Return the rates of a motion; in a world that is turned over the precession is reversed."""
    if motion.kind in ("sleeping", "through the pole"):
        precession = spin = turns = math.nan
    else:
        sign = -1 if is_turned_over else 1
        precession, spin = motion.mean_rates
        precession, turns = sign * precession, sign * motion.precession_per_nutation
    return Rates(motion.nutation_period, precession, spin, turns, motion.spin_reverses)
