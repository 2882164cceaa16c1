"""Energy and angular momentum: what changes is what the torques make."""

import numpy as np
import pytest
from physics.tops import EPS, random_case

from symtop_ros.physics import Friction, Motion, State, Top, motion
from symtop_ros.physics.balance import NODES, balance

ARTICLE = Top(Ix=0.000228, Iz=0.0000572, Mgl=0.068)
CUSPS = State.from_euler(theta=0.5, psi_dot=200.0)
PATHS = {
    "closed form": motion(ARTICLE, CUSPS),
    "elementary": motion(Top(ARTICLE.Ix, ARTICLE.Iz, 0.0), CUSPS),
    "friction": motion(ARTICLE, CUSPS, Friction(2e-6, 1e-5)),
    "torque": motion(ARTICLE, CUSPS, Friction(), (1e-3, -2e-3, 1e-4)),
    "both": motion(ARTICLE, CUSPS, Friction(1e-5, 1e-4), (0.0, 0.01, 0.02)),
}
# the exact engines: a sum of 24 terms, each with the rounding of a state
ROUNDING = NODES * EPS
# the splitting: up to 20 steps in a stretch of 4 rad, each with the error that it states
STATED = 20 * 1e-13


@pytest.mark.parametrize("name", PATHS)
@pytest.mark.parametrize("end", [0.05, 2.0, -1.0])
def test_energy_and_angular_momentum_balance(name, end):
    path = PATHS[name]
    top, state = path.top, path.at(end)
    found = balance(path, end, longest=1.0)
    allowed = STATED if path.driven else ROUNDING
    energy = np.abs(top.body_angular_momentum(state) * state.angular_velocity).sum() + top.Mgl
    assert abs(found.energy) < allowed * energy
    momentum = np.linalg.norm(top.angular_momentum(state))
    assert np.abs(found.angular_momentum).max() < allowed * momentum


@pytest.mark.parametrize("seed", range(12))
def test_random_tops_balance(seed):
    case = random_case(seed, "any")
    Ix, Iz, Mgl = case.top.moments
    rate = np.sqrt(abs(Mgl) / Ix)
    drive = Friction(0.1 * Iz * rate, 0.1 * Ix * rate), [0.2 * Mgl, 0.1 * Mgl, -0.1 * Mgl]
    path = motion(case.top, case.start, *drive)
    end = 1 / rate
    state = path.at(end)
    found = balance(path, end, longest=end)
    energy = np.abs(case.top.body_angular_momentum(state) * state.angular_velocity).sum() + abs(Mgl)
    momentum = np.linalg.norm(case.top.angular_momentum(state)) + Ix * rate
    assert abs(found.energy) < STATED * energy
    assert np.abs(found.angular_momentum).max() < STATED * momentum


def test_a_motion_that_is_wrong_does_not_balance():
    class Wrong(Motion):
        def at(self, t):
            return super().at(np.asarray(t) * (1 + 1e-9))

    found = balance(Wrong(ARTICLE, CUSPS), 2.0, longest=1.0)
    assert np.abs(found.angular_momentum).max() > 1e-10 * ARTICLE.Mgl / 50
