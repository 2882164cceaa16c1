"""The effect of wrong assumptions: a systematic deviation in addition to that of the noise.

Each cause changes what a record shows, by as much as is usual. To first order the parameters change
by the weighted least squares of that change. Residuals do not show it, because for the most part
other numbers compensate for the change. Causes are independent of each other (consider covariance;
Tapley, Schutz and Born, Statistical Orbit Determination, section 6.2; type B of the Guide to the
Expression of Uncertainty in Measurement, 4.3).
"""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from symtop_ros.base.arrays import Real
from symtop_ros.truth.fit.aliases import RATES
from symtop_ros.truth.fit.camera import CENTRE, project
from symtop_ros.truth.fit.model import find_axis
from symtop_ros.truth.fit.refine import Fit

SMALL = 2.0**-10  # part of a change for its derivative
TIME_BASE = 1e-3  # of the time: 30 frames a second, where a camera takes 29.97
SHUTTER = 0.02  # s of a frame, if frames are not closer than that
READOUT = 0.02  # s from the first row of a picture to the last
LENS = 0.01  # of its distance from the centre, of a point half a picture away
SQUARE = 0.01  # part by which pixels are wider than they are high
AIM = 0.1  # part of the picture by which the aim of a camera is off its middle, in u and in v
LENGTH = 0.5  # lengths of the axis above the pivot, at which a camera of unknown aim may look
NEAR = 0.05  # lengths of the axis in distances of a camera that is taken to be far away
GAIN, TILT = 0.01, 0.01  # of each axis of a sensor, and rad


@dataclass(frozen=True)
class Part:
    """The change of a number by one cause; the template `cause.NAME` has its name."""

    cause: str
    shift: float


@dataclass(frozen=True, eq=False)
class Budget:
    """Changes of the parameters of a fit by usual errors of what it assumes."""

    fit: Fit

    def list_parts(self, slope: Real) -> tuple[Part, ...]:
        """Return the effect of each cause on a combination (p,) of the parameters."""
        sums: dict[str, float] = {}
        for cause, shift in self._shifts:
            sums[cause] = float(np.hypot(sums.get(cause, 0.0), slope @ shift))
        return tuple(Part(cause, shift) for cause, shift in sums.items())

    @cached_property
    def _shifts(self) -> list[tuple[str, Real]]:
        """Causes with changes (p,) of the parameters."""
        return [(cause, self._follow(change)) for cause, change in list_changes(self.fit)]

    def raise_aim(self) -> Real | None:
        """Return the change (p,) if a camera looks above the pivot; None if far or known."""
        camera = self.fit.model.find_camera(self.fit.x)
        if CENTRE[0] in camera or not camera["nearness"]:
            return None
        above = np.array([0.0, LENGTH * np.exp(camera["log_scale"])])
        # the record was made with this aim, so the parameters change in the opposite direction
        return -self._follow(_aim(self.fit, above))

    def _follow(self, change: Real) -> Real:
        """Return the change (p,), to first order, that shows a change (n, r)."""
        white = self.fit.noise.whiten(change)
        return np.asarray(np.einsum("tip,ti->p", self.fit.columns, white) @ self.fit.covariance)


def list_changes(fit: Fit) -> Iterator[tuple[str, Real]]:
    """Yield causes with changes (n, r) of what a record shows."""
    record = fit.model.record
    # as a derivative: after many turns the phases of the whole change are no small angles
    late = fit.model.show_at(fit.x[np.newaxis], _list_times(fit) * (1 + SMALL * TIME_BASE))
    change = fit.model.subtract(fit.model.compare(late)[0], fit.residuals)
    yield "time_base", np.asarray(change / SMALL)
    if record.kind.name == "pixels":
        yield from _list_of_pictures(fit)
        yield from _list_of_cameras(fit)
    if record.kind.name in RATES:
        yield from _list_of_sensors(fit)


def _list_times(fit: Fit) -> Real:
    return np.asarray(fit.model.record.times - fit.model.record.times[0])


def _list_of_pictures(fit: Fit) -> Iterator[tuple[str, Real]]:
    """Yield what a lens, pixels and shutters do, with changes (n, 2)."""
    x, times = fit.x[np.newaxis], _list_times(fit)
    camera, shown = fit.model.find_camera(fit.x), fit.model.show(x)[0]
    far = shown - _find_centre(camera)
    half = _find_half(fit)
    yield "lens", LENS * far * (far**2).sum(axis=1, keepdims=True) / half**2
    yield "pixels", SQUARE * (shown - [camera["u"], camera["v"]]) * [1.0, 0.0]
    exposed = min(SHUTTER, fit.model.record.step)
    before, after = (fit.model.show_at(x, times + side * exposed / 2)[0] for side in (-1, 1))
    velocity = (after - before) / exposed
    # the time of a frame is its beginning; the mean over the exposure is by Simpson's rule
    yield "shutter", velocity * exposed / 2 + (before + after - 2 * shown) / 6
    # the upper rows are read first
    yield "readout", READOUT * velocity * (0.5 - far[:, 1:] / (2 * half))


def _list_of_cameras(fit: Fit) -> Iterator[tuple[str, Real]]:
    """Yield what a different aim and distance do, with changes (n, 2)."""
    camera = fit.model.find_camera(fit.x)
    if camera["nearness"]:
        is_known = CENTRE[0] in camera
        aside = AIM * 2 * _find_half(fit) if is_known else LENGTH * np.exp(camera["log_scale"])
        for change in aside * np.eye(2):
            yield "aim", _aim(fit, change)
    elif not {"nearness"} & {*fit.model.place, *fit.model.record.camera}:
        yield "distance", _see(fit, {**camera, "nearness": NEAR}) - _see(fit, camera)


def _find_centre(camera: Mapping[str, float]) -> Real:
    """Return the point (2,) at which a camera looks: the pivot, if nothing else is known."""
    pivot = dict(zip(CENTRE, (camera["u"], camera["v"]), strict=True))
    return np.array([{**pivot, **camera}[name] for name in CENTRE])


def _find_half(fit: Fit) -> float:
    """Return half the size of the picture: as far as points go from its centre, at least."""
    shown = fit.model.show(fit.x[np.newaxis])[0]
    return float(np.abs(shown - _find_centre(fit.model.find_camera(fit.x))).max())


def _aim(fit: Fit, change: Real) -> Real:
    """Return what it does, (n, 2), that a camera looks at another point (2,) of the picture."""
    camera = fit.model.find_camera(fit.x)
    centre = dict(zip(CENTRE, _find_centre(camera) + change, strict=True))
    return _see(fit, {**camera, **centre}) - _see(fit, camera)


def _see(fit: Fit, camera: Mapping[str, float]) -> Real:
    """Return what a camera shows of the motion, (n, 2)."""
    axis = find_axis(fit.model.find_motion(fit.x).at(_list_times(fit)).orientation)
    numbers = {name: np.array([each]) for name, each in camera.items()}
    return np.asarray(project(axis[np.newaxis], numbers)[0])


def _list_of_sensors(fit: Fit) -> Iterator[tuple[str, Real]]:
    """Yield what gains and a tilt of a gyroscope do, with changes (n, r)."""
    shown = fit.model.show(fit.x[np.newaxis])[0]
    width = shown.shape[1]
    spins = shown[:, 2] if width > 2 else np.full(len(shown), fit.x[fit.model.place["spin"]])
    rates = np.column_stack([shown[:, :2], spins])
    others = np.zeros((len(rates), max(width - 3, 0)))
    for axis in np.eye(3)[:width]:
        yield "gain", np.hstack([GAIN * rates * axis, others])[:, :width]
    if not fit.model.record.has_mount:
        for axis in np.eye(3)[:2]:
            yield "tilt", np.hstack([TILT * np.cross(rates, axis), others])[:, :width]
