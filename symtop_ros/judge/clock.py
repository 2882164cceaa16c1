"""The clock of the stamps of estimates: how late they are, how fast that grows, and its jitter.

A top that turns at 200 rad/s turns by 0.2 mrad in a microsecond: an error of a stamp is an error of
the attitude along the angular velocity. Noise is the same in all directions, so what is left along
the angular velocity, beyond what is left across it, is jitter.
"""

import math
from dataclasses import dataclass

import numpy as np

from symtop_ros.arrays import Real, Stamps, compose, find_rotation_vectors, invert
from symtop_ros.judge.compare import Offset, to_rotation
from symtop_ros.judge.estimates import Estimates
from symtop_ros.judge.search import align
from symtop_ros.judge.truth import Truth
from symtop_ros.simulation.validation import RefusedError
from symtop_ros.wording import write

FEWEST = 10  # estimates
SIGNIFICANT = 3.0  # standard deviations, below which jitter may be noise
RESOLUTION = 1e-9 / math.sqrt(12)  # s: the standard deviation of a time in whole ns


@dataclass(frozen=True, slots=True)
class Clock:
    """The delay of the stamps in the middle of their time (us), and its growth (ppm)."""

    source: str
    estimates: int
    delay: float
    delay_deviation: float
    rate: float
    rate_deviation: float
    kind: str  # "jitter", or "none" if it may be noise
    jitter: float  # us; of "none" the largest that noise may hide


def measure_clock(estimates: Estimates, truth: Truth, source: str, model: str = "none") -> Clock:
    """Return the clock of estimates; the rotations of the model (of `--aligned`) are fitted too."""
    run = truth.select(estimates)
    _demand_enough(len(run), source)
    # In the middle delay and rate are independent: at an end the delay is half as sure.
    middle = int(run.stamps[0]) // 2 + int(run.stamps[-1]) // 2
    fitted = align(estimates, truth, f"{model.partition('+')[0]}+delay+clock", middle)
    left, omega, stamps = _find_left(fitted.offset, truth, run)
    _demand_enough(len(left), source)
    kind, jitter = _find_jitter(left, omega)
    seconds = float(stamps[-1] - stamps[0]) * 1e-9
    return Clock(
        source=source,
        estimates=len(left),
        delay=1e6 * fitted.offset.delay,
        delay_deviation=1e6 * math.hypot(fitted.deviations[0], RESOLUTION),
        rate=1e6 * fitted.offset.clock,
        rate_deviation=1e6 * math.hypot(fitted.deviations[1], RESOLUTION / seconds),
        kind=kind,
        jitter=1e6 * jitter,
    )


def _demand_enough(count: int, source: str) -> None:
    if count < FEWEST:
        raise RefusedError(f"{source} must have {FEWEST} estimates within the run, got {count}")


def _find_left(offset: Offset, truth: Truth, run: Estimates) -> tuple[Real, Real, Stamps]:
    """Return the rotations that are left, the angular velocities (both in the world) and stamps."""
    exact, rates, known = truth.states_at(offset.shift(run.stamps), run.of_sensor)
    run, exact, rates = run.select(known), exact[known], rates[known]
    turned = compose(offset.turn_world(run.stamps), exact)
    left = compose(run.orientations, invert(compose(turned, offset.turn_body(run.stamps))))
    return find_rotation_vectors(left), to_rotation(turned).apply(rates), run.stamps


def _find_jitter(left: Real, omega: Real) -> tuple[str, float]:
    """Return "jitter" and its size (s), or "none" and the largest that noise may hide.

    Least squares of along - across = square * variance, in which noise of the variance n has a
    deviation of sqrt(3) n: sqrt(2) n along, and n across, the mean of two.
    """
    square = (omega**2).sum(axis=1)
    along = (left * omega).sum(axis=1) ** 2 / np.where(square > 0, square, 1.0)
    across = ((left**2).sum(axis=1) - along) / 2
    weight = float((square**2).sum()) or 1.0
    variance = float((square * (along - across)).sum()) / weight
    deviation = math.sqrt(3 / weight) * float(across.mean())
    if variance > max(SIGNIFICANT * deviation, RESOLUTION**2):
        return "jitter", math.sqrt(variance)
    return "none", math.sqrt(max(variance, 0.0) + SIGNIFICANT * deviation + RESOLUTION**2)


def format_clocks(clocks: list[Clock]) -> str:
    """Return a sentence for each clock."""
    records = (
        {
            "source": clock.source,
            "estimates": clock.estimates,
            "delay": {"value": clock.delay, "deviation": clock.delay_deviation},
            "rate": {"value": clock.rate, "deviation": clock.rate_deviation},
            "jitter": {"kind": clock.kind, "value": clock.jitter},
        }
        for clock in clocks
    )
    return "\n".join(write("clock_of_stamps", record) for record in records)
