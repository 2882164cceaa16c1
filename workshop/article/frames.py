"""Claims on the equations that connect both frames, and on what the article says in passing."""

import numpy as np
from scipy.integrate import solve_ivp

from symtop_ros.arrays import Real
from symtop_ros.physics import Motion, Top, hurry, regular_precession_rates
from workshop.article.answers.fictitious import point_masses
from workshop.article.claims import Claim, claim, differ
from workshop.article.motions import FAST, PSI_DOT, SLOW, THETA, start
from workshop.article.torque import COUNT, SEED, draw_states, inertia_in_world

ROUNDED = 1e-14  # relative; products of a few rotations with errors of eps
SUMMED = 1e-13  # relative; sums over 16 masses, of which some cancel
FACTOR = 1.4  # by which the precession is delayed
SPRING, MASS, REST = 400.0, 0.001, 0.03  # N/m, kg, m: a mass on a spring that turns with the top
FOLLOWED = 1e-9  # relative; DOP853 at a relative tolerance of 1e-12 over ten turns


def claims_on_frames(top: Top) -> list[Claim]:
    """Return the claims on equations 4, 6, 9 and 17, delays, roots of one sign and tension."""
    return [
        matrix_turns_body_to_world(),
        angular_velocity_has_its_components(),
        torque_has_its_components_in_the_body(top),
        inertia_is_an_integral(top),
        delay_does_the_opposite(top),
        roots_have_the_sign_of_the_spin(top),
        elastic_body_elongates(),
    ]


def _turn(angles: Real, axis: int) -> Real:
    """Return the matrices (n, 3, 3) of turns about the x-axis (0) or the z-axis (2)."""
    c, s = np.cos(angles), np.sin(angles)
    turned = np.zeros((len(angles), 3, 3))
    first, second = (1, 2) if axis == 0 else (0, 1)
    turned[:, axis, axis] = 1.0
    turned[:, first, first] = turned[:, second, second] = c
    turned[:, second, first], turned[:, first, second] = s, -s
    return turned


@claim
def matrix_turns_body_to_world() -> Claim:
    """Check the matrix of the attitude against equation 6, and against three turns."""
    states = draw_states()
    phi, theta, psi = map(np.asarray, states.euler_angles)
    a, b, c, s, f, g = (
        np.cos(phi),
        np.sin(phi),
        np.cos(theta),
        np.sin(theta),
        np.cos(psi),
        np.sin(psi),
    )
    rows = [
        [a * f - c * b * g, -a * g - c * b * f, s * b],
        [b * f + c * a * g, -b * g + c * a * f, -s * a],
        [s * g, s * f, c],
    ]
    printed = np.moveaxis(np.array(rows), -1, 0)
    turned = _turn(phi, 2) @ _turn(theta, 0) @ _turn(psi, 2)
    off = max(float(np.abs(states.matrix - each).max()) for each in (printed, turned))
    return Claim(
        "Equation 6 turns vectors of the body frame into the fixed frame: about z by psi, about "
        "the line of nodes by theta, about z' by phi.",
        f"on {COUNT} random attitudes the matrix, equation 6 and three turns differ by {off:.0e}",
        off < ROUNDED,
        "S = R_z(phi) R_x(theta) R_z(psi)",
        f"{ROUNDED:g}: rounding of the angles and of products of three matrices",
    )


@claim
def angular_velocity_has_its_components() -> Claim:
    """Check the angular velocity in the fixed frame by Euler's rates, equation 9."""
    states = draw_states()
    (phi, theta, _), rates = map(tuple, (states.euler_angles, states.euler_rates))
    p, t, s = rates
    printed = np.stack(
        [
            t * np.cos(phi) + s * np.sin(theta) * np.sin(phi),
            t * np.sin(phi) - s * np.sin(theta) * np.cos(phi),
            p + s * np.cos(theta),
        ],
        axis=-1,
    )
    off = differ(states.to_world(states.angular_velocity), printed)
    return Claim(
        "Equation 9 gives the angular velocity in the fixed frame by the rates of Euler's angles.",
        f"on {COUNT} random states it differs from the turned one by {off:.0e} of the largest",
        off < 10 * ROUNDED,
        "omega = theta' N + phi' z' + psi' z",
        f"{10 * ROUNDED:g}: rounding, over sin(theta) >= 0.1 in phi' and psi'",
    )


@claim
def torque_has_its_components_in_the_body(top: Top) -> Claim:
    """Check gravity's torque in the body frame, equation 17."""
    states = draw_states()
    _, theta, psi = states.euler_angles
    size = top.Mgl * np.sin(theta)
    printed = np.stack([size * np.cos(psi), -size * np.sin(psi), 0 * size], axis=-1)
    found = states.to_body(top.gravity_torque(states))
    off = float(np.abs(found - printed).max() / 0.068)
    return Claim(
        "Equation 17 gives gravity's torque in the body frame.",
        f"on {COUNT} random attitudes it differs from the turned torque by {off:.0e} of 0.068 N m; "
        f"largest {np.abs(found).max():.4f} N m",
        bool(off < ROUNDED and np.abs(found).max() > 0.067),
        "S^-1 torque = Mgl sin(theta) (cos(psi), -sin(psi), 0)",
        f"{ROUNDED:g}: rounding of a rotation; the largest component as for Mgl = 0.068 J",
    )


@claim
def inertia_is_an_integral(top: Top) -> Claim:
    """Check the integral of equation 4, over mass elements in the fixed frame, against I'."""
    states, (masses, places) = draw_states(), point_masses(top)
    moved = np.einsum("nij,kj->nki", states.matrix, places)
    squares = (moved**2).sum(axis=-1)
    summed = np.einsum("k,nk,ij->nij", masses, squares, np.eye(3)) - np.einsum(
        "k,nki,nkj->nij", masses, moved, moved
    )
    angles = states.euler_angles
    off = differ(summed, inertia_in_world(top, angles.phi, angles.theta))
    return Claim(
        "The integral of equation 4, in the fixed frame, is the tensor that equation 7 gives.",
        f"summed over {len(masses)} masses on {COUNT} random attitudes: equal within {off:.0e}",
        off < SUMMED,
        "I'_ij = sum of m (r^2 delta_ij - r_i r_j)",
        f"{SUMMED:g}: sums of rounded products that cancel",
    )


@claim
def delay_does_the_opposite(top: Top) -> Claim:
    """Check that a delayed top falls at the slow root and rises at the fast one."""
    found = []
    for rate in (SLOW, FAST):
        low, high = Motion(top, hurry(start(rate), 1 / FACTOR)).turning_angles
        found.append((float(low), float(high)))
    (slow_low, slow_high), (fast_low, fast_high) = found
    falls = abs(slow_low - THETA) < ROUNDED and slow_high > THETA + 0.01
    rises = abs(fast_high - THETA) < ROUNDED and fast_low < THETA - 0.01
    return Claim(
        "Delayed, the top falls at the slow root and rises at the fast one.",
        f"phi' divided by {FACTOR}: theta {slow_low:.3f} to {slow_high:.3f} rad at the slow root, "
        f"{fast_low:.3f} to {fast_high:.3f} rad at the fast one",
        falls and rises,
        "theta'' changes its sign at both roots",
        f"{ROUNDED:g} rad: the start is a turning point; 0.01 rad of motion",
    )


@claim
def roots_have_the_sign_of_the_spin(top: Top) -> Claim:
    """Check that roots of one sign have the sign of the spin rate, also if it is negative."""
    random = np.random.default_rng(SEED + 2)
    roots = regular_precession_rates(top, THETA, -PSI_DOT)
    signs = []
    for Iz, theta, spin in random.uniform((0.1, 0.1, -400.0), (1.9, 3.0, 400.0), (COUNT, 3)):
        other = Top(top.Ix, Iz * top.Ix, abs(top.Mgl))
        rates = regular_precession_rates(other, theta, spin)
        if len(rates) == 2:
            is_upward = (other.Ix - other.Iz) * np.cos(theta) > 0
            signs.append(
                all(np.sign(rates) == np.sign(spin)) if is_upward else rates[0] * rates[1] < 0
            )
    return Claim(
        "If (Ix - Iz) cos(theta) > 0 both roots have the sign of psi', else different ones.",
        f"at psi' = -200 rad/s the roots are {roots[0]:.3f} and {roots[1]:.2f} rad/s; "
        f"{sum(signs)} of {len(signs)} random tops with two roots agree",
        bool(np.allclose(sorted(roots), (-FAST, -SLOW), rtol=SUMMED) and all(signs)),
        "phi'_1 + phi'_2 = Iz psi'/((Ix - Iz) cos(theta)), "
        "phi'_1 phi'_2 = Mgl/((Ix - Iz) cos(theta))",
        f"{SUMMED:g}: the roots of the mirrored top; counts",
    )


@claim
def elastic_body_elongates() -> Claim:
    """Check that a mass on a spring that turns keeps a larger distance, by the tension."""
    stretched = SPRING * REST / (SPRING - MASS * PSI_DOT**2)
    tension = SPRING * (stretched - REST)

    def fall(_: float, y: Real) -> Real:
        distance = np.hypot(*y[:2])
        return np.concatenate([y[2:], -SPRING / MASS * (1 - REST / distance) * y[:2]])

    span = 20 * np.pi / PSI_DOT  # ten turns
    ends = []
    for begin in (stretched, REST):
        y = [begin, 0.0, 0.0, PSI_DOT * begin]
        path = solve_ivp(fall, (0.0, span), y, "DOP853", rtol=1e-12, atol=1e-15).y
        ends.append(np.hypot(*path[:2]))
    kept = float(np.abs(ends[0] / stretched - 1).max())
    return Claim(
        "An elastic body that rotates elongates, and its tension is the centripetal force "
        "(conclusion).",
        f"1 g on a spring of 400 N/m and 30 mm at 200 rad/s: {1000 * stretched:.2f} mm with a "
        f"tension of {tension:.3f} N, kept within {kept:.0e} of it in ten turns; from 30 mm it "
        f"moves out to {1000 * ends[1].max():.1f} mm",
        bool(
            kept < FOLLOWED
            and abs(tension - MASS * PSI_DOT**2 * stretched) < ROUNDED * SPRING
            and ends[1].min() > REST * (1 - FOLLOWED)
        ),
        "k (r - r_0) = m psi'^2 r",
        f"{FOLLOWED:g}: the integrator's tolerance",
    )
