"""Claims on places where the article disagrees with itself, and on its longest equations."""

import numpy as np

from symtop_ros.arrays import Real
from symtop_ros.physics import Body, Motion, State, Top
from workshop.article.claims import Claim, Measured, claim
from workshop.article.motions import THETA, accelerations, cusps, regular
from workshop.article.nutation import horizontal_square, times_of_extreme_rate
from workshop.article.torque import FASTEST, SEED, draw_states

STILL = 1e-12  # relative; the start misses the root by rounding. Measured: 1e-15
ROUNDED = 1e-14  # of the largest; rounding of sums of a few products. Measured: 5e-16
SUBTRACTED = 1e-13  # relative; the weight is subtracted from a larger force. Measured: 4e-15


def claims_on_corrections(top: Top) -> list[Claim]:
    """Return the claims on Fig. 5, on principal axes, and on the equations in the fixed frame."""
    return [
        momentum_is_that_of_cusps(cusps(top), regular(top)),
        line_of_nodes_is_principal(top),
        printed_equations_hold(top),
    ]


@claim
def momentum_is_that_of_cusps(nodding: Motion, steady: Motion) -> Measured:
    """Check that L^2 - L_z'^2 swings as drawn in Fig. 5 for cusps, and not for regular motion."""
    changes = []
    for motion in (nodding, steady):
        square = horizontal_square(motion, np.linspace(0.0, nodding.nutation_period, 2001))
        changes.append(float(np.ptp(square) / square.mean()))
    return Measured(f"{changes[0]:.1%}" == "8.9%" and changes[1] < STILL, changes=changes)


@claim
def line_of_nodes_is_principal(top: Top) -> Measured:
    """Check L of the rotations in theta and in phi, and the force that the first one needs."""
    rate = _fastest_fall(top)
    tilting = State.from_euler(theta=THETA, theta_dot=rate)
    turning = State.from_euler(theta=THETA, phi_dot=rate)
    L, omega = top.angular_momentum(tilting), tilting.to_world(tilting.angular_velocity)
    off = float(np.abs(L - top.Ix * omega).max() / (top.Ix * rate))
    across = top.angular_momentum(turning)
    angle = float(np.arctan2(np.linalg.norm(across[:2]), across[2]))
    tangent = (top.Ix - top.Iz) * np.sin(THETA) * np.cos(THETA)
    tangent /= top.Ix * np.sin(THETA) ** 2 + top.Iz * np.cos(THETA) ** 2
    missed = abs(angle - float(np.arctan(tangent)))
    body = Body.of(top)
    force = body.pivot_force(Motion(top, tilting), tilting) @ tilting.to_world([0.0, 0.0, 1.0])
    needed = body.mass * body.gravity * np.cos(THETA) - float(force)
    holds = (
        off < ROUNDED
        and missed < ROUNDED
        and angle > 0.1
        and abs(needed / (top.Mgl / body.gravity * rate**2) - 1) < SUBTRACTED
        and f"{needed:.3f}" == "0.072"
    )
    return Measured(
        holds, rate=rate, off=off, needed=needed, degrees=np.degrees(angle), missed=missed
    )


def _fastest_fall(top: Top) -> float:
    """Return theta' in rad/s of cusps at t1."""
    first, _ = times_of_extreme_rate(cusps(top))
    return float(cusps(top).at(first).euler_rates.theta)


@claim
def printed_equations_hold(top: Top) -> Measured:
    """Check the three equations in the fixed frame, term by term, with the accelerations."""
    states = draw_states()
    solved = accelerations(top, states)
    torque = np.moveaxis(top.gravity_torque(states), -1, 0)
    found, size = _write_out(top, states, solved)
    off = float(np.abs(found - torque).max()) / size
    # Off the solutions the sums are dL/dt of accelerations that no torque of gravity makes
    random = np.random.default_rng(SEED + 2).uniform(-(FASTEST**2), FASTEST**2, solved.shape)
    found, largest = _write_out(top, states, random)
    missed = float(np.abs(found - _change_momentum(top, states, random)).max()) / largest
    return Measured(
        off < ROUNDED and missed < ROUNDED, count=len(states), off=off, size=size, missed=missed
    )


def _write_out(top: Top, states: State, changes: Real) -> tuple[Real, float]:
    """Return the article's three sums (3, n) in N m, and their largest term."""
    Ix, Iz = top.Ix, top.Iz
    phi, theta, _ = states.euler_angles
    p, t, q = states.euler_rates
    pp, tt, qq = changes.T
    s, c, sine, cosine = np.sin(theta), np.cos(theta), np.sin(phi), np.cos(phi)
    along = Ix * tt + Iz * p * q * s + (Iz - Ix) * p**2 * s * c
    across = (Iz - Ix) * pp * s * c + Iz * qq * s + Iz * t * q * c
    across += Iz * t * p * (c**2 - s**2) - 2 * Ix * t * p * c**2
    upward = [Iz * qq * c, pp * (Ix * s**2 + Iz * c**2), -Iz * t * q * s]
    upward.append(-2 * (Iz - Ix) * t * p * s * c)
    found = [along * cosine + across * sine, along * sine - across * cosine, sum(upward)]
    return np.array(found), float(np.abs(upward).max())


def _change_momentum(top: Top, states: State, changes: Real) -> Real:
    """Return dL/dt (3, n) in N m for phi'', theta'' and psi'' (n, 3), by Euler's equations."""
    phi_dot, theta_dot, psi_dot = states.euler_rates
    _, theta, psi = states.euler_angles
    pp, tt, qq = changes.T
    s, c, sine, cosine = np.sin(theta), np.cos(theta), np.sin(psi), np.cos(psi)
    # omega_x = a sin(psi) + theta' cos(psi), omega_y = a cos(psi) - theta' sin(psi)
    a, da = phi_dot * s, pp * s + phi_dot * theta_dot * c
    alpha = np.stack(
        [
            da * sine + tt * cosine + psi_dot * (a * cosine - theta_dot * sine),
            da * cosine - tt * sine - psi_dot * (a * sine + theta_dot * cosine),
            qq + pp * c - phi_dot * theta_dot * s,
        ],
        axis=-1,
    )
    moments, omega = np.array([top.Ix, top.Ix, top.Iz]), states.angular_velocity
    return states.to_world(moments * alpha + np.cross(omega, moments * omega)).T
