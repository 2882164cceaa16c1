"""Likely mistakes: conventions that were mixed up, found by undoing each of them."""

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from symtop_ros.arrays import Real
from symtop_ros.judge.causes.cause import CHANGES, Change, Finding
from symtop_ros.judge.compare import NONE, Errors, Offset, compare, to_rotation
from symtop_ros.judge.estimates import Estimates
from symtop_ros.judge.fit import SAMPLES
from symtop_ros.judge.truth import Truth
from symtop_ros.wording import write

MUCH = 10.0  # a change explains an error that it makes this many times smaller
SMALL = 0.05  # rad, or part of the largest rate: smaller errors are no mistakes of convention
DEGREE = np.pi / 180


def _rates(estimates: Estimates, rates: Real) -> Estimates:
    return replace(estimates, angular_velocities=rates)


def _to_frame(estimates: Estimates) -> Estimates:
    omega = np.asarray(estimates.angular_velocities)
    return _rates(estimates, to_rotation(estimates.orientations).apply(omega, inverse=True))


def _to_radians(estimates: Estimates) -> Estimates:
    return _rates(estimates, np.asarray(estimates.angular_velocities) * DEGREE)


VELOCITIES: dict[str, Change] = {
    "the angular velocities are in deg/s": _to_radians,
    "the angular velocities are in the world frame": _to_frame,
    "the angular velocities are in deg/s, in the world frame": lambda e: _to_frame(_to_radians(e)),
}


def find_mistakes(estimates: Estimates, truth: Truth, found: Finding) -> list[str]:
    """Return the likely mistakes as sentences: that of the attitude, then that of the rates."""
    every = max(1, len(estimates) // SAMPLES)
    some = estimates.select(np.arange(len(estimates)) % every == 0)
    change = found.best.change
    mended = CHANGES[change][2](some)
    # Rates are in the frame of the body, which a half turn of the attitude has not turned.
    offset = NONE if change else found.best.offset
    rates = [] if estimates.angular_velocities is None else [*_find_rates(mended, truth, offset)]
    return [*_name_changes(found, some.of_sensor), *rates]


def _name_changes(found: Finding, of_sensor: bool) -> list[str]:
    """Return the mistake of the attitude, with others that would explain as much."""
    several = {each.change: each for each in (found.best, *found.others)}
    if list(several) == [""]:
        return []
    frame = "body" if of_sensor else "sensor"
    keys = [frame if name == "frame" else name or "none" for name in several]
    return [", or ".join(write(f"change.{key}", {}) for key in keys)]


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


def _rate(errors: Errors) -> float:
    rate = np.zeros(1) if errors.rate is None or not len(errors.rate) else errors.rate
    return float(np.sqrt((rate**2).mean()))
