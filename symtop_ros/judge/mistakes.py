"""Likely mistakes: conventions that were mixed up, found by undoing each of them."""

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from symtop_ros.judge.causes.cause import CHANGES, Finding
from symtop_ros.judge.compare import NONE, Errors, Offset, compare
from symtop_ros.judge.estimates import Estimates
from symtop_ros.judge.fit import SAMPLES
from symtop_ros.judge.truth import Truth
from symtop_ros.testset.score import VELOCITIES
from symtop_ros.wording import write

MUCH = 10.0  # a change explains an error that it makes this many times smaller
SMALL = 0.05  # rad, or part of the largest rate: smaller errors are no mistakes of convention


def find_mistakes(estimates: Estimates, truth: Truth, found: Finding) -> list[str]:
    """Return the likely mistakes as sentences: that of the attitude, then that of the rates."""
    some = estimates.thin(SAMPLES)
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
    q, omega = some.orientations, np.asarray(some.angular_velocities)
    size = float(np.sqrt((omega**2).sum(axis=1).mean()))
    if now > SMALL * size:
        errors = {
            text: _rate(compare(replace(some, angular_velocities=mend(q, omega)), truth, offset))
            for text, mend in VELOCITIES.items()
        }
        best = min(errors, key=lambda name: errors[name])
        if errors[best] < now / MUCH:
            yield best


def _rate(errors: Errors) -> float:
    rate = np.zeros(1) if errors.rate is None or not len(errors.rate) else errors.rate
    return float(np.sqrt((rate**2).mean()))
