"""Likely mistakes: conventions that were mixed up, found by undoing each of them."""

from collections.abc import Callable, Iterator
from dataclasses import replace

import numpy as np

from symtop_ros.arrays import Real
from symtop_ros.judge.compare import NONE, Errors, Offset, compare, to_rotation
from symtop_ros.judge.estimates import Estimates
from symtop_ros.judge.explain import SAMPLES, explain
from symtop_ros.judge.truth import Truth
from symtop_ros.quaternions import invert

Change = Callable[[Estimates], Estimates]
MUCH = 10.0  # a change explains an error that it makes this many times smaller
SMALL = 0.05  # rad, or part of the largest rate: smaller errors are no mistakes of convention
DEGREE = np.pi / 180


def _turn(estimates: Estimates, q: Real) -> Estimates:
    return replace(estimates, orientations=q)


def _rates(estimates: Estimates, rates: Real) -> Estimates:
    return replace(estimates, angular_velocities=rates)


def _to_frame(estimates: Estimates) -> Estimates:
    omega = np.asarray(estimates.angular_velocities)
    return _rates(estimates, to_rotation(estimates.orientations).apply(omega, inverse=True))


def _to_radians(estimates: Estimates) -> Estimates:
    return _rates(estimates, np.asarray(estimates.angular_velocities) * DEGREE)


ATTITUDES: dict[str, Change] = {
    "the quaternions have the order x, y, z, w": lambda e: _turn(
        e, e.orientations[:, [3, 0, 1, 2]]
    ),
    "the quaternions are conjugate: world to body": lambda e: _turn(e, invert(e.orientations)),
    "the quaternions are conjugate, in the order x, y, z, w": lambda e: _turn(
        e, invert(e.orientations[:, [3, 0, 1, 2]])
    ),
}
FRAMES: dict[bool, str] = {
    True: "the estimates are of the body, not of the sensor: --attitude-of body",
    False: "the estimates are of the sensor, not of the body: --attitude-of sensor",
}
VELOCITIES: dict[str, Change] = {
    "the angular velocities are in deg/s": _to_radians,
    "the angular velocities are in the world frame": _to_frame,
    "the angular velocities are in deg/s, in the world frame": lambda e: _to_frame(_to_radians(e)),
}


def find_mistakes(estimates: Estimates, truth: Truth, found: Offset, left: float) -> list[str]:
    """Return the likely mistakes, given what was found and the error in rad that it leaves."""
    every = max(1, len(estimates) // SAMPLES)
    some = estimates.select(np.arange(len(estimates)) % every == 0)
    named, mended = _find_attitude(some, truth, left)
    offset = NONE if named else found
    rates = [] if estimates.angular_velocities is None else [*_find_rates(mended, truth, offset)]
    return [*named, *rates]


def _find_attitude(some: Estimates, truth: Truth, left: float) -> tuple[list[str], Estimates]:
    """Return the mistake of the attitude, if there is one, and the estimates without it."""
    now = _rms(compare(some, truth))
    changes = {name: change(some) for name, change in ATTITUDES.items()}
    changes[FRAMES[some.of_sensor]] = replace(some, of_sensor=not some.of_sensor)
    if now > SMALL:
        errors = {name: _rms(compare(each, truth)) for name, each in changes.items()}
        best = min(errors, key=lambda name: errors[name])
        if errors[best] < now / MUCH:
            return [best], changes[best]
    if left > SMALL:  # a heading that is not known may hide the mistake
        for name, each in changes.items():
            if explain(each, truth, delay=False).residual < left / MUCH:
                return [name], each
    return [], some


def _find_rates(some: Estimates, truth: Truth, offset: Offset) -> Iterator[str]:
    """Yield the mistake of the angular velocities, if there is one."""
    now = _rate(compare(some, truth, offset))
    size = float(np.sqrt((np.asarray(some.angular_velocities) ** 2).sum(axis=1).mean()))
    if now > SMALL * size:
        errors = {
            name: _rate(compare(change(some), truth, offset)) for name, change in VELOCITIES.items()
        }
        best = min(errors, key=lambda name: errors[name])
        if errors[best] < now / MUCH:
            yield best


def _rms(errors: Errors) -> float:
    return float(np.sqrt((errors.total**2).mean())) if len(errors.total) else 0.0


def _rate(errors: Errors) -> float:
    rate = np.zeros(1) if errors.rate is None or not len(errors.rate) else errors.rate
    return float(np.sqrt((rate**2).mean()))
