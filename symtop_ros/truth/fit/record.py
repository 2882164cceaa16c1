"""A record: measurements of a top at some times, and what else is known."""

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np

from symtop_ros.base.arrays import Mask, Places, Real
from symtop_ros.base.refusals import RefusedError, refuse, require
from symtop_ros.run.simulation import points
from symtop_ros.truth.fit.kinds import KINDS, Kind
from symtop_ros.truth.residuals.rounding import find_steps
from symtop_ros.truth.residuals.spread import find_spread

FEWEST = 12  # rows
MOST = points.MOST  # rows of a fit, as many as a run has points; more are thinned
RUN = 200  # rows that follow each other in a record that was thinned, for the correlation of noise
GAP = 1.5  # medians of the steps; a longer step ends a run of noise
LENGTH, USUAL = 0.1, 75  # largest relative difference of lengths, in this percentage of the rows
STILL = 1e-9  # relative change below which a record counts as without motion
Known = tuple[float, float]  # a value and its standard deviation


@dataclass(frozen=True, eq=False)
class Record:
    """Measurements of a top, with their times.

    Attributes
    ----------
    times : ndarray (n,)
        In s, growing.
    values : ndarray (n, m)
        By the columns of the kind, in rad, rad/s or pixels; axes and attitudes have the norm 1;
        points at a fixed distance have it up to their errors.
    kind : Kind
    camera : mapping
        For `pixels` the known numbers of the camera, by the names of `camera.CAMERA`.
    known : mapping
        Known values with their standard deviations: "Mgl/Ix", "Iz/Ix", and biases.
    has_friction : bool
        True if friction is looked for.
    has_length : bool
        For points of an axis, True if their distance from the pivot is fitted; values are then
        close to the norm 1.
    has_kick : bool
        True if a sudden change of the rates is looked for.
    has_mount : bool
        For rates, True if biases and the tilt of the sensor are fitted.
    has_perspective : bool
        For `pixels`, True if the distance of the camera is fitted.
    position : tuple of float
        For inertial records, the place of the accelerometer in the body, in m.
    notes : tuple of str
        Sentences on unusual properties of the file.
    steps : ndarray (m,), optional
        Steps of the last decimals of each column, if the record was read from text.
    """

    times: Real
    values: Real
    kind: Kind
    camera: Mapping[str, float] = field(default_factory=dict)
    known: Mapping[str, Known] = field(default_factory=dict)
    has_friction: bool = False
    has_kick: bool = False
    has_length: bool = False
    has_mount: bool = False
    has_perspective: bool = False
    position: tuple[float, ...] = (0.0, 0.0, 0.0)
    notes: tuple[str, ...] = ()
    steps: Real | None = None

    def __len__(self) -> int:
        """Return the number of rows."""
        return len(self.times)

    @cached_property
    def step(self) -> float:
        """Median of the steps of time, in s."""
        return float(np.median(np.diff(self.times)))

    @property
    def seconds(self) -> float:
        """Time from the first to the last row."""
        return float(self.times[-1] - self.times[0])

    @cached_property
    def follows(self) -> Mask:
        """True (n,) for rows one step after the row before: their noise is correlated with it."""
        return np.append(False, np.diff(self.times) < GAP * self.step)

    @cached_property
    def rounding(self) -> Real:
        """Deviation step/sqrt(12), (m,), of the rounding of each column; 0 if none is seen."""
        return np.asarray(find_steps(self.values, self.steps) / np.sqrt(12))

    @property
    def plain(self) -> "Record":
        """The same record without the data that distinguish twins: accelerometer or perspective."""
        if self.kind.name == "inertial":
            steps = None if self.steps is None else self.steps[:3]
            return replace(self, kind=KINDS["rates"], values=self.values[:, :3], steps=steps)
        if self.kind.name == "pixels":
            camera = {name: value for name, value in self.camera.items() if name != "nearness"}
            return replace(self, camera=camera, has_perspective=False)
        return self

    @property
    def breaks_twins(self) -> bool:
        """True if this record distinguishes twins of the plain record."""
        return self.kind.name == "inertial" or self.has_perspective or "nearness" in self.camera

    def select(self, rows: slice | Mask | Places) -> "Record":
        """Return a part of the record."""
        return replace(self, times=self.times[rows], values=self.values[rows])

    def thin(self, most: int = MOST) -> "Record":
        """Return at most `most` rows: all, or runs of rows that are spread over the record."""
        if len(self) <= most:
            return self
        pieces = max(most // RUN, 1)
        firsts = np.linspace(0, len(self) - RUN, pieces).astype(int)
        return self.select(np.unique(firsts[:, np.newaxis] + np.arange(RUN)).ravel())


def make_record(
    times: Real, values: Real, kind: str, *, steps: Real | None = None, **more: object
) -> Record:
    """Return a record, after its numbers, times and motion are checked.

    Parameters
    ----------
    times : array_like (n,)
        In s.
    values : array_like (n, m)
        By the columns of `KINDS[kind]`: theta and phi, or theta, in rad; x, y, z of the axis or
        the quaternion w, x, y, z of any norm; rates of the body in rad/s, of inertial records
        with the specific force in m/s^2; u, v of a point of the
        axis, v upwards.
    kind : str
        A name of `KINDS`.
    steps : array_like (m,), optional
        Steps of the last decimals of each column, if the numbers were read from text.
    **more
        Further attributes of `Record`.

    Raises
    ------
    ValueError
        If the record is refused.

    Examples
    --------
    >>> import numpy as np
    >>> from symtop_ros.truth.fit import make_record
    >>> t = np.arange(20) / 10
    >>> len(make_record(t, 0.5 + 0.1 * np.sin(t)[:, None], "theta"))
    20
    """
    require(kind in KINDS, "kind", f"one of {', '.join(KINDS)}", kind)
    times, values = np.asarray(times, dtype=float), np.asarray(values, dtype=float)
    found = KINDS[kind]
    if times.ndim != 1 or values.shape != (len(times), found.width):
        raise RefusedError(
            f"values must have the columns {', '.join(found.columns)} for each of "
            f"{times.size} times, got shape {values.shape}"
        )
    _refuse_odd(times, values)
    length = 1.0
    if kind in {"axis", "attitude"}:
        values, length = _normalize(values, kind)
    _refuse_still(values, found)
    steps = None if steps is None else np.asarray(steps, dtype=float) / length
    return Record(times, values, found, steps=steps, has_length=length != 1, **more)  # type: ignore[arg-type]


def _refuse_odd(times: Real, values: Real) -> None:
    """Refuse too few rows, numbers that are not finite, and times that do not grow."""
    if len(times) < FEWEST:
        raise RefusedError(f"a record must have at least {FEWEST} rows, got {len(times)}")
    bad = ~(np.isfinite(times) & np.isfinite(values).all(axis=1))
    if bad.any():
        row = int(np.argmax(bad))
        raise RefusedError(
            f"a record must have finite numbers (empty cells where nothing was seen), got "
            f"{[float(times[row]), *map(float, values[row])]} in row {row + 1}"
        )
    back = np.flatnonzero(np.diff(times) <= 0)
    if len(back):
        row = int(back[0]) + 1
        raise RefusedError(
            f"times must grow, got {times[row]:.9g} s after {times[row - 1]:.9g} s in row {row + 1}"
        )


def _normalize(values: Real, kind: str) -> tuple[Real, float]:
    """Return rows of norm 1, and the length by which points at a fixed distance were divided.

    If each row were divided by its own length, the motion would modulate correlated errors. Points
    whose length is 1 up to their errors are not divided at all: an error of the length would become
    an error of the tilt.
    """
    norms = np.linalg.norm(values, axis=1, keepdims=True)
    if not norms.all():
        row = int(np.argmin(norms)) + 1
        raise refuse(f"{kind} in row {row}", "a vector other than zero", 0.0)
    usual = float(np.median(norms))
    if kind != "axis" or np.percentile(np.abs(norms / usual - 1), USUAL) >= LENGTH:
        return np.asarray(values / norms), 1.0
    errors = max(float(find_spread(norms)[0]), float(find_steps(values).max()), STILL)
    length = 1.0 if abs(usual - 1) <= errors else usual
    return np.asarray(values / length), length


def _refuse_still(values: Real, kind: Kind) -> None:
    """Refuse a record in which nothing moves."""
    size = np.abs(values).max()
    moved = np.ptp(np.abs(values) if kind.name == "attitude" else values, axis=0).max()
    if moved <= STILL * max(size, 1e-300):
        raise RefusedError(
            f"a record must show a motion, got {kind.name} that do not change: "
            f"{', '.join(f'{v:.6g}' for v in values[0])}"
        )
