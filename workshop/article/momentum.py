"""Claims on the constants of motion, gravity's torque, and the equations of motion."""

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from symtop_ros.arrays import Real
from symtop_ros.physics import Motion, State, Top
from workshop.article.claims import Claim, claim
from workshop.article.motions import (
    Slope,
    accelerations,
    cusps,
    regular,
    seven_motions,
    slope,
)

SPAN = 10.0  # s
TIMES = np.linspace(0.0, SPAN, 10_001)
AXIS, UP = np.array([0.0, 0.0, 1.0]), np.array([0.0, 0.0, 1.0])  # in the body, in the world
CONSTANT = 1e-13  # relative; the start is known to 1e-16, and L is a sum of a few products
ACROSS = 1e-14  # of |torque|; rounding of a scalar product
DIFFERENTIATED = 1e-9  # relative; a difference is good to 1e-11
DIFFERENCE = f"{DIFFERENTIATED:g}: a derivative by differences is good to 1e-11"


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
def is_constant(name: str, motions: Sequence[Motion]) -> Claim:
    """Check one of the `CONSTANTS` over ten seconds of each motion."""
    drifts, (compute, equation) = [], CONSTANTS[name]
    for motion in motions:
        values = compute(motion.top, motion.at(TIMES))
        drifts.append(np.abs(values - values[0]).max() / abs(values[0]))
    return Claim(
        f"{name} is a constant of motion.",
        f"largest relative change in {SPAN:g} s of {len(motions)} motions: {max(drifts):.1e}",
        bool(max(drifts) < CONSTANT),
        equation,
        f"{CONSTANT:g}: rounding of the start and of a sum of a few products",
    )


@claim
def torque_is_along_the_line_of_nodes(motion: Motion) -> Claim:
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
    return Claim(
        "Gravity's torque is along the line of nodes: it has no component along the axis, and none "
        "along the vertical, so that L_z' is constant.",
        "of its size, at most " + ", ".join(f"{part:.0e} {name}" for name, part in largest.items()),
        max(largest.values()) < ACROSS,
        "torque = Mgl sin(theta) (cos(phi), sin(phi), 0)",
        f"{ACROSS:g}: rounding of a scalar product",
    )


@claim
def momentum_changes_by_gravity(motion: Motion) -> Claim:
    """Check that dL/dt in the world frame is gravity's torque."""
    times = TIMES[::10]
    found = slope(lambda t: motion.top.angular_momentum(motion.at(t)), times)
    sentence = f"dL/dt is gravity's torque and nothing else ({motion.kind})."
    expected = motion.top.gravity_torque(motion.at(times))
    equation = "dL/dt = Mgl sin(theta) (cos(phi), sin(phi), 0)"
    return _compare(sentence, equation, found, expected, ("dL/dt is", "torque"))


@claim
def equations_hold(motion: Motion) -> Claim:
    """Check that phi'', theta'' and psi'' of the motion obey the article's equations."""
    times = TIMES[::10]
    found = slope(lambda t: np.stack(motion.at(t).euler_rates, axis=-1), times)
    sentence = f"phi'', theta'' and psi'' obey the article's three equations ({motion.kind})."
    expected = accelerations(motion.top, motion.at(times))
    equation = (
        "theta'' = sin(theta)/Ix ((Ix - Iz) phi'^2 cos(theta) - Iz phi' psi' + Mgl), "
        "phi'' = theta'/(Ix sin(theta)) (Iz psi' + (Iz - 2 Ix) phi' cos(theta)), "
        "psi'' = theta' phi' sin(theta) - phi'' cos(theta)"
    )
    return _compare(sentence, equation, found, expected, ("the rates are", "largest"))


def _compare(
    sentence: str, equation: str, found: Slope, expected: Real, words: tuple[str, str]
) -> Claim:
    """Return the claim that derivatives are as expected; `words` name them and their size."""
    (what, size), (off, error) = words, _relative(found, expected)
    return Claim(
        sentence,
        f"differentiated at {len(expected)} times in {SPAN:g} s, {what} off by {off:.0e} of the "
        f"{size}; the difference itself may be off by {error:.0e}",
        off < DIFFERENTIATED,
        equation,
        DIFFERENCE,
    )


@claim
def attitude_turns_with_the_angular_velocity(motion: Motion) -> Claim:
    """Check that the angular velocity is 2 q* q', so that L and E belong to the attitude."""
    times = TIMES[::10]
    found = slope(lambda t: motion.at(t).orientation, times)
    q, omega = motion.at(times).parts
    # The vector part of conj(q) q', for quaternions w, x, y, z
    p, axis = found.values, q[:, 1:]
    vector = q[:, :1] * p[:, 1:] - p[:, :1] * axis - np.cross(axis, p[:, 1:])
    turned = Slope(2 * vector, 2 * found.error)
    off, error = _relative(turned, omega)
    return Claim(
        "L and E belong to the attitude: it turns with the angular velocity in them "
        f"({motion.kind}).",
        f"omega from the differentiated attitude is off by {off:.0e} of the largest; the "
        f"difference itself may be off by {error:.0e}",
        off < DIFFERENTIATED,
        "omega = 2 conj(q) dq/dt",
        DIFFERENCE,
    )


def _relative(found: Slope, expected: Real) -> tuple[float, float]:
    """Return the largest deviation and the error of the difference, over the largest value."""
    largest = float(np.abs(expected).max())
    return float(np.abs(found.values - expected).max()) / largest, found.error / largest
