"""The equations of motion in a frame that leaves the spin out, as the package integrates them.

The frame turns about the axis at s omega_z, s = Iz/Ix, while the body turns at omega_z, so that
steps resolve the nutation alone (docs/derivation.md, section 15). Without a torque along the axis
but friction the spin is known: omega_z = omega_z(0) exp(-f t).
"""

from functools import partial
from math import exp
from typing import Any

import numpy as np

from symtop_ros.base.arrays import Real
from symtop_ros.physics import Motion
from workshop.speed.peers.peer import Equations, find_torque, initial_values, normalize


def on_turning_frame(task: Motion) -> Equations:
    """Return quaternion and angular velocity in the frame, and the angle of spin, as variables."""
    start = [*initial_values(task), 0.0]
    half_rest = (1 - task.top.Iz / task.top.Ix) / 2

    def read(_: Real, y: Real) -> Real:
        return turn_about_axis(normalize(y[:, :4]), half_rest * y[:, 7])

    return Equations(start, partial(frame_rates, task), read)


def on_turning_frame_with_known_spin(
    task: Motion, exp: Any = exp, number: Any = float
) -> Equations:
    """Return quaternion and angular velocity across the axis as variables: the spin is a formula.

    `exp` may be that of another package, and `number` a type with more digits. No torque may be
    applied.
    """
    *across, spin = map(number, initial_values(task)[4:])
    # Of norm 1 to the last of its digits: the torque has the square of the norm as a factor.
    start = [*normalize(task.start.orientation.astype(number)), *across]
    Ix, Iz = number(task.top.Ix), number(task.top.Iz)
    decay = number(task.friction.axial) / Iz

    def rates(t: Any, y: Any) -> list[Any]:
        values = y.tolist() if hasattr(y, "tolist") else y
        now = spin * exp(-decay * t) if decay else spin
        return frame_rates(task, t, [*values, now, 0.0], number)[:6]

    def read(times: Real, y: Real) -> Real:
        passed = -np.expm1(-decay * times) / decay if decay else times.astype(number)
        return turn_about_axis(normalize(y[:, :4]), (1 - Iz / Ix) / 2 * spin * passed)

    return Equations(start, rates, read)


def frame_rates(task: Motion, _: Any, y: Any, number: Any = float) -> list[Any]:
    """Return the rates of y = (w, x, y, z, omega_x, omega_y, omega_z, S) in the frame.

    Only sums and products are used, so that the numbers may also be symbolic expressions.
    """
    Ix, Iz, _ = map(number, task.top.moments)
    axial, transverse = number(task.friction.axial), number(task.friction.transverse)
    w, x, y_, z, wx, wy, wz, _ = y.tolist() if hasattr(y, "tolist") else y
    turn = Iz / Ix * wz
    nx, ny, nz = find_torque(task, w, x, y_, z)
    return [
        (-x * wx - y_ * wy - z * turn) / 2,
        (w * wx + y_ * turn - z * wy) / 2,
        (w * wy - x * turn + z * wx) / 2,
        (w * turn + x * wy - y_ * wx) / 2,
        (nx - transverse * wx) / Ix,
        (ny - transverse * wy) / Ix,
        (nz - axial * wz) / Iz,
        wz,
    ]


def turn_about_axis(q: Real, half: Real) -> Real:
    """Return quaternions (n, 4), turned about the axis; `half` is half of the angle (n,) in rad."""
    w, x, y, z = q.T
    c, s = np.cos(half), np.sin(half)
    turned = np.stack([w * c - z * s, x * c + y * s, y * c - x * s, z * c + w * s], axis=1)
    return turned.astype(float)
