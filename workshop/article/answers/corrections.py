"""Claims on places where the article disagrees with itself, and on its longest equations."""

import numpy as np

from symtop_ros.physics import Motion, State, Top
from workshop.article.claims import Claim
from workshop.article.motions import accelerations, cusps, regular
from workshop.article.nutation import horizontal_square
from workshop.article.torque import draw_states

STILL = 1e-12  # relative; the start misses the root by rounding. Measured: 1e-15
ROUNDED = 1e-14  # of the largest; rounding of sums of a few products. Measured: 2e-16


def claims_on_corrections(top: Top) -> list[Claim]:
    """Return the claims on Fig. 5, on principal axes, and on the equations in the fixed frame."""
    return [
        momentum_is_that_of_cusps(cusps(top), regular(top)),
        line_of_nodes_is_principal(top),
        printed_equations_hold(top),
    ]


def momentum_is_that_of_cusps(nodding: Motion, steady: Motion) -> Claim:
    """Check that L^2 - L_z'^2 swings as drawn in Fig. 5 for cusps, and not for regular motion."""
    changes = []
    for motion in (nodding, steady):
        square = horizontal_square(motion, np.linspace(0.0, nodding.nutation_period, 2001))
        changes.append(float(np.ptp(square) / square.mean()))
    return Claim(
        "Fig. 5 shows the motion on cusps, as the text says; its caption names regular precession, "
        "of which L^2 - L_z'^2 is constant.",
        f"L^2 - L_z'^2 changes by {changes[0]:.1%} of its mean (cusps) and by {changes[1]:.0e} "
        "(regular)",
        f"{changes[0]:.1%}" == "8.9%" and changes[1] < STILL,
        "L^2 - L_z'^2 = p_psi^2 - p_phi^2 + 2 Ix (E' - Mgl cos(theta))",
        f"{STILL:g}: a root that is rounded to a double nutates by its rounding",
    )


def line_of_nodes_is_principal(top: Top) -> Claim:
    """Check L of the two rotations that the article says are not about principal axes."""
    theta, rate = 0.5, 10.0
    tilting = State.from_euler(theta=theta, theta_dot=rate)
    turning = State.from_euler(theta=theta, phi_dot=rate)
    L, omega = top.angular_momentum(tilting), tilting.to_world(tilting.angular_velocity)
    off = float(np.abs(L - top.Ix * omega).max() / (top.Ix * rate))
    across = top.angular_momentum(turning)
    angle = float(np.arctan2(np.linalg.norm(across[:2]), across[2]))
    tangent = (top.Ix - top.Iz) * np.sin(theta) * np.cos(theta)
    tangent /= top.Ix * np.sin(theta) ** 2 + top.Iz * np.cos(theta) ** 2
    missed = abs(angle - float(np.arctan(tangent)))
    return Claim(
        "The rotation in theta is about a principal axis, the line of nodes; only that in phi is "
        "not. The conclusion says that neither is.",
        f"at {theta} rad, theta' alone: L off Ix theta' N by {off:.0e}; phi' alone: L leans by "
        f"{np.degrees(angle):.2f} degrees from the vertical, off the equation by {missed:.0e} rad",
        off < ROUNDED and missed < ROUNDED and angle > 0.1,
        "L = Ix theta' N; tan(angle) = (Ix - Iz) sin(theta) cos(theta)/(Ix sin^2(theta) + Iz "
        "cos^2(theta))",
        f"{ROUNDED:g}: rounding of sums of a few products",
    )


def printed_equations_hold(top: Top) -> Claim:
    """Check the three equations in the fixed frame, term by term, with the accelerations."""
    states, Ix, Iz = draw_states(), top.Ix, top.Iz
    phi, theta, _ = states.euler_angles
    p, t, q = states.euler_rates
    pp, tt, qq = accelerations(top, states).T
    s, c, sine, cosine = np.sin(theta), np.cos(theta), np.sin(phi), np.cos(phi)
    along = Ix * tt + Iz * p * q * s + (Iz - Ix) * p**2 * s * c
    across = (Iz - Ix) * pp * s * c + Iz * qq * s + Iz * t * q * c
    across += Iz * t * p * (c**2 - s**2) - 2 * Ix * t * p * c**2
    upward = [Iz * qq * c, pp * (Ix * s**2 + Iz * c**2), -Iz * t * q * s]
    upward.append(-2 * (Iz - Ix) * t * p * s * c)
    found = [along * cosine + across * sine, along * sine - across * cosine, sum(upward)]
    torque = np.moveaxis(top.gravity_torque(states), -1, 0)
    size = float(np.abs(upward).max())
    off = float(np.abs(np.array(found) - torque).max()) / size
    return Claim(
        "The three equations in the fixed frame hold as they are printed, with the accelerations "
        "that follow from them.",
        f"on {len(phi)} random states the right sides are off the torque by {off:.0e} of their "
        f"largest term, {size:.3g} N m",
        off < ROUNDED,
        "Mgl sin(theta) (cos(phi), sin(phi), 0) = the article's three sums",
        f"{ROUNDED:g}: rounding of sums of products",
    )
