"""Accelerations, forces, energy, and the world's view of exact states, with the digits of these.

Newton's and Euler's equations in mpmath, written apart from those of `symtop_ros.physics.body`.
"""

from __future__ import annotations

from typing import NamedTuple

from mpmath import mp, mpf

from workshop.testset.exact import DIGITS
from workshop.testset.problems import Setting

Attitude = tuple[mpf, ...]  # w, x, y, z
Vector = tuple[mpf, ...]


class Forces(NamedTuple):
    """Forces of a state; `angular_acceleration` is in the body frame, the others in the world."""

    angular_acceleration: Vector  # rad/s^2
    acceleration: Vector  # of the centre of mass, m/s^2
    pivot_force: Vector  # on the top, N
    energy: mpf  # J; Mgl cos(theta) is the potential energy


class WorldState(NamedTuple):
    """A state as engines in maximal coordinates have it, in the world frame."""

    position: Vector  # of the centre of mass, m
    velocity: Vector  # of the centre of mass, m/s
    angular_velocity: Vector  # rad/s


def find_world_state(setting: Setting, q: Attitude, omega: Vector) -> WorldState:
    """Return the centre of mass, its velocity, and the angular velocity in the world frame."""
    arm = mpf(setting.body.arm)
    with mp.workdps(DIGITS):
        R = rotation(q)
        wx, wy, _ = omega
        velocity = (arm * wy, -arm * wx, mpf(0))  # omega x (0, 0, arm), in the body frame
        return WorldState(
            tuple(arm * row[2] for row in R),
            tuple(mp.fdot(row, velocity) for row in R),
            tuple(mp.fdot(row, omega) for row in R),
        )


def find_forces(setting: Setting, q: Attitude, omega: Vector) -> Forces:
    """Return the forces of a state; the constants of the top and of its body are exact doubles."""
    Ix, Iz, Mgl = map(mpf, setting.top.moments)
    mass, arm, gravity = map(mpf, (setting.body.mass, setting.body.arm, setting.body.gravity))
    with mp.workdps(DIGITS):
        R = rotation(q)
        wx, wy, wz = omega
        gx, gy, gz = R[2]  # the vertical, seen from the body
        alpha = (
            ((Ix - Iz) * wy * wz + Mgl * gy) / Ix,
            ((Iz - Ix) * wz * wx - Mgl * gx) / Ix,
            mpf(0),
        )
        # alpha x p + omega x (omega x p), for p on the axis
        local = (arm * (alpha[1] + wx * wz), arm * (wy * wz - alpha[0]), -arm * (wx**2 + wy**2))
        acceleration = tuple(mp.fdot(row, local) for row in R)
        x, y, z = acceleration
        energy = (Ix * (wx**2 + wy**2) + Iz * wz**2) / 2 + Mgl * gz
        return Forces(alpha, acceleration, (mass * x, mass * y, mass * (z + gravity)), energy)


def rotation(q: Attitude) -> tuple[Vector, Vector, Vector]:
    """Return the rows of the matrix from body to world."""
    w, x, y, z = q
    return (
        (w * w + x * x - y * y - z * z, 2 * (x * y - w * z), 2 * (x * z + w * y)),
        (2 * (x * y + w * z), w * w - x * x + y * y - z * z, 2 * (y * z - w * x)),
        (2 * (x * z - w * y), 2 * (y * z + w * x), w * w - x * x - y * y + z * z),
    )
