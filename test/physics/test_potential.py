"""The effective potential and the cubic meet the motion at its turning angles."""

import math

import numpy as np
import pytest
from physics.tops import ARTICLE, EPS

from symtop_ros.physics import EffectivePotential, Motion, State, Top

STARTS = {
    "cusps": State.from_euler(theta=0.5, psi_dot=200.0),
    "looping": State.from_euler(theta=0.5, phi_dot=-3.0, psi_dot=200.0),
    "unidirectional": State.from_euler(theta=0.5, phi_dot=9.0, psi_dot=200.0),
    "through the pole": State.from_euler(theta=0.5, theta_dot=30.0),
    "small tilt": State.from_euler(theta=1e-4, theta_dot=1e-2, psi_dot=100.0),
}
TOPS = {"above": ARTICLE, "below": Top(ARTICLE.Ix, ARTICLE.Iz, -ARTICLE.Mgl)}


def everywhere(test):
    """Run a test with each top and each start."""
    tops = pytest.mark.parametrize("top", TOPS.values(), ids=TOPS)
    return tops(pytest.mark.parametrize("start", STARTS.values(), ids=STARTS)(test))


def terms(top, potential):
    """Size in J of the terms whose rounding is in U_eff and in E'."""
    kinetic = potential.energy + abs(top.Mgl)
    return abs(top.Mgl) + abs(kinetic) + potential.axial_momentum**2 / top.Ix


@everywhere
def test_the_energy_line_meets_the_potential_at_the_turning_angles(top, start):
    potential = EffectivePotential.of(top, start)
    for angle in Motion(top, start).turning_angles:
        if min(angle, math.pi - angle) > 1e-6:
            # near a pole the rounding of p_phi - p_psi is divided by sin^2
            margin = 16 * EPS * terms(top, potential) / math.sin(angle) ** 2
            assert potential.at(angle) == pytest.approx(potential.energy, abs=margin)


@everywhere
def test_the_cubic_is_the_square_of_the_rate_of_u(top, start):
    motion, potential = Motion(top, start), EffectivePotential.of(top, start)
    states = motion.at(np.linspace(0.0, 1.0, 50))
    rate = np.sin(states.euler_angles.theta) * states.euler_rates.theta
    u = states.vertical[:, 2]
    scale = terms(top, potential) / top.Ix
    np.testing.assert_allclose(potential.cubic(u), rate**2, rtol=0, atol=32 * EPS * scale)


@everywhere
def test_the_cubic_vanishes_at_its_three_roots(top, start):
    motion, potential = Motion(top, start), EffectivePotential.of(top, start)
    low, high = motion.turning_angles
    third = potential.find_third_root(low, high)
    assert abs(third) >= 1 - 16 * EPS
    scale = terms(top, potential) / top.Ix
    for root in (math.cos(low), math.cos(high), third):
        # (1 - u^2)(alpha - beta u) grows with the cube of the third root
        assert abs(potential.cubic(root)) <= 64 * EPS * scale * max(1.0, abs(root)) ** 3


def test_a_top_without_weight_has_no_third_root():
    start = STARTS["looping"]
    top = Top(ARTICLE.Ix, ARTICLE.Iz, 0.0)
    assert EffectivePotential.of(top, start).find_third_root(0.5, 1.0) == math.inf
