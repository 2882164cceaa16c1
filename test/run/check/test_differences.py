"""The laws of motion tried with the samples of a log: what holds, and what was changed."""

from dataclasses import replace

import numpy as np
import pytest
from log_files import Run
from physics.tops import DISC
from run.session.test_outputs import Program, advance, start
from trials import seeds

from symtop_ros.physics import Friction, State, Top
from symtop_ros.replay.main import main
from symtop_ros.run.check.differences import (
    ATTITUDE,
    INERTIA,
    LEAST,
    MOMENTUM,
    WEIGHT,
    DifferenceCheck,
)
from symtop_ros.run.check.run import check_run
from symtop_ros.run.check.stencils import MARGIN
from symtop_ros.run.log.bags import open_run
from symtop_ros.run.log.batch import BatchReader
from symtop_ros.run.log.contents import DECODED
from symtop_ros.run.log.reader import McapFile
from symtop_ros.run.log.top_log import TopLog
from symtop_ros.run.simulation.presets import scene_names

LAWS = (MOMENTUM, ATTITUDE, INERTIA, WEIGHT)


def try_laws(log):
    """How each law holds in a log: computed by NumPy alone."""
    check, reader = DifferenceCheck(log.catalog), BatchReader()
    reader.frame = log.catalog.frame
    for run in log.list_messages():
        chosen = [each for each in run if each[1] in DECODED]
        data = [(name, message.data) for _, name, message in chosen]
        check.add_batch(reader.read(data, [place for place, *_ in chosen]))
    check.finish()
    return check.laws


def laws_of(run, folder):
    return try_laws(TopLog(McapFile(run.write(folder))))


def record(scene, folder, acts=(), seconds=0.5, **settings):
    """The log of a scene, with acts (service, argument) half a second apart."""
    session, clock = start(
        Program(), scene, record__enabled=True, record__directory=str(folder), **settings
    )
    for service, argument in (*acts, (None, None)):
        advance(session, clock, seconds)
        if service:
            session.answer(service, lambda argument=argument: argument)
    path = session.recording.path
    session.close()
    return TopLog(open_run([path]))


# Every fifth scene in each run of the tests.
QUICK = scene_names()[::5]


@pytest.mark.parametrize(
    "scene",
    [
        each if each in QUICK else pytest.param(each, marks=pytest.mark.long)
        for each in scene_names()
    ],
)
def test_every_scene_obeys_the_laws_of_motion_before_and_after_a_kick(scene, tmp_path):
    for law in try_laws(record(scene, tmp_path, [("hurry_precession", None)])).values():
        assert law.wrong == 0
        assert law.samples + law.too_fast > 150


def test_what_is_compared_is_all_but_the_ends_of_each_stretch(tmp_path):
    laws = laws_of(Run(seconds=2.0), tmp_path)  # kicked in the middle
    counts = [laws[name].samples for name in LAWS]
    assert counts == [400 - 4 * MARGIN, 400 - 4 * MARGIN, 400, 400]
    assert laws[MOMENTUM].largest < 1e-8  # N m; the torque is 0.03 N m
    assert laws[ATTITUDE].largest < 1e-2  # 1/s; half of omega is 100 rad/s


ACTS = [
    ("set_initial_conditions", {"theta": 1.0}),
    ("kick", {"axle_impulse": 2.0**-18, "rate": 30.0, "number": 12}),
    ("kick", {"angular_impulse": [0.0, 2.0**-14, 0.0]}),
    ("clamp", True),
    ("clamp", False),
    ("pause", True),
    ("step", {"duration": 0.0625}),
    ("pause", False),
    ("reset", None),
]


@pytest.mark.slow
@pytest.mark.parametrize("factor", [0.25, 1.0])
def test_no_difference_crosses_an_event_a_push_or_a_pause(factor, tmp_path):
    laws = try_laws(record("cusps", tmp_path, ACTS, real_time_factor=factor, publish_rate=500.0))
    assert [each.wrong for each in laws.values()] == [0, 0, 0, 0]
    # Of the pushes 17 samples apart no stretch is long enough: nothing is claimed.
    assert laws[MOMENTUM].samples == laws[ATTITUDE].samples > 1000


def test_no_difference_crosses_a_gap(tmp_path):
    run = Run(seconds=1.0)  # the kick after the gap has the next number: no event is missing
    stamp = run.messages[run.places("orientation")[50]][1]
    run.messages = [each for each in run.messages if each[1] != stamp or each[0] == "events"]
    laws = laws_of(run, tmp_path)
    assert [each.wrong for each in laws.values()] == [0, 0, 0, 0]
    assert laws[MOMENTUM].samples == 199 - 3 * 2 * MARGIN


def test_where_the_rate_is_too_low_for_the_motion_nothing_is_claimed(tmp_path, capsys):
    run = Run(rate=20.0, seconds=4.0, hurried=False)
    path = run.write(tmp_path)
    laws = try_laws(TopLog(McapFile(path)))
    assert (laws[ATTITUDE].samples, laws[ATTITUDE].too_fast) == (0, 80 - 2 * MARGIN)
    assert (laws[INERTIA].samples, laws[WEIGHT].samples) == (80, 80)
    assert main([str(path), "--check"]) == 0
    out = capsys.readouterr().out
    assert "q' = omega q/2" in out
    assert "not compared: the rate of the samples is too low for the motion" in out


def test_a_stretch_that_is_too_short_claims_nothing(tmp_path):
    run = Run(seconds=(LEAST - 1) / 200.0, hurried=False)
    laws = laws_of(run, tmp_path)
    assert [laws[name].samples for name in LAWS] == [0, 0, LEAST - 1, LEAST - 1]


def add(place, size):
    def change(numbers):
        return numbers + size * (np.arange(len(numbers)) == place)

    return change


def turn(angle):
    """Turn an attitude about the vertical: the torque of gravity turns with it."""

    def change(numbers):
        x, y, z, w = numbers
        s, c = np.sin(angle / 2), np.cos(angle / 2)
        return np.array([c * x - s * y, c * y + s * x, c * z + s * w, c * w - s * z])

    return change


# One message each; the sizes are far below what anybody sees in a plot.
TAMPERED = [
    ("orientation", add(0, 1e-9)),
    ("orientation", add(3, -1e-9)),
    ("orientation", turn(1e-4)),
    ("angular_velocity", add(3, 1e-9)),
    ("angular_velocity", add(5, 1e-8)),
    ("angular_momentum", add(0, 1e-13)),
    ("angular_momentum", add(2, -1e-13)),
    ("torque", add(3, 1e-12)),
    ("torque", add(5, 1e-12)),
    ("torque", add(4, np.nan)),
]


@pytest.mark.parametrize("place", range(len(TAMPERED)))
def test_one_message_that_was_changed_is_found_without_the_kernel(place, tmp_path, capsys):
    name, change = TAMPERED[place]
    run = Run(seconds=1.0)
    run.change(run.places(name)[60 + place], change)
    path = run.write(tmp_path)
    laws = try_laws(TopLog(McapFile(path)))
    assert sum(each.wrong for each in laws.values()) >= 1
    assert main([str(path), "--check"]) == 1
    assert "the samples DO NOT obey the laws of motion" in capsys.readouterr().out


class Liar(Run):
    """A run whose samples are those of another motion than its events say."""

    told = None

    def _announce(self, event):
        values = {**event.values, **(self.told or {})}
        super()._announce(replace(event, values=values))


LIES = [
    ({"top": "0.000228 5.72e-05 0.0680001"}, {WEIGHT}),
    ({"top": "0.0002280001 5.72e-05 0.068"}, {INERTIA}),
    ({"top": "0.000228 5.7200001e-05 0.068"}, {INERTIA}),
    ({"motion.real_time_factor": "1.0001"}, {MOMENTUM, ATTITUDE}),
    ({"friction": "1e-09 0.0"}, {WEIGHT}),
    ({"applied_torque": "0.0 0.0 1e-12"}, {WEIGHT}),
]


@pytest.mark.parametrize("told", range(len(LIES)))
def test_a_kernel_that_wrote_another_motion_than_it_says_is_found(told, tmp_path):
    values, found = LIES[told]
    kind = type("Lie", (Liar,), {"told": values})
    laws = laws_of(kind(seconds=0.5, hurried=False), tmp_path)
    assert {name for name in LAWS if laws[name].wrong} == found


DRIVEN = [
    {"friction": Friction(2e-6, 1e-5), "torque": (1e-4, 0.0, 2e-4)},
    {"top": DISC, "start": State.from_euler(theta=2.0, phi_dot=3.0, psi_dot=-4.0)},
    {"top": Top(2e-4, 1e-4, 0.0), "start": State.from_euler(theta=1, phi_dot=3, psi_dot=40)},
    {"start": State.from_euler(theta=0, theta_dot=1, psi_dot=60), "hurried": False},
]


@pytest.mark.parametrize("arguments", DRIVEN)
def test_friction_torques_and_other_tops_obey_them_too(arguments, tmp_path):
    laws = laws_of(Run(seconds=1.0, rate=400.0, **arguments), tmp_path)
    assert [each.wrong for each in laws.values()] == [0, 0, 0, 0]
    assert min(each.samples for each in laws.values()) > 350


def test_a_log_without_a_topic_tries_what_the_others_say(tmp_path):
    run = Run(seconds=1.0, hurried=False)
    run.messages = [each for each in run.messages if each[0] != "angular_momentum"]
    laws = laws_of(run, tmp_path)
    assert [laws[name].samples for name in LAWS] == [0, 200 - 2 * MARGIN, 0, 200]
    assert not any(each.wrong for each in laws.values())


def test_the_check_of_a_log_has_them(tmp_path):
    found = check_run(TopLog(McapFile(Run(seconds=1.0).write(tmp_path))))
    assert found.laws_hold
    assert [*found.laws] == [*LAWS]


@pytest.mark.parametrize("seed", seeds(3, 100))
def test_pushes_at_any_rate_are_not_crossed(seed, tmp_path):
    rate = [17.0, 99.9, 7.25, 333.0][seed % 4] * (1 + seed / 1024)
    acts = [("kick", {"axle_impulse": 2.0**-17, "rate": rate, "number": 40})]
    laws = try_laws(record("looping", tmp_path, acts, seconds=1.0, publish_rate=1000.0))
    assert [each.wrong for each in laws.values()] == [0, 0, 0, 0]


@pytest.mark.slow
def test_after_the_last_push_nothing_is_left_out(tmp_path):
    impulse = {"axle_impulse": 2.0**-17}
    samples = []
    for number, act in enumerate((impulse, {**impulse, "rate": 17.0, "number": 3})):
        folder = tmp_path / f"{number}"
        folder.mkdir()
        run = record("looping", folder, [("kick", act)], seconds=1.0, publish_rate=1000.0)
        samples.append([each.samples for each in try_laws(run).values()])
    # Of two pushes more: on each side of each, and a sample that stands at it.
    for once, often in zip(*samples, strict=True):
        assert 0 <= once - often <= 2 * (2 * MARGIN + 1)
