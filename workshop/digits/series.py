"""The series of the reference in numbers of mpmath, without a proof."""

from fractions import Fraction

from mpmath import mp, mpf
from mpmath.libmp import MPZ

from symtop_ros.physics.reference import series
from workshop.digits.state import ExactState


class Series(series.Series):
    """A motion that is integrated up to the times of `at`, and kept."""

    integer = MPZ  # with gmpy2 GMP's, which multiplies in half of the time

    def at(self, t: float | Fraction) -> ExactState:
        """Return the state at t in s."""
        with mp.workprec(self.bits + 10):
            w, x, y, z, *rates = (mpf(each) / 2**self.bits for each in self.find(Fraction(t)))
            wx, wy, wz = (rate * mpf(self.second) for rate in rates)
            return ExactState((w, x, y, z), (wx, wy, wz))
