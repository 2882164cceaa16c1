"""Single statements of the article."""

import pytest

from symtop_ros.physics import Top
from workshop.article.answers import statements
from workshop.article.motions import TOP, accelerations, cusps


def test_a_body_that_is_symmetric_shows_nothing_of_the_second_term(monkeypatch):
    monkeypatch.setattr(statements, "ACROSS_Y", TOP.Ix)
    assert not statements.axis_moves_too(cusps()).holds


def test_other_accelerations_do_not_obey_lagrange(monkeypatch):
    monkeypatch.setattr(statements, "accelerations", lambda *given: 1.0001 * accelerations(*given))
    assert not statements.lagrangian_gives_the_same(TOP).holds


@pytest.mark.parametrize(
    "claim", ["masses_feel_the_euler_force", "torque_tilts_only", "release_tilts_first"]
)
def test_another_torque_is_not_in_balance(monkeypatch, claim):
    check = getattr(statements, claim)
    given = TOP if claim == "torque_tilts_only" else cusps()
    assert check(given).holds
    if claim == "release_tilts_first":
        given = cusps(Top(TOP.Ix, TOP.Iz, 1.01 * TOP.Mgl))
    right = Top.gravity_torque
    monkeypatch.setattr(Top, "gravity_torque", lambda top, state: 1.001 * right(top, state))
    assert not check(given).holds


def test_a_torque_that_follows_the_rate_has_two_changes(monkeypatch):
    monkeypatch.setattr(statements, "_change_of_momentum", lambda each: each.start.angular_velocity)
    assert not statements.one_torque_has_one_change(TOP).holds


def test_the_harmonics_of_a_heavier_top_are_others():
    assert not statements.momentum_is_nearly_a_sine(cusps(Top(TOP.Ix, TOP.Iz, 1.1 * TOP.Mgl))).holds


def test_the_first_powers_of_time_are_those_of_this_top():
    assert not statements.release_tilts_first(cusps(Top(TOP.Ix, 1.01 * TOP.Iz, TOP.Mgl))).holds
