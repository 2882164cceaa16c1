"""Claims on nutation: what swings with theta, and what happens at a cusp."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import brentq
from scipy.signal import find_peaks

from symtop_ros.physics import Motion
from symtop_ros.report.article.claim import Claim

Real = NDArray[np.float64]
SPAN = 10.0  # s
SAMPLES = 20_001  # two hundred in a nutation
ROUNDING = 1e-9  # of the values: less of a swing than that is none
VANISHED = 1e-12  # of the largest phi'


def horizontal_square(path: Motion, times: Real) -> Real:
    """L^2 - L_z'^2 (n,) in (N m s)^2, as the sum of squares that it is: nothing cancels."""
    horizontal = path.top.angular_momentum(path.at(times))[:, :2]
    return np.asarray((horizontal**2).sum(axis=1))


def maxima(values: Real) -> int:
    """Count the maxima that stand out by half of the whole swing, and from rounding."""
    swing, size = float(np.ptp(values)), float(np.abs(values).max())
    return len(find_peaks(values, prominence=max(swing / 2, ROUNDING * size))[0])


def momentum_swings_with_the_tilt(paths: Sequence[Motion]) -> Claim:
    """The squared horizontal part of L has as many maxima as theta."""
    times = np.linspace(0.0, SPAN, SAMPLES)
    nutations = [maxima(np.asarray(path.at(times).euler_angles.theta)) for path in paths]
    swings = [maxima(horizontal_square(path, times)) for path in paths]
    return Claim(
        "L^2 - L_z'^2 swings as often as the top nutates.",
        f"maxima in {SPAN:g} s of {len(paths)} motions: {', '.join(map(str, swings))}; of theta: "
        f"{', '.join(map(str, nutations))}",
        swings == nutations and min(swings) > 0,
    )


def precession_stops_at_the_cusps(path: Motion) -> Claim:
    """The precession rate vanishes where theta is smallest, and nowhere else."""
    sentence = "At cusps phi' vanishes exactly where theta is smallest, and nowhere else."
    tops = highest_points(path)
    if len(tops) < 2:
        return Claim(sentence, "theta has no minima", holds=False)
    at_cusps, elsewhere = path.at(tops), path.at(_between(tops))
    largest = np.abs(elsewhere.euler_rates.phi).max()
    stopped = np.abs(at_cusps.euler_rates.phi).max() / largest
    slowest = np.abs(elsewhere.euler_rates.phi).min() / largest
    smallest = np.max(at_cusps.euler_angles.theta) < np.min(elsewhere.euler_angles.theta)
    return Claim(
        sentence,
        f"at {len(tops)} minima of theta phi' is at most {stopped:.0e} of its largest, "
        f"{largest:.3g} rad/s; a hundredth of a nutation away and more, it is at least "
        f"{slowest:.0e} of that",
        bool(stopped < VANISHED < slowest and smallest),
    )


def highest_points(path: Motion) -> Real:
    """Times (n,) in s within ten seconds at which theta' goes up through zero."""
    times = np.linspace(0.0, SPAN, SAMPLES)[1:]
    rates = np.asarray(path.at(times).euler_rates.theta)
    rising = np.flatnonzero((rates[:-1] < 0) & (rates[1:] >= 0))
    return np.array([_turn(path, times[k], times[k + 1]) for k in rising])


def _turn(path: Motion, before: float, after: float) -> float:
    """Time in s between two at which theta' is zero."""
    return brentq(lambda t: float(path.at(t).euler_rates.theta), before, after, xtol=1e-15)


def _between(times: Real) -> Real:
    """Hundredths of the way from each time to the next, without the times themselves."""
    steps = np.linspace(0.01, 0.99, 99)
    return np.asarray((times[:-1, None] + np.diff(times)[:, None] * steps).ravel())
