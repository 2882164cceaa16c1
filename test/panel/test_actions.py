"""The acts of users become requests of the interface, and refusals become one sentence."""

import time

import numpy as np
import pytest

from symtop_ros.panel.actions import Actions, impulse_of_pull, read_link
from symtop_ros.panel.source import LocalTop
from symtop_ros.session.recording import Answer
from symtop_ros.simulation.presets import scene_names
from symtop_ros.simulation.validation import RefusedError
from symtop_ros.web.facts import write_link
from symtop_ros.web.run import Run


@pytest.fixture(name="played")
def _played():
    """Actions on a paused top, its run, and a function that takes over what happened."""
    top, run = LocalTop("hurry_slow", factor=0.1), Run()
    actions = Actions(top, run)
    top.watch(True)

    def look():
        """Take over events, and samples until one is as new as the last event."""
        events, deadline = [], time.monotonic() + 10.0
        while True:
            events += run.follow(top.batch())
            if run.state is not None and run.stamp >= run.event.stamp:
                return events
            assert time.monotonic() < deadline, "no sample"

    look()
    actions.toggle_pause()
    look()
    yield actions, run, look
    top.close()


def test_pausing_twice_resumes(played):
    actions, run, look = played
    assert not run.segment.running
    actions.toggle_pause()
    look()
    assert run.segment.running


def test_a_step_is_a_part_of_a_nutation(played):
    actions, run, look = played
    before = run.segment.elapsed
    actions.step()
    look()
    stepped = float(run.segment.elapsed - before) * 1e-9
    assert stepped == pytest.approx(run.motion.nutation_period / 24, rel=1e-12)
    actions.toggle_pause()
    look()
    actions.step()  # pauses first
    assert [event.name for event in look()] == ["pause", "step"]


def test_keys_push_the_axle(played):
    actions, run, look = played
    rate = run.state.euler_rates
    actions.push("up")
    actions.push("along")
    look()
    after = run.motion.start.euler_rates
    # An impulse of Ix times 1 rad/s about the line of nodes; 1e-12: rounding, seen 2e-14.
    assert after.theta == pytest.approx(rate.theta - 1.0, abs=1e-12)
    assert after.phi == pytest.approx(rate.phi + 1.0, abs=1e-12)


def test_a_pull_is_an_impulse_across_the_axle(played):
    actions, run, look = played
    motion, axis = run.motion, run.state.to_world([0.0, 0.0, 1.0])
    before = motion.top.angular_momentum(run.state)
    end = axis + np.array([0.3, -0.2, 0.5])
    actions.pull(end)
    look()
    gained = run.motion.top.angular_momentum(run.motion.start) - before
    assert gained == pytest.approx(impulse_of_pull(motion.top, axis, end), abs=1e-15)
    assert abs(float(gained @ axis)) < 1e-16  # a push on the axle leaves L_z
    assert float(run.motion.start.euler_angles.theta) == pytest.approx(0.5, abs=1e-12)


def test_every_scene_can_be_chosen(played):
    actions, run, look = played
    for name in scene_names():
        actions.choose_scene(name)
    with pytest.raises(RefusedError, match=r"^scene must be one of"):
        actions.choose_scene("no_such_scene")
    actions.choose_scene("perry_fails")
    look()
    assert run.motion.top.Mgl < 0


def test_a_refusal_is_one_sentence_and_changes_nothing(played):
    actions, _, look = played
    with pytest.raises(RefusedError, match=r"^theta must be"):
        actions.start({"theta": 4.0})
    with pytest.raises(RefusedError, match=r"^top.Ix must be"):
        actions.set_parameters({"top.Ix": -1.0})
    with pytest.raises(RefusedError, match=r"^way must be up, down, along or back"):
        actions.push("sideways")
    assert look() == []


def test_an_entry_of_the_history_restarts_the_same_motion_with_its_top(played):
    actions, run, look = played
    actions.kick(1.4)
    look()
    kick = run.history[-1]
    actions.set_parameters({"top.Mgl": 0.05})
    actions.start({"theta": 1.0})
    look()
    actions.restart_from(kick)
    look()
    assert run.event.name == "start"
    assert run.motion.top.Mgl == 0.068
    assert np.array_equal(run.motion.start.angular_velocity, kick.state().angular_velocity)
    assert np.array_equal(run.motion.start.orientation, kick.state().orientation)


def test_a_link_starts_an_experiment(played):
    actions, run, look = played
    actions.follow_link({"theta": "0.3", "psi_dot": "150", "phi_dot": "0", "Mgl": "0.05"})
    look()
    assert run.motion.top.Mgl == 0.05
    assert run.motion.start.euler_angles.theta == pytest.approx(0.3, abs=1e-15)
    actions.follow_link({"scene": "sleeping"})
    look()
    assert run.motion.kind == "sleeping"


@pytest.mark.parametrize(
    ("link", "message"),
    [
        ({"thet": "0.3"}, "name in a link must be"),
        ({"theta": "<b>"}, "theta must be a finite number"),
        ({"theta": "nan"}, "theta must be a finite number"),
        ({"theta": "9"}, "theta must be 0 to"),
        ({"scene": "../etc/passwd"}, "scene must be one of"),
        ({"Ix": "-1"}, "top.Ix must be"),
        ({"precession": "slow", "phi_dot": "3"}, "precession must be given without phi_dot"),
    ],
)
def test_a_link_that_cannot_be_followed_is_refused(played, link, message):
    actions, _, look = played
    with pytest.raises(RefusedError) as refusal:
        actions.follow_link(link)
    assert str(refusal.value).startswith(message)
    assert "start" not in [event.name for event in look()]


def test_the_link_of_a_motion_starts_it_again_to_six_digits(played):
    actions, run, look = played
    actions.start({"theta": 0.7, "phi": 0.2, "psi_dot": -120.0, "phi_dot": 3.25})
    look()
    query = dict(pair.split("=") for pair in write_link(run).split("&"))
    top, initial = read_link(query)
    assert top["top.Mgl"] == 0.068
    for name, value in (("theta", 0.7), ("phi", 0.2), ("psi_dot", -120.0), ("phi_dot", 3.25)):
        assert initial[name] == pytest.approx(value, rel=1e-5)
    with pytest.raises(RefusedError):
        read_link({"Ix": "heavy"})


def test_the_torque_of_the_buttons_suits_the_top(played):
    actions, run, look = played
    actions.hold_torque(-1.0)
    look()
    assert run.motion.applied_torque == pytest.approx((0.0, 0.0, -5.1e-4), rel=1e-12)


def test_a_recording_is_switched_and_named(played, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    actions, _run, look = played
    _answer, log = actions.switch_recording()
    assert log is None
    look()
    answer, log = actions.switch_recording()
    assert log is not None
    assert answer == str(Answer("recorded", str(log)))
    assert log.is_file()
