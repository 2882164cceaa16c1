"""The sensor on the top and the odometry: exact numbers, and noise with the figures asked for."""

import math
from dataclasses import replace

import numpy as np
import pytest
from physics.tops import ARTICLE, CUSPS, EPS
from run.simulation.runs import SECOND, Run
from scipy.spatial.transform import Rotation

from symtop_ros.physics import Body, Motion, State, Top, point_acceleration
from symtop_ros.run.session.outputs import list_fixed_frames
from symtop_ros.run.simulation.segment import Segment
from symtop_ros.run.simulation.sensor.imu import (
    CONSUMER,
    DEFAULT_GRAVITY,
    EARTH,
    EXACT,
    EXACT_FIELD,
    LIMITS,
    MAGNETOMETER_NOISE,
    NOISE,
    Imu,
    Magnetometer,
    Rig,
)
from symtop_ros.run.simulation.sensor.noise import random_walks
from symtop_ros.run.simulation.topics import SENSOR_TOPICS, STATE_TOPICS, Samples

pytestmark = pytest.mark.numbers

MOTION = Motion(ARTICLE, CUSPS)
MOUNT = Rotation.from_euler("xyz", (0.3, -1.1, 2.0))
PLACE = (0.01, -0.02, 0.05)
NOISY = Imu(PLACE, tuple(MOUNT.as_quat().tolist()), 2e-3, 3e-4, 0.02, 0.005, seed=11, rate=400.0)
STAMPS = np.arange(40) * 2_500_000 + 7 * SECOND


def segment_of(imu=None, motion=MOTION, **changes):
    return replace(Segment.begin(motion, 0, 1.0, Rig(9.81, imu)), **changes)


def measured(topic, segment, stamps=STAMPS):
    return SENSOR_TOPICS[topic].compute(Samples.at(segment, stamps))


def test_an_exact_sensor_has_the_attitude_the_rates_and_the_force_of_its_place():
    imu = Imu(PLACE, tuple(MOUNT.as_quat().tolist()))
    segment = segment_of(imu)
    numbers = measured("imu", segment)
    state = segment.state_at(STAMPS)
    body = Rotation.from_quat(state.orientation[:, [1, 2, 3, 0]])
    found = Rotation.from_quat(numbers[:, :4])
    assert (found * (body * MOUNT).inv()).magnitude().max() < 8 * EPS
    rates = MOUNT.inv().apply(state.angular_velocity.copy())
    assert np.abs(numbers[:, 13:16] - rates).max() < 8 * EPS * 200
    acceleration = body.apply(point_acceleration(MOTION, state, PLACE)) + np.array((0, 0, 9.81))
    force = (body * MOUNT).inv().apply(acceleration)
    # 200 rad/s at 0.02 m are 900 m/s^2
    assert np.abs(numbers[:, 25:28] - force).max() < 8 * EPS * np.abs(force).max()
    for first in (4, 16, 28):
        assert (numbers[:, first : first + 9] == EXACT * np.eye(3).reshape(-1)).all()


def test_odometry_is_the_motion_of_the_centre_of_mass():
    segment = segment_of()
    step = 1000  # ns
    numbers = measured("odometry", segment)
    body, state = Body.from_top(ARTICLE), segment.state_at(STAMPS)
    assert np.abs(numbers[:, :3] - body.centre_of_mass(state)).max() < 2 * EPS * body.arm
    later, before = (measured("odometry", segment, STAMPS + sign * step)[:, :3] for sign in (1, -1))
    velocity = (later - before) / (2 * step * 1e-9)
    ours = state.to_world(numbers[:, 43:46])
    # 1e-6 s of 200 rad/s give a third derivative of 2e-4^2/6; rounding of places, 1e-18/1e-6
    assert np.abs(ours - velocity).max() < 1e-7 * np.abs(ours).max()
    assert (numbers[:, 46:49] == state.angular_velocity).all()
    assert (numbers[:, 3:7] == state.orientation[:, [1, 2, 3, 0]]).all()


def test_a_force_that_needs_a_body_is_nan_without_one():
    flat = Motion(Top(1.0, 2.0, 1.0), State.from_euler(theta=0.5, psi_dot=2.0))
    wrench = STATE_TOPICS["torque"].compute
    assert np.isnan(wrench(Samples.at(segment_of(motion=flat), 5))[:3]).all()
    assert np.isnan(measured("odometry", segment_of(motion=flat))[:, :3]).all()


def test_white_noise_has_the_density_asked_for_and_none_knows_another():
    white = replace(NOISY, gyroscope_random_walk=0.0, accelerometer_random_walk=0.0)
    white = replace(white, magnetometer=Magnetometer(EARTH, 6e-8, seed=NOISY.seed))
    stamps = np.arange(20_000) * 2_500_000
    _, field = white.measure_field(segment_of(white).state_at(stamps), stamps)
    errors = np.concatenate((white.noise(stamps), field), axis=1)
    for first, density in ((0, 2e-3), (3, 0.02), (6, 6e-8)):
        spread = errors[:, first : first + 3].std(axis=0)
        # 20 000 numbers: half a per cent, four sigma
        assert spread == pytest.approx(np.full(3, density * math.sqrt(400.0)), rel=0.02)
    assert white.magnetometer.variance(400.0) == pytest.approx(spread[0] ** 2, rel=0.04)
    assert np.abs(np.corrcoef(errors.T) - np.eye(9)).max() < 4 / math.sqrt(20_000)
    # neighbours in time do not know each other
    assert abs(np.corrcoef(errors[1:, 0], errors[:-1, 0])[0, 1]) < 4 / math.sqrt(20_000)
    assert np.abs(errors[:, 0] / errors[:, 0].std()).max() < 6


@pytest.mark.parametrize("spacing", [2_500_000, SECOND, 100 * SECOND, 3600 * SECOND])
def test_a_random_walk_grows_by_the_root_of_time(spacing):
    (walk,) = random_walks(5, [2], np.arange(4000) * spacing)
    steps = np.diff(walk)
    size = math.sqrt(spacing * 1e-9)
    assert steps.std() == pytest.approx(size, rel=0.05)  # 4000 numbers: 1.1 %, four sigma
    assert abs(np.corrcoef(steps[1:], steps[:-1])[0, 1]) < 4 / math.sqrt(4000)
    assert walk[0] == 0.0
    assert random_walks(5, [2], np.array([-5, 0])).tolist() == [[0.0, 0.0]]


def test_noise_depends_on_the_seed_and_the_stamp_only():
    errors = NOISY.noise(STAMPS)
    assert (errors == NOISY.noise(STAMPS[::-1])[::-1]).all()
    assert (errors != replace(NOISY, seed=12).noise(STAMPS)).all()


def test_noise_has_the_values_that_it_had_in_logs_of_before():
    stamp = np.array([7 * SECOND])
    # the logarithm in the inverse of the normal distribution may differ in its last bits
    within = {"rel": 1e-12}
    white = replace(NOISY, gyroscope_random_walk=0.0, accelerometer_random_walk=0.0)
    gyroscope = [0.006015341648823625, -0.036003598188738904, -0.01871372888514022]
    accelerometer = [-0.13606311253896938, -0.4890352087910973, 0.060353280564874795]
    assert white.noise(stamp)[0].tolist() == pytest.approx([*gyroscope, *accelerometer], **within)
    walks = [0.006134343307703254, -0.03663529636966924, -0.01921767214655474]
    walks += [-0.11881259134568098, -0.4899157954420559, 0.04078434593768043]
    assert NOISY.noise(stamp)[0].tolist() == pytest.approx(walks, **within)
    later = random_walks(5, [2, 3], np.array([SECOND, 3600 * SECOND + 1])).ravel().tolist()
    known = [-0.0181971324128599, -53.8163166360681, -0.5371121175440042, 91.22892677461851]
    assert later == pytest.approx(known, **within)


BEYOND = [
    (Imu, "seed", (-1, 2**63), "0 to "),
    (Imu, "rate", (0.0, 1e7, math.nan), "0.001 to 1e\\+06 Hz"),
    (Magnetometer, "seed", (-1, 2**63), "0 to "),
    *((Imu, name, (-1e-9, 1.1e6, math.inf), "0 to 1e\\+06 in SI units") for name in NOISE),
    *((Imu, name, (-1e-9, 1.1e9, math.inf), "0 to 1e\\+09 in SI units") for name in LIMITS),
    *(
        (Magnetometer, name, (-1e-9, 1.1e6, math.inf), "0 to 1e\\+06 in SI units")
        for name in MAGNETOMETER_NOISE
    ),
]


@pytest.mark.parametrize(("kind", "name", "values", "condition"), BEYOND)
def test_a_number_out_of_the_range_of_a_sensor_is_refused_when_it_is_made(
    kind, name, values, condition
):
    for value in values:
        with pytest.raises(ValueError, match=f"^{name} must be {condition}.*, got "):
            kind(**{name: value})


def test_the_consumer_sensor_has_the_figures_of_its_data_sheet():
    """Bosch BMI088: 0.014 deg/s/sqrt(Hz), 175 ug/sqrt(Hz), and a bias stable to 2 deg/h."""
    noise = CONSUMER.gyroscope_noise_density, CONSUMER.accelerometer_noise_density
    # two digits of each, and one of the walks: half of the last one
    assert noise[0] == pytest.approx(math.radians(0.014), abs=0.5e-5)
    assert noise[1] == pytest.approx(175e-6 * DEFAULT_GRAVITY, abs=0.5e-4)
    assert CONSUMER.gyroscope_random_walk == pytest.approx(math.radians(2) / 3600, abs=0.5e-6)
    # The data sheet has no stability of the accelerometer: 1e-5 g in a second is usual.
    assert CONSUMER.accelerometer_random_walk == pytest.approx(1e-5 * DEFAULT_GRAVITY, abs=0.5e-5)


def test_noise_shows_in_the_covariances():
    numbers = measured("imu", segment_of(NOISY))
    assert numbers[0, 16] == pytest.approx((2e-3) ** 2 * 400, rel=4 * EPS)
    assert numbers[0, 28] == pytest.approx(0.02**2 * 400, rel=4 * EPS)
    assert numbers[0, 4] == EXACT  # the attitude is still exact


# 2000 deg/s are 34.9; both ends are multiples of the steps, which are powers of two
LIMITED = dict(zip(LIMITS, (34.875, 0.125, 400.0, 0.25), strict=True))


def test_a_sensor_shows_multiples_of_its_step_and_no_more_than_its_range():
    free = measured("imu", segment_of(NOISY))
    shown = measured("imu", segment_of(replace(NOISY, **LIMITED)))
    for first, end, step in ((13, 34.875, 0.125), (25, 400.0, 0.25)):
        values, exact = shown[:, first : first + 3], free[:, first : first + 3]
        assert (values % step == 0).all()
        assert (np.abs(values) <= end).all()
        within = np.abs(exact) < end
        assert within.any()
        assert not within.all()
        assert (np.abs(values - exact)[within] <= step / 2).all()
        assert (values[~within] == np.copysign(end, exact[~within])).all()


def test_rounding_is_in_the_covariances():
    numbers = measured("imu", segment_of(Imu(**LIMITED)))
    assert numbers[0, 16] == pytest.approx(0.125**2 / 12, rel=4 * EPS)
    assert numbers[0, 28] == pytest.approx(0.25**2 / 12, rel=4 * EPS)


def test_the_limits_of_a_sensor_are_in_the_event_of_a_run():
    rig = Rig(9.81, replace(NOISY, **LIMITED))
    assert Rig.from_values(rig.values) == rig
    assert "imu.limits" not in Rig(9.81, NOISY).values


def test_an_exact_magnetometer_has_the_field_of_the_world_in_its_frame():
    imu = replace(NOISY, magnetometer=Magnetometer((1e-5, 2e-5, -4e-5)))
    segment = segment_of(imu)
    numbers = measured("magnetic_field", segment)
    state = segment.state_at(STAMPS)
    body = Rotation.from_quat(state.orientation[:, [1, 2, 3, 0]])
    expected = (body * MOUNT).inv().apply((1e-5, 2e-5, -4e-5))
    assert np.abs(numbers[:, :3] - expected).max() < 8 * EPS * 5e-5
    assert (numbers[:, 3:] == EXACT_FIELD * np.eye(3).reshape(-1)).all()
    assert np.isnan(measured("magnetic_field", segment_of(replace(imu, magnetometer=None)))).all()


def test_noise_of_the_magnetometer_has_its_own_seed_and_a_random_walk():
    noisy = replace(NOISY, magnetometer=Magnetometer(EARTH, 6e-8, seed=NOISY.seed))
    other = replace(noisy, magnetometer=replace(noisy.magnetometer, seed=12))
    assert (other.noise(STAMPS) == noisy.noise(STAMPS)).all()
    walking = replace(noisy, magnetometer=Magnetometer(EARTH, 0.0, 1e-8, seed=12))
    exact, _ = noisy.measure_field(segment_of(noisy).state_at(STAMPS), STAMPS)
    numbers = measured("magnetic_field", segment_of(walking))
    walks = 1e-8 * random_walks(12, [15, 16, 17], STAMPS)
    assert numbers[:, :3] - exact == pytest.approx(walks.T, abs=4 * EPS * 5e-5)


def test_the_simulation_equips_its_motions_and_tells_of_its_frames():
    run = Run(**{"imu.enabled": True, "imu.position": list(PLACE), "odometry.enabled": True})
    settings = run.sink.descriptions[0]
    body = settings.body
    frames = list_fixed_frames(settings.top_frame, settings.imu, body)
    assert [each.child for each in frames] == ["top_imu", "top_centre_of_mass"]
    assert frames[0].translation == PLACE
    assert run.simulation.segment.rig.imu.position == PLACE
    run.change({"publish_rate": 50.0, "top.Mgl": 0.05})
    assert run.simulation.segment.rig.imu.rate == 50.0
    assert run.simulation.segment.motion.top.Mgl == 0.05
    only = Run(**{"magnetic_field.enabled": True, "imu.orientation": [0.0, 0.6, 0.0, 0.8]})
    (frame,) = list_fixed_frames("top", only.simulation.settings.imu, None)
    assert (frame.translation, frame.rotation) == ((0.0, 0.0, 0.0), (0.0, 0.6, 0.0, 0.8))
    assert list_fixed_frames("top", Run().simulation.settings.imu, None) == []
