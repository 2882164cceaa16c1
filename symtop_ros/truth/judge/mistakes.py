"""Sentences on likely mistakes of convention, of the attitude and of the angular velocity."""

from collections.abc import Callable, Iterator
from dataclasses import replace

import numpy as np

from symtop_ros.base.arrays import Real
from symtop_ros.truth.judge.alignment import SAMPLES
from symtop_ros.truth.judge.causes import CHANGES, PERMUTED, Finding
from symtop_ros.truth.judge.compare import NONE, Errors, Offset, compare
from symtop_ros.truth.judge.saturated import find_saturated
from symtop_ros.truth.judge.truth import Truth
from symtop_ros.truth.testset.score import turn_to_body
from symtop_ros.truth.topics.estimates import Estimates
from symtop_ros.words import write

# Undoing each, by its sentence.
VELOCITIES: dict[str, Callable[[Real, Real], Real]] = {
    "the angular velocities are in deg/s": lambda q, omega: np.radians(omega),
    "the angular velocities are in the world frame": turn_to_body,
    "the angular velocities are in deg/s, in the world frame": lambda q, omega: turn_to_body(
        q, np.radians(omega)
    ),
}
MUCH = 10.0  # a change explains an error that it makes this many times smaller
SMALL = 0.05  # part of the rates; smaller errors are no mistakes of convention


def find_mistakes(estimates: Estimates, truth: Truth, found: Finding) -> list[str]:
    """Return sentences on the likely mistakes: of the attitude, then of the rates.

    Rates of a sensor at its limit are no mistake of units or frames.
    """
    some = estimates.thin(SAMPLES)
    change = found.said.change
    mended = CHANGES[change][2](some)
    # Rates are in the frame of the body, which a half turn of the attitude has not turned.
    offset = NONE if change else found.said.offset
    rates = [] if estimates.angular_velocities is None else [*_find_rates(mended, truth, offset)]
    limit = find_saturated(estimates, truth)
    return [*_name_changes(found, some.of_sensor), *([limit.describe()] if limit else rates)]


def _name_changes(found: Finding, of_sensor: bool) -> list[str]:
    """Return the mistake of the attitude, with others that would explain as much."""
    several = {each.change: each for each in (found.said, *found.others)}
    if list(several) == [""]:
        return []
    names = {"": "none", "frame": "body" if of_sensor else "sensor"}
    return [", or ".join(_name_change(names.get(name, name)) for name in several)]


def _name_change(name: str) -> str:
    return PERMUTED[name].describe() if name in PERMUTED else write(f"change.{name}", {})


def _find_rates(some: Estimates, truth: Truth, offset: Offset) -> Iterator[str]:
    """Yield the mistake of the angular velocities, if there is one.

    The errors of diverging rates also become smaller if the rates are divided by any number. So the
    remaining error must be small compared with the exact rates.
    """
    now = _rate(compare(some, truth, offset))
    q = some.orientations
    omega = np.asarray(some.angular_velocities)
    exact = truth.states_at(some.stamps, some.of_sensor)[1]
    size = float(np.sqrt((exact**2).sum(axis=1).mean()))
    if now > SMALL * size:
        errors = {
            text: _rate(compare(replace(some, angular_velocities=mend(q, omega)), truth, offset))
            for text, mend in VELOCITIES.items()
        }
        best = min(errors, key=lambda name: errors[name])
        if errors[best] < min(now, size) / MUCH:
            yield best


def _rate(errors: Errors) -> float:
    rate = np.zeros(1) if errors.rate is None or not len(errors.rate) else errors.rate
    return float(np.sqrt((rate**2).mean()))
