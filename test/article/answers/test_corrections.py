"""Places at which the article disagrees with itself."""

import numpy as np

from symtop_ros.physics import Top
from workshop.article.answers import corrections
from workshop.article.motions import TOP, accelerations, cusps, regular


def test_the_figure_is_not_that_of_its_caption():
    assert not corrections.momentum_is_that_of_cusps(regular(), cusps()).holds


def test_the_equations_fail_with_other_accelerations(monkeypatch):
    monkeypatch.setattr(corrections, "accelerations", lambda *given: 1.0001 * accelerations(*given))
    assert not corrections.printed_equations_hold(TOP).holds


def test_about_an_axis_that_is_not_principal_the_momentum_leans(monkeypatch):
    right = Top.body_angular_momentum
    bent = np.array([0.0, 1e-9, 0.0])
    monkeypatch.setattr(Top, "body_angular_momentum", lambda *given: right(*given) + bent)
    assert not corrections.line_of_nodes_is_principal(TOP).holds


def test_off_the_solutions_the_sums_are_those_of_euler(monkeypatch):
    right = corrections._change_momentum
    monkeypatch.setattr(corrections, "_change_momentum", lambda *given: 1.0001 * right(*given))
    assert not corrections.printed_equations_hold(TOP).holds


def test_the_force_on_the_tilting_top_is_that_of_its_weight():
    assert not corrections.line_of_nodes_is_principal(Top(TOP.Ix, TOP.Iz, 1.01 * TOP.Mgl)).holds
