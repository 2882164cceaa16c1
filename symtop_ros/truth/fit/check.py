"""The test of the model: white residuals without lines, and the same constants in both halves."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from symtop_ros.base.arrays import Real
from symtop_ros.truth.fit.aliases import RATES
from symtop_ros.truth.fit.lines import list_lines
from symtop_ros.truth.fit.refine import Fit, find_rounding
from symtop_ros.truth.residuals.correlation import measure_correlation
from symtop_ros.truth.residuals.lines import Line

# The constants of two halves differ by more than five deviations once in two million records; noise
# that wanders makes deviations of halves uncertain, which the sandwich of a half allows for.
CHANGED = 5.0
# Residuals of a wrong model swing with the motion: their size exceeds that of their steps from row
# to row by more than this factor. Noise with a correlation of 0.9 from row to row reaches 3.2.
SMOOTH = 4.0
# The same factor for one column, such as a spin that falls while the rates across the axis
# oscillate. Noise with a correlation of 0.99 reaches 10.
SMOOTH_COLUMN = 12.0
# Of rows that are outliers by chance, 5 % of all, eight follow each other once in 4e10 rows.
STRETCH = 8
ABOVE = 10.0  # deviations of rounding: noise that would change a number's last decimal
HOLDS, UNCLEAR, FAILS = "holds", "unclear", "fails"
CONSTANTS = ("Mgl/Ix", "p_psi/Ix", "Iz/Ix", "spin")


@dataclass(frozen=True)
class Change:
    """A constant that differs between the halves of a record."""

    name: str
    first: float
    second: float
    deviations: float


@dataclass(frozen=True, eq=False)
class Check:
    """The model of a fit, tested."""

    fit: Fit

    @cached_property
    def is_white(self) -> bool:
        """True if the whitened residuals are white noise."""
        return self.fit.remainder.is_white

    @cached_property
    def correlation(self) -> float:
        """Sum of squares of the first ten correlations; 30 at most for white noise, as a rule."""
        return measure_correlation(self.fit.white)

    @cached_property
    def smoothness(self) -> float:
        """Size of the residuals divided by that of white noise with the same steps between rows."""
        squares, steps = self._squares
        return float(np.sqrt(squares.mean() / max(steps.mean(), 1e-300)))

    @cached_property
    def _squares(self) -> tuple[Real, Real]:
        """Mean squares (r,) of the residuals, and of white noise with the same steps.

        A rate that is constant, and rounded, has a residual without steps, which is no motion.
        """
        rows = self.fit.residuals[self.fit.noise.kept] / self.fit.noise.sigma
        steps = (np.diff(rows, axis=0) ** 2).mean(axis=0) / 2
        rounding, _ = find_rounding(self.fit.model.record, rows.shape[1])
        return (rows**2).mean(axis=0), np.maximum(steps, (rounding / self.fit.noise.sigma) ** 2)

    @cached_property
    def is_smooth(self) -> bool:
        """True if the residuals, or a column of them, change slowly, as a missed motion would."""
        squares, steps = self._squares
        columns = np.sqrt(squares / np.maximum(steps, 1e-300))
        return bool(self.smoothness > SMOOTH or columns.max() > SMOOTH_COLUMN)

    @cached_property
    def lines(self) -> tuple[Line, ...]:
        """Lines in the residuals; those with a name are at frequencies of the motion."""
        return list_lines(self.fit)

    @property
    def swings(self) -> bool:
        """True if the residuals have a line at a frequency of the motion."""
        return any(line.name for line in self.lines)

    @cached_property
    def changes(self) -> tuple[Change, ...]:
        """Constants that are not the same in both halves."""
        first, second = (find_half(self.fit, late) for late in (False, True))
        return tuple(
            change
            for name in CONSTANTS
            if name in self.fit.model.place
            and (change := self._compare(name, first, second)).deviations > CHANGED
        )

    def _compare(self, name: str, first: "Half", second: "Half") -> Change:
        place = self.fit.model.place[name]
        both = np.hypot(first.deviations[place], second.deviations[place])
        a, b = first.x[place], second.x[place]
        return Change(name, float(a), float(b), float(abs(a - b) / max(both, 1e-300)))

    @cached_property
    def stretch(self) -> int:
        """Most outliers that follow each other; 0 if they are too few to mean anything."""
        kept = np.flatnonzero(np.concatenate([[True], self.fit.noise.kept, [True]]))
        longest = int(np.diff(kept).max()) - 1
        return longest if longest >= STRETCH else 0

    @cached_property
    def still(self) -> tuple[int, ...]:
        """Rates that are the same in all rows although the noise of others is far above rounding.

        A sensor at an unknown limit outputs the same rate in all rows; a spin with noise does not.
        """
        record = self.fit.model.record
        if record.kind.name not in RATES:
            return ()
        values, noise = (
            record.values[:, :3],
            self.fit.residuals[self.fit.noise.kept, :3].std(axis=0),
        )
        rounding, _ = find_rounding(record, self.fit.residuals.shape[1])
        is_still = (np.ptp(values, axis=0) == 0) & (rounding[:3] < noise.max() / ABOVE)
        return tuple(map(int, np.flatnonzero(is_still)))

    @property
    def fault(self) -> str:
        """Why there are no honest deviations: "few", "wanders" or ""."""
        return self.fit.remainder.find_fault(1)

    @property
    def verdict(self) -> str:
        """HOLDS, UNCLEAR (noise that wanders, a stretch left out, a lone search) or FAILS."""
        return FAILS if self.swings else self.of_noise

    @property
    def of_noise(self) -> str:
        """The verdict without the test for lines, which the right motion may leave, too."""
        if self.changes or (not self.is_white and self.is_smooth):
            return FAILS
        return HOLDS if self.is_noise and not self.fit.is_lone else UNCLEAR

    @property
    def is_noise(self) -> bool:
        """True if the residuals are noise, and at most single rows were left out."""
        is_odd = self.is_smooth or self.fault or self.stretch or self.still
        return self.is_white and not is_odd


@dataclass(frozen=True, eq=False)
class Half:
    """Parameters (p,) from one half of a record, by one Gauss-Newton step, with deviations."""

    x: Real
    deviations: Real


def find_half(fit: Fit, late: bool) -> Half:
    """Return the parameters that one half of the record shows."""
    middle = len(fit.white) // 2
    rows = slice(middle, None) if late else slice(middle)
    columns, white = fit.columns[rows] / fit.sizes, fit.white[rows]
    normal = np.einsum("tij,tik->jk", columns, columns) + np.diag(fit.priors / fit.sizes**2)
    values, vectors = np.linalg.eigh(normal)
    inverse = (vectors / np.maximum(values, 1e-12 * values[-1])) @ vectors.T
    influences = np.einsum("tij,ti->tj", columns, white) @ inverse / fit.sizes
    # noise that is not white after all makes sums larger than those of independent numbers
    excess = max(fit.remainder.independent, 1.0)
    wider = np.sqrt(len(fit.white) / excess)
    deviations = wider * np.sqrt(np.diag(inverse)) / fit.sizes
    return Half(fit.x - influences.sum(axis=0), deviations)
