"""Logs of runs of the page, and runs at random: log, run.json and a check agree."""

import json
from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from drawn import Numbers
from exact_log import read_messages, stamps_of
from run.session.test_outputs import Program, advance, start
from run.simulation.page_runs import START, make_run, to_json
from trials import seeds

from symtop_ros.base.refusals import RefusedError
from symtop_ros.physics import ExactTimes, Motion, State
from symtop_ros.run.check.run import check_run
from symtop_ros.run.log.bags import open_run
from symtop_ros.run.log.top_log import TopLog
from symtop_ros.run.session.run_log import write_run_log
from symtop_ros.run.simulation.run_file import RunEvent, read_run, record_run, write_run
from symtop_ros.run.simulation.topics import DIAGNOSTICS

END = 4_000_000_000  # ns


def read(path):
    return TopLog(open_run([path]))


def test_it_has_the_diagnostics_of_a_node(tmp_path):
    path = tmp_path / "run.mcap"
    write_run_log(make_run(), END, path)
    topics = [topic for topic, *_ in read_messages(path)]
    assert topics.count(DIAGNOSTICS.ros_name) == 4  # once a second


def test_of_acts_at_one_time_only_the_last_has_a_sample(tmp_path):
    begin, kick, _ = make_run()
    torque = (0.0, 0.0, 1e-4)
    state = kick.motion.at(ExactTimes(1_000_000_000))
    free = Motion(START.top, state)
    pushed = Motion(START.top, state, torque=torque)
    run = [
        begin,
        replace(begin, kind="start"),
        kick,
        RunEvent("torque", kick.time + 1_000_000_000, pushed, {}),
        RunEvent("torque", kick.time + 1_000_000_000, free, {}),
    ]
    path = tmp_path / "run.mcap"
    write_run_log(run, END, path)
    assert (np.diff(stamps_of(path)) > 0).all()
    log = read(path)
    found = check_run(log)
    assert found.samples_agree
    assert (found.mismatches, log.catalog.problems) == ([], ())
    events, _ = record_run(log.catalog.events, END)
    assert [event.kind for event in events] == ["start", "start", "kick", "torque"]


KICKED = make_run()[1]
_q, _omega = KICKED.motion.start._parts
NEARLY = Motion(START.top, State(_q, _omega * (1 + 1e-6)))
WILD = Motion(START.top, START.start, torque=(0.0, 0.0, 1e20))


REFUSED = [
    (START, [replace(KICKED, motion=NEARLY)], r"events\[1\]: angular_velocity must be the "),
    # a kick that no node grants
    (START, [replace(KICKED, act={})], r"events\[1\]: a request must have one of"),
    (WILD, [], "the run cannot be computed: "),
]


@pytest.mark.parametrize(("first", "others", "reason"), REFUSED)
def test_a_run_that_cannot_be_is_refused_and_leaves_no_file(first, others, reason, tmp_path):
    with pytest.raises(RefusedError, match=reason):
        write_run_log([RunEvent("start", 0, first, {}), *others], END, tmp_path / "run.mcap")
    assert not list(tmp_path.iterdir())


ACTS = 8


def draw_values(rng):
    """Named values of a start, some of which are refused."""
    values = {
        "theta": rng.uniform(0.0, 3.0),
        "phi": rng.uniform(-3.0, 3.0),
        "psi_dot": rng.uniform(-300.0, 300.0),
        "phi_dot": rng.uniform(-20.0, 20.0),
        "theta_dot": rng.uniform(-5.0, 5.0),
    }
    return {name: values[name] for name in rng.sample(sorted(values), rng.randint(0, 5))}


def draw_question(rng):
    """What is seen of a motion, of which some have none."""
    theta = rng.uniform(0.1, 3.0)
    question = rng.choice(
        (
            {"theta": theta, "precession_period": rng.uniform(0.2, 3.0)},
            {"psi_dot": rng.uniform(100.0, 300.0), "precession_period": rng.uniform(0.2, 3.0)},
            {"theta": theta, "psi_dot": rng.uniform(100.0, 300.0), "solution": 1},
            {"theta": theta, "dip": rng.uniform(0.01, 1.0)},
            {"theta": theta, "nutation_period": rng.uniform(0.05, 0.3)},
            {"energy": 1.21, "p_phi": 0.01004, "p_psi": rng.uniform(0.01, 0.012)},
            {"alpha": 600.0, "a": rng.uniform(40.0, 60.0), "b": 44.0},
        )
    )
    others = {"phi": rng.uniform(-3.0, 3.0), "psi": 1.0, "solution": rng.randint(1, 3)}
    chosen = rng.sample(sorted(others), rng.randint(0, 3))
    return question | {name: others[name] for name in chosen}


def draw_kick(rng):
    if rng.random() < 0.3:
        return {"angular_impulse": [rng.uniform(-1e-3, 1e-3) for _ in range(3)]}
    if rng.random() < 0.4:
        pushes = {"rate": rng.uniform(10.0, 500.0), "number": rng.randint(1, 40)}
        return {"axle_impulse": rng.uniform(-1e-4, 1e-4), **rng.choice((pushes, pushes, {}))}
    kinds = {
        "precession_rate": rng.uniform(-20.0, 20.0),
        "precession_rate_change": rng.uniform(-10.0, 10.0),
        "precession_rate_factor": rng.uniform(-3.0, 3.0),
    }
    kind = rng.choice(sorted(kinds))
    hold = rng.choice(({}, {"hold": "spin_rate"}, {"hold": "spin_momentum"}))
    return {kind: kinds[kind], **hold}


def draw_changes(rng):
    values = {
        "top.Ix": rng.uniform(1e-4, 4e-4),
        "top.Mgl": rng.uniform(-0.1, 0.1),
        "friction.axial": rng.choice((0.0, 1e-6)),
        "friction.transverse": rng.choice((0.0, 1e-6)),
        "steady_torque": rng.choice(([], [0.0, 0.0, 1e-4])),
        "real_time_factor": rng.choice((0.5, 1.0, 2.0)),
        "publish_rate": rng.choice((50.0, 100.0)),
        "publish_tf": rng.random() < 0.5,
        "initial.theta": rng.uniform(0.0, 1.0),
        "initial.clamped": rng.random() < 0.5,
    }
    return {name: values[name] for name in rng.sample(sorted(values), rng.randint(1, 3))}


def draw_weights(rng):
    """A mass and a gravity: with some of the tops above no body has that mass."""
    values = {"mass": rng.choice((0.0, 0.5, 2.0)), "gravity": rng.choice((9.81, 9.80, 9.83))}
    return {name: values[name] for name in rng.sample(sorted(values), rng.randint(1, 2))}


def act(rng, session, clock):
    """Do something; what is refused changes nothing."""
    kinds = "start", "kick", "kick", "release", "change", "pause", "step", "torque", "jump", "reset"
    kinds += ("clamp", "clamp", "ask", "ask", "weigh")
    kind = rng.choice(kinds)
    if kind in ("change", "weigh"):
        changes = draw_changes(rng) if kind == "change" else draw_weights(rng)
        try:
            session.apply_settings(changes)
        except RefusedError:
            return
    elif kind == "torque":
        session.hold_torque([rng.uniform(-1e-3, 1e-3) for _ in range(3)])
    elif kind == "jump":
        session.simulation.begin_jump()
        clock.now += rng.randint(2, 9) * 1_000_000_000
        session.simulation.end_jump(True)
    else:
        service, argument = {
            "start": ("set_initial_conditions", draw_values(rng)),
            "ask": ("set_initial_conditions", draw_question(rng)),
            "kick": ("kick", draw_kick(rng)),
            "release": ("release", None),
            "clamp": ("clamp", not session.simulation.segment.motion.clamped),
            "pause": ("pause", session.simulation.segment.running),
            "step": ("step", {"duration": rng.uniform(0.0, 0.1)}),
            "reset": ("reset", None),
        }[kind]
        session.answer(service, lambda: argument)


def move(rng, folder):
    """A run with acts at random times; the path of its log and its last stamp."""
    scene = rng.choice(("cusps", "regular_precession", "friction", "sleeping"))
    host = Program()
    session, clock = start(
        host,
        scene,
        record__enabled=True,
        record__directory=str(folder),
        publish_rate=100.0,
        publish_clock=rng.random() < 0.3,
        imu__enabled=rng.random() < 0.3,
        odometry__enabled=rng.random() < 0.3,
    )
    for _ in range(ACTS):
        advance(session, clock, rng.randint(1, 300) / 1024)
        act(rng, session, clock)
    advance(session, clock, 0.1)
    path, stamp = session.recording.path, session.simulation.last
    session.close()
    assert host.errors == []
    return path, stamp


def check(path):
    """The events of a log in which everything agrees."""
    log = TopLog(open_run([path]))
    found = check_run(log)
    assert found.mismatches == []
    assert all(each.differing == 0 for each in found.deviations.values())
    assert found.laws_hold
    assert log.catalog.problems == ()
    return list(log.catalog.events)


def list_exact(event):
    """The fields that an event and its repetition have in common to the last bit."""
    motion = event.motion
    body = motion.top, motion.friction, motion.applied_torque, motion.clamped
    body += event.mass, event.gravity
    return event.kind, event.time, json.dumps(event.act), body


def drop_idle(events):
    """Events without those that changed back, while the motion stood still, what others changed."""
    bodies = [list_exact(event)[-1] for event in events]
    is_same = [False, *(before == after for before, after in pairwise(bodies))]
    acts = ("start", "kick", "push", "clamp", "unclamp")
    pairs = zip(events, is_same, strict=True)
    return [event for event, same in pairs if event.kind in acts or not same]


def is_near(found, given):
    """A node kicks at any time of a motion, a run at a whole nanosecond of it."""
    rate = 2 * float(np.abs(given.angular_velocity).max())  # the axis turns at most twice as fast
    moved = np.abs(found.orientation - given.orientation).max()
    changed = np.abs(found.angular_velocity - given.angular_velocity).max()
    return moved <= 1e-9 * rate and changed <= 1e-9 * rate * max(1.0, rate)


def try_again(rng, folder):
    """A random run, its run.json, and the log of that: each is what the one before says."""
    path, stamp = move(rng, folder)
    events, end = record_run(check(path), stamp)
    content = folder / "run.json"
    content.write_text(json.dumps(write_run(events, end)))
    read, reached, _ = read_run(content)
    assert (to_json(read), reached) == (to_json(events), end)
    again = folder / "again.mcap"
    write_run_log(read, reached, again, rate=50.0)
    repeated, _ = record_run(check(again), reached)
    for given, found in zip(drop_idle(read), repeated, strict=True):
        assert list_exact(found) == list_exact(given)
        assert is_near(found.motion.start, given.motion.start)


@pytest.mark.parametrize("seed", seeds(3, 300))
def test_a_random_session_its_run_and_the_log_of_that_agree(seed, tmp_path):
    try_again(Numbers(seed), tmp_path)
