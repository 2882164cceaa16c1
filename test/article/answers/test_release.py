"""An axis that is let go at rest, with and without spin, and torque alone."""

import numpy as np
import pytest

from symtop_ros.physics import Top
from workshop.article.answers import release
from workshop.article.motions import TOP, cusps

HEAVIER = Top(TOP.Ix, TOP.Iz, 1.001 * TOP.Mgl)


def test_the_largest_tilts_are_those_of_the_constants_of_motion():
    degrees = [np.degrees(release.largest_tilt(TOP, spin)) for spin in release.SPINS]
    assert degrees == pytest.approx([180.0, 163.8, 130.4, 93.8, 38.0, 30.4], abs=0.05)


def test_the_tilts_of_a_heavier_top_are_others(monkeypatch):
    right = release.largest_tilt
    monkeypatch.setattr(release, "largest_tilt", lambda _, spin: right(HEAVIER, spin))
    assert not release.spin_limits_the_fall(TOP).holds


def test_the_least_spin_is_that_of_this_top():
    assert not release.regular_precession_needs_spin(HEAVIER).holds


def test_at_another_spin_rate_there_is_another_case(monkeypatch):
    monkeypatch.setattr(release, "PSI_DOT", 60.0)  # named as the case in which psi' only falls
    assert not release.spin_has_three_cases(TOP).holds


def test_another_torque_leads_to_another_motion(monkeypatch):
    right = Top.gravity_torque
    monkeypatch.setattr(Top, "gravity_torque", lambda top, state: 1.0001 * right(top, state))
    assert not release.torque_suffices(cusps()).holds
