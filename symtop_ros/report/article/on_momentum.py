"""Claims on angular momentum, torque and energy."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from symtop_ros.physics import Motion, State, Top
from symtop_ros.report.article.claim import Claim
from symtop_ros.report.article.difference import Slope, slope
from symtop_ros.report.article.equations import accelerations

Real = NDArray[np.float64]
SPAN = 10.0  # s
TIMES = np.linspace(0.0, SPAN, 10_001)
AXIS, UP = np.array([0.0, 0.0, 1.0]), np.array([0.0, 0.0, 1.0])  # in the body, in the world
CONSTANT = 1e-13  # relative; the start is known to 1e-16, and L is a sum of a few products
ACROSS = 1e-14  # of |torque|; rounding of a scalar product
DIFFERENTIATED = 1e-9  # relative; a difference is good to 1e-11


def axial_momentum(top: Top, state: State) -> Any:
    """L_z (...) in N m s: L along the axis, both in the world."""
    return (top.angular_momentum(state) * state.to_world(AXIS)).sum(axis=-1)


def vertical_momentum(top: Top, state: State) -> Any:
    """L_z' (...) in N m s: L along the vertical."""
    return top.angular_momentum(state) @ UP


def energy(top: Top, state: State) -> Any:
    """E (...) in J."""
    return top.energy(state)


CONSTANTS: dict[str, Callable[[Top, State], Any]] = {
    "L_z (along the axis)": axial_momentum,
    "L_z' (along the vertical)": vertical_momentum,
    "The energy E": energy,
}


def is_constant(name: str, paths: Sequence[Motion]) -> Claim:
    """One of the constants of motion over ten seconds of each of the motions."""
    drifts = []
    for path in paths:
        values = CONSTANTS[name](path.top, path.at(TIMES))
        drifts.append(np.abs(values - values[0]).max() / abs(values[0]))
    return Claim(
        f"{name} is a constant of motion.",
        f"largest relative change in {SPAN:g} s of {len(paths)} motions: {max(drifts):.1e}",
        bool(max(drifts) < CONSTANT),
    )


def torque_is_along_the_line_of_nodes(path: Motion) -> Claim:
    """Gravity's torque has no part along the axis or the vertical."""
    states = path.at(TIMES)
    torque, phi = path.torque(states), states.euler_angles.phi
    nodes = np.stack([np.cos(phi), np.sin(phi), np.zeros_like(phi)], axis=-1)
    size = np.linalg.norm(torque, axis=-1)
    parts = {
        "off the line of nodes": np.linalg.norm(np.cross(torque, nodes), axis=-1),
        "along the axis": np.abs((torque * states.to_world(AXIS)).sum(axis=-1)),
        "along the vertical": np.abs(torque @ UP),
    }
    largest = {name: float((part / size).max()) for name, part in parts.items()}
    return Claim(
        "Gravity's torque is along the line of nodes, so that it changes neither L_z nor L_z'.",
        "of its size, at most " + ", ".join(f"{part:.0e} {name}" for name, part in largest.items()),
        max(largest.values()) < ACROSS,
    )


def momentum_changes_by_gravity(path: Motion) -> Claim:
    """dL/dt in the world is gravity's torque."""
    times = TIMES[::10]
    found = slope(lambda t: path.top.angular_momentum(path.at(t)), times)
    sentence = f"dL/dt is gravity's torque and nothing else ({path.kind})."
    return _agree(sentence, found, path.top.torque(path.at(times)), ("dL/dt is", "torque"))


def equations_hold(path: Motion) -> Claim:
    """The article's phi'', theta'' and psi'' are those of the motion."""
    times = TIMES[::10]
    found = slope(lambda t: np.stack(path.at(t).euler_rates, axis=-1), times)
    sentence = f"phi'', theta'' and psi'' obey the article's three equations ({path.kind})."
    expected = accelerations(path.top, path.at(times))
    return _agree(sentence, found, expected, ("the rates are", "largest"))


def _agree(sentence: str, found: Slope, expected: Real, words: tuple[str, str]) -> Claim:
    """A claim that derivatives are what is expected, in words for them and for their size."""
    (what, size), (off, error) = words, _relative(found, expected)
    return Claim(
        sentence,
        f"differentiated at {len(expected)} times in {SPAN:g} s, {what} off by {off:.0e} of the "
        f"{size}; the difference itself may be off by {error:.0e}",
        off < DIFFERENTIATED,
    )


def attitude_turns_with_the_angular_velocity(path: Motion) -> Claim:
    """The angular velocity is 2 q* q', so that L and E are those of the attitude."""
    times = TIMES[::10]
    found = slope(lambda t: path.at(t).orientation, times)
    q, omega = path.at(times)
    turned = Slope(2 * _vector_of_product(q, found.values), 2 * found.error)
    off, error = _relative(turned, omega)
    return Claim(
        "L and E belong to the attitude: it turns with the angular velocity in them "
        f"({path.kind}).",
        f"omega from the differentiated attitude is off by {off:.0e} of the largest; the "
        f"difference itself may be off by {error:.0e}",
        off < DIFFERENTIATED,
    )


def _vector_of_product(q: Real, p: Real) -> Real:
    """Vector part of conj(q) p (n, 3), for quaternions w, x, y, z (n, 4)."""
    scalar, vector = q[:, :1], q[:, 1:]
    return np.asarray(scalar * p[:, 1:] - p[:, :1] * vector - np.cross(vector, p[:, 1:]))


def _relative(found: Slope, expected: Real) -> tuple[float, float]:
    """Largest deviation, and the error of the difference, over the largest value expected."""
    largest = float(np.abs(expected).max())
    return float(np.abs(found.values - expected).max()) / largest, found.error / largest
