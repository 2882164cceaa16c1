"""Measurements of an inertial sensor on a top, at instants or as means over sample intervals."""

import math
from dataclasses import dataclass
from fractions import Fraction

import numpy as np

from symtop_ros.arrays import Real, Stamps
from symtop_ros.physics import STANDARD_GRAVITY, ExactTimes, Motion, State
from symtop_ros.simulation.events import Event, start_event
from symtop_ros.simulation.sensor.imu import Imu, Rig
from symtop_ros.simulation.validation import RefusedError, number
from symtop_ros.wire.layout import NANOSECONDS

MAX_SECONDS, MAX_SAMPLES = 1e9, 20_000_000
# Points of Gauss and Legendre in an interval: for each rad by which the integrand turns in it, and
# for an interval without any turn. The error is then below 1e-20.
POINTS_PER_RAD, FEWEST_POINTS = 1.0, 10


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
        Of the sensor in the world frame, from the pivot, in m and m/s.
    rates, forces : ndarray (n, 3)
        Exact angular velocity in rad/s and specific force in m/s^2, in the sensor frame.
    means : ndarray (n, 6) or None
        Exact means of both over the interval of length 1/rate that ends at the stamp.
    biases : ndarray (n, 6)
        Biases of the gyroscope and the accelerometer.
    measured : ndarray (n, 6)
        Rates and forces (their means, if there are means) with biases and noise.
    fields, measured_fields : ndarray (n, 3) or None
        Exact and measured magnetic field in T, in the sensor frame.
    event : Event
        From which the run can be computed again; it names motion, gravity and sensor.
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
    gravity: float = STANDARD_GRAVITY,
    average: bool = False,
) -> ImuRecord:
    """Return what a sensor measures from the start of a motion on.

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
        True for a sensor that integrates: measurements are means over the interval of length
        1/rate that ends at the stamp.

    Raises
    ------
    ValueError
        If a number is refused.

    Examples
    --------
    >>> from dataclasses import replace
    >>> from symtop_ros.imu import CONSUMER, record_imu
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
    means = _average(motion, imu, stamps, state, gravity) if average else None
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
        exact + imu.noise(stamps),
        fields,
        measured_fields,
        start_event(motion, Rig(gravity, imu)),
    )


def _make_stamps(rate: float, seconds: float) -> Stamps:
    count = math.floor(seconds * rate * (1 + 1e-12)) or 1
    if count > MAX_SAMPLES:
        raise RefusedError(f"seconds times rate must be at most {MAX_SAMPLES}, got {count}")
    return np.asarray(np.rint(np.arange(count) * (NANOSECONDS / rate)).astype(np.int64))


def _average(motion: Motion, imu: Imu, stamps: Stamps, state: State, gravity: float) -> Real:
    """Return the means (n, 6) of rates and forces, by the quadrature of Gauss and Legendre."""
    interval = NANOSECONDS / imu.rate
    fastest = float(np.linalg.norm(state.angular_velocity, axis=1).max())
    fastest += math.sqrt(abs(motion.top.Mgl) / motion.top.Ix)  # of a pendulum that starts at rest
    turn = 2 * fastest / imu.rate  # forces turn twice as fast as the top
    points, weights = np.polynomial.legendre.leggauss(
        FEWEST_POINTS + math.ceil(POINTS_PER_RAD * turn)
    )
    total = np.zeros((len(stamps), 6))
    for point, weight in zip(points.tolist(), weights.tolist(), strict=True):
        # The times are exact: a double of s is off by 4e-15 s after 20 s, 8e-13 rad at 200 rad/s.
        times = ExactTimes(stamps, 1.0, Fraction(interval * (point - 1) / 2))
        _, rates, forces = imu.measure(motion, motion.at(times), gravity)
        total += weight / 2 * np.concatenate((rates, forces), axis=1)
    return total
