"""Claims on the constants of motion, gravity's torque, and the equations of motion."""

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from symtop_ros.arrays import Real
from symtop_ros.physics import Motion, State, Top
from workshop.article.claims import Claim, Measured, claim
from workshop.article.motions import Slope, accelerations, cusps, regular, seven_motions, slope

SPAN = 10.0  # s
TIMES = np.linspace(0.0, SPAN, 10_001)
AXIS, UP = np.array([0.0, 0.0, 1.0]), np.array([0.0, 0.0, 1.0])  # in the body, in the world
CONSTANT = 1e-13  # relative; the start is known to 1e-16, and L is a sum of a few products
ACROSS = 1e-14  # of |torque|; rounding of a scalar product
DIFFERENTIATED = 1e-9  # relative; a difference is good to 1e-11


def claims_on_momentum(top: Top) -> list[Claim]:
    """Return the claims on constants of motion, torque, and the equations of motion."""
    motions = seven_motions(top)
    return [
        *(is_constant(name, motions) for name in CONSTANTS),
        torque_is_along_the_line_of_nodes(cusps(top)),
        *(momentum_changes_by_gravity(motion) for motion in (regular(top), cusps(top))),
        attitude_turns_with_the_angular_velocity(cusps(top)),
        equations_hold(cusps(top)),
    ]


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


@claim
def is_constant(name: str, motions: Sequence[Motion]) -> Measured:
    """Check one of the `CONSTANTS` over ten seconds of each motion."""
    drifts, (compute, equation) = [], CONSTANTS[name]
    for motion in motions:
        values = compute(motion.top, motion.at(TIMES))
        drifts.append(np.abs(values - values[0]).max() / abs(values[0]))
    return Measured(
        max(drifts) < CONSTANT, name=name, count=len(motions), drift=max(drifts), equation=equation
    )


@claim
def torque_is_along_the_line_of_nodes(motion: Motion) -> Measured:
    """Check that the torque has no component along the axis or the vertical."""
    states = motion.at(TIMES)
    torque, phi = motion.total_torque(states), states.euler_angles.phi
    nodes = np.stack([np.cos(phi), np.sin(phi), np.zeros_like(phi)], axis=-1)
    size = np.linalg.norm(torque, axis=-1)
    parts = {
        "off the line of nodes": np.linalg.norm(np.cross(torque, nodes), axis=-1),
        "along the axis": np.abs((torque * states.to_world(AXIS)).sum(axis=-1)),
        "along the vertical": np.abs(torque @ UP),
    }
    largest = {name: float((part / size).max()) for name, part in parts.items()}
    listed = ", ".join(f"{part:.0e} {name}" for name, part in largest.items())
    return Measured(max(largest.values()) < ACROSS, listed=listed)


@claim
def momentum_changes_by_gravity(motion: Motion) -> Measured:
    """Check that dL/dt in the world frame is gravity's torque."""
    times = TIMES[::10]
    found = slope(lambda t: motion.top.angular_momentum(motion.at(t)), times)
    return _compare(motion, found, motion.top.gravity_torque(motion.at(times)))


@claim
def equations_hold(motion: Motion) -> Measured:
    """Check that phi'', theta'' and psi'' of the motion obey the article's equations."""
    times = TIMES[::10]
    found = slope(lambda t: np.stack(motion.at(t).euler_rates, axis=-1), times)
    return _compare(motion, found, accelerations(motion.top, motion.at(times)))


def _compare(motion: Motion, found: Slope, expected: Real) -> Measured:
    """Return how far derivatives are off what is expected."""
    off, error = _relative(found, expected)
    count = len(expected)
    return Measured(off < DIFFERENTIATED, motion=motion, off=off, error=error, count=count)


@claim
def attitude_turns_with_the_angular_velocity(motion: Motion) -> Measured:
    """Check that the angular velocity is 2 q* q', so that L and E belong to the attitude."""
    times = TIMES[::10]
    found = slope(lambda t: motion.at(t).orientation, times)
    q, omega = motion.at(times).parts
    # The vector part of conj(q) q', for quaternions w, x, y, z
    p, axis = found.values, q[:, 1:]
    vector = q[:, :1] * p[:, 1:] - p[:, :1] * axis - np.cross(axis, p[:, 1:])
    turned = Slope(2 * vector, 2 * found.error)
    off, error = _relative(turned, omega)
    return Measured(off < DIFFERENTIATED, motion=motion, off=off, error=error)


def _relative(found: Slope, expected: Real) -> tuple[float, float]:
    """Return the largest deviation and the error of the difference, over the largest value."""
    largest = float(np.abs(expected).max())
    return float(np.abs(found.values - expected).max()) / largest, found.error / largest
