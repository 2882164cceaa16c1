"""The kind of a motion from its start with theta' = 0."""

import numpy as np
import pytest

from symtop_ros.physics import Motion, State, Top
from workshop.article.answers import starts
from workshop.article.motions import PSI_DOT, THETA, TOP


def test_of_a_heavier_top_the_boundaries_are_others():
    heavier = Top(TOP.Ix, TOP.Iz, 1.01 * TOP.Mgl)
    assert not starts.start_decides(heavier).holds
    assert not starts.second_cusp_is_twice_as_fast(heavier).holds


def test_with_another_factor_the_rule_and_the_cusp_are_wrong(monkeypatch):
    monkeypatch.setattr(starts, "TWICE", 1.9)
    assert not any(claim.holds for claim in starts.claims_on_starts(TOP))


@pytest.mark.parametrize("share", [0.5, 0.9, 1.1, 2.0, 8.0])
def test_the_second_cusp_needs_a_spin_that_is_fast_enough(share):
    u = np.cos(THETA)
    p_psi = np.sqrt(share * 2 * TOP.Ix * TOP.Mgl * (1 + u))
    phi_dot = 2 * TOP.Mgl / p_psi
    psi_dot = p_psi / TOP.Iz - phi_dot * u
    start = State.from_euler(theta=THETA, phi_dot=phi_dot, psi_dot=psi_dot)
    assert Motion(TOP, start).kind == ("cusps" if share > 1 else "unidirectional")


def test_the_curves_are_the_edges_of_the_coloured_regions():
    """A hundred-thousandth of a rad/s on each side of a curve the kind changes."""
    phi_dot = np.array([-40.0, -9.0, 12.0, 60.0])
    curves = starts.find_curves(TOP, phi_dot)
    for name in ("cusps", "through the vertical"):
        for values in curves[name]:
            for rate, psi_dot in zip(phi_dot, values, strict=True):
                sides = [starts.loops(TOP, THETA, rate, psi_dot + d) for d in (-1e-5, 1e-5)]
                outside = np.isnan(psi_dot) or _is_dry(rate, psi_dot)
                assert outside or sides[0] != sides[1], (name, rate, psi_dot)


def _is_dry(rate, psi_dot):
    """Return True where the axis passes through the vertical without a loop on either side."""
    p_psi = TOP.Iz * (psi_dot + rate * np.cos(THETA))
    return rate * (rate * p_psi - 2 * TOP.Mgl) * p_psi <= 0


def test_regular_precession_of_the_article_lies_on_its_curve():
    (values,) = starts.find_curves(TOP, np.array([starts.SLOW, starts.FAST]))["regular precession"]
    np.testing.assert_allclose(values, PSI_DOT, rtol=1e-14)  # rounding of the roots
