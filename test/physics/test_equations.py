"""The article's equations, derived again in two ways, and the motion as a solution of them."""

import numpy as np
import pytest
from physics.tops import ARTICLE, DISC, EPS, random_case, random_states

from symtop_ros.physics import Motion, Top, theta_acceleration, theta_torque

TOPS = [ARTICLE, DISC, Top(2.0, 2.0, 7.0)]


def accelerations_of_the_article(top, angles, rates):
    """theta'', phi'', psi'' as displayed in the article."""
    Ix, Iz, Mgl = top.moments
    _, theta, _ = angles
    phi_dot, theta_dot, psi_dot = rates
    sine, cosine = np.sin(theta), np.cos(theta)
    mixed = Iz * psi_dot + (Iz - 2 * Ix) * phi_dot * cosine
    return (
        sine / Ix * ((Ix - Iz) * phi_dot**2 * cosine - Iz * phi_dot * psi_dot + Mgl),
        theta_dot / (Ix * sine) * mixed,
        theta_dot / Ix * (-cosine / sine * mixed + Ix * phi_dot * sine),
    )


def body_acceleration(top, state):
    """Euler's equations: rates of change of the body angular velocity."""
    Ix, Iz, Mgl = top.moments
    wx, wy, wz = np.moveaxis(state.angular_velocity, -1, 0)
    gx, gy, _ = np.moveaxis(state.vertical, -1, 0)
    across = ((Ix - Iz) * wy * wz + Mgl * gy) / Ix, ((Iz - Ix) * wz * wx - Mgl * gx) / Ix
    return np.stack([*across, np.zeros_like(wz)], axis=-1)


def body_acceleration_of_angles(angles, rates, accelerations):
    """The body angular velocity as a function of Euler angles, differentiated by hand."""
    _, theta, psi = angles
    p, t, s = rates
    theta_2, phi_2, psi_2 = accelerations
    st, ct, sp, cp = np.sin(theta), np.cos(theta), np.sin(psi), np.cos(psi)
    return np.stack(
        [
            phi_2 * st * sp + p * t * ct * sp + p * s * st * cp + theta_2 * cp - t * s * sp,
            phi_2 * st * cp + p * t * ct * cp - p * s * st * sp - theta_2 * sp - t * s * cp,
            phi_2 * ct - p * t * st + psi_2,
        ],
        axis=-1,
    )


@pytest.mark.parametrize("top", TOPS)
def test_eulers_equations_give_the_accelerations_of_the_article(top):
    states = random_states(2000)
    angles, rates = states.euler_angles, states.euler_rates
    accelerations = accelerations_of_the_article(top, angles, rates)
    by_angles = body_acceleration_of_angles(angles, rates, accelerations)
    # near the poles phi' is 1/sin(theta) large and its terms cancel: rounding of the largest
    sine = np.sin(angles.theta)
    terms = (np.abs(np.stack(rates)).max(axis=0) + 1) ** 2 / sine + abs(top.Mgl) / top.Ix
    error = np.abs(by_angles - body_acceleration(top, states)).max(axis=1)
    assert (error <= 256 * EPS * terms).all()


@pytest.mark.parametrize("top", TOPS)
def test_theta_acceleration_is_the_articles(top):
    states = random_states(500)
    angles, rates = states.euler_angles, states.euler_rates
    expected, _, _ = accelerations_of_the_article(top, angles, rates)
    found = theta_acceleration(top, angles.theta, rates.phi, rates.psi)
    terms = (abs(rates.phi) + abs(rates.psi)) ** 2 + abs(top.Mgl) / top.Ix
    assert (np.abs(found - expected) <= 16 * EPS * terms).all()  # sums of three products
    # without sin(theta)/Ix, which the product takes back to a few roundings
    torque = theta_torque(top, angles.theta, rates.phi, rates.psi)
    assert found == pytest.approx(np.sin(angles.theta) / top.Ix * torque, rel=4 * EPS)


@pytest.mark.parametrize("top", TOPS)
def test_the_change_of_angular_momentum_is_gravitys_torque_in_the_world(top):
    states = random_states(2000)
    L = top.body_angular_momentum(states)
    change = body_acceleration(top, states) * [top.Ix, top.Ix, top.Iz]
    in_world = states.to_world(change + np.cross(states.angular_velocity, L))
    terms = np.linalg.norm(states.angular_velocity, axis=1) * np.linalg.norm(L, axis=1)
    error = np.abs(in_world - top.gravity_torque(states)).max(axis=1)
    assert (error <= 32 * EPS * (terms + abs(top.Mgl))).all()  # three products and a rotation


@pytest.mark.parametrize("top", TOPS)
def test_gravitys_torque_lies_along_the_line_of_nodes(top):
    states = random_states(500)
    phi, theta, _ = states.euler_angles
    nodes = np.stack([np.cos(phi), np.sin(phi), np.zeros_like(phi)], axis=-1)
    expected = top.Mgl * np.sin(theta)[:, np.newaxis] * nodes
    assert np.abs(top.gravity_torque(states) - expected).max() <= 16 * EPS * abs(top.Mgl)


@pytest.mark.parametrize("seed", range(20))
def test_the_motion_obeys_the_equations_of_motion(seed):
    case = random_case(seed, "any")
    motion, top = Motion(case.top, case.start), case.top
    rate = max(np.abs(case.start.angular_velocity).max(), np.sqrt(abs(top.Mgl) / top.Ix)) * 2
    h = 0.02 / rate
    times = 0.37 / rate + h * np.arange(-4, 5)
    states = motion.at(times)
    # central differences of order 8: truncation (rate h)^8/630, rounding 8 eps/h
    weights = np.array([1 / 280, -4 / 105, 1 / 5, -4 / 5, 0, 4 / 5, -1 / 5, 4 / 105, -1 / 280]) / h
    now = motion.at(times[4])
    scale = (0.02**8 / 630 + 32 * EPS / 0.02) * rate
    wx, wy, wz = now.angular_velocity
    w, x, y, z = now.orientation
    expected = np.array(
        [
            -x * wx - y * wy - z * wz,
            w * wx + y * wz - z * wy,
            w * wy - x * wz + z * wx,
            w * wz + x * wy - y * wx,
        ]
    )
    assert np.abs(weights @ states.orientation - expected / 2).max() <= scale
    change = weights @ states.angular_velocity
    assert np.abs(change - body_acceleration(top, now)).max() <= scale * rate
