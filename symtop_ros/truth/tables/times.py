"""Times of rows, as exact as their text: whole units as integers, fractions as doubles.

A stamp of epoch seconds with nine decimals has more digits than a double.
"""

from array import array
from collections.abc import Sequence
from dataclasses import dataclass
from decimal import ROUND_FLOOR, Decimal
from functools import cached_property

import numpy as np

from symtop_ros.base.arrays import Mask, Places, Real, Stamps
from symtop_ros.base.refusals import plain
from symtop_ros.truth.tables.cells import Row, count_decimals
from symtop_ros.truth.tables.columns import SECONDS
from symtop_ros.truth.tables.iso import write_seconds

NS = 9  # decimals of a second
EXACT = 22  # the largest power of ten that is a double
LATEST = Decimal(2**62)  # units; a time beyond it is none of a run
EARLIEST = -LATEST


@dataclass(frozen=True, eq=False)
class Times:
    """Times of the rows of a table.

    Attributes
    ----------
    whole : ndarray of int64 (n,)
        Whole units.
    rest : ndarray (n,)
        Fractions of a unit, from 0 to 1.
    unit : str
        A name of `SECONDS`.
    decimals : int
        Most decimals of the text.
    """

    whole: Stamps
    rest: Real
    unit: str
    decimals: int

    def __len__(self) -> int:
        """Return the number of rows."""
        return len(self.whole)

    @cached_property
    def seconds(self) -> Real:
        """Times since the first row in s, (n,): the nearest doubles of their decimals."""
        if not len(self):
            return np.zeros(0)
        whole, power = self.whole - self.whole[0], SECONDS[self.unit]
        if (
            0 <= self.decimals <= EXACT - power
            and np.abs(whole).max() < 2.0**53 / 10**self.decimals
        ):
            # whole numbers below 2^53 over a power of ten that is a double: one rounding
            ticks = np.rint(self.rest * 10.0**self.decimals)
            since = whole * 10.0**self.decimals + (ticks - ticks[0])
            return np.asarray(since / 10.0 ** (self.decimals + power))
        return np.asarray((whole + (self.rest - self.rest[0])) / 10.0**power)

    @cached_property
    def stamps(self) -> tuple[int, ...]:
        """Times in ns, which may be beyond 64 bits if the unit is wrong."""
        decimals = NS - SECONDS[self.unit]
        factor = 10**decimals
        more = np.rint(self.rest * factor).astype(np.int64).tolist()
        return tuple(factor * a + b for a, b in zip(self.whole.tolist(), more, strict=True))

    @property
    def step(self) -> float:
        """Step of the last decimal in s."""
        return float(10.0 ** -(self.decimals + SECONDS[self.unit]))

    def select(self, rows: Mask | Places) -> "Times":
        """Return some rows."""
        return Times(self.whole[rows], self.rest[rows], self.unit, self.decimals)


class SplitStampError(ValueError):
    """A stamp that is not a whole number of ns."""


class TimeReader:
    """Reader of the times of rows; stamps in ns must be whole numbers."""

    def __init__(self, unit: str, *, is_stamp: bool) -> None:
        self._unit, self._decimals = unit, 0
        self._is_whole = is_stamp and unit == "ns"
        self._whole, self._rest = array("q"), array("d")

    def read(self, columns: Sequence[Row]) -> None:
        """Read the cells of the time, or of whole s and ns."""
        if len(columns) == 1:
            self._read_one(columns[0])
        else:
            seconds, nanoseconds = ([*map(int, map(plain, column))] for column in columns)
            if min(nanoseconds, default=0) < 0 or max(nanoseconds, default=0) >= 10**NS:
                raise ValueError("nanoseconds")
            self._whole.extend(seconds)
            self._rest.extend(each / 10**NS for each in nanoseconds)
            self._decimals = NS

    def _read_one(self, column: Row) -> None:
        column = [write_seconds(plain(cell.strip())).replace(",", ".") for cell in column]
        numbers = [*map(Decimal, column)]
        floors = [each.to_integral_value(ROUND_FLOOR) for each in numbers]
        if self._is_whole and numbers != floors:
            raise SplitStampError
        # before they are integers, of which 1e999999999 would fill the memory
        whole = [int(min(max(each, EARLIEST), LATEST)) for each in floors]
        self._decimals = max(self._decimals, count_decimals(column)[1])
        self._rest.extend([*map(float, map(Decimal.__sub__, numbers, floors))])
        self._whole.extend(whole)

    def make(self) -> Times:
        """Return the times; without a unit in s if they have decimals, else in ns."""
        whole = np.array(self._whole, dtype=np.int64)
        unit = self._unit or ("s" if self._decimals > 0 else "ns")
        return Times(whole, np.array(self._rest, dtype=float), unit, max(self._decimals, 0))
