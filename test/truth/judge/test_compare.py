"""The exact motion of a run, errors of estimates, and the rotations and delay behind them."""

import json
import math
import signal
from dataclasses import asdict, replace

import numpy as np
import pytest
from physics.tops import ARTICLE, CUSPS, EPS, SLOW, precess
from programs import judge_live, running, running_node
from scipy.spatial.transform import Rotation
from trials import seeds
from truth.judge.cases import SECOND, Made, make_estimates, make_events, truth_and_stamps
from waiting import TIMEOUT

from symtop_ros.base.refusals import RefusedError
from symtop_ros.physics import Motion
from symtop_ros.run.simulation.changes.follow import Act, Change
from symtop_ros.run.simulation.changes.requests import start_motion
from symtop_ros.run.simulation.events import Event, start_event
from symtop_ros.run.simulation.segment import Segment
from symtop_ros.run.simulation.sensor.imu import Imu, Rig
from symtop_ros.run.simulation.settings import Settings
from symtop_ros.run.simulation.topics import SENSOR_TOPICS, Samples
from symtop_ros.run.wire.messages import IMU
from symtop_ros.truth.judge.compare import compare
from symtop_ros.truth.judge.judgement import judge
from symtop_ros.truth.judge.named_causes import explain
from symtop_ros.truth.judge.truth import Truth, read_events, scene_truth
from symtop_ros.truth.topics.estimates import Estimates
from workshop.load.domains import share_domain


def test_the_attitude_of_a_stamp_is_that_of_the_last_event():
    events = make_events()
    for event in events:
        stamps = np.array([event.stamp, event.stamp + SECOND // 2])
        found = Truth(events).states_at(stamps)[0]
        expected = event.segment().state_at(stamps)
        assert (found == expected.orientation).all()


def test_stamps_before_the_run_are_unknown():
    estimates = Estimates.of([5, SECOND], [[1.0, 0, 0, 0]] * 2)
    for events, early in ((make_events(), 0), (make_events()[1:], 2)):  # from the start, the kick
        errors = compare(estimates, Truth(events))
        assert (errors.early, errors.unknown) == (early, 0)


@pytest.mark.parametrize("angle", [1e-12, 1e-3, 1.0, 3.1])
def test_a_turned_world_is_split_into_tilt_and_heading(angle):
    truth, stamps = truth_and_stamps(500)
    turned = compare(make_estimates(truth, stamps, Rotation.from_rotvec([0, 0, angle])), truth)
    # a rotation about the vertical is heading; products of quaternions round to some eps
    assert turned.total == pytest.approx(np.full(500, angle), abs=8 * EPS)
    assert np.abs(turned.heading) == pytest.approx(np.full(500, angle), abs=8 * EPS)
    assert turned.tilt.max() < 8 * EPS
    tilted = compare(make_estimates(truth, stamps, Rotation.from_rotvec([angle, 0, 0])), truth)
    assert tilted.tilt == pytest.approx(np.full(500, angle), abs=8 * EPS)
    # next to a tilt of pi the heading is what two small components say
    assert np.abs(tilted.heading).max() < 8 * EPS / math.cos(angle / 2)


@pytest.mark.parametrize("seed", seeds(1, 3))
def test_rotations_of_any_size_and_a_delay_are_found(seed):
    random = np.random.default_rng(seed)
    world, body = (Rotation.from_rotvec(random.normal(size=3)) for _ in range(2))
    delay = random.uniform(-0.05, 0.05)
    truth, stamps = truth_and_stamps(seed=seed)
    estimates = make_estimates(truth, stamps, world, body, delay)
    found = explain(estimates, truth).offset
    # A spin is a delay and a rotation of the body at once; nutation, kick and pauses tell them
    # apart. The stamps are whole nanoseconds, in which the top turns by 2e-7 rad.
    assert found.delay == pytest.approx(delay, abs=1e-8)
    errors = compare(estimates, truth, found)
    assert errors.total.max() < 3e-6
    assert errors.rate.max() < 1e-3
    alone = explain(estimates, truth, removed=("delay", "drift")).offset
    assert alone.angles == (0.0, 0.0)


def test_a_clock_that_jumps_back_replaces_what_it_repeats():
    events = make_events()
    again = Truth([*events, events[0]])  # the whole run starts again at its first stamp
    stamps = np.array([4 * SECOND])
    first = Truth(events[:1]).states_at(stamps)[0]
    assert (again.states_at(stamps)[0] == first).all()


STAMPS = np.arange(SECOND // 2, 9 * SECOND, SECOND // 5)


STEADY = [
    pytest.param("regular_precession", 0.0, 0.01, marks=pytest.mark.long),
    ("conical_pendulum", 0.007, 1e-4),
    ("sleeping", 0.007, 0.0),
]


@pytest.mark.slow
@pytest.mark.parametrize(("scene", "delay", "rate"), STEADY)
def test_a_steady_motion_hides_the_delay_but_not_the_drift(scene, delay, rate):
    truth = scene_truth(scene)
    found = explain(Made(delay=delay, drift=rate).make(truth, STAMPS), truth)
    assert found.offset.delay == 0.0
    # angles are right to 1e-15; over 8 s that is this rate
    assert found.offset.drift == pytest.approx(rate, abs=1e-12)
    assert found.residual < 1e-9  # of stamps in whole ns: 1e-9 s times 0.2 rad/s


@pytest.mark.parametrize(("noise", "delay"), [(1e-9, 0.004), (1e-2, 0.0)])
def test_a_delay_that_noise_hides_is_not_removed(noise, delay):
    # 1e-3 rad/s off regular precession: a nutation of 1e-5 rad
    truth = Truth([start_event(Motion(ARTICLE, precess(SLOW + 1e-3)))])
    estimates = Made(delay=0.004, noise=noise).make(truth, STAMPS)
    found = explain(estimates, truth, removed=("offset", "delay"))
    assert found.offset.delay == pytest.approx(delay, abs=1e-4)


CUSPS_EVENT = start_event(start_motion(Settings.from_scene("cusps")))
INSTANTS = np.arange(0, SECOND, SECOND // 50)


@pytest.mark.slow
@pytest.mark.wording
def test_the_mount_of_the_sensor_is_applied_to_its_messages():
    mounted = Imu(position=(0.0, 0.0, 0.02), orientation=(0.5, -0.5, 0.5, 0.5))
    segment = Segment.begin(Motion(ARTICLE, CUSPS), 0, 1.0, Rig(imu=mounted))
    truth = Truth([Event.of(Change(Act("start", 0, {}), CUSPS, segment))])
    numbers = SENSOR_TOPICS["imu"].compute(Samples.at(segment, INSTANTS))
    rates = numbers[:, IMU.quantities["angular_velocity"]]
    estimates = Estimates.of(INSTANTS, numbers[:, [3, 0, 1, 2]], rates)
    sensor = judge(replace(estimates, of_sensor=True), truth, "imu")
    assert sensor.errors.total.max() < 1e-15  # the same products of the same doubles
    assert sensor.errors.rate.max() == 0.0
    body = judge(estimates, truth, "imu")
    assert body.errors.total.max() > 2.0
    (note,) = body.notes
    assert note.endswith("--attitude-of sensor")


def test_stamps_after_the_last_sample_are_counted_apart():
    whole = scene_truth("cusps")
    judgement = judge(make_estimates(whole, INSTANTS), Truth([CUSPS_EVENT], end=SECOND // 2), "x")
    assert judgement.errors.late == 24  # the stamp of the end itself is judged
    assert judgement.errors.unknown == 0
    assert " 24 estimates " in judgement.format()


def test_a_refusal_has_both_spans_of_time():
    begin = 1_700_000_000 * SECOND
    events = [replace(CUSPS_EVENT, stamp=begin)]
    estimates = make_estimates(scene_truth("cusps"), INSTANTS)
    with pytest.raises(RefusedError, match=r"within the run, 17.* s to 17.* s, got 0\.0"):
        judge(estimates, Truth(events, begin + SECOND), "x")


DOMAIN = share_domain()


@pytest.mark.slow
def test_the_nodes_own_attitude_is_exact_while_it_runs():
    words = judge_live("--topic", "/top/orientation", "--max-error", "1e-15")
    with running_node(DOMAIN, "scene:=looping"), running(words, DOMAIN) as judging:
        while " estimates: attitude " not in judging.stdout.readline():
            assert judging.poll() is None
        judging.send_signal(signal.SIGINT)
        assert judging.wait(timeout=TIMEOUT) == 0
        assert judging.stderr.read() == ""


WRONG = [{"stamp": "0"}, {"stamp": None}, {"name": 3}, {"values": None}, {"values": {"top": 3}}]


@pytest.mark.parametrize("wrong", WRONG)
def test_events_of_wrong_types_are_refused(wrong, tmp_path):
    path = tmp_path / "events.json"
    event = asdict(start_event(Motion(ARTICLE, CUSPS))) | wrong
    path.write_text(json.dumps({"events": [event], "end": 0}))
    with pytest.raises(RefusedError, match="must have the events of a run as top_imu writes them"):
        read_events(path)
