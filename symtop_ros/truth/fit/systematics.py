"""What wrong assumptions may cost: a systematic deviation beside that of the noise.

Each cause changes what a record shows, by as much as is usual. Least squares follow: to first order
the parameters move by the weighted least squares of that change. No look at what is left tells,
since the change is, for the most part, one that other numbers would make. Causes are independent of
each other (consider covariance; Tapley, Schutz and Born, Statistical Orbit Determination, section
6.2; type B of the Guide to the Expression of Uncertainty in Measurement, 4.3).
"""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from symtop_ros.base.arrays import Real
from symtop_ros.truth.fit.camera import CENTRE, project
from symtop_ros.truth.fit.model import find_axis
from symtop_ros.truth.fit.refine import Fit

TIME_BASE = 1e-3  # of the time: 30 frames a second, where a camera takes 29.97
SHUTTER = 0.02  # s of a frame, if frames are not closer than that
READOUT = 0.02  # s from the first row of a picture to the last
LENS = 0.01  # of its distance from the centre, of a point half a picture away
SQUARE = 0.01  # part by which pixels are wider than they are high
AIM = 0.1  # of the picture, by which a camera looks beside its middle, in u and in v
LENGTH = 0.5  # of the axis, above the pivot: where a camera looks whose aim is not known
NEAR = 0.05  # lengths of the axis in distances of a camera that is taken to be far away
GAIN, TILT = 0.01, 0.01  # of each axis of a sensor, and rad


@dataclass(frozen=True)
class Part:
    """What one cause changes a number by; its name is that of the template `cause.NAME`."""

    cause: str
    shift: float


@dataclass(frozen=True, eq=False)
class Budget:
    """Changes of the parameters of a fit by usual errors of what it assumes."""

    fit: Fit

    def list_parts(self, slope: Real) -> tuple[Part, ...]:
        """Return what each cause does to a combination (p,) of the parameters."""
        sums: dict[str, float] = {}
        for cause, shift in self._shifts:
            sums[cause] = float(np.hypot(sums.get(cause, 0.0), slope @ shift))
        return tuple(Part(cause, shift) for cause, shift in sums.items())

    @cached_property
    def _shifts(self) -> list[tuple[str, Real]]:
        """Causes with changes (p,) of the parameters."""
        return [(cause, self._follow(change)) for cause, change in list_changes(self.fit)]

    def _follow(self, change: Real) -> Real:
        white = self.fit.noise.whiten(change)
        return np.asarray(
            np.einsum("tip,ti->p", self.fit.columns, white) @ self.fit.covariance
        )


def list_changes(fit: Fit) -> Iterator[tuple[str, Real]]:
    """Yield causes with changes (n, r) of what a record shows."""
    record = fit.model.record
    times = record.times - record.times[0]
    yield "time_base", _subtract(fit, fit.model.show_at(fit.x[np.newaxis], times * (1 + TIME_BASE)))
    if record.kind.name == "pixels":
        yield from _list_of_cameras(fit, times)
    if record.kind.name in {"rates", "inertial"}:
        yield from _list_of_sensors(fit)


def _subtract(fit: Fit, shown: Real) -> Real:
    """Return how what is shown (1, n, m) differs from what the fit shows."""
    return fit.model.subtract(fit.model.compare(shown)[0], fit.residuals)


def _list_of_cameras(fit: Fit, times: Real) -> Iterator[tuple[str, Real]]:
    x, camera = fit.x[np.newaxis], fit.model.find_camera(fit.x)
    shown = fit.model.show(x)[0]
    pivot = np.array([camera["u"], camera["v"]])
    middle = np.array([camera[name] for name in CENTRE]) if "centre_u" in camera else pivot
    far = shown - middle
    half = float(np.abs(far).max())
    yield "lens", LENS * far * (far**2).sum(axis=1, keepdims=True) / half**2
    yield "pixels", SQUARE * (shown - pivot) * [1.0, 0.0]
    open_for = min(SHUTTER, fit.model.record.step)
    middle_of, end = (fit.model.show_at(x, times + part * open_for)[0] for part in (0.5, 1.0))
    yield "shutter", np.asarray((4 * middle_of + end - 5 * shown) / 6)  # Simpson's rule
    # the upper rows are read first
    down = 0.5 - far[:, 1:] / (2 * half)
    yield "readout", (end - shown) / open_for * READOUT * down
    if camera["nearness"]:
        aside = AIM * 2 * half if middle is not pivot else LENGTH * np.exp(camera["log_scale"])
        for change in aside * np.eye(2):
            yield "aim", _see(fit, times, {**camera, **dict(zip(CENTRE, middle + change, strict=True))}) - shown
    elif "nearness" not in fit.model.place and "nearness" not in fit.model.record.camera:
        yield "distance", _see(fit, times, {**camera, "nearness": NEAR}) - shown


def _see(fit: Fit, times: Real, camera: Mapping[str, float]) -> Real:
    """Return what another camera shows of the same motion, (n, 2)."""
    axis = find_axis(fit.model.find_motion(fit.x).at(times).orientation)
    return np.asarray(
        project(axis[np.newaxis], {name: np.array([each]) for name, each in camera.items()})[0]
    )


def _list_of_sensors(fit: Fit) -> Iterator[tuple[str, Real]]:
    rates = fit.model.show(fit.x[np.newaxis])[0][:, :3]
    others = np.zeros((len(rates), fit.residuals.shape[1] - 3))
    for axis in np.eye(3):
        yield "gain", np.hstack([GAIN * rates * axis, others])
    if not fit.model.record.has_mount:
        for axis in np.eye(3)[:2]:
            yield "tilt", np.hstack([TILT * np.cross(rates, axis), others])
