"""Rounding that decides the kind of a motion: found next to the separatrix, and nowhere else."""

import math

import numpy as np
import pytest
from drawn import Numbers, cos, sin, sqrt
from physics.tops import ARTICLE, CUSPS, FAMILIES, random_case
from trials import seeds

from symtop_ros.physics import Friction, Motion, State, Top

APART = 0.01  # rad, as the docs say


def draw_asymptotic(seed):
    """A slow top that approaches the vertical for ever, up to the rounding of its numbers.

    b = a gives phi' = a/(1 + u), and theta' has the energy that is left of 2 Mgl (1 - u)/Ix.
    """
    rng = Numbers(f"doubt {seed}")
    Ix = rng.power(-5, 1)
    top = Top(Ix, Ix * rng.uniform(0.05, 1.9), Ix * rng.power(0, 3))
    theta, beta = rng.uniform(0.3, 2.8), 2 * top.Mgl / Ix
    # a^2 (1 - u)/(1 + u) < beta (1 - u) leaves some, and a^2 < 2 beta lets a sleeping axis fall.
    a = sqrt(beta) * rng.uniform(-1, 1) * min(sqrt(1 + cos(theta)), 1.2)
    phi_dot = a / (1 + cos(theta))
    left = beta * (1 - cos(theta)) - (phi_dot * sin(theta)) ** 2
    rates = {"phi_dot": phi_dot, "psi_dot": a * Ix / top.Iz - phi_dot * cos(theta)}
    return top, State.from_euler(theta=theta, theta_dot=-sqrt(left), **rates)


def find_neighbours(top, start):
    """All motions of which one number is the next double, up or down."""
    numbers = np.concatenate([top.moments, start.given_orientation, start.angular_velocity])
    for k in np.flatnonzero(numbers):
        for towards in (-np.inf, np.inf):
            changed = numbers.copy()
            changed[k] = np.nextafter(changed[k], towards)
            yield Motion(Top(*changed[:3]), State(changed[3:7], changed[7:]))


def find_angles_between(one, other, times):
    axes = [motion.at(times).to_world([0.0, 0.0, 1.0]) for motion in (one, other)]
    return np.linalg.norm(axes[0] - axes[1], axis=-1)


@pytest.mark.parametrize("seed", seeds(20, 500))
def test_a_start_on_the_separatrix_parts_from_a_neighbour_when_it_is_said_to(seed):
    top, start = draw_asymptotic(seed)
    motion = Motion(top, start)
    shows_at = motion.rounding_shows_at
    # The time in which an error of one EPS grows to 0.01 rad is 30 swings or more.
    assert 10 / math.sqrt(top.Mgl / top.Ix) < shows_at < math.inf
    before = np.linspace(0.0, shows_at * (1 - 1e-6), 400)
    parted = 0.0
    for each in find_neighbours(top, start):
        assert find_angles_between(motion, each, before).max() < APART * (1 + 1e-6)
        parted = max(parted, find_angles_between(motion, each, [shows_at * (1 + 1e-6)])[0])
    assert parted > APART * (1 - 1e-6)


@pytest.mark.parametrize("seed", seeds(20, 500))
def test_a_millionth_of_a_rate_leaves_no_doubt(seed):
    top, start = draw_asymptotic(seed)
    x, y, z = start.angular_velocity
    for factor in (1 - 1e-6, 1 + 1e-6):
        moved = State(start.given_orientation, (x * factor, y * factor, z))
        assert Motion(top, moved).rounding_shows_at == math.inf


@pytest.mark.parametrize("seed", seeds(60, 3000))
def test_motions_of_all_families_are_in_no_doubt_but_next_to_the_separatrix(seed):
    case = random_case(seed, FAMILIES[seed % len(FAMILIES)])
    motion = Motion(case.top, case.start)
    if motion.rounding_shows_at < math.inf:
        swings = motion.nutation_period * math.sqrt(abs(case.top.Mgl) / case.top.Ix)
        assert swings > 20, "an error of one EPS does not grow to 0.01 rad in less"


def test_what_else_acts_leaves_no_doubt():
    assert Motion(ARTICLE, CUSPS).rounding_shows_at == math.inf
    assert Motion(ARTICLE, CUSPS, clamped=True).rounding_shows_at == math.inf
    top, start = draw_asymptotic(1)
    assert Motion(top, start, friction=Friction(axial=1e-9)).rounding_shows_at == math.inf
