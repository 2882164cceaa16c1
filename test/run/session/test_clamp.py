"""A hand on the gimbal, as a request: what is held, what is refused, what is told."""

import json

import numpy as np
import pytest
from physics.tops import ARTICLE, EPS
from run.simulation.runs import Run

from symtop_ros.physics import clamp_verdict, kick_verdict, perrys_rule
from symtop_ros.run.session.diagnostics import balance_status, motion_status, summarize_state
from symtop_ros.run.simulation.settings import Settings

HELD = "must come while the precession is free, got it held: release it first (~/clamp with false)"


@pytest.fixture(name="held")
def _held():
    run = Run("regular_precession", 0.1)
    run.ask("clamp", True)
    return run


def find_motion(run):
    return run.simulation.segment.motion


def test_it_stops_the_precession_and_says_what_follows():
    run = Run("regular_precession", 0.1)
    before = run.simulation.state
    granted, answer = run.ask("clamp", True)
    motion = find_motion(run)
    assert (granted, answer) == (True, str(clamp_verdict(ARTICLE, before)))
    assert motion.kind == "clamped"
    assert run.sink.events[-1].name == "clamp"
    rates = motion.euler_rates(run.simulation.state)
    assert rates.phi_dot == 0.0
    p_psi = [float(ARTICLE.axial_momentum(each)) for each in (before, run.simulation.state)]
    assert p_psi[0] == p_psi[1]
    run.advance(0.15)
    assert run.simulation.state.euler_angles.theta > 2.0  # it falls


def test_let_go_it_goes_on_without_precession(held):
    held.advance(0.05)
    state = held.simulation.state
    granted, answer = held.ask("clamp", False)
    assert (granted, find_motion(held).kind) == (True, "looping")
    assert answer == f"Let go. Kind of motion: looping. {perrys_rule(ARTICLE, state)}"
    assert held.simulation.state == state


def test_asked_for_again_it_changes_nothing(held):
    before = held.simulation.segment
    assert held.ask("clamp", True) == (True, "the precession is held already")
    assert held.simulation.segment is before
    held.ask("clamp", False)
    assert held.ask("clamp", False) == (True, "the precession is free already")


REFUSED = [
    ("kick", {"precession_rate_factor": 1.4}, f"kick {HELD}"),
    ("kick", {"axle_impulse": 1e-6, "rate": 50.0, "number": 20}, f"pushes {HELD}"),
    ("kick", {"angular_impulse": (0.0, 0.0, 1e-5)}, f"kick {HELD}"),
    ("hurry_precession", None, f"kick {HELD}"),
]


@pytest.mark.parametrize(("service", "values", "reason"), REFUSED)
def test_what_would_act_on_a_held_precession_is_refused_and_changes_nothing(
    held, service, values, reason
):
    before = held.simulation.segment
    count = len(held.sink.events)
    given = () if values is None else (values,)
    assert held.ask(service, *given) == (False, reason)
    assert held.simulation.segment is before
    assert len(held.sink.events) == count


def test_torques_and_friction_are_refused_while_it_is_held(held):
    with pytest.raises(ValueError, match="~/applied_torque must come while the precession is free"):
        held.simulation.hold_torque((0.0, 0.0, 1e-4))
    timeline, stamp = held.simulation.timeline, held.simulation.stamp
    for name, value in (("friction.axial", 1e-6), ("steady_torque", [0.0, 0.0, 1e-4])):
        settings = Settings.from_values({**timeline.settings.values, name: value})
        with pytest.raises(ValueError, match=f"^{name} must come while the precession is free"):
            timeline.change_settings(settings, stamp)
    assert find_motion(held).clamped
    held.change({"top.Mgl": 0.05})  # another weight falls as well
    assert find_motion(held).clamped
    assert find_motion(held).top.Mgl == 0.05


TORQUE = "steady_torque plus ~/applied_torque"
OBSTACLES = [
    ({"scene": "sleeping"}, "theta must be > 0 and < pi rad for ~/clamp (no phi on the ", "0"),
    (
        {"friction.axial": 2.0**-20},
        "friction.axial must be 0 for ~/clamp, got",
        "9.5367431640625e-07",
    ),
    ({"friction.transverse": 0.5}, "friction.transverse must be 0 for ~/clamp, got", "0.5"),
    ({"steady_torque": [0.0, 0.0, 0.5]}, f"{TORQUE} must be 0 for ~/clamp, got", "[0.0, 0.0, 0.5]"),
]


@pytest.mark.parametrize(("changes", "reason", "got"), OBSTACLES)
def test_a_clamp_is_refused_by_the_name_and_the_value_of_its_obstacle(changes, reason, got):
    run = Run(seconds=0.1, **changes)
    granted, answer = run.ask("clamp", True)
    assert not granted
    assert answer.startswith(reason)
    assert answer.endswith(f"got {got}")
    assert not find_motion(run).clamped


NOT_HELD = [
    ({"theta": 0.0}, {}, "for a start on the vertical (theta = 0 rad), got True"),
    ({}, {"friction.axial": 0.5}, "together with friction.axial = 0.5, got True"),
    ({}, {"steady_torque": [0.0, 0.5, 0.0]}, f"together with {TORQUE} = [0.0, 0.5, 0.0], got True"),
]


@pytest.mark.parametrize(("start", "changes", "reason"), NOT_HELD)
def test_a_start_that_cannot_be_held_names_the_parameter_that_would_hold_it(start, changes, reason):
    run = Run("cusps", initial__clamped=True)
    run.ask("clamp", False)
    run.change(changes)
    before = run.simulation.segment
    granted, answer = run.ask("set_initial_conditions", start)
    assert not granted
    assert answer == f"initial.clamped must be false {reason}"
    assert run.simulation.segment is before
    if not start:
        assert run.ask("reset") == (False, answer)
    with pytest.raises(ValueError, match=r"initial\.clamped must be false "):
        Run(
            "cusps",
            initial__clamped=True,
            **changes,
            **{f"initial.{k}": v for k, v in start.items()},
        )


@pytest.mark.parametrize("service", ["reset", "set_initial_conditions"])
def test_a_start_lets_go(held, service):
    granted, _ = held.ask(service, *([] if service == "reset" else [{"theta": 0.7}]))
    assert granted
    assert not find_motion(held).clamped


def test_a_scene_may_begin_held_and_a_reset_holds_it_again():
    run = Run("cusps", initial__clamped=True)
    (start,) = run.sink.events
    assert (
        start.verdict
        == f"Kind of motion: clamped. {clamp_verdict(ARTICLE, find_motion(run).start)}"
    )
    run.ask("clamp", False)
    run.advance(0.1)
    run.ask("reset")
    assert find_motion(run).clamped


def test_pushes_end_where_it_takes_hold():
    run = Run("cusps", 0.1)
    run.ask("kick", {"axle_impulse": 1e-6, "rate": 50.0, "number": 20})
    run.advance(0.1)
    assert run.ask("clamp", True)[0]
    assert find_motion(run).pushes is None
    assert run.sink.events[-1].values["before.pushes"] == "6"


def test_the_state_and_the_diagnostics_say_that_a_hand_holds_it(held):
    held.advance(0.05)
    segment, stamp = held.simulation.segment, held.simulation.stamp
    found = json.loads(json.dumps(summarize_state(segment, stamp), allow_nan=False))
    verdict = str(clamp_verdict(ARTICLE, segment.motion.start))
    assert (found["clamped"], found["kind"], found["verdict"]) == (True, "clamped", verdict)
    assert (found["why"], found["perrys_rule_holds"]) == ("", None)
    assert (found["mean_precession_rate"], found["fast_top_precession_rate"]) == (0.0, None)
    spin = float(ARTICLE.axial_momentum(segment.motion.start)) / ARTICLE.Iz
    assert found["mean_spin_rate"] == pytest.approx(spin, rel=2 * EPS)
    assert (found["euler_rates"]["phi"], found["seen_from_above"]) == (0.0, "")
    assert found["euler_rates"]["psi"] == found["mean_spin_rate"]
    hand = np.array(found["torque"]) - ARTICLE.gravity_torque(held.simulation.state)
    assert np.linalg.norm(hand) > 0
    motion = motion_status(segment, stamp, 1)
    balance = balance_status(segment, stamp)
    assert motion.message == verdict
    assert abs(float(motion.values["L_z'.drift"])) > 1e-4
    assert balance.message == "a hand holds the precession: L_z' is not constant"
    assert abs(float(balance.values["energy.balance"])) < 1e-15
    assert max(map(abs, map(float, balance.values["angular_momentum.balance"].split()))) < 1e-15


def test_a_kick_after_it_is_judged_as_any_other(held):
    held.advance(0.05)
    held.ask("clamp", False)
    before = held.simulation.state
    granted, answer = held.ask("kick", {"precession_rate": 8.0})
    assert granted
    assert answer == str(kick_verdict(find_motion(held), before, "spin_rate"))
