"""Measurements of the sensor, compared with 50 digits."""

from dataclasses import replace

import numpy as np
import pytest
from mpmath import mp, mpf
from physics.test_body import differentiate
from physics.tops import ARTICLE, CUSPS, Case, cross, turn

from symtop_ros.imu import CONSUMER, Imu, record_imu
from symtop_ros.physics import Motion

MOTION = Motion(ARTICLE, CUSPS)
GRAVITY = 9.81
PLACE = (0.01, -0.005, 0.02)
SENSOR = Imu(PLACE, rate=1000.0)


def state_at(t):
    return Case(ARTICLE, CUSPS, t).exact


def force_at(t):
    """Specific force in the body frame, from differences of places with 50 digits."""
    q, _ = state_at(t)
    with mp.workdps(50):
        acceleration = differentiate(lambda dt: state_at(mpf(t) + dt)[0], PLACE, 2.0**-21)
        total = [*acceleration[:2], acceleration[2] + mpf(GRAVITY)]
        return turn((q[0], -q[1], -q[2], -q[3]), total)


@pytest.mark.parametrize("sample", [0, 777, 19_999])
def test_the_record_agrees_with_differences_of_50_digits(sample):
    record = record_imu(MOTION, SENSOR, 20.0)
    with mp.workdps(50):
        t = mpf(int(record.stamps[sample])) / 10**9
    q, omega = state_at(t)
    pairs = (
        (record.orientations, q),
        (record.positions, turn(q, [mpf(p) for p in PLACE])),
        (record.velocities, turn(q, cross(omega, [mpf(p) for p in PLACE]))),
        (record.rates, omega),
        (record.forces, force_at(t)),
    )
    for ours, exact in pairs:
        size = max(abs(float(x)) for x in exact)
        error = np.abs(ours[sample] - [float(x) for x in exact]).max() / size
        assert error < 4e-16  # the rounding of the state, and of a product


@pytest.mark.parametrize(
    ("rate", "points"), [(1000.0, 9), pytest.param(30.0, 22, marks=pytest.mark.long)]
)  # 1e-18 of the integrals
def test_means_are_the_integrals_over_the_interval(rate, points):
    record = record_imu(MOTION, replace(SENSOR, rate=rate), 1.0, average=True)
    k = 7
    points, weights = np.polynomial.legendre.leggauss(points)
    mean = np.zeros(6)
    for point, weight in zip(points.tolist(), weights.tolist(), strict=True):
        with mp.workdps(50):
            t = mpf(int(record.stamps[k])) / 10**9 + (mpf(point) - 1) / (2 * mpf(rate))
        values = [*state_at(t)[1], *force_at(t)]
        mean += weight / 2 * np.array([float(x) for x in values])
    for part in (slice(0, 3), slice(3, 6)):
        scale = np.abs(record.means[:, part]).max()
        assert (
            np.abs(record.means[k, part] - mean[part]).max() / scale < 4e-16
        )  # the same, of a sum with positive weights
    assert (record.measured == record.means).all()


def test_noise_depends_on_seed_and_stamp_alone():
    sensor = replace(CONSUMER, rate=1000.0, seed=3)
    long, short = (record_imu(MOTION, sensor, seconds) for seconds in (1.0, 0.5))
    assert (long.measured[:500] == short.measured).all()
    errors = long.measured[:, :3] - long.rates
    # 3000 normal numbers: 1.3 %, four sigma
    assert errors.std() == pytest.approx(2.4e-4 * np.sqrt(1000.0), rel=0.055)
    other = record_imu(MOTION, replace(sensor, seed=4), 0.5)
    assert (other.measured != short.measured).all()


@pytest.mark.parametrize(
    ("changes", "reason"),
    [
        ({"rate": 0.0}, "rate must be 0.001 to 1e\\+06 Hz, got 0"),
        ({"rate": float("nan")}, "rate must be"),
        ({"position": (0, 0)}, "position must have 3 elements"),
        ({"orientation": (0, 0, 0, 0)}, "orientation must be a quaternion of norm 1"),
        ({"seed": -1}, "seed must be"),
        ({"gyroscope_random_walk": -1.0}, "gyroscope_random_walk must be"),
        ({"seconds": 0.0}, "seconds must"),
        ({"seconds": 1e9}, "seconds times"),
    ],
)
def test_a_sensor_or_a_length_that_cannot_be_is_refused(changes, reason):
    arguments = {"seconds": 1.0, **changes}
    seconds = arguments.pop("seconds")
    with pytest.raises(ValueError, match=reason):
        record_imu(MOTION, replace(SENSOR, **arguments), seconds)
