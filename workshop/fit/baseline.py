"""Fits without `top_fit`: integrated equations, least squares, and whole derivatives."""

import time
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from scipy.integrate import solve_ivp
from scipy.optimize import least_squares

from symtop_ros.base.arrays import Real
from symtop_ros.truth.fit import fit_motion
from symtop_ros.truth.fit.body_starts import find_nutation
from symtop_ros.truth.fit.model import Model, find_axis
from symtop_ros.truth.fit.starts import fill
from workshop.fit.records import Sample, draw_sample

RECORDS = 20
CLOSE = 1.1  # times the noise of the record; a fit with smaller residuals is a success
TOLERANCE, MOST = 1e-8, 100  # of the integration; evaluations, of which each has seven
ROUNDS, TIMES = 100, 119  # of derivatives
FAR = 10.0  # a residual of parameters without a motion


@dataclass(frozen=True)
class Row:
    """CPU time in s and success, without and with `top_fit`."""

    plain_seconds: float
    plain: bool
    seconds: float
    found: bool


def integrate(x: Real, times: Real) -> Real:
    """Return the axes (n, 3) by the equations of the Euler angles; x: Mgl, p_psi, start."""
    weight, p = x[:2]

    def derive(_: float, y: Real) -> list[float]:
        theta, _, tilting, turning = y
        sin, cos = np.sin(theta), np.cos(theta)
        tilt = sin * cos * turning**2 - p * sin * turning + weight * sin
        return [tilting, turning, tilt, (p * tilting - 2 * turning * tilting * cos) / sin]

    found = solve_ivp(
        derive, (0.0, times[-1]), x[2:], t_eval=times, rtol=TOLERANCE, atol=TOLERANCE / 100
    )
    theta, phi = found.y[:2]
    return np.stack([np.sin(theta) * np.sin(phi), -np.sin(theta) * np.cos(phi), np.cos(theta)], 1)


def guess(times: Real, axes: Real) -> Real:
    """Return the guess of a textbook: nutation p_psi/Ix, precession Mgl/p_psi."""
    theta = np.arccos(np.clip(axes[:, 2], -1, 1))
    phi = np.unwrap(np.arctan2(axes[:, 0], -axes[:, 1]))
    p, turning = find_nutation(times, theta), float(np.polyfit(times, phi, 1)[0])
    rates = (theta[3] - theta[0]) / times[3], (phi[3] - phi[0]) / times[3]
    return np.array([p * turning, p, theta[0], phi[0], *rates])


def fit_plainly(times: Real, axes: Real) -> float:
    """Return the root mean square of what the integrated motion leaves."""

    def find(x: Real) -> Real:
        try:
            left = integrate(x, times) - axes
        except ValueError:  # the integration stopped at a pole
            return np.full(axes.size, FAR)
        return left.ravel() if np.isfinite(left).all() else np.full(axes.size, FAR)

    found = least_squares(find, guess(times, axes), x_scale="jac", max_nfev=MOST)
    return float(np.sqrt((found.fun**2).mean()))


def compare(sample: Sample) -> Row:
    """Return what both make of a record of the axis with white noise."""
    record, clock = sample.record, time.process_time
    exact = find_axis(sample.motion.at(record.times).orientation)
    noise = float(np.sqrt(((record.values - exact) ** 2).mean()))
    began = clock()
    with np.errstate(all="ignore"):
        plain = fit_plainly(record.times, record.values)
    middle = clock()
    left = fit_motion(record).residuals
    own = float(np.sqrt((left**2).mean()))
    return Row(middle - began, plain < CLOSE * noise, clock() - middle, own < CLOSE * noise)


def list_seeds(count: int) -> list[int]:
    """Return seeds of records without friction, which the equations here lack."""
    samples = ((seed, draw_sample("axis", "white", seed)) for seed in range(2 * count))
    return [seed for seed, each in samples if not each.record.has_friction][:count]


def compare_all(count: int = RECORDS) -> list[Row]:
    """Return what both make of some records."""
    return [compare(draw_sample("axis", "white", seed)) for seed in list_seeds(count)]


def compare_derivatives(rounds: int = ROUNDS) -> tuple[float, float]:
    """Return the CPU times in s of the derivatives of a fit, and of `Motion.jacobian`, in pairs.

    Both are medians, at the same times of one motion.
    """
    sample = draw_sample("axis", "white", 0)
    model = Model(sample.record.select(slice(TIMES)), sample.motion.start.orientation)
    motion, t = sample.motion, model.record.times
    start = motion.start.angular_velocity
    named = {"Mgl/Ix": motion.top.Mgl, "p_psi/Ix": motion.top.Iz * start[2]}
    x = fill(model, {**named, "wx": start[0], "wy": start[1]})
    pairs = [
        (_time(lambda: model.find_jacobian(x)), _time(lambda: motion.jacobian(t)))
        for _ in range(rounds)
    ]
    own, whole = np.median(pairs, axis=0)
    return float(own), float(whole)


def _time(action: Callable[[], object]) -> float:
    began = time.process_time()
    action()
    return time.process_time() - began
