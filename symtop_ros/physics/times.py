"""Exact times of a motion: integer nanoseconds of a clock, a factor, and an exact elapsed time.

A published sample belongs to an integer number of nanoseconds, so its exact time is known to the
last bit. As a double of seconds it would be rounded: after a day by 7 ps, in which a top of 200
rad/s turns by 7 million EPS. The integers are therefore kept until phases are reduced to one turn.
"""

from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from symtop_ros.base.arrays import Real
from symtop_ros.base.refusals import Words, refuse
from symtop_ros.physics.values import ignore_underflow, validate_number

SECOND = 10**9  # ns
LARGEST_STAMP = 2**63 - 1  # ns
SMALLEST, LARGEST_FACTOR = 1e-100, 1e100
ELAPSED_PARTS = 4  # of `symtop_clock`
LARGEST_ELAPSED = 10**300  # ns; so that the sum is a double of seconds


@dataclass(frozen=True, eq=False)
class ExactTimes:
    """Times of a motion that are exact: elapsed + factor * nanoseconds.

    Parameters
    ----------
    nanoseconds : int or ndarray (n,) of int64
        Nanoseconds of a clock since the elapsed time was read, of either sign.
    factor : float
        Time of the motion per time of the clock; 1e-100 to 1e100. The exact value of the double
        counts.
    elapsed : Fraction
        Time of the motion in ns at which `nanoseconds` is 0. Its denominator is a power of two, as
        in every sum of products of integers and doubles. `Motion.at` needs a time that is a sum of
        four doubles.

    Raises
    ------
    ValueError
        If an argument is refused.

    Examples
    --------
    >>> from fractions import Fraction
    >>> from symtop_ros.physics import ExactTimes, Motion, State, Top
    >>> times = ExactTimes(2_000_000_000, factor=0.5, elapsed=Fraction(1, 2))
    >>> times.seconds
    1.0000000005
    >>> top = Top(Ix=0.000228, Iz=0.0000572, Mgl=0.068)
    >>> motion = Motion(top, State.from_euler(theta=0.5, psi_dot=200.0))
    >>> year = 365 * 86_400 * 10**9
    >>> motion.at(ExactTimes(year + 1)) == motion.at(ExactTimes(year))
    False
    """

    nanoseconds: int | NDArray[np.int64]
    factor: float = 1.0
    elapsed: Fraction = Fraction(0)

    def __post_init__(self) -> None:
        object.__setattr__(self, "nanoseconds", _validate_nanoseconds(self.nanoseconds))
        object.__setattr__(self, "factor", validate_number("factor", self.factor))
        if not SMALLEST <= self.factor <= LARGEST_FACTOR:
            raise refuse("factor", f"{SMALLEST:g} to {LARGEST_FACTOR:g}", self.factor)
        object.__setattr__(self, "elapsed", _validate_elapsed(self.elapsed))

    @property
    def shape(self) -> tuple[int, ...]:
        """Shape of the times: () for one time, (n,) for an array."""
        return () if isinstance(self.nanoseconds, int) else self.nanoseconds.shape

    @cached_property
    def seconds(self) -> float | Real:
        """The nearest doubles in s, a float or (n,)."""
        ticks, parts = self.factor.as_integer_ratio()
        elapsed, pieces = self.elapsed.as_integer_ratio()
        start = elapsed * parts
        step = ticks * pieces
        divisor = parts * pieces * SECOND
        # Python's quotient of integers of any size is the nearest double.
        seconds = [(start + step * n) / divisor for n in np.ravel(self.nanoseconds).tolist()]
        return np.array(seconds) if self.shape else seconds[0]

    @cached_property
    def clock(self) -> tuple[float, tuple[float, ...]]:
        """The factor, and the elapsed time in ns as a sum of four doubles, for the kernel.

        Raises
        ------
        ValueError
            If four doubles are not enough, or if one is neither 0 nor 1e-100 to 1e100 in size.
        """
        parts: list[float] = []
        left = self.elapsed
        while left and len(parts) < ELAPSED_PARTS:
            part = left.numerator / left.denominator  # the nearest double
            if not SMALLEST <= abs(part) <= LARGEST_FACTOR:
                break
            parts.append(part)
            left -= Fraction(part)
        if left:
            raise refuse(
                "elapsed",
                "a sum of four doubles, each 0 or 1e-100 to 1e100 ns in size",
                Words(f"{float(self.elapsed):.17g}"),
            )
        return self.factor, (*parts, *[0.0] * (ELAPSED_PARTS - len(parts)))

    def advance(self, nanoseconds: int) -> Fraction:
        """Return the time of the motion in ns at another reading of the clock, exactly.

        Parameters
        ----------
        nanoseconds : int
            Nanoseconds of the clock since the elapsed time was read.

        Examples
        --------
        >>> from fractions import Fraction
        >>> from symtop_ros.physics import ExactTimes
        >>> ExactTimes(0, factor=0.25, elapsed=Fraction(3)).advance(5)
        Fraction(17, 4)
        """
        if not isinstance(nanoseconds, int | np.integer):
            raise refuse("nanoseconds", "one whole number (ns)", nanoseconds)
        return self.elapsed + Fraction(self.factor) * int(nanoseconds)

    @property
    @ignore_underflow
    def rough_seconds(self) -> Any:
        """Seconds, a float or (n,), up to a few roundings; much faster than `seconds`."""
        elapsed, pieces = self.elapsed.as_integer_ratio()
        return elapsed / (pieces * SECOND) + self.factor * (self.nanoseconds * 1e-9)

    def ravel(self) -> "ExactTimes":
        """Return the times as an array (n,); a single time as an array (1,)."""
        return ExactTimes(np.atleast_1d(self.nanoseconds), self.factor, self.elapsed)

    def __getitem__(self, part: slice | NDArray[np.bool_ | np.intp]) -> "ExactTimes":
        """Return a part of an array of times."""
        return ExactTimes(np.asarray(self.nanoseconds)[part], self.factor, self.elapsed)


def to_rough_seconds(times: Any) -> Any:
    """Return times in s up to a few roundings: those of exact times, others unchanged."""
    return times.rough_seconds if isinstance(times, ExactTimes) else times


def to_seconds(times: Any) -> Any:
    """Return times in s: the nearest doubles of exact times, others unchanged."""
    return times.seconds if isinstance(times, ExactTimes) else times


def _validate_nanoseconds(value: Any) -> int | NDArray[np.int64]:
    array = np.asarray(value)
    if array.dtype.kind in "iu":
        if array.ndim == 0 and abs(number := int(array)) <= LARGEST_STAMP:
            return number
        # NumPy 1 compares 64 bits without a sign and an int as doubles, in which 2^63 - 1 is 2^63
        if array.ndim == 1 and (
            array.dtype.kind == "i" or int(array.max(initial=0)) <= LARGEST_STAMP
        ):
            return array.astype(np.int64, copy=False)
    raise refuse("nanoseconds", "an int or an array (n,) of ints, of at most 63 bits (ns)", value)


def _validate_elapsed(value: Any) -> Fraction:
    condition = "a Fraction with a power of two as denominator (ns)"
    if not isinstance(value, Fraction | int) or isinstance(value, bool):
        raise refuse("elapsed", condition, value)
    ticks, pieces = value.as_integer_ratio()
    if pieces & (pieces - 1):
        raise refuse("elapsed", condition, value)
    if abs(ticks) > LARGEST_ELAPSED * pieces:  # no division: this is asked for every sample
        raise refuse("elapsed", "at most 1e300 ns in size", Words(f"{ticks:.3e}"))
    return value if isinstance(value, Fraction) else Fraction(value)
