"""Fictitious torques, and the masses that feel them."""

import pytest

from symtop_ros.physics import FrameTorques, Top, precessing_frame_torques
from workshop.article.answers import fictitious
from workshop.article.answers.fictitious import claims_on_fictitious_forces, point_masses
from workshop.article.motions import HANGING_DISC, PSI_DOT, THETA, TOP

# gravity, Coriolis, centrifugal in N m at the article's rates; computed by hand to five decimals
TABLE = {
    6.497: (0.03260, -0.03563, 0.00303),
    9.0: (0.03260, -0.04936, 0.00582),
    69.825: (0.03260, -0.38296, 0.35036),
    73.0: (0.03260, -0.40038, 0.38295),
}


@pytest.mark.parametrize("phi_dot", TABLE)
def test_the_three_torques_are_those_of_the_table(phi_dot):
    found = precessing_frame_torques(TOP, THETA, phi_dot, PSI_DOT)
    assert found == pytest.approx(TABLE[phi_dot], abs=6e-6)  # printed decimals


@pytest.mark.parametrize("top", [TOP, HANGING_DISC, Top(1.0, 2.0, 0.0)])
def test_the_masses_have_the_moments_of_the_top(top):
    masses, places = point_masses(top)
    x, y, z = (places**2).T
    inertia = [masses @ (y + z), masses @ (z + x), masses @ (x + y)]
    assert inertia == pytest.approx([top.Ix, top.Ix, top.Iz], rel=4e-16 * len(masses))
    # eps of arms of 1 cm
    assert masses @ places == pytest.approx([0, 0, 0], abs=4e-18 * masses.sum())


def test_a_wrong_constant_fails_each_claim(monkeypatch):
    assert all(claim.holds for claim in claims_on_fictitious_forces(TOP))
    twice, once = fictitious.precessing_frame_torques, fictitious.point_masses

    def with_half_of_coriolis(*arguments):
        gravity, coriolis, centrifugal = twice(*arguments)
        return FrameTorques(gravity, coriolis / 2, centrifugal)

    monkeypatch.setattr(fictitious, "precessing_frame_torques", with_half_of_coriolis)
    assert [claim.holds for claim in claims_on_fictitious_forces(TOP)] == [False, False, True]
    monkeypatch.setattr(fictitious, "precessing_frame_torques", twice)
    monkeypatch.setattr(fictitious, "point_masses", lambda top: (once(top)[0] * 1.01, once(top)[1]))
    assert [claim.holds for claim in claims_on_fictitious_forces(TOP)] == [True, False, False]
