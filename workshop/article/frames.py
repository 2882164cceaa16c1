"""Claims on the equations that connect both frames, and on what the article says in passing."""

import numpy as np
from scipy.integrate import solve_ivp
from scipy.spatial.transform import Rotation

from symtop_ros.base.arrays import Real
from symtop_ros.physics import Motion, Top, hurry, regular_precession_rates
from workshop.article.answers.fictitious import point_masses
from workshop.article.claims import Measured, claim, differ
from workshop.article.motions import FAST, PSI_DOT, SLOW, THETA, start
from workshop.article.torque import COUNT, SEED, draw_states, inertia_in_world

ROUNDED = 1e-14  # relative; products of a few rotations with errors of eps
SUMMED = 1e-13  # relative; sums over 16 masses, of which some cancel
FACTOR = 1.4  # by which the precession is delayed
SPRING, MASS, REST = 400.0, 0.001, 0.03  # N/m, kg, m: a mass on a spring that turns with the top
FOLLOWED = 1e-9  # relative; DOP853 at a relative tolerance of 1e-12 over ten turns


@claim()
def matrix_turns_body_to_world(_: Top) -> Measured:
    """Check the matrix of the attitude against equation 6, and against three turns."""
    states = draw_states()
    angles = np.array(states.euler_angles)
    (a, c, f), (b, s, g) = np.cos(angles), np.sin(angles)
    rows = [
        [a * f - c * b * g, -a * g - c * b * f, s * b],
        [b * f + c * a * g, -b * g + c * a * f, -s * a],
        [s * g, s * f, c],
    ]
    printed = np.moveaxis(np.array(rows), -1, 0)
    turned = Rotation.from_euler("ZXZ", angles.T).as_matrix()
    off = max(float(np.abs(states.matrix - each).max()) for each in (printed, turned))
    return Measured(off < ROUNDED, off=off)


@claim()
def angular_velocity_has_its_components(_: Top) -> Measured:
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
    return Measured(off < 10 * ROUNDED, off=off, limit=10 * ROUNDED)


@claim()
def torque_has_its_components_in_the_body(top: Top) -> Measured:
    """Check gravity's torque in the body frame, equation 17."""
    states = draw_states()
    _, theta, psi = states.euler_angles
    size = top.Mgl * np.sin(theta)
    printed = np.stack([size * np.cos(psi), -size * np.sin(psi), 0 * size], axis=-1)
    found = states.to_body(top.gravity_torque(states))
    off = float(np.abs(found - printed).max() / 0.068)
    return Measured(
        off < ROUNDED and np.abs(found).max() > 0.067, off=off, largest=np.abs(found).max()
    )


@claim()
def inertia_is_an_integral(top: Top) -> Measured:
    """Check the integral of equation 4, over mass elements in the fixed frame, against I'."""
    states = draw_states()
    masses, places = point_masses(top)
    moved = np.einsum("nij,kj->nki", states.matrix, places)
    squares = (moved**2).sum(axis=-1)
    summed = np.einsum("k,nk,ij->nij", masses, squares, np.eye(3)) - np.einsum(
        "k,nki,nkj->nij", masses, moved, moved
    )
    angles = states.euler_angles
    off = differ(summed, inertia_in_world(top, angles.phi, angles.theta))
    return Measured(off < SUMMED, count=len(masses), off=off)


@claim()
def delay_does_the_opposite(top: Top) -> Measured:
    """Check that a delayed top falls at the slow root and rises at the fast one."""
    delayed = (Motion(top, hurry(start(rate), 1 / FACTOR)) for rate in (SLOW, FAST))
    slow, fast = (motion.turning_angles for motion in delayed)
    falls = abs(slow[0] - THETA) < ROUNDED and slow[1] > THETA + 0.01
    rises = abs(fast[1] - THETA) < ROUNDED and fast[0] < THETA - 0.01
    return Measured(falls and rises, slow=slow, fast=fast)


@claim()
def roots_have_the_sign_of_the_spin(top: Top) -> Measured:
    """Check that roots of one sign have the sign of the spin rate, also if it is negative."""
    random = np.random.default_rng(SEED + 2)
    roots = regular_precession_rates(top, THETA, -PSI_DOT)
    signs = []
    for Iz, theta, spin in random.uniform((0.1, 0.1, -400.0), (1.9, 3.0, 400.0), (COUNT, 3)):
        other = Top(top.Ix, Iz * top.Ix, abs(top.Mgl))
        rates = regular_precession_rates(other, theta, spin)
        if np.isfinite(rates).all():
            is_upward = (other.Ix - other.Iz) * np.cos(theta) > 0
            signs.append(
                all(np.sign(rates) == np.sign(spin)) if is_upward else rates[0] * rates[1] < 0
            )
    holds = np.allclose(sorted(roots), (-FAST, -SLOW), rtol=SUMMED) and all(signs)
    return Measured(holds, roots=roots, good=sum(signs), tried=len(signs))


@claim()
def elastic_body_elongates(_: Top) -> Measured:
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
    holds = (
        kept < FOLLOWED
        and abs(tension - MASS * PSI_DOT**2 * stretched) < ROUNDED * SPRING
        and ends[1].min() > REST * (1 - FOLLOWED)
    )
    return Measured(
        holds, length=1e3 * stretched, tension=tension, kept=kept, farthest=1e3 * ends[1].max()
    )
