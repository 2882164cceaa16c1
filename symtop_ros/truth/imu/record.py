"""Measurements of an inertial sensor on a top, at instants or as means over sample intervals."""

import math
from dataclasses import dataclass
from fractions import Fraction
from itertools import product

import numpy as np

from symtop_ros.base.arrays import Real, Stamps
from symtop_ros.base.refusals import RefusedError, number, refuse
from symtop_ros.physics import DEFAULT_GRAVITY, ExactTimes, Motion
from symtop_ros.run.simulation.events import Event, start_event
from symtop_ros.run.simulation.sensor.imu import Imu, Rig
from symtop_ros.run.wire.layout import NANOSECONDS

MAX_SECONDS, MAX_SAMPLES = 1e9, 20_000_000
# Means are computed by Gauss-Legendre quadrature, in stretches of at most so many rad of F. F is
# the sum of the largest rates on the way: omega_xy, omega_z, and sqrt(2 |Mgl|/Ix) for the weight.
# At complex times up to 1.2/F from the real ones A, B and omega are regular: Gronwall's lemma for
# their equations (docs/derivation.md, section 1), whatever shares of F the three rates have, leaves
# |omega| < 1.7 F and |A|^2 + |B|^2 < 4.2, and so a specific force below 12 (F^2 d + g) with the
# distance d of the sensor and gravity g. Then n + 1 points err by less than half of 64/15 * 12 (F^2
# d + g) rho^(-2 n)/(1 - rho^-2) (Trefethen, Is Gauss quadrature better than Clenshaw-Curtis?,
# theorem 4.5), with the sum rho of the half axes of the ellipse around a stretch that reaches so
# far. With LOST = ln(3e18) this is 1e-17 (F^2 d + g).
LONGEST_STRETCH, REGULAR, LOST = 2.0, 1.2, 43.0
MAX_STATES = 10**9  # of a record of means: some minutes


@dataclass(frozen=True, eq=False)
class ImuRecord:
    """Exact truth and measurements of a sensor, with n samples.

    Attributes
    ----------
    imu : Imu
    stamps : ndarray (n,) of int64
        In ns; the first is 0.
    attitudes : ndarray (n, 4)
        Exact attitude w, x, y, z, body to world.
    orientations : ndarray (n, 4)
        Exact attitude w, x, y, z, sensor to world.
    positions, velocities : ndarray (n, 3)
        Position and velocity of the sensor, from the pivot, in the world frame, in m and m/s.
    rates, forces : ndarray (n, 3)
        Exact angular velocity in rad/s and specific force in m/s^2, in the sensor frame.
    means : ndarray (n, 6) or None
        Exact means of rates and forces over the interval of length 1/rate that ends at the stamp;
        None without `average`.
    biases : ndarray (n, 6)
        Biases of the gyroscope and the accelerometer.
    measured : ndarray (n, 6)
        Rates and forces (their means, if there are means) with biases and noise, within the limits
        of the sensor.
    fields, measured_fields : ndarray (n, 3) or None
        Exact and measured magnetic field in T, in the sensor frame.
    event : Event
        The event from which the run can be computed again: motion, gravity and sensor.
    """

    imu: Imu
    stamps: Stamps
    attitudes: Real
    orientations: Real
    positions: Real
    velocities: Real
    rates: Real
    forces: Real
    means: Real | None
    biases: Real
    measured: Real
    fields: Real | None
    measured_fields: Real | None
    event: Event


def record_imu(
    motion: Motion,
    imu: Imu,
    seconds: float,
    *,
    gravity: float = DEFAULT_GRAVITY,
    average: bool = False,
) -> ImuRecord:
    """Return the measurements of a sensor from the start of a motion on.

    Parameters
    ----------
    motion : Motion
    imu : Imu
        Its rate is that of the samples; stamps are whole ns.
    seconds : float
        Length of the record in s, > 0.
    gravity : float
        Acceleration of gravity in m/s^2.
    average : bool
        True for a sensor that integrates: measurements are means over the interval of length 1/rate
        that ends at the stamp. The error of the quadrature is below 1e-17 of F^2 d + gravity, where
        d is the distance of the sensor from the pivot, and F the sum of the largest rates in the
        interval. The rounding errors of the states come on top.

    Raises
    ------
    ValueError
        If a number is refused.

    Examples
    --------
    >>> from dataclasses import replace
    >>> from symtop_ros.truth.imu import CONSUMER, record_imu
    >>> from symtop_ros.physics import Motion, State, Top
    >>> top = Top(Ix=0.000228, Iz=0.0000572, Mgl=0.068)
    >>> motion = Motion(top, State.from_euler(theta=0.5, psi_dot=200.0))
    >>> sensor = replace(CONSUMER, position=(0, 0, 0.02), rate=1000)
    >>> record = record_imu(motion, sensor, seconds=20)
    >>> record.measured.shape, record.stamps[:2].tolist()
    ((20000, 6), [0, 1000000])
    """
    stamps = _make_stamps(imu.rate, number("seconds", seconds, "s", 1e-9, MAX_SECONDS))
    number("gravity", gravity, "m/s^2", 1e-3, 1e3)
    state = motion.at(ExactTimes(stamps))
    orientations, rates, forces = imu.measure(motion, state, gravity)
    means = _average(motion, imu, stamps, gravity) if average else None
    exact = np.concatenate((rates, forces), axis=1) if means is None else means
    fields = measured_fields = None
    if imu.magnetometer:
        fields, errors = imu.measure_field(state, stamps)
        measured_fields = fields + errors
    return ImuRecord(
        imu,
        stamps,
        state.orientation,
        orientations[:, [3, 0, 1, 2]],
        state.to_world(imu.position),
        state.to_world(np.cross(state.angular_velocity, imu.position)),
        rates,
        forces,
        means,
        imu.biases(stamps),
        imu.show(exact, stamps),
        fields,
        measured_fields,
        start_event(motion, Rig(gravity, imu)),
    )


def _make_stamps(rate: float, seconds: float) -> Stamps:
    count = math.floor(seconds * rate * (1 + 1e-12)) or 1
    if count > MAX_SAMPLES:
        raise RefusedError(f"seconds times rate must be at most {MAX_SAMPLES}, got {count}")
    return np.asarray(np.rint(np.arange(count) * (NANOSECONDS / rate)).astype(np.int64))


def _average(motion: Motion, imu: Imu, stamps: Stamps, gravity: float) -> Real:
    """Return the means (n, 6) of rates and forces, right to rounding."""
    interval = NANOSECONDS / imu.rate
    fastest = _find_fastest(motion, stamps, interval)
    stretches, points, weights = _choose_nodes(fastest / imu.rate, len(stamps))
    total, lost = np.zeros((2, len(stamps), 6))
    for stretch, (point, weight) in product(
        range(stretches), list(zip(points.tolist(), weights.tolist(), strict=True))
    ):
        place = (stretch + (point + 1) / 2) / stretches
        # The times are exact: a double of s is off by 4e-15 s after 20 s, 8e-13 rad at 200 rad/s.
        times = ExactTimes(stamps, 1.0, Fraction(interval * (place - 1)))
        _, rates, forces = imu.measure(motion, motion.at(times), gravity)
        part = weight / (2 * stretches) * np.concatenate((rates, forces), axis=1)
        # Knuth's two-sum: of thousands of points the rounding would add up.
        before, total = total, total + part
        taken = total - before
        lost += (before - (total - taken)) + (part - taken)
    return total + lost


def _choose_nodes(turn: float, count: int) -> tuple[int, Real, Real]:
    """Return the number of stretches of an interval of `turn` rad; nodes of each, and weights."""
    stretches = max(1, math.ceil(turn / LONGEST_STRETCH))
    height = 2 * REGULAR * stretches / turn if turn else math.inf  # of the ellipse, in half widths
    points = 1 + math.ceil(LOST / 2 / math.asinh(min(height, 1e6)))  # asinh(height) is ln(rho)
    if (states := count * stretches * points) > MAX_STATES:
        raise refuse("number of states for the means", f"at most {MAX_STATES:g}", states)
    return stretches, *np.polynomial.legendre.leggauss(points)


def _find_fastest(motion: Motion, stamps: Stamps, interval: float) -> float:
    """Return a bound on the sum of the rates in rad/s, anywhere on the way."""
    if motion.is_driven:
        return _find_fastest_driven(motion, stamps, interval)
    Ix, _, Mgl = motion.top.moments
    # omega_xy is largest where the weight is lowest: at a turning point.
    fall = max(Mgl * (motion.start.vertical[2] - np.cos(each)) for each in motion.turning_angles)
    x, y, z = motion.start.angular_velocity.tolist()
    across = math.sqrt(x * x + y * y + 2 / Ix * max(float(fall), 0.0))
    return float(across + abs(z) + math.sqrt(2 * abs(Mgl) / Ix))


def _find_fastest_driven(motion: Motion, stamps: Stamps, interval: float) -> float:
    """Return such a bound with friction, which only slows the top, and a torque.

    The root of twice the energy above its minimum grows by at most |torque|/sqrt(I) in a second.
    """
    Ix, Iz, Mgl = motion.top.moments
    begun = motion.at(ExactTimes(stamps, 1.0, Fraction(-interval)))
    momentum = motion.top.body_angular_momentum(begun)
    twice = float((momentum * begun.angular_velocity).sum(axis=-1).max()) + 4 * abs(Mgl)
    torque = math.hypot(*motion.applied_torque)
    least = min(Ix, Iz)
    energy = math.sqrt(twice) + torque / math.sqrt(least) * interval / NANOSECONDS
    drive = float(motion.friction._find_decay(motion.top)) + math.sqrt(2 * torque / least)
    rates = energy * (1 / math.sqrt(Ix) + 1 / math.sqrt(Iz))
    return float(rates + math.sqrt(2 * abs(Mgl) / Ix) + drive)
