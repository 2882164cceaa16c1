"""The plan of a measurement: what it will determine, with how many rows, and from which start.

No unbiased estimate has a smaller deviation than that of Cramer and Rao, the inverse of Fisher's
matrix of an exact record. A fit reaches it if the valley of motions that fit as well is straight.
"""

import math
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from symtop_ros.base.arrays import Real
from symtop_ros.physics import Motion, State, regular_precession_rates
from symtop_ros.truth.fit.across import Across
from symtop_ros.truth.fit.model import Model, find_momentum, name_parameters
from symtop_ros.truth.fit.record import FEWEST, Record
from symtop_ros.truth.fit.refine import Fit, find_sizes, find_spectrum
from symtop_ros.truth.fit.starts import fill
from symtop_ros.truth.fit.valley import Valley
from symtop_ros.truth.fit.values import find_slope, list_quantities
from symtop_ros.truth.residuals.whitening import Noise

PRECISE = 0.01  # relative deviation that is asked for
LONGEST = 20_000  # rows that are tried
STEPS = 8  # 1/8 of the rows is added as long as a deviation is not reliable
OFF = (0.1, 1.0)  # rad/s; phi' of starts that are off a regular precession


class Planned(Fit):
    """A motion that will be fitted: zero residuals, and Cramer-Rao bounds as deviations."""

    def find_deviation(self, slope: Real) -> float:
        """Return the deviation of a combination (p,)."""
        return find_bound(self.columns, self.priors, slope)


def find_bound(columns: Real, priors: Real, slope: Real) -> float:
    """Return the deviation of a combination (p,) by whitened derivatives (n, r, p)."""
    sizes = find_sizes(columns, priors)
    values, vectors = find_spectrum(columns, priors, sizes)
    return float(np.sqrt((((slope / sizes) @ vectors) ** 2 / values).sum()))


@dataclass(frozen=True)
class Start:
    """A start of the same top, tilt and psi', and the deviation of p_psi/Ix that it leads to."""

    kind: str  # "given", "rest", "off" (above a regular precession), "back" (against it)
    phi_dot: float
    theta_dot: float
    off: float  # rad/s, from the regular precession
    deviation: float
    is_straight: bool  # False: the deviation is not to be trusted


@dataclass(frozen=True, eq=False)
class Plan:
    """The plan of a measurement.

    Attributes
    ----------
    motion : Motion
    record : Record
        Its times and its kind, and what is known; its values are ignored.
    noise : ndarray (r,)
        Deviations of the noise of each residual, which is white.
    camera : mapping
        For `pixels` the camera, by the names of `camera.CAMERA`.
    limits : ndarray (m,) or float
        Largest size of the values of each column that the sensor shows; rows beyond it show
        nothing.

    Examples
    --------
    >>> import numpy as np
    >>> from symtop_ros.physics import Motion, State, Top
    >>> from symtop_ros.truth.fit.kinds import KINDS
    >>> from symtop_ros.truth.fit.plan import Plan
    >>> from symtop_ros.truth.fit.record import Record
    >>> motion = Motion(Top(1.0, 0.25, 300.0), State.from_euler(theta=0.5, psi_dot=200.0))
    >>> record = Record(np.arange(360) / 120, np.zeros((360, 3)), KINDS["axis"])
    >>> plan = Plan(motion, record, np.full(3, 0.005), {})
    >>> plan.best.kind, plan.starts[-1].kind, plan.starts[-1].off
    ('back', 'off', 0.1)
    >>> needed = plan.count_rows("Mgl/Ix")
    >>> needed is not None and needed < 50
    True
    """

    motion: Motion
    record: Record
    noise: Real
    camera: Mapping[str, float]
    limits: Real | float = math.inf

    @cached_property
    def fit(self) -> Planned:
        """The motion with the planned record."""
        return self.expect(self.motion, self.record)

    def expect(self, motion: Motion, record: Record) -> Planned:
        """Return a motion with the exact record of it."""
        model = Model(record, np.asarray(motion.start.orientation))
        if model.lacks_ratio:  # the motion with Iz = Ix that shows the same
            motion = Across.of(motion).find_motion(1.0)
            model = Model(record, np.asarray(motion.start.orientation))
        x = fill(model, {**name_parameters(motion), **self.camera})
        exact = replace(record, values=model.show(x[np.newaxis])[0])
        noise = Noise(
            kept=np.asarray((np.abs(exact.values) <= self.limits).all(axis=1)),
            before=np.zeros(len(record), dtype=int),
            sigma=self.noise,
            partial=np.zeros((0, len(self.noise))),
            outliers=0,
        )
        return Planned(model.move(exact), x, noise)

    @cached_property
    def _longest(self) -> Planned:
        """The motion with a long record at the same rate."""
        times = np.asarray(np.arange(LONGEST) * self.record.step, dtype=float)
        return self.expect(self.motion, replace(self.record, times=times))

    def count_rows(self, name: str) -> int | None:
        """Return the number of rows for a reliable relative deviation of PRECISE.

        None: it takes more than LONGEST rows.
        """
        fit, of = self._longest, dict(list_quantities(self._longest))[name]
        slope, most = find_slope(fit, of), PRECISE * abs(of(fit.x))
        shown = np.cumsum(fit.noise.kept)

        def reaches(rows: int) -> bool:
            return find_bound(fit.columns[: shown[rows - 1]], fit.priors, slope) <= most

        if not reaches(LONGEST):
            return None
        rows = bisect(reaches, FEWEST, LONGEST)
        while rows < LONGEST and not self._holds(rows, slope, of):
            rows = min(rows + max(rows // STEPS, 1), LONGEST)
        return rows

    def _holds(self, rows: int, slope: Real, of: Callable[[Real], float]) -> bool:
        """Return True if a deviation is reliable for a number of rows."""
        times = self._longest.model.record.times[:rows]
        short = self.expect(self.motion, replace(self.record, times=times))
        return Valley(short).is_straight(slope, of)

    @cached_property
    def starts(self) -> list[Start]:
        """Starts of the same top, the best first; empty if no start determines p_psi."""
        if self.fit.model.lacks_ratio:
            return []
        found = [self._try(*each) for each in self._list_starts()]
        return sorted(found, key=lambda each: (not each.is_straight, each.deviation))

    @property
    def best(self) -> Start:
        """The start from which p_psi is determined best."""
        return self.starts[0]

    def _list_starts(self) -> Iterator[tuple[str, float, float, float]]:
        """Yield kinds of starts, with phi', theta', and how far phi' is off."""
        angles, rates = self.motion.start.euler_angles, self.motion.start.euler_rates
        if rates.phi_dot or rates.theta_dot:
            yield "given", float(rates.phi_dot), float(rates.theta_dot), 0.0
        yield "rest", 0.0, 0.0, 0.0
        slow, _ = regular_precession_rates(self.motion.top, angles.theta, rates.psi_dot)
        if not math.isnan(slow):
            yield from (("off", slow + off, 0.0, off) for off in OFF)
            yield "back", -slow, 0.0, -2 * slow

    def _try(self, kind: str, phi_dot: float, theta_dot: float, off: float) -> Start:
        angles, rates = self.motion.start.euler_angles, self.motion.start.euler_rates
        new = State.from_euler(
            theta=float(angles.theta),
            phi=float(angles.phi),
            psi_dot=float(rates.psi_dot),
            phi_dot=phi_dot,
            theta_dot=theta_dot,
        )
        fit = self.expect(Motion(self.motion.top, new, self.motion.friction), self.record)

        def of(x: Real) -> float:
            return find_momentum(fit.model, x)

        slope = find_slope(fit, of)
        straight = Valley(fit).is_straight(slope, of)
        return Start(kind, phi_dot, theta_dot, off, fit.find_deviation(slope), straight)


def bisect(is_enough: Callable[[int], bool], low: int, high: int) -> int:
    """Return the smallest sufficient number from low to high, if high is sufficient."""
    while low < high:
        middle = (low + high) // 2
        low, high = (low, middle) if is_enough(middle) else (middle + 1, high)
    return high
