"""Phases that grow at constant rates, reduced to one turn without error.

Phases are reduced to one turn in integers of 64 bits, a turn being 2^64. Their products wrap round
after whole turns, which is the reduction itself: it is exact however many turns there are, while
the product rate * t in doubles would have an error of EPS times the whole phase
(design/phases.py).
"""

import math
from decimal import Decimal, localcontext
from fractions import Fraction
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from symtop_ros.arrays import Real
from symtop_ros.physics.exact.elementary import Number, Pair, round_to_integer
from symtop_ros.physics.exact.precise import (
    PRECISE,
    TWO,
    TWO_PI,
    TWO_PI_HIGH,
    TWO_PI_LOW,
    compute_cosine,
    split,
)
from symtop_ros.physics.times import SECOND, ExactTimes
from symtop_ros.physics.values import refuse

PER_TURN = Decimal("0.159154943091895335768883763372514362034459645740456")  # 1/(2 pi)

# A turn in the integers of the set-up. They have digits to spare: 192 bits go before a phase of
# 64 bits is left, and 128 of them before a count of 64 bits has been multiplied.
TURN_BITS = 256
TURN = Decimal(2**TURN_BITS)
# The fastest phase grows by 2^-11 to 2^-10 of a turn in a tick. So a count of ticks in 63 bits
# reaches 4e15 turns, and the rest of a tick is small enough for a product in doubles.
TICK_BITS = 10
COUNT_BITS = 62
# From 2^48 times as many turns on, about 1e30, 50 digits of a rate are too few. The phase would
# lose its digits then, one after the other.
LATEST = 2.0**48
LOW_HALF = 2**32 - 1
# 2 pi in two parts. The product of a phase of 27 bits and the first part of 26 bits is exact.
COARSE_BITS = 37  # low bits of a phase that the coarse part leaves out
FINE = 2**COARSE_BITS - 1
# The table of cosines and sines, in parts of a turn.
ENTRIES = 512
ENTRY_BITS = 64 - 9
HALF_ENTRY = 2 ** (ENTRY_BITS - 1)
FINENESS = 2.0**-27  # unit of the coarse part, in turns

Limbs = tuple[int, int, int]


class Phases:
    """Several phases that grow at constant rates, at times in s or at exact times."""

    def __init__(self, *rates: Decimal) -> None:
        turns = [rate * PER_TURN for rate in rates]  # per s
        fastest = float(max(map(abs, turns)))
        exponent = math.frexp(fastest)[1] + TICK_BITS if fastest else 0
        exponent = min(max(exponent, -1000), 1000)
        tick = TURN / TWO**exponent  # 2^256 s per tick
        self._exponent, self._steps = exponent, [int(each * tick) for each in turns]
        self._scaled: tuple[tuple[float, Fraction] | None, list[tuple[Limbs, int]]] = None, []
        self._ticks = 2.0**self._exponent  # per s
        self._limbs = [_split_step(step) for step in self._steps]
        self._rest_rates = [2 * math.pi * (step / 2**TURN_BITS) for step in self._steps]
        self.farthest = math.ldexp(1.0, min(COUNT_BITS - self._exponent, 1023))
        self._latest = self.farthest * LATEST if any(self._steps) else math.inf

    def at(self, times: Number | ExactTimes) -> list["Phase"]:
        """Return the phases at times in s, or at exact times."""
        if isinstance(times, ExactTimes):
            return self._at_exact(times)
        if isinstance(times, np.ndarray):
            far = np.abs(times) >= self.farthest
            if far.any():
                return self._at_far(times, far)
        elif abs(times) >= self.farthest:
            return self._at_far_time(times)
        ticks = times * self._ticks
        counts = round_to_integer(ticks)
        rest = ticks - counts
        factors = _Counts(
            counts.astype(np.int64) if isinstance(counts, np.ndarray) else int(counts)
        )
        return [
            Phase(factors.multiply(limbs), rate * rest)
            for limbs, rate in zip(self._limbs, self._rest_rates, strict=True)
        ]

    def _refuse_late(self, seconds: Number) -> None:
        """Refuse times at which no digit of a phase can be promised."""
        latest = float(np.max(np.abs(seconds), initial=0.0))
        if latest > self._latest:
            raise refuse("t", f"within {self._latest:.2g} s of the start (1e30 turns)", latest)

    def _at_exact(self, times: ExactTimes) -> list["Phase"]:
        self._refuse_late(times.rough_seconds)
        counts = _Counts(times.nanoseconds)
        return [
            Phase(_wrap(counts.multiply(limbs) + start))
            for limbs, start in self._scale_steps(times.factor, times.elapsed)
        ]

    def _scale_steps(self, factor: float, elapsed: Fraction) -> list[tuple[Limbs, int]]:
        """Return the steps in a nanosecond of the clock, and the phases at its zero."""
        known, scaled = self._scaled
        if known == (factor, elapsed):  # as for all samples between two changes of a run
            return scaled
        ticks, seconds = factor.as_integer_ratio()
        start, parts = elapsed.as_integer_ratio()
        scaled = [
            (
                _split_step(self._scale(step * ticks, seconds * SECOND)),
                _wrap_turns(self._scale(step * start, parts * SECOND)),
            )
            for step in self._steps
        ]
        self._scaled = (factor, elapsed), scaled
        return scaled

    def _scale(self, turns_by_tick: int, seconds: int) -> int:
        """Return turns_by_tick/seconds with seconds counted in ticks."""
        shift = self._exponent
        if shift >= 0:
            return (turns_by_tick << shift) // seconds
        return turns_by_tick // (seconds << -shift)

    def _at_far(self, times: Real, far: NDArray[np.bool_]) -> list["Phase"]:
        """Return the phases at times of which some are too long for a count of ticks."""
        self._refuse_late(times)
        phases = self.at(np.where(far, 0.0, times))
        for n in np.flatnonzero(far).tolist():
            for phase, own in zip(phases, self._at_far_time(float(times[n])), strict=True):
                phase.turns[n] = own.turns
        return phases

    def _at_far_time(self, time: float) -> list["Phase"]:
        self._refuse_late(time)
        elapsed, parts = time.as_integer_ratio()
        turns = [self._scale(step * elapsed, parts) for step in self._steps]
        return [Phase(_wrap_turns(each)) for each in turns]


def _wrap_turns(turns: int) -> int:
    """Return turns of 256 bits in units of 2^-64 turns, as an integer of 64 bits with sign."""
    return int(_wrap(turns >> (TURN_BITS - 64)))


def _wrap(turns: Any) -> Any:
    """Return integers modulo 2^64, from -2^63 up; arrays wrap round by themselves."""
    return turns if isinstance(turns, np.ndarray) else (turns + 2**63) % 2**64 - 2**63


def _split_step(step: int) -> Limbs:
    """Return 128 bits of a fraction of a turn: the first 64, and twice 32 more."""
    fraction = step >> (TURN_BITS - 128)
    return (fraction >> 64) % 2**64, (fraction >> 32) % 2**32, fraction % 2**32


class _Counts:
    """Counts of ticks, an int or (n,) of int64, to be multiplied by steps of 128 bits."""

    def __init__(self, counts: Any) -> None:
        self._sign: Any
        if isinstance(counts, np.ndarray):
            # Two extremes take less time than signs and sizes, which most counts do not need.
            least, largest = int(counts.min(initial=0)), int(counts.max(initial=0))
            self._sign = np.sign(counts) if least < 0 else 1
            self._sizes = (np.abs(counts) if least < 0 else counts).view(np.uint64)
            self._is_short = max(largest, -least) <= LOW_HALF
        else:
            self._sign, self._sizes = (1 if counts >= 0 else -1), abs(counts)
            self._is_short = bool(self._sizes <= LOW_HALF)
        if not self._is_short:
            self._above, self._below = self._sizes >> 32, self._sizes & LOW_HALF

    def multiply(self, limbs: Limbs) -> Any:
        """Return counts times a step, in units of 2^-64 turns.

        Of the products of 32 bits only what reaches the first 64 bits is added. The carries left
        out are at most 3 units, 2^-62 of a turn.
        """
        whole, upper, lower = limbs
        turns = self._sizes * whole
        if self._is_short:
            turns += (self._sizes * upper) >> 32
        else:
            turns += self._above * upper
            turns += (self._above * lower) >> 32
            turns += (self._below * upper) >> 32
        if isinstance(turns, np.ndarray):
            turns = turns.view(np.int64)
            return turns * self._sign if isinstance(self._sign, np.ndarray) else turns
        return _wrap(turns * self._sign)


class Phase(NamedTuple):
    """A phase modulo whole turns, at one time or at many."""

    turns: Any  # in units of 2^-64 turns
    # to be added, in rad; at most 2^-11 of a turn. So the phase of a short time keeps its
    # digits
    rest: Any = 0.0

    @property
    def radians(self) -> Pair:
        """The phase in rad, between -pi and pi up to the rest, as a sum of two doubles."""
        units = self.turns >> COARSE_BITS
        small = (self.turns & FINE) * (2 * math.pi * 2.0**-64)
        units = units * FINENESS
        coarse = units * TWO_PI_HIGH  # exact
        small += units * TWO_PI_LOW
        small += self.rest
        high = coarse + small
        return high, (coarse - high) + small

    @property
    def unit(self) -> Pair:
        """Cosine and sine of the phase, right to 0.6 EPS of 1.

        The nearest entry of a table is turned by what remains, less than 0.01 rad. That takes half
        the time of NumPy's functions, and the result does not depend on which of their variants
        the processor has.
        """
        shifted = self.turns + HALF_ENTRY
        entry = (shifted >> ENTRY_BITS) & (ENTRIES - 1)
        angle = ((shifted & (2 * HALF_ENTRY - 1)) - HALF_ENTRY) * (2 * math.pi * 2.0**-64)
        angle += self.rest
        square = angle * angle
        # The terms left out are below 1e-18.
        sine = angle + angle * (square * (square * (1 / 120) - 1 / 6))
        versine = square * (0.5 - square * (1 / 24 - square * (1 / 720)))
        is_array = isinstance(entry, np.ndarray)
        c, s, c_rest, s_rest = (
            (column.take(entry) for column in COLUMNS) if is_array else ROWS[entry]
        )
        return c + (c_rest - (c * versine + s * sine)), s + (s_rest + (c * sine - s * versine))


def _list_entries() -> list[tuple[float, float, float, float]]:
    """Return cosine and sine of whole parts of a turn, and what their rounding left.

    A quarter is computed, and the rest is its mirror image, so that zeros are exact.
    """
    step = TWO_PI / ENTRIES
    quarter = [split(compute_cosine(n * step)) for n in range(ENTRIES // 4)] + [(0.0, 0.0)]
    half = quarter + [(-high, 0.0 - low) for high, low in quarter[-2::-1]]
    cosines = half + half[-2:0:-1]
    sines = cosines[-(ENTRIES // 4) :] + cosines[: -(ENTRIES // 4)]
    return [
        (cosine, sine, rest, other_rest)
        for (cosine, rest), (sine, other_rest) in zip(cosines, sines, strict=True)
    ]


with localcontext(PRECISE):
    ROWS = _list_entries()
COLUMNS = tuple(np.array(column) for column in zip(*ROWS, strict=True))
