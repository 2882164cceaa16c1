"""A peer, and the equations of motion for general integrators.

A task is the motion that a peer integrates; its numbers are taken as exact. The equations are in
plain floats: with so few numbers, arrays would only slow SciPy down.
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from math import cos, sin
from typing import Any, Literal, NamedTuple

import numpy as np

from symtop_ros.base.arrays import Real, Vector
from symtop_ros.physics import Motion

Arrays = Callable[[Any], Real]  # a time or times (n,) in s -> orientations (..., 4)
# solve_ivp takes no relative tolerance below 100 eps, the last one here.
TOLERANCES = (*(10.0**-k for k in (4, 6, 8, 9, 10, 11, 12, 13)), 100 * 2.0**-52)
# Times at which errors are taken, evenly in (0, T]. For T = 10 s they are multiples of 2^-10 s:
# exact doubles, as are steps of powers of two, so that no error comes from the times.
RECORDED = 10_240
OWN_STEPS = 1000  # at most, of an integrator that has no exact output between its steps


class Solution(NamedTuple):
    """A model that is built; both functions compute from the start, each time they are called."""

    # returns the orientation (w, x, y, z) at a time in s, and stores nothing on the way: this is
    # timed
    reach: Callable[[float], Real]
    # returns times (n,) in (0, t] and the orientations (n, 4) there, with the same steps: errors
    # are taken from it, and it is not timed
    record: Callable[[float], tuple[Real, Real]]

    @classmethod
    def of_steps(
        cls,
        reach: Callable[[float], Real],
        run: Callable[[float], tuple[Real, Real]],
        read: Callable[[Real, Real], Real],
    ) -> "Solution":
        """Return a solution from an integrator's own steps, without its interpolation.

        `reach` returns the variables (1, k) at a time; `run` returns the times (n,) of all steps,
        with the start, and the variables (n, k) there; `read` is that of an `Equations`.
        """

        def record(t: float) -> tuple[Real, Real]:
            times, states = run(t)
            # From the end back: the time t itself is always among them.
            chosen = slice(None, None, -(-(len(times) - 1) // OWN_STEPS))
            kept = times[:0:-1][chosen]
            return kept, read(kept, states[:0:-1][chosen])

        return cls(lambda t: np.asarray(read(np.array([t]), reach(t))[0]), record)

    @classmethod
    def of_arrays(cls, reach: Callable[[float], Real], arrays: Arrays) -> "Solution":
        """Return a solution from a function for the orientations at any times."""
        return cls(reach, lambda t: (spread_times(t), arrays(spread_times(t))))

    @classmethod
    def of_fixed_steps(
        cls,
        step: float,
        begin: Callable[[], object],
        advance: Callable[[int], object],
        read: Callable[[], Real],
    ) -> "Solution":
        """Return a solution from a model that holds its state, in steps of one size (s).

        `begin` sets it to the start, `advance` makes a number of steps, and `read` returns a copy
        of the orientation.
        """

        def reach(t: float) -> Real:
            begin()
            advance(count_steps(t, step))
            return read()

        def record(t: float) -> tuple[Real, Real]:
            begin()
            orientations = []
            steps = count_steps(t, step)
            stride = max(1, steps // RECORDED)
            for _ in range(steps // stride):
                advance(stride)
                orientations.append(read())
            times = np.arange(1.0, len(orientations) + 1) * (stride * step)
            return times, np.array(orientations)

        return cls(reach, record)


class Equations(NamedTuple):
    """Equations of motion in some variables, for a general integrator."""

    start: list[float]  # the variables at t = 0
    rates: Callable[..., list[Any]]  # their rates of change, from the time in s and the variables
    # times (n,) in s and variables (n, k) -> orientations (n, 4)
    read: Callable[[Real, Real], Real]


def on_quaternion(task: Motion) -> Equations:
    """Return the quaternion and the body's angular velocity as variables."""
    rates = partial(body_rates, task)
    return Equations(initial_values(task), rates, lambda _, y: normalize(y[:, :4]))


def on_euler_angles(task: Motion, **functions: Any) -> Equations:
    """Return the Euler angles and their rates as variables; `functions` may be sin and cos."""
    start = [*task.start.euler_angles, *task.start.euler_rates]
    rates = partial(euler_rates, task, **functions)
    return Equations(start, rates, lambda _, y: from_euler_angles(y[:, :3]))


PrepareArrays = Callable[[Motion], Arrays]
Friction = Literal["no", "also", "only"]


@dataclass(frozen=True)
class Peer:
    """An integrator with one method."""

    name: str  # as in tables and plots
    # tolerances, or steps in s, from coarse to fine; the package's own engines have one
    settings: tuple[float, ...]
    # builds a `Solution` for a task and a setting, with all compiling and loading
    prepare: Callable[[Motion, float], Solution]
    # friction along and across the axis: not modelled, modelled, or the only use of the peer
    friction: Friction = "no"
    # builds a model, at the best setting, that computes the states at many times at once
    prepare_arrays: PrepareArrays | None = None


def spread_times(t: float) -> Real:
    """Return `RECORDED` times, evenly in (0, t] (s)."""
    return np.asarray(np.arange(1, RECORDED + 1) * (t / RECORDED))


def from_euler_angles(angles: Real) -> Real:
    """Return quaternions (n, 4) from phi, theta, psi (n, 3) in rad."""
    phi, theta, psi = angles.T
    A = np.cos(theta / 2) * np.exp(0.5j * (phi + psi))
    B = np.sin(theta / 2) * np.exp(0.5j * (phi - psi))
    return np.stack([A.real, B.real, B.imag, A.imag], axis=1)


def normalize(orientations: Real) -> Real:
    """Return quaternions (..., 4) of norm 1."""
    return np.asarray(orientations / np.linalg.norm(orientations, axis=-1, keepdims=True))


def count_steps(t: float, step: float) -> int:
    """Return the number of steps of this size (s) to t (s), which must be a multiple of it."""
    return round(t / step)


def initial_values(task: Motion) -> list[float]:
    """Return orientation (w, x, y, z) and body angular velocity (rad/s) at the start."""
    return [*task.start.orientation.tolist(), *task.start.angular_velocity.tolist()]


def body_rates(task: Motion, t: float, y: Any) -> list[Any]:
    """Return q' = q omega/2 and Euler's equations for y = (w, x, y, z, wx, wy, wz).

    With friction -axial wz on the axis and -transverse (wx, wy) across it, and with the applied
    torque. Only sums and products are used, so that the numbers may also be symbolic expressions.
    """
    Ix, Iz, _ = task.top.moments
    axial, transverse = task.friction.axial, task.friction.transverse
    w, x, y_, z, wx, wy, wz = y.tolist() if hasattr(y, "tolist") else y
    nx, ny, nz = find_torque(task, w, x, y_, z)
    return [
        (-x * wx - y_ * wy - z * wz) / 2,
        (w * wx + y_ * wz - z * wy) / 2,
        (w * wy - x * wz + z * wx) / 2,
        (w * wz + x * wy - y_ * wx) / 2,
        ((Ix - Iz) * wy * wz + nx - transverse * wx) / Ix,
        ((Iz - Ix) * wz * wx + ny - transverse * wy) / Ix,
        (nz - axial * wz) / Iz,
    ]


def find_torque(task: Motion, w: Any, x: Any, y: Any, z: Any) -> tuple[Any, Any, Any]:
    """Return the torque of gravity and the applied one in the frame of a quaternion."""
    Mgl, torque = task.top.Mgl, task.applied_torque
    tx, ty, tz = _to_body(torque, w, x, y, z) if any(torque) else torque
    return Mgl * (2 * (y * z + w * x)) + tx, -Mgl * (2 * (x * z - w * y)) + ty, tz


def _to_body(torque: Vector, w: Any, x: Any, y: Any, z: Any) -> tuple[Any, Any, Any]:
    """Return a vector of the world frame in the body frame: rows of the transposed rotation."""
    a, b, c = torque
    return (
        (1 - 2 * (y * y + z * z)) * a + 2 * (x * y + w * z) * b + 2 * (x * z - w * y) * c,
        2 * (x * y - w * z) * a + (1 - 2 * (x * x + z * z)) * b + 2 * (y * z + w * x) * c,
        2 * (x * z + w * y) * a + 2 * (y * z - w * x) * b + (1 - 2 * (x * x + y * y)) * c,
    )


def euler_rates(task: Motion, t: float, y: Any, *, sin: Any = sin, cos: Any = cos) -> list[Any]:
    """Return the article's three equations for y = (phi, theta, psi, phi', theta', psi').

    With the functions sin and cos of another package the numbers may be symbolic expressions.
    """
    Ix, Iz, Mgl = task.top.moments
    _, theta, _, phi_dot, theta_dot, psi_dot = y.tolist() if hasattr(y, "tolist") else y
    c, s = cos(theta), sin(theta)
    gyration = Iz * psi_dot + (Iz - 2 * Ix) * phi_dot * c
    phi_ddot = theta_dot / (Ix * s) * gyration
    theta_ddot = s / Ix * ((Ix - Iz) * phi_dot**2 * c - Iz * phi_dot * psi_dot + Mgl)
    psi_ddot = theta_dot * phi_dot * s - phi_ddot * c
    return [phi_dot, theta_dot, psi_dot, phi_ddot, theta_ddot, psi_ddot]
