"""Claims on torque and momentum: inertia, dL/dt in three frames, and the constants of motion.

The frames are the fixed one (`world`), the body's, and that of the line of nodes, which follows
the precession and the tilt but not the spin.
"""

from collections.abc import Callable
from typing import Any

import numpy as np

from symtop_ros.base.arrays import Real
from symtop_ros.physics import Motion, State, Top
from symtop_ros.replay.view.quantities import nodes_of
from workshop.article.claims import Measured, claim, differ
from workshop.article.motions import (
    FAST,
    SLOW,
    STEP,
    Maker,
    accelerations,
    cusps,
    regular,
    seven_motions,
    slope,
    start,
)

COUNT, SEED = 500, 20210329  # random states, the same every time
MARGIN = 0.1  # rad from the vertical, where phi' and phi'' have a pole
FASTEST = 200.0  # rad/s
ROUNDED = 1e-14  # relative; products of a rotation with errors of eps. Measured: 2e-15
LONG = 1e-14  # relative; sums of twenty products, over sin(theta) >= 0.1. Measured: 6e-16
BALANCED = 1e-14  # relative; a start on a root is rounded once. Measured: 9e-16
FEW = np.linspace(0.0, 2.0, 401)  # s; two turns of the slow precession
SPAN = 10.0  # s
TIMES = np.linspace(0.0, SPAN, 10_001)
TENTH = TIMES[::10]
AXIS, UP = np.array([0.0, 0.0, 1.0]), np.array([0.0, 0.0, 1.0])  # in the body, in the world
CONSTANT = 1e-13  # relative; the start is known to 1e-16, and L is a sum of a few products
ACROSS = 1e-14  # of |torque|; rounding of a scalar product
DIFFERENTIATED = 1e-9  # relative; a difference is good to 1e-11


def draw_states() -> State:
    """Return random states, none near the vertical."""
    random = np.random.default_rng(SEED)
    phi, psi = random.uniform(-np.pi, np.pi, (2, COUNT))
    theta = random.uniform(MARGIN, np.pi - MARGIN, COUNT)
    plus = (phi + psi) / 2
    minus = (phi - psi) / 2
    half = theta / 2
    c, s = np.cos(half), np.sin(half)
    orientation = [c * np.cos(plus), s * np.cos(minus), s * np.sin(minus), c * np.sin(plus)]
    return State(np.transpose(orientation), random.uniform(-FASTEST, FASTEST, (COUNT, 3)))


def find_momentum_change(top: Top, states: State, alpha: Real) -> Real:
    """Return dL/dt (n, 3) in N m for d(omega)/dt in the body frame, by Euler's equations."""
    moments = np.array([top.Ix, top.Ix, top.Iz])
    omega = states.angular_velocity
    return states.to_world(moments * alpha + np.cross(omega, moments * omega))


def inertia_in_world(top: Top, phi: Real, theta: Real) -> Real:
    """Return the components of I' (n, 3, 3) in kg m^2 by the article's formulas.

    psi is not among the arguments: the body is symmetric.
    """
    Ix = top.Ix
    more = top.Iz - top.Ix
    s, c = np.sin(theta), np.cos(theta)
    a, b = np.sin(phi), np.cos(phi)
    xy = -more * s * s * a * b
    xz = more * s * c * a
    yz = -more * s * c * b
    rows = [
        [Ix + more * (s * a) ** 2, xy, xz],
        [xy, Ix + more * (s * b) ** 2, yz],
        [xz, yz, Ix + more * c * c],
    ]
    return np.moveaxis(np.array(rows), -1, 0)


def inertia_change(top: Top, states: State) -> Real:
    """Return dI'/dt (n, 3, 3) in kg m^2/s: the formulas differentiated by phi and theta."""
    phi, theta, _ = states.euler_angles
    rates = states.euler_rates
    more = top.Iz - top.Ix
    s = np.sin(theta)
    c = np.cos(theta)
    s2 = np.sin(2 * theta)
    c2 = np.cos(2 * theta)
    a = np.sin(phi)
    b = np.cos(phi)
    a2 = np.sin(2 * phi)
    b2 = np.cos(2 * phi)
    p, t = more * rates.phi_dot, more * rates.theta_dot
    xx = t * s2 * a * a + p * s * s * a2
    yy = t * s2 * b * b - p * s * s * a2
    xy = -t * s2 * a2 / 2 - p * s * s * b2
    xz = t * c2 * a + p * s * c * b
    yz = -t * c2 * b + p * s * c * a
    return np.moveaxis(np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, -t * s2]]), -1, 0)


@claim()
def inertia_has_its_components(top: Top) -> Measured:
    """Check the components of I' = S I_b S^-1 against their formulas on random states."""
    states = draw_states()
    S = np.stack([states.to_world(axis) for axis in np.eye(3)], axis=-1)
    turned = S @ np.diag([top.Ix, top.Ix, top.Iz]) @ np.swapaxes(S, 1, 2)
    formulas = inertia_in_world(top, states.euler_angles.phi, states.euler_angles.theta)
    off = float(np.abs(turned - formulas).max()) / max(top.Ix, top.Iz)
    return Measured(off < ROUNDED, off=off)


@claim()
def fixed_frame_agrees_with_euler(top: Top) -> Measured:
    """Check dL/dt in the fixed frame from I' and dI'/dt against Euler's equations.

    The angular accelerations are random as well: the two sides are equal for any torque.
    """
    states = draw_states()
    alpha = np.random.default_rng(SEED + 1).uniform(-(FASTEST**2), FASTEST**2, (COUNT, 3))
    euler = find_momentum_change(top, states, alpha)
    inertia = inertia_in_world(top, states.euler_angles.phi, states.euler_angles.theta)
    # d(omega)/dt is the same vector in both frames, because omega x omega = 0.
    vectors = [states.to_world(each)[..., None] for each in (states.angular_velocity, alpha)]
    fixed = (inertia_change(top, states) @ vectors[0] + inertia @ vectors[1])[..., 0]
    off = differ(fixed, euler)
    return Measured(off < LONG, off=off, largest=np.abs(euler).max(), least=np.sin(MARGIN))


def split_torque(motion: Motion, times: Real) -> dict[str, Real]:
    """Return components (n,) along the line of nodes in N m, by the frame that they belong to."""
    top = motion.top
    states = motion.at(times)
    change = slope(lambda t: top.body_angular_momentum(motion.at(t)), times)
    omega = states.to_world(states.angular_velocity)
    parts = {
        "torque": motion.total_torque(states),
        "dL/dt in the body frame": states.to_world(change),
        "omega x L": np.cross(omega, top.angular_momentum(states)),
    }
    nodes = nodes_of(states.euler_angles.phi)
    return {name: np.asarray((vectors * nodes).sum(axis=1)) for name, vectors in parts.items()}


@claim(regular, cusps)
def inertial_torque_is_the_difference(top: Top, make: Maker) -> Measured:
    """Check that the body sees a different dL/dt, by the inertial torque -omega x L."""
    motion = make(top)
    parts = split_torque(motion, FEW)
    torque, body, turning = parts.values()
    size = max(np.abs(part).max() for part in parts.values())
    off = float(np.abs(torque - body - turning).max() / size)
    half = int(FEW.searchsorted(motion.nutation_period / 2))
    numbers = ", ".join(f"{name} {part[half]:+.4f}" for name, part in parts.items())
    return Measured(off < DIFFERENTIATED, motion=motion, numbers=numbers, count=len(FEW), off=off)


@claim()
def precession_alone_balances_gravity(top: Top) -> Measured:
    """Check that only regular precession is at rest in the frame of the line of nodes."""
    steady, nodding = regular(top), cusps(top)
    off, elsewhere = (_imbalance(motion) for motion in (steady, nodding))
    holds = off < BALANCED and elsewhere > 0.5
    return Measured(holds, off=off, steady=steady, elsewhere=elsewhere, nodding=nodding)


def _imbalance(motion: Motion) -> float:
    states = motion.at(FEW)
    L, torque = motion.top.angular_momentum(states), motion.top.gravity_torque(states)
    turning = np.asarray(states.euler_rates.phi_dot)[:, None] * np.cross(UP, L)
    return differ(turning, torque)


@claim()
def torque_is_across_momentum(top: Top) -> Measured:
    """Check that in regular precession the torque turns L and changes neither of their sizes."""
    states = regular(top).at(FEW)
    L, torque = top.angular_momentum(states), top.gravity_torque(states)
    sizes = np.linalg.norm(L, axis=1), np.linalg.norm(torque, axis=1)
    along = float((np.abs((L * torque).sum(axis=1)) / (sizes[0] * sizes[1])).max())
    changes = [float(np.ptp(size) / size.mean()) for size in sizes]
    return Measured(max(along, *changes) < BALANCED, along=along, changes=changes, sizes=sizes)


@claim()
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


def axial_momentum(top: Top, state: State) -> Any:
    """Return L_z (...) in N m s: the component of L along the axis, both in the world frame.

    `Top.axial_momentum` is Iz omega_z, a constant of the closed form by construction. Computed
    from the attitude as here, it can fail.
    """
    return (top.angular_momentum(state) * state.to_world(AXIS)).sum(axis=-1)


def vertical_momentum(top: Top, state: State) -> Any:
    """Return L_z' (...) in N m s: the component of L along the vertical."""
    return top.angular_momentum(state) @ UP


CONSTANTS: dict[str, tuple[Callable[[Top, State], Any], str]] = {
    "L_z (along the axis)": (axial_momentum, "p_psi = Iz (psi' + phi' cos(theta))"),
    "L_z' (along the vertical)": (
        vertical_momentum,
        "p_phi = Ix phi' sin^2(theta) + p_psi cos(theta)",
    ),
    "The energy E": (
        Top.energy,
        "E = Ix (theta'^2 + phi'^2 sin^2(theta))/2 + p_psi^2/(2 Iz) + Mgl cos(theta)",
    ),
}


@claim(*CONSTANTS)
def is_constant(top: Top, name: str) -> Measured:
    """Check one of the `CONSTANTS` over ten seconds of each motion."""
    motions = seven_motions(top)
    drifts = []
    compute, equation = CONSTANTS[name]
    for motion in motions:
        values = compute(motion.top, motion.at(TIMES))
        drifts.append(np.abs(values - values[0]).max() / abs(values[0]))
    drift = max(drifts)
    return Measured(drift < CONSTANT, count=len(motions), drift=drift, equation=equation)


@claim()
def torque_is_along_the_line_of_nodes(top: Top) -> Measured:
    """Check that the torque has no component along the axis or the vertical."""
    motion = cusps(top)
    states = motion.at(TIMES)
    torque = motion.total_torque(states)
    nodes = nodes_of(states.euler_angles.phi)
    size = np.linalg.norm(torque, axis=-1)
    parts = {
        "off the line of nodes": np.linalg.norm(np.cross(torque, nodes), axis=-1),
        "along the axis": np.abs((torque * states.to_world(AXIS)).sum(axis=-1)),
        "along the vertical": np.abs(torque @ UP),
    }
    largest = {name: float((part / size).max()) for name, part in parts.items()}
    listed = ", ".join(f"{part:.0e} {name}" for name, part in largest.items())
    return Measured(max(largest.values()) < ACROSS, listed=listed)


@claim(regular, cusps)
def momentum_changes_by_gravity(top: Top, make: Maker) -> Measured:
    """Check that dL/dt in the world frame is gravity's torque."""
    motion = make(top)
    expected = top.gravity_torque(motion.at(TENTH))
    return _compare(motion, lambda t: top.angular_momentum(motion.at(t)), expected)


@claim()
def equations_hold(top: Top) -> Measured:
    """Check that phi'', theta'' and psi'' of the motion obey the article's equations."""
    motion = cusps(top)
    expected = accelerations(top, motion.at(TENTH))
    return _compare(motion, lambda t: np.stack(motion.at(t).euler_rates, axis=-1), expected)


def _compare(motion: Motion, function: Callable[[Real], Real], expected: Real) -> Measured:
    """Return how far the derivatives of a function are off what is expected."""
    found, coarse = (slope(function, TENTH, step) for step in (STEP, 2 * STEP))
    off = differ(found, expected)
    error = np.abs(coarse - found).max() / np.abs(expected).max()
    count = len(expected)
    return Measured(off < DIFFERENTIATED, motion=motion, off=off, error=error, count=count)


@claim()
def attitude_turns_with_the_angular_velocity(top: Top) -> Measured:
    """Check that the angular velocity is 2 q* q', so that L and E belong to the attitude."""
    motion = cusps(top)
    q, omega = motion.at(TENTH)._parts
    p, coarse = (slope(lambda t: motion.at(t).orientation, TENTH, h) for h in (STEP, 2 * STEP))
    # The vector part of conj(q) q', for quaternions w, x, y, z
    axis = q[:, 1:]
    vector = q[:, :1] * p[:, 1:] - p[:, :1] * axis - np.cross(axis, p[:, 1:])
    off = differ(2 * vector, omega)
    error = 2 * np.abs(coarse - p).max() / np.abs(omega).max()
    return Measured(off < DIFFERENTIATED, motion=motion, off=off, error=error)
