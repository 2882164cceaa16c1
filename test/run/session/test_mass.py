"""The mass of the top and gravity, as parameters: force of the pivot, arm, log, run.json."""

import json
from dataclasses import replace

import numpy as np
import pytest
from run.session.test_outputs import Program, advance, start
from run.simulation.runs import Run

from symtop_ros.base.refusals import RefusedError
from symtop_ros.physics import BODIES, Body
from symtop_ros.run.check.run import check_run
from symtop_ros.run.log.bags import open_run
from symtop_ros.run.log.top_log import TopLog
from symtop_ros.run.session.run_log import write_run_log
from symtop_ros.run.simulation.changes.requests import initial_state
from symtop_ros.run.simulation.events import Event
from symtop_ros.run.simulation.run_file import read_run, record_run, write_run
from symtop_ros.run.simulation.settings import Settings
from symtop_ros.run.simulation.topics import SAMPLE_TOPICS, Samples

WHEEL = Body.from_parts(BODIES["balanced_gyroscope"], gravity=9.80)
MOMENTS = {"top.Ix": WHEEL.top.Ix, "top.Iz": WHEEL.top.Iz, "top.Mgl": WHEEL.top.Mgl}
WEIGHED = {**MOMENTS, "mass": WHEEL.mass, "gravity": WHEEL.gravity}


def read(run):
    return json.loads(run.ask("get_state")[1])


def test_the_force_of_the_pivot_is_that_of_the_body_that_was_weighed():
    run = Run("cusps", 0.1)
    assert read(run)["mass_is_assumed"]
    run.change(WEIGHED)
    found = read(run)
    assert (found["pivot_force_of_mass"], found["mass_is_assumed"]) == (2.6, False)
    assert found["gravity"] == 9.80
    segment, state = run.simulation.segment, run.simulation.state
    force = WHEEL.pivot_force(segment.motion, state)
    assert found["pivot_force"] == pytest.approx(force.tolist(), rel=1e-13)
    wrench = SAMPLE_TOPICS["torque"].compute(Samples.at(segment, run.simulation.stamp))
    assert wrench[:3].tolist() == found["pivot_force"]
    # The weight is carried: what the axle's motion adds to 25.48 N is small for a balanced body.
    assert found["pivot_force"][2] == pytest.approx(2.6 * 9.80, rel=0.1)


def test_gravity_alone_leaves_the_motion_and_moves_the_arm():
    run = Run("cusps", 0.1, mass=0.5)
    before = run.simulation.settings.body.arm
    motion = run.simulation.segment.motion
    run.change({"gravity": 2 * 9.81})
    assert run.simulation.segment.motion.top == motion.top
    assert run.simulation.settings.body.arm == before / 2


ARTICLES = "mass must be at least 0.24096"
TOO_LIGHT = [
    ({}, {"mass": 0.24}, ARTICLES),
    ({"mass": 0.25}, {"top.Mgl": 0.08}, "mass must be at least 0.33351"),
    ({"mass": 0.25}, {"top.Ix": 2e-4}, "mass must be at least 0.280"),
    ({"mass": 0.25}, {"gravity": 9.0}, "mass must be at least 0.286"),
]


@pytest.mark.parametrize(("begun", "changes", "reason"), TOO_LIGHT)
def test_a_mass_that_no_body_of_the_top_has_is_refused_with_the_least_one(begun, changes, reason):
    session, _ = start(Program(), "cusps", **begun)
    before = session.simulation.segment
    with pytest.raises(RefusedError, match=f"^{reason}"):
        session.plan_settings(changes)
    assert session.simulation.segment is before
    with pytest.raises(RefusedError, match=f"^{reason}"):
        Settings.from_values({**session.simulation.settings.values, **changes})


def test_a_description_of_another_body_is_sent_and_the_sensors_follow(tmp_path):
    settings = {"odometry__enabled": True, "imu__enabled": True, "publish_rate": 100.0}
    record = {"record__enabled": True, "record__directory": str(tmp_path)}
    session, clock = start(Program(), "cusps", **settings, **record)
    advance(session, clock, 0.1)
    session.apply_settings(WEIGHED)
    advance(session, clock, 0.1)
    session.apply_settings({"gravity": 9.83})
    advance(session, clock, 0.1)
    segment, stamp = session.simulation.segment, session.simulation.stamp
    path = session.recording.path
    session.close()
    samples = Samples.at(segment, np.array([stamp]))
    place = SAMPLE_TOPICS["odometry"].compute(samples)[0, :3]
    arm = WHEEL.top.Mgl / (2.6 * 9.83)
    assert np.linalg.norm(place) == pytest.approx(abs(arm), rel=1e-14)
    felt = SAMPLE_TOPICS["imu"].compute(samples)
    still = replace(segment, rig=replace(segment.rig, gravity=9.80))
    less = SAMPLE_TOPICS["imu"].compute(Samples.at(still, samples.stamps))
    pulled = felt[0, -12:-9] - less[0, -12:-9]
    assert np.linalg.norm(pulled) == pytest.approx(0.03, rel=1e-12)
    log = TopLog(open_run([path]))
    found = check_run(log)
    assert (found.mismatches, found.samples_agree, log.catalog.problems) == ([], True, ())
    assert found.compared["robot_description"] == 3


def test_an_event_without_a_mass_means_an_assumed_one():
    run = Run("cusps", mass=0.5)
    (event,) = run.sink.events
    assert event.values["mass"] == "0.5"
    older = {name: text for name, text in event.values.items() if name != "mass"}
    segment = Event(event.stamp, event.name, event.verdict, older).segment()
    assert segment.rig.find_body(segment.motion.top) == Body.from_top(segment.motion.top)
    assert "mass" not in Run("cusps").sink.events[0].values


def test_a_run_keeps_the_body_and_one_of_before_has_none(tmp_path):
    run = Run("cusps", 0.1)
    plain, _ = record_run(run.sink.events, run.simulation.stamp)
    assert write_run(plain, 0)["format"] == 2
    run.change(WEIGHED)
    run.advance(0.1)
    events, end = record_run(run.sink.events, run.simulation.stamp)
    content = write_run(events, end)
    assert content["format"] == 4
    assert [event.get("mass") for event in content["events"]] == [None, 2.6]
    path = tmp_path / "run.json"
    path.write_text(json.dumps(content))
    again, *_ = read_run(path)
    assert [(each.mass, each.gravity) for each in again] == [(0.0, 9.81), (2.6, 9.80)]
    write_run_log(again, end, tmp_path / "run.mcap")
    last = TopLog(open_run([tmp_path / "run.mcap"])).catalog.events[-1].segment()
    assert (last.rig.mass, last.rig.gravity) == (2.6, 9.80)
    content["events"][1]["mass"] = 1e-6
    path.write_text(json.dumps(content))
    with pytest.raises(RefusedError, match=r"events\[1\]: mass must be at least "):
        read_run(path)


def test_a_model_may_have_the_mass_of_its_scene():
    settings = Settings.from_scene("cusps", mass=0.5, gravity=9.80)
    assert settings.body.mass == 0.5
    assert initial_state(settings.top, settings.initial, {}).euler_angles.theta > 0


@pytest.mark.parametrize(("scene", "mass"), [("bicycle_wheel", 1.5), ("toy_gyroscope", 0.06)])
def test_a_scene_that_says_a_mass_has_the_force_of_it(scene, mass):
    found = read(Run(scene))
    assert (found["pivot_force_of_mass"], found["mass_is_assumed"]) == (mass, False)
    # Its axis is carried by the pivot, whatever the centre of mass does on its circle.
    assert found["pivot_force"][2] == pytest.approx(mass * 9.81, rel=1e-9)
