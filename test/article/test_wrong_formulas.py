"""Claims that hold for every top fail if one of their two formulas is a little different."""

import numpy as np
import pytest

from symtop_ros.physics import State, Top
from workshop.article import frames, rates, torque
from workshop.article.answers import ledger, starts
from workshop.article.motions import HANGING_DISC, RATES, THETA, TOP, Rate, cusps, regular


@pytest.mark.parametrize("direction", ["rises", "falls", "stays"])
@pytest.mark.parametrize("rate", RATES, ids=lambda rate: f"{rate.phi_dot:.3g}")
def test_the_claim_on_a_rate_holds_only_with_the_direction_of_the_top(rate, direction):
    claim = rates.rate_decides(TOP, Rate(rate.phi_dot, rate.place, direction))
    assert claim.holds == (direction == rate.direction)


@pytest.mark.parametrize(("name", "other"), [("regular", cusps), ("cusps", regular)])
def test_cusps_are_not_taken_for_regular_precession(name, other, monkeypatch):
    monkeypatch.setattr(torque, name, other)
    assert torque.torque_is_across_momentum(TOP).holds == (other is regular)
    assert not torque.precession_alone_balances_gravity(TOP).holds


@pytest.mark.parametrize(("phi_dot", "shown"), [(0.0, True), (-5.0, True), (9.0, False)])
def test_only_rates_on_both_sides_of_a_root_begin_alike_and_are_of_different_kinds(phi_dot, shown):
    assert starts.accelerations_do_not_decide(TOP, phi_dot).holds == shown


def test_an_upright_parabola_is_not_taken_for_one_that_opens_downward():
    assert not starts.parabola_opens_downward(TOP, "upright", THETA).holds
    assert not starts.parabola_opens_downward(HANGING_DISC, "hanging", THETA).holds
    assert not starts.six_rates_have_kinds(Top(TOP.Ix, TOP.Iz, 1.01 * TOP.Mgl)).holds


@pytest.mark.parametrize("hold", ledger.HOLDS)
def test_of_another_top_the_energies_of_a_kick_are_others(hold):
    for other in (Top(1.01 * TOP.Ix, TOP.Iz, TOP.Mgl), Top(TOP.Ix, TOP.Iz, 1.01 * TOP.Mgl)):
        assert not ledger.precession_lifts(other, hold).holds


def test_a_changed_sign_in_the_matrix_is_noticed(monkeypatch):
    right = State.matrix.fget
    wrong = property(lambda state: right(state) * np.array([[1, -1, 1], [1, 1, 1], [1, 1, 1]]))
    monkeypatch.setattr(State, "matrix", wrong)
    assert not frames.matrix_turns_body_to_world(TOP).holds
    assert not frames.inertia_is_an_integral(TOP).holds
