"""Angles, rates, angular momentum and torque of a state, compared with 50 digits."""

import math

import numpy as np
import pytest
from mpmath import mp, mpf
from physics.tops import ARTICLE, EPS, exact_euler, exact_parts, turn

from symtop_ros.physics import State


def states(near):
    """States with theta anywhere, down to 1e-9 from a pole, or with parts of all sizes."""
    rng = np.random.default_rng(5)
    for _ in range(200):
        small = 10.0 ** rng.uniform(-9, 0)
        theta = {"pole": small, "lower pole": math.pi - small}.get(near, rng.uniform(0.1, 3.0))
        phi, psi = rng.uniform(-3, 3, 2)
        rates = dict(zip(("theta_dot", "phi_dot", "psi_dot"), rng.normal(size=3), strict=True))
        state = State.from_euler(theta=theta, phi=phi, psi=psi, **rates)
        if near == "zero":
            q = rng.normal(size=4) * 10 ** rng.uniform(-12, 0, 4)
            state = State(q / np.linalg.norm(q), state.angular_velocity)
        yield state


NEAR = pytest.mark.parametrize("near", ["pole", "lower pole", "nothing", "zero"])


@NEAR
def test_angles_and_rates_keep_their_digits(near):
    for state in states(near):
        with mp.workdps(50):
            q, omega = exact_parts(state)
            (phi, theta, psi), rates = exact_euler(q, omega)
            angles, size, sine = state.euler_angles, mp.norm(omega), mp.sin(theta)
            # measured: 0.9, 0.4, 0.4 and 1.4 of these units, of the last 2.2 with parts near zero
            assert abs(angles.theta - theta) <= 2 * EPS * theta
            for angle, value in ((angles.phi, phi), (angles.psi, psi)):
                turns = (angle - value) / (2 * mp.pi)
                assert abs(turns - mp.nint(turns)) * 2 <= min(4, 1 / sine) * EPS
            for rate, value in zip(state.euler_rates, rates, strict=True):
                assert abs(rate - value) <= (3 if near == "zero" else 2) * EPS * size / sine


@NEAR
def test_angular_momentum_and_torque_keep_their_digits(near):
    Ix, Iz, Mgl = map(mpf, ARTICLE.moments)
    for state in states(near):
        with mp.workdps(50):
            q, (wx, wy, wz) = exact_parts(state)
            momentum = turn(q, [Ix * wx, Ix * wy, Iz * wz])
            axis = turn(q, [mpf(0), mpf(0), Mgl])
            torque = [-axis[1], axis[0], mpf(0)]
            # measured: 3.6 and 1.9; the norm of a rounded quaternion alone gives 2
            for found, value in (
                (ARTICLE.angular_momentum(state), momentum),
                (ARTICLE.gravity_torque(state), torque),
            ):
                parts = zip(value, found.tolist(), strict=True)
                assert mp.norm([a - b for a, b in parts]) <= 4 * EPS * mp.norm(value)
