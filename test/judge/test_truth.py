"""The exact motion of a run: its end, and the mount of its sensor."""

import json
from dataclasses import asdict, replace

import numpy as np
import pytest
from judge.cases import SECOND, make_estimates
from physics.tops import ARTICLE, CUSPS
from programs import run, running_node

from symtop_ros.judge.estimates import Estimates
from symtop_ros.judge.judgement import judge
from symtop_ros.judge.truth import Truth, read_events, scene_truth
from symtop_ros.physics import Motion
from symtop_ros.simulation.events import Event, start_event
from symtop_ros.simulation.segment import Segment
from symtop_ros.simulation.sensor.imu import Imu, Rig
from symtop_ros.simulation.topics import SENSOR_TOPICS, Samples
from symtop_ros.simulation.validation import RefusedError
from symtop_ros.wire.messages import IMU
from workshop.load.domains import claim_domain

STAMPS = np.arange(0, SECOND, SECOND // 50)


@pytest.mark.wording
def test_the_mount_of_the_sensor_is_applied_to_its_messages():
    mounted = Imu(position=(0.0, 0.0, 0.02), orientation=(0.5, -0.5, 0.5, 0.5))
    segment = Segment.begin(Motion(ARTICLE, CUSPS), 0, 1.0, Rig(imu=mounted))
    truth = Truth([Event.of(0, "start", None, {}, CUSPS, segment)])
    numbers = SENSOR_TOPICS["imu"].compute(Samples.at(segment, STAMPS))
    rates = numbers[:, IMU.quantities["angular_velocity"]]
    estimates = Estimates.of(STAMPS, numbers[:, [3, 0, 1, 2]], rates)
    sensor = judge(replace(estimates, of_sensor=True), truth, "imu")
    assert sensor.errors.total.max() < 1e-15  # the same products of the same doubles
    assert sensor.errors.rate.max() == 0.0
    body = judge(estimates, truth, "imu")
    assert body.errors.total.max() > 2.0
    (note,) = body.notes
    assert note.endswith("--attitude-of sensor")


def test_stamps_after_the_last_sample_are_counted_apart():
    whole = scene_truth("cusps")
    judgement = judge(make_estimates(whole, STAMPS), Truth(whole._events, end=SECOND // 2), "x")
    assert judgement.errors.late == 24  # the stamp of the end itself is judged
    assert judgement.errors.unknown == 0
    assert " 24 estimates " in judgement.format()


def test_a_refusal_has_both_spans_of_time():
    begin = 1_700_000_000 * SECOND
    events = [replace(event, stamp=begin) for event in scene_truth("cusps")._events]
    estimates = make_estimates(scene_truth("cusps"), STAMPS)
    with pytest.raises(RefusedError, match=r"within the run, 17.* s to 17.* s, got 0\.0"):
        judge(estimates, Truth(events, begin + SECOND), "x")


DOMAIN = claim_domain()


def test_the_nodes_own_attitude_is_exact_while_it_runs():
    with running_node(DOMAIN, "scene:=looping"):
        arguments = ("--live", "--topic", "/top/orientation", "--max-error", "1e-15")
        done = run("top_judge", *arguments, "--seconds", "2.5", domain=DOMAIN)
        assert (done.returncode, done.stderr) == (0, "")
        assert " estimates: attitude " in done.stdout


@pytest.mark.parametrize(
    "wrong",
    [{"stamp": "0"}, {"stamp": None}, {"name": 3}, {"values": None}, {"values": {"top": 3}}],
)
def test_events_of_wrong_types_are_refused(wrong, tmp_path):
    path = tmp_path / "events.json"
    event = asdict(start_event(Motion(ARTICLE, CUSPS))) | wrong
    path.write_text(json.dumps({"events": [event], "end": 0}))
    with pytest.raises(RefusedError, match="must have the events of a run as top_imu writes them"):
        read_events(path)
