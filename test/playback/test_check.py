"""A log is what its events say to the last bit, and a log that is not is caught."""

import numpy as np
import pytest
from log_files import ARTICLE, LAYOUTS, Run

from symtop_ros.physics import Friction, State, Top
from symtop_ros.playback.check import ROUNDING, check
from symtop_ros.playback.mcap_file import McapFile
from symtop_ros.playback.top_log import TopLog
from symtop_ros.wire.messages import KINDS, unpacked

EPS = np.finfo(float).eps


def deviations_of(run, folder):
    return check(TopLog(McapFile(run.write(folder))))


@pytest.mark.parametrize(
    ("top", "start"),
    [
        (ARTICLE, State.from_euler(theta=0.5, psi_dot=200.0)),
        (Top(2e-4, 3e-4, -0.05), State.from_euler(theta=2.0, phi_dot=3.0, psi_dot=-40.0)),
        (Top(2e-4, 1e-4, 0.0), State.from_euler(theta=1.0, phi_dot=3.0, psi_dot=40.0)),
        (ARTICLE, State.from_euler(theta=0.0, theta_dot=1.0, psi_dot=60.0)),
    ],
)
def test_a_good_log_deviates_by_nothing(top, start, tmp_path):
    hurried = start.euler_angles.theta > 0  # phi' means nothing on the vertical
    for name, deviation in deviations_of(Run(top, start, hurried=hurried), tmp_path).items():
        assert (name, deviation.largest, deviation.unchecked) == (name, 0.0, 0)
        assert deviation.samples == 400


def test_a_good_log_under_friction_and_torque_deviates_by_nothing(tmp_path):
    run = Run(friction=Friction(2e-6, 1e-5), torque=(1e-4, 0.0, 2e-4), seconds=4.0)
    for name, deviation in deviations_of(run, tmp_path).items():
        assert (name, deviation.largest, deviation.samples) == (name, 0.0, 800)


def test_a_log_of_less_friction_than_it_says_is_caught(tmp_path):
    run = Run(friction=Friction(2e-6, 1e-5))
    told = Run(friction=Friction(2e-6, 1e-5 * (1 + 1e-7)))
    run.messages = [
        truth if truth[0] in LAYOUTS else event
        for truth, event in zip(run.messages, told.messages, strict=True)
    ]
    assert not deviations_of(run, tmp_path)["orientation"].is_rounding


@pytest.mark.parametrize("name", list(LAYOUTS))
@pytest.mark.parametrize("size", [1e-9, 1.0, np.nan])
def test_one_wrong_number_is_found(name, size, tmp_path):
    run = Run()
    k = [k for k, each in enumerate(run.messages) if each[0] == name][100]
    _, stamp, data = run.messages[k]
    ((found,), _) = unpacked(KINDS[name], [data])
    numbers = found.numbers[0].copy()
    wrong = numbers[-1] * (1 + size) if numbers[-1] else size
    numbers[-1] = wrong
    run.messages[k] = name, stamp, LAYOUTS[name].pack(stamp, numbers.tolist())
    deviations = deviations_of(run, tmp_path)
    assert not deviations[name].is_rounding
    assert all(each.largest == 0.0 for other, each in deviations.items() if other != name)


def test_rounding_of_another_machine_is_let_pass(tmp_path):
    run = Run()
    run.messages = [
        (name, stamp, _nudged(name, stamp, data) if name in LAYOUTS else data)
        for name, stamp, data in run.messages
    ]
    for deviation in deviations_of(run, tmp_path).values():
        assert 0 < deviation.relative < ROUNDING
        assert deviation.is_rounding


def _nudged(name, stamp, data):
    ((found,), _) = unpacked(KINDS[name], [data])
    return LAYOUTS[name].pack(stamp, (found.numbers[0] * (1 + 4 * EPS)).tolist())


def test_an_angle_that_is_a_turn_off_is_the_same_angle(tmp_path):
    run = Run()
    for k, (name, stamp, data) in enumerate(run.messages):
        if name == "euler_angles":
            ((found,), _) = unpacked(KINDS[name], [data])
            turned = found.numbers[0] + np.array([2 * np.pi, 0, -2 * np.pi, 0, 0, 0])
            run.messages[k] = name, stamp, LAYOUTS[name].pack(stamp, turned.tolist())
    assert deviations_of(run, tmp_path)["euler_angles"].is_rounding


def test_samples_before_the_first_event_are_counted_and_not_checked(tmp_path):
    run = Run()
    run.messages = [each for k, each in enumerate(run.messages) if each[0] != "events" or k > 0]
    deviations = deviations_of(run, tmp_path)
    assert {each.unchecked for each in deviations.values()} == {200}
    assert {each.samples for each in deviations.values()} == {200}


def test_an_event_that_arrives_after_its_first_samples_still_governs_them(tmp_path):
    run = Run()
    k = [k for k, each in enumerate(run.messages) if each[0] == "events"][1]
    kick = run.messages.pop(k)
    run.messages.insert(k + 20, kick)  # some samples late, as a recorder of arrivals may log it
    assert all(each.largest == 0.0 for each in deviations_of(run, tmp_path).values())
