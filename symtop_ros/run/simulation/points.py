"""Measured points of a run, with their differences from its motion.

They are a record of the past, and no part of the motion: nothing is computed from them again.
"""

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from itertools import pairwise
from typing import Any

import numpy as np

from symtop_ros.base.arrays import Mask, Real, Stamps, axis_of
from symtop_ros.base.refusals import number, refuse, vector
from symtop_ros.physics import State
from symtop_ros.run.simulation.fields import TABLE
from symtop_ros.run.wire.layout import NANOSECONDS

FIELDS = TABLE["points"]
MOST: int = FIELDS["most"]  # points of a run
DIGITS = 6  # of a residual, which is a small difference


@dataclass(frozen=True, slots=True)
class Seen:
    """Columns of a kind of points: values, and residuals with their units.

    Attributes
    ----------
    columns : tuple of str
        Names of the values of a row.
    residuals : tuple of str
        Names of the residuals of a row.
    units : tuple of str
        Units of the residuals.
    """

    columns: tuple[str, ...]
    residuals: tuple[str, ...]
    units: tuple[str, ...]


SEEN = {
    name: Seen(
        tuple(kind["columns"]), tuple(kind.get("residuals", kind["columns"])), tuple(kind["units"])
    )
    for name, kind in FIELDS["kinds"].items()
}


@dataclass(frozen=True, eq=False, slots=True)
class Points:
    """Measured points of a run.

    Attributes
    ----------
    kind : str
        A name of `SEEN`.
    rows : int
        Rows that were measured, of which these points may be a part.
    times : ndarray (n,)
        In s of the run, growing.
    values : ndarray (n, m)
        By the columns of the kind.
    residuals : ndarray (n, r)
        Measured minus computed values; for attitudes a rotation vector in the body frame.
    camera : mapping
        For `pixels` the numbers of the camera, by their names in run_fields.json.
    """

    kind: str
    rows: int
    times: Real
    values: Real
    residuals: Real
    camera: Mapping[str, float] = field(default_factory=dict)

    def __len__(self) -> int:
        """Return the number of points."""
        return len(self.times)

    @property
    def stamps(self) -> Stamps:
        """The times in ns."""
        return np.asarray(np.rint(self.times * NANOSECONDS), dtype=np.int64)

    def select(self, rows: Mask) -> "Points":
        """Return some of the points."""
        times, values, residuals = self.times[rows], self.values[rows], self.residuals[rows]
        return replace(self, times=times, values=values, residuals=residuals)

    def to_json(self) -> dict[str, Any]:
        """Return the points as they stand in run.json."""
        left = [[float(f"{each:.{DIGITS}g}") for each in row] for row in self.residuals.tolist()]
        return {
            "kind": self.kind,
            "rows": self.rows,
            "times": self.times.tolist(),
            "values": self.values.tolist(),
            "residuals": left,
            **({"camera": dict(self.camera)} if self.camera else {}),
        }

    def find_axes(self, states: State) -> Real:
        """Return the axes (n, 3) that were seen; nan for those that the points do not show.

        Parameters
        ----------
        states : State
            States of the motion at the times of the points.
        """
        with np.errstate(invalid="ignore"):  # a row of zeros has no direction
            return self._find_directions(states)

    def _find_directions(self, states: State) -> Real:
        if self.kind == "axis":
            return np.asarray(self.values / np.linalg.norm(self.values, axis=1, keepdims=True))
        if self.kind == "attitude":
            norms = np.linalg.norm(self.values, axis=1, keepdims=True)
            return axis_of((self.values / norms)[:, [1, 2, 3, 0]])
        if self.kind == "angles":
            (theta, phi), sin = self.values.T, np.sin(self.values[:, 0])
            return np.stack([sin * np.sin(phi), -sin * np.cos(phi), np.cos(theta)], axis=1)
        if self.kind == "pixels":
            return unproject(self.values, self.camera, states.to_world([0.0, 0.0, 1.0]))
        return np.full((len(self), 3), np.nan)

    def find_tilts(self, states: State) -> Real:
        """Return the tilts theta (n,) that were seen, in rad; nan as for `find_axes`."""
        if self.kind in ("theta", "angles"):
            return np.asarray(self.values[:, 0])
        x, y, z = self.find_axes(states).T
        return np.asarray(np.arctan2(np.hypot(x, y), z))

    def find_rates(self, states: State) -> tuple[Real, Real]:
        """Return phi' and psi' (n,), in rad/s, of rates of the body that were seen; else nan.

        The angles between both are those of the motion (Goldstein, eq. 4.87). On the vertical there
        is no phi'.
        """
        if self.kind not in ("rates", "inertial"):
            return np.full(len(self), np.nan), np.full(len(self), np.nan)
        wx, wy, wz = self.values.T[:3]
        _, theta, psi = states.euler_angles
        with np.errstate(divide="ignore", invalid="ignore"):
            phi_dot = (wx * np.sin(psi) + wy * np.cos(psi)) / np.sin(theta)
        return np.asarray(phi_dot), np.asarray(wz - phi_dot * np.cos(theta))


def unproject(seen: Real, camera: Mapping[str, float], axes: Real) -> Real:
    """Return the axes (n, 3) of points (n, 2) of a picture; nan for points outside the sphere.

    A line of sight meets the sphere twice: in front, and behind. The axis is the one that is nearer
    to an axis (n, 3) of the motion. The camera is that of `truth/fit/camera.py`: it shows right and
    high as (a, b) = (right, high)/(1 - nearness near), so that with s = a^2 + b^2 near solves
    (1 + s nearness^2) near^2 - 2 s nearness near + s - 1 = 0.
    """
    u, v = (seen - [camera["u"], camera["v"]]).T * np.exp(-camera["log_scale"])
    cos, sin, n = np.cos(camera["roll"]), np.sin(camera["roll"]), camera["nearness"]
    a, b = cos * u + sin * v, cos * v - sin * u
    s = a * a + b * b
    up, out = np.sin(camera["elevation"]), np.cos(camera["elevation"])
    known = axes[:, 2] * up - axes[:, 1] * out
    with np.errstate(invalid="ignore"):
        root = np.sqrt(1 - s + s * n * n)
    both = (s * n + np.stack([root, -root])) / (1 + s * n * n)
    near = np.where(np.abs(both[0] - known) <= np.abs(both[1] - known), *both)
    right, high = a * (1 - n * near), b * (1 - n * near)
    return np.stack([right, high * up - near * out, high * out + near * up], axis=1)


def read_points(given: Any) -> Points:
    """Return the points of run.json; RefusedError names what is wrong."""
    if not isinstance(given, dict):
        raise refuse("points", "a record with kind, times, values and residuals", given)
    kind = given.get("kind")
    if not isinstance(kind, str) or kind not in SEEN:
        raise refuse("points: kind", f"one of {', '.join(SEEN)}", kind)
    times = _read_times(given.get("times"))
    rows = number("points: rows", given.get("rows", len(times)), **FIELDS["rows"])
    seen = SEEN[kind]
    values = _read_rows("values", given.get("values"), len(times), seen.columns)
    residuals = _read_rows("residuals", given.get("residuals"), len(times), seen.residuals)
    camera = _read_camera(given.get("camera")) if kind == "pixels" else {}
    return Points(kind, int(rows), times, values, residuals, camera)


def _read_times(given: Any) -> Real:
    count = len(given) if isinstance(given, list) else 0
    if not 0 < count <= MOST:
        raise refuse("points: times", f"a list of 1 to {MOST}", count or given)
    times = [number(f"points: times[{k}]", each, **FIELDS["time"]) for k, each in enumerate(given)]
    for place, (before, after) in enumerate(pairwise(times), start=1):
        if not before < after:
            raise refuse(f"points: times[{place}]", "later than the one before it", after)
    return np.array(times)


def _read_rows(name: str, given: Any, count: int, columns: tuple[str, ...]) -> Real:
    """Return rows of numbers, one for each time."""
    if not isinstance(given, list) or len(given) != count:
        got = len(given) if isinstance(given, list) else given
        raise refuse(f"points: {name}", f"a list of {count}, one for each time", got)
    size, limit, unit = len(columns), FIELDS["limit"], ", ".join(columns)
    rows = [vector(f"points: {name}[{k}]", row, size, limit, unit) for k, row in enumerate(given)]
    return np.array(rows)


def _read_camera(given: Any) -> dict[str, float]:
    fields = given if isinstance(given, dict) else {}
    return {
        name: number(f"points: camera: {name}", fields.get(name), **field)
        for name, field in FIELDS["camera"].items()
    }
