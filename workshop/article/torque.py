"""Claims on torque: inertia in the fixed frame, dL/dt in three frames, and regular precession.

The frames are the fixed one (`world`), the body's, and that of the line of nodes, which follows
the precession and the tilt but not the spin.
"""

import numpy as np

from symtop_ros.arrays import Real
from symtop_ros.physics import Motion, State, Top
from workshop.article.claims import Claim, Measured, claim, differ
from workshop.article.motions import FAST, SLOW, cusps, regular, slope, start

COUNT, SEED = 500, 20210329  # random states, the same every time
MARGIN = 0.1  # rad from the vertical, where phi' and phi'' have a pole
FASTEST = 200.0  # rad/s
ROUNDED = 1e-14  # relative; products of a rotation with errors of eps. Measured: 2e-15
LONG = 1e-14  # relative; sums of twenty products, over sin(theta) >= 0.1. Measured: 6e-16
DIFFERENTIATED = 1e-9  # relative; a difference is good to 1e-11
BALANCED = 1e-14  # relative; a start on a root is rounded once. Measured: 9e-16
SPAN = 2.0  # s: two turns of the slow precession
TIMES = np.linspace(0.0, SPAN, 401)
UP = np.array([0.0, 0.0, 1.0])


def claims_on_torque(top: Top) -> list[Claim]:
    """Return the claims on inertia, dL/dt in three frames, and the torque of regular precession."""
    return [
        inertia_has_its_components(top),
        fixed_frame_agrees_with_euler(top),
        inertial_torque_is_the_difference(regular(top)),
        inertial_torque_is_the_difference(cusps(top)),
        precession_alone_balances_gravity(regular(top), cusps(top)),
        torque_is_across_momentum(regular(top)),
        one_torque_has_two_momenta(top),
    ]


def draw_states() -> State:
    """Return random states, none near the vertical."""
    random = np.random.default_rng(SEED)
    phi, psi = random.uniform(-np.pi, np.pi, (2, COUNT))
    theta = random.uniform(MARGIN, np.pi - MARGIN, COUNT)
    plus, minus, half = (phi + psi) / 2, (phi - psi) / 2, theta / 2
    c, s = np.cos(half), np.sin(half)
    orientation = [c * np.cos(plus), s * np.cos(minus), s * np.sin(minus), c * np.sin(plus)]
    return State(np.transpose(orientation), random.uniform(-FASTEST, FASTEST, (COUNT, 3)))


def inertia_in_world(top: Top, phi: Real, theta: Real) -> Real:
    """Return the components of I' (n, 3, 3) in kg m^2 by the article's formulas.

    psi is not among the arguments: the body is symmetric.
    """
    Ix, more = top.Ix, top.Iz - top.Ix
    s, c = np.sin(theta), np.cos(theta)
    a, b = np.sin(phi), np.cos(phi)
    xy, xz, yz = -more * s * s * a * b, more * s * c * a, -more * s * c * b
    rows = [
        [Ix + more * (s * a) ** 2, xy, xz],
        [xy, Ix + more * (s * b) ** 2, yz],
        [xz, yz, Ix + more * c * c],
    ]
    return np.moveaxis(np.array(rows), -1, 0)


def inertia_change(top: Top, states: State) -> Real:
    """Return dI'/dt (n, 3, 3) in kg m^2/s: the formulas differentiated by phi and theta."""
    phi, theta, _ = states.euler_angles
    rates, more = states.euler_rates, top.Iz - top.Ix
    s, c, s2, c2 = np.sin(theta), np.cos(theta), np.sin(2 * theta), np.cos(2 * theta)
    a, b, a2, b2 = np.sin(phi), np.cos(phi), np.sin(2 * phi), np.cos(2 * phi)
    p, t = more * rates.phi, more * rates.theta
    xx = t * s2 * a * a + p * s * s * a2
    yy = t * s2 * b * b - p * s * s * a2
    xy = -t * s2 * a2 / 2 - p * s * s * b2
    xz, yz = t * c2 * a + p * s * c * b, -t * c2 * b + p * s * c * a
    return np.moveaxis(np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, -t * s2]]), -1, 0)


@claim
def inertia_has_its_components(top: Top) -> Measured:
    """Check the components of I' = S I_b S^-1 against their formulas on random states."""
    states = draw_states()
    S = np.stack([states.to_world(axis) for axis in np.eye(3)], axis=-1)
    turned = S @ np.diag([top.Ix, top.Ix, top.Iz]) @ np.swapaxes(S, 1, 2)
    formulas = inertia_in_world(top, states.euler_angles.phi, states.euler_angles.theta)
    off = float(np.abs(turned - formulas).max()) / max(top.Ix, top.Iz)
    return Measured(off < ROUNDED, off=off)


@claim
def fixed_frame_agrees_with_euler(top: Top) -> Measured:
    """Check dL/dt in the fixed frame from I' and dI'/dt against Euler's equations.

    The angular accelerations are random as well: the two sides are equal for any torque.
    """
    states = draw_states()
    moments, omega = np.array([top.Ix, top.Ix, top.Iz]), states.angular_velocity
    alpha = np.random.default_rng(SEED + 1).uniform(-(FASTEST**2), FASTEST**2, (COUNT, 3))
    euler = states.to_world(moments * alpha + np.cross(omega, moments * omega))
    inertia = inertia_in_world(top, states.euler_angles.phi, states.euler_angles.theta)
    # d(omega)/dt is the same vector in both frames, because omega x omega = 0.
    vectors = states.to_world(omega)[..., None], states.to_world(alpha)[..., None]
    fixed = (inertia_change(top, states) @ vectors[0] + inertia @ vectors[1])[..., 0]
    off = differ(fixed, euler)
    return Measured(off < LONG, off=off, largest=np.abs(euler).max(), least=np.sin(MARGIN))


def split_torque(motion: Motion, times: Real) -> dict[str, Real]:
    """Return components (n,) along the line of nodes in N m, by the frame that they belong to."""
    top, states = motion.top, motion.at(times)
    change = slope(lambda t: top.body_angular_momentum(motion.at(t)), times)
    omega = states.to_world(states.angular_velocity)
    parts = {
        "torque": motion.total_torque(states),
        "dL/dt in the body frame": states.to_world(change.values),
        "omega x L": np.cross(omega, top.angular_momentum(states)),
    }
    phi = states.euler_angles.phi
    nodes = np.stack([np.cos(phi), np.sin(phi), np.zeros_like(phi)], axis=-1)
    return {name: np.asarray((vectors * nodes).sum(axis=1)) for name, vectors in parts.items()}


@claim
def inertial_torque_is_the_difference(motion: Motion) -> Measured:
    """Check that the body sees a different dL/dt, by the inertial torque -omega x L."""
    parts = split_torque(motion, TIMES)
    torque, body, turning = parts.values()
    size = max(np.abs(part).max() for part in parts.values())
    off = float(np.abs(torque - body - turning).max() / size)
    half = int(TIMES.searchsorted(motion.nutation_period / 2))
    numbers = ", ".join(f"{name} {part[half]:+.4f}" for name, part in parts.items())
    return Measured(off < DIFFERENTIATED, motion=motion, numbers=numbers, count=len(TIMES), off=off)


@claim
def precession_alone_balances_gravity(steady: Motion, nodding: Motion) -> Measured:
    """Check that only regular precession is at rest in the frame of the line of nodes."""
    off, elsewhere = (_imbalance(motion) for motion in (steady, nodding))
    holds = off < BALANCED and elsewhere > 0.5
    return Measured(holds, off=off, steady=steady, elsewhere=elsewhere, nodding=nodding)


def _imbalance(motion: Motion) -> float:
    states = motion.at(TIMES)
    L, torque = motion.top.angular_momentum(states), motion.top.gravity_torque(states)
    turning = np.asarray(states.euler_rates.phi)[:, None] * np.cross(UP, L)
    return differ(turning, torque)


@claim
def torque_is_across_momentum(motion: Motion) -> Measured:
    """Check that in regular precession the torque turns L and changes neither of their sizes."""
    states = motion.at(TIMES)
    L, torque = motion.top.angular_momentum(states), motion.top.gravity_torque(states)
    sizes = np.linalg.norm(L, axis=1), np.linalg.norm(torque, axis=1)
    along = float((np.abs((L * torque).sum(axis=1)) / (sizes[0] * sizes[1])).max())
    changes = [float(np.ptp(size) / size.mean()) for size in sizes]
    return Measured(max(along, *changes) < BALANCED, along=along, changes=changes, sizes=sizes)


@claim
def one_torque_has_two_momenta(top: Top) -> Measured:
    """Check that one attitude and one torque have two regular precessions with different L."""
    starts = [start(rate) for rate in (SLOW, FAST)]
    momenta = [top.angular_momentum(state) for state in starts]
    torques = [float(np.linalg.norm(top.gravity_torque(state))) for state in starts]
    turned = [
        rate * float(np.linalg.norm(L[:2])) for rate, L in zip((SLOW, FAST), momenta, strict=True)
    ]
    off = max(abs(a - b) / b for a, b in zip(turned, torques, strict=True))
    sizes = [float(np.linalg.norm(L)) for L in momenta]
    holds = off < BALANCED and sizes[1] - sizes[0] > 0.1 * sizes[0]
    return Measured(holds, sizes=sizes, torques=torques, off=off)
