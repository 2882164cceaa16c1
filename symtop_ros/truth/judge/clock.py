"""The clock of the stamps of estimates: how late they are, how fast that grows, and its jitter.

A top that turns at 200 rad/s turns by 0.2 mrad in a microsecond: an error of a stamp is an error of
the attitude along the angular velocity, and nowhere else. Residuals along it that exceed those
across it are jitter, unless residuals along the vertical or along the axis of the body are as
large: then they may be the noise of a heading or of a gyroscope.
"""

import math
from dataclasses import asdict, dataclass
from typing import Any

import numpy as np

from symtop_ros.base.arrays import Real, Stamps, compose, find_rotation_vectors, invert
from symtop_ros.base.measured import format_measured
from symtop_ros.base.refusals import RefusedError
from symtop_ros.truth.judge.compare import Offset, to_rotation
from symtop_ros.truth.judge.named_causes import align
from symtop_ros.truth.judge.refine import RESOLUTION
from symtop_ros.truth.judge.truth import Truth
from symtop_ros.truth.residuals.influence import sum_lags
from symtop_ros.truth.topics.estimates import Estimates
from symtop_ros.words import write

FEWEST = 10  # estimates
SIGNIFICANT = 3.0  # standard deviations, below which jitter may be noise


@dataclass(frozen=True, slots=True)
class Clock:
    """The delay of the stamps in the middle of their time (us), and its growth (ppm)."""

    source: str
    estimates: int
    independent: float  # number of independent estimates
    correlation_time: float  # s
    delay: float
    delay_deviation: float | None  # None: the residuals do not show it
    rate: float
    rate_deviation: float | None
    fault: str  # why there are no deviations: "few", "wanders"; or ""
    kind: str  # "jitter", "either" (or noise about one axis), or "none"
    jitter: float  # us; for "none" the largest that noise may hide


def measure_clock(estimates: Estimates, truth: Truth, source: str, model: str = "none") -> Clock:
    """Return the clock of estimates; the rotations of the model (of `--aligned`) are fitted too."""
    run = truth.select(estimates)
    _demand_enough(len(run), source)
    # In the middle delay and rate are independent: at an end the delay is half as sure.
    middle = int(run.stamps[0]) // 2 + int(run.stamps[-1]) // 2
    fitted = align(estimates, truth, f"{model.partition('+')[0]}+delay+clock", middle)
    left, directions, stamps = _find_left(fitted.offset, truth, run)
    _demand_enough(len(left), source)
    kind, jitter = _find_jitter(left, *directions)
    seconds = float(stamps[-1] - stamps[0]) * 1e-9
    delay, rate = fitted.deviations or (RESOLUTION, RESOLUTION / seconds)
    return Clock(
        source=source,
        estimates=len(left),
        independent=fitted.independent or float(len(left)),
        correlation_time=fitted.correlation_time,
        delay=1e6 * fitted.offset.delay,
        delay_deviation=None if fitted.fault else 1e6 * delay,
        rate=1e6 * fitted.offset.clock,
        rate_deviation=None if fitted.fault else 1e6 * rate,
        fault=fitted.fault,
        kind=kind,
        jitter=1e6 * jitter,
    )


def _demand_enough(count: int, source: str) -> None:
    if count < FEWEST:
        raise RefusedError(f"{source} must have {FEWEST} estimates that can be judged, got {count}")


def _find_left(
    offset: Offset, truth: Truth, run: Estimates
) -> tuple[Real, tuple[Real, Real], Stamps]:
    """Return the rotations that are left, angular velocities and body axes, and stamps.

    All of them are in the world, (n, 3).
    """
    exact, rates, known = truth.states_at(offset.shift(run.stamps), run.of_sensor)
    run, exact, rates = run.select(known), exact[known], rates[known]
    turned = compose(offset.turn_world(run.stamps), exact)
    left = compose(run.orientations, invert(compose(turned, offset.turn_body(run.stamps))))
    to_world = to_rotation(turned)
    directions = to_world.apply(rates), to_world.apply([0.0, 0.0, 1.0])
    return find_rotation_vectors(left), directions, run.stamps


def _find_jitter(left: Real, omega: Real, axes: Real) -> tuple[str, float]:
    """Return "jitter" and its size (s), or "none" and the largest that noise may hide.

    It is "either" if noise about the vertical or the axis of the body explains as much: a fast top
    turns about its axis.

    The variance of the jitter is found by least squares from along - across = square * variance.
    Its deviation comes from the residuals, with their correlations.
    """
    square = (omega**2).sum(axis=1)
    along = (left * omega).sum(axis=1) ** 2 / np.where(square > 0, square, 1.0)
    across = ((left**2).sum(axis=1) - along) / 2
    weight = float((square**2).sum()) or 1.0
    variance = float((square * (along - across)).sum()) / weight
    rest = square * (along - across - square * variance)
    deviation = math.sqrt(len(rest) * sum_lags(rest)) / weight
    others = left[:, 2] ** 2, (left * axes).sum(axis=1) ** 2
    least = min(_measure_excess(along - each) for each in others)
    if least > -SIGNIFICANT and variance > max(SIGNIFICANT * deviation, RESOLUTION**2):
        return "jitter" if least > SIGNIFICANT else "either", math.sqrt(variance)
    return "none", math.sqrt(max(variance, 0.0) + SIGNIFICANT * deviation + RESOLUTION**2)


def _measure_excess(differences: Real) -> float:
    """Return the sum of differences, divided by its standard deviation."""
    spread = math.sqrt(len(differences) * sum_lags(differences - differences.mean()))
    return float(differences.sum()) / (spread or 1.0)


def format_clocks(clocks: list[Clock]) -> str:
    """Return a sentence for each clock."""
    records = (
        {
            "source": clock.source,
            "estimates": clock.estimates,
            "delay": format_measured(clock.delay, clock.delay_deviation),
            "rate": format_measured(clock.rate, clock.rate_deviation),
            "fault": _write_fault(clock),
            "jitter": {"kind": clock.kind, "value": clock.jitter},
        }
        for clock in clocks
    )
    return "\n".join(write("clock_of_stamps", record) for record in records)


def _write_fault(clock: Clock) -> dict[str, Any] | None:
    counted = {**asdict(clock), "independent": round(clock.independent), "kind": clock.fault}
    return counted if clock.fault else None
