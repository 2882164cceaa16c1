import pytest

from symtop_ros.physics import Top
from workshop.article import kinds
from workshop.article.motions import HANGING_DISC, THETA, TOP


def test_for_a_heavier_top_the_six_rates_have_other_kinds():
    assert kinds.six_rates_have_kinds(TOP).holds
    assert not kinds.six_rates_have_kinds(Top(TOP.Ix, TOP.Iz, 1.01 * TOP.Mgl)).holds


@pytest.mark.parametrize("phi_dot", [0.0, -1.0, -5.0])
def test_a_rate_and_its_partner_begin_alike_and_are_of_different_kinds(phi_dot):
    assert kinds.accelerations_do_not_decide(TOP, phi_dot).holds


def test_two_rates_between_the_roots_are_of_one_kind_so_that_nothing_is_shown():
    assert not kinds.accelerations_do_not_decide(TOP, 9.0).holds


def test_an_upright_parabola_is_not_taken_for_one_that_opens_downward():
    assert not kinds.parabola_opens_downward("upright", TOP, THETA).holds
    assert not kinds.parabola_opens_downward("hanging", HANGING_DISC, THETA).holds


def test_without_roots_there_is_nothing_to_claim():
    assert not kinds.parabola_opens_downward("heavy", Top(TOP.Ix, TOP.Iz, 0.6), THETA).holds
