"""The equations of motion of a driven top, with quadratic derivatives.

The spin about the axis is split off. It is counted as an angle, and the rest is integrated in a
frame that turns about the axis at about Iz/Ix omega_z instead of omega_z. There friction and weight
have the same form as in the body, and the angular velocity of a free top is constant. Steps have to
resolve the nutation only, however fast a slender body spins. In this frame every derivative is a
polynomial of degree 2:

- of the quaternion: q' = q omega/2,
- of the angular velocity, by Euler's equations: the directions of the torques are quadratic in q,
  and friction is linear in omega.
"""

import math

import numpy as np
from numpy.typing import NDArray

from symtop_ros.arrays import Vector
from symtop_ros.physics.state import State
from symtop_ros.physics.top import Friction, Top

Extended = NDArray[np.longdouble]
Form = tuple[tuple[int, int, int], ...]

# Places of the variables: quaternion and angular velocity in the frame, the number 1, by which a
# linear term becomes a product, and the integral of omega_z, which is no factor of any product.
W, X, Y, Z, OMEGA_X, OMEGA_Y, OMEGA_Z, ONE, SPIN = range(9)
FACTORS = 8
QUATERNION, RATES = slice(W, OMEGA_X), slice(OMEGA_X, ONE)

SHARE_BITS = 26  # bits of the rate of the frame over omega_z: 1 - share is exact

# Quadratic forms of the quaternion: the components of x', y' and z' in the frame.
AXES = (
    (
        ((W, W, 1), (X, X, 1), (Y, Y, -1), (Z, Z, -1)),
        ((X, Y, 2), (W, Z, -2)),
        ((X, Z, 2), (W, Y, 2)),
    ),
    (
        ((X, Y, 2), (W, Z, 2)),
        ((W, W, 1), (Y, Y, 1), (X, X, -1), (Z, Z, -1)),
        ((Y, Z, 2), (W, X, -2)),
    ),
    (
        ((X, Z, 2), (W, Y, -2)),
        ((Y, Z, 2), (W, X, 2)),
        ((W, W, 1), (Z, Z, 1), (X, X, -1), (Y, Y, -1)),
    ),
)
# q' = q omega/2: row, the two factors, and the sign.
TURNING = (
    *((W, X, OMEGA_X, -1), (W, Y, OMEGA_Y, -1), (W, Z, OMEGA_Z, -1)),
    *((X, W, OMEGA_X, 1), (X, Y, OMEGA_Z, 1), (X, Z, OMEGA_Y, -1)),
    *((Y, W, OMEGA_Y, 1), (Y, Z, OMEGA_X, 1), (Y, X, OMEGA_Z, -1)),
    *((Z, W, OMEGA_Z, 1), (Z, X, OMEGA_Y, 1), (Z, Y, OMEGA_X, -1)),
)


class DrivenEquations:
    """Terms of the derivatives, and how states become variables and variables states."""

    def __init__(self, top: Top, friction: Friction, torque: Vector) -> None:
        Ix, Iz, Mgl = map(np.longdouble, top.moments)
        ratio = Iz / Ix
        share = round(float(ratio) * 2**SHARE_BITS) / 2**SHARE_BITS
        self.ratio = float(ratio)  # Iz/Ix
        self.half_rest = (1 - share) / 2
        # The derivative of variable k is the sum of parts[n, k, i, j] times variables i and j, over
        # i, j and n: the terms of the free top, of friction, and of the torques. In another unit of
        # time part n has the n-th power of the unit as a factor.
        self.parts = np.zeros((3, FACTORS, FACTORS, FACTORS), np.longdouble)
        free, damping, driving = self.parts
        for row, i, j, sign in TURNING:
            free[row, i, j] = sign * (share if j == OMEGA_Z else 1.0) / 2
        # The frame turns at share omega_z instead of exactly L_z/Ix; the difference remains.
        free[OMEGA_X, OMEGA_Z, OMEGA_Y] = share - ratio
        free[OMEGA_Y, OMEGA_Z, OMEGA_X] = ratio - share
        with np.errstate(over="ignore"):  # such a motion is refused, because it is too fast
            decays = np.longdouble(friction.transverse) / Ix, np.longdouble(friction.axial) / Iz
            for row, decay in zip((OMEGA_X, OMEGA_Y, OMEGA_Z), (decays[0], *decays), strict=True):
                damping[row, ONE, row] = -decay
            _add_torque(driving[OMEGA_X], AXES[2][1], Mgl / Ix)
            _add_torque(driving[OMEGA_Y], AXES[2][0], -Mgl / Ix)
            for part, axis in zip(torque, AXES, strict=True):
                for row, form, inertia in zip(range(OMEGA_X, ONE), axis, (Ix, Ix, Iz), strict=True):
                    _add_torque(driving[row], form, part / inertia)
            self._swing = math.sqrt(float((abs(Mgl) + math.hypot(*torque)) / Ix))
            self.decay = float(max(decays))  # 1/s

    def start(self, state: State) -> Extended:
        """Return the variables (9,) of a state, with a spin of 0."""
        values = np.zeros(SPIN + 1, np.longdouble)
        q = state.given_orientation.astype(np.longdouble)
        values[QUATERNION] = q / np.sqrt(np.dot(q, q))
        values[RATES] = state.angular_velocity
        values[ONE] = 1.0
        return values

    def estimate_rate(self, values: Extended) -> float:
        """Return a rate in rad/s: in units of its inverse no Taylor coefficient is far above 1."""
        x, y, z = values[RATES].tolist()
        return math.hypot(x, y, self.ratio * z) + self._swing + self.decay

    def read(self, values: Extended) -> tuple[Extended, Extended]:
        """Return the orientations (n, 4) and body angular velocities (n, 3) of variables (n, 9)."""
        w, x, y, z, omega_x, omega_y, omega_z, _, spin = values.T
        half = self.half_rest * spin
        c, s = np.cos(half), np.sin(half)
        orientation = w * c - z * s, x * c + y * s, y * c - x * s, z * c + w * s
        c, s = c * c - s * s, 2 * c * s
        omega = omega_x * c + omega_y * s, omega_y * c - omega_x * s, omega_z
        return np.stack(orientation, axis=1), np.stack(omega, axis=1)


def _add_torque(matrix: Extended, form: Form, size: np.longdouble) -> None:
    """Add a component of a torque along an axis, given as a quadratic form, over the inertia."""
    if size:
        for i, j, factor in form:
            matrix[i, j] += factor * size
