"""A run that starts paused: it stands at its initial conditions until it is stepped or resumed."""

import json

import pytest
from run.session.test_outputs import Program, advance, start

from symtop_ros.physics import Motion
from symtop_ros.run.check.run import check_run
from symtop_ros.run.log.bags import open_run
from symtop_ros.run.log.top_log import TopLog

MS = 1_000_000
OWN = [False, True]


def begin(tmp_path, scene="cusps", **options):
    return start(
        Program(),
        scene,
        record__enabled=True,
        record__directory=str(tmp_path),
        start_paused=True,
        **options,
    )


def find_state(session):
    return json.loads(session.answer("get_state", lambda: None)[1])


def close(session):
    path = session.recording.path
    session.close()
    log = TopLog(open_run([path]))
    findings = check_run(log)
    assert (findings.mismatches, findings.samples_agree, findings.laws_hold) == ([], True, True)
    assert log.catalog.problems == ()
    (batch, *_) = log.batches()
    return [event.name for event in log.catalog.events], batch


def test_it_stands_still_at_its_start_however_long_it_waits(tmp_path):
    session, clock = begin(tmp_path)
    advance(session, clock, 0.5)
    state = find_state(session)
    assert (state["time"], state["running"]) == (0.0, False)
    angles = session.simulation.settings.initial
    assert state["euler_angles"]["theta"] == pytest.approx(angles.theta, abs=2**-52)
    names, batch = close(session)
    assert names == ["start", "pause"]
    columns = batch.columns["orientation"].numbers
    assert len(columns) > 50
    assert (columns == columns[0]).all()


@pytest.mark.parametrize("scene", ["cusps", "friction"])
@pytest.mark.parametrize("own", OWN)
def test_a_step_leads_from_the_start_to_its_duration(own, scene, tmp_path):
    session, clock = begin(tmp_path, scene, publish_clock=own)
    motion = session.simulation.segment.motion
    same = Motion(motion.top, motion.start, motion.friction)
    advance(session, clock, 0.5)
    granted, answer = session.answer("step", lambda: {"duration": 0.125})
    assert granted, answer
    advance(session, clock, 0.5)
    time = 0.125 + (1e-9 if own else 0.0)  # in its own time the next instant after the sample
    assert find_state(session)["time"] == time
    _, batch = close(session)
    stamps, columns = batch.columns["orientation"].stamps, batch.columns["orientation"].numbers
    if own:
        assert stamps.tolist() == [0, 125 * MS]
    for value, moment in ((columns[0], 0.0), (columns[-1], 0.125)):
        w, x, y, z = same.at(moment).orientation.tolist()
        assert value.tolist() == pytest.approx([x, y, z, w], abs=1e-15)


@pytest.mark.parametrize("own", OWN)
def test_it_runs_from_its_start_when_it_is_resumed(own, tmp_path):
    session, clock = begin(tmp_path, publish_clock=own)
    advance(session, clock, 0.5)
    assert session.answer("pause", lambda: False)[0]
    for _ in range(50):  # its own time waits for samples that are late by more than 0.1 s
        advance(session, clock, 0.005)
    assert 0.24 < find_state(session)["time"] < 0.26
    assert close(session)[0] == ["start", "pause", "resume"]


def test_in_its_own_time_steps_have_the_samples_of_their_multiples(tmp_path):
    session, clock = begin(tmp_path, publish_clock=True)
    for wait in (0.5, 0.0, 0.25):
        advance(session, clock, wait)
        assert session.answer("step", lambda: {"duration": 0.01})[0]
    _, batch = close(session)
    assert batch.columns["orientation"].stamps.tolist() == [0, 10 * MS, 20 * MS, 30 * MS]
