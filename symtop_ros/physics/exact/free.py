"""The free motion, without a torque that turns the axis: Mgl = 0, or a resting vertical axis."""

import math
from decimal import Decimal

from symtop_ros.arrays import Quaternion, Vector
from symtop_ros.physics.exact.elementary import (
    Components,
    Number,
    arc_tangent,
    find_modulus,
    multiply,
    normalize,
)
from symtop_ros.physics.exact.kind import Kind, classify_free
from symtop_ros.physics.exact.phases import Phases
from symtop_ros.physics.exact.precise import HALF
from symtop_ros.physics.exact.spin import spin_reverses_free
from symtop_ros.physics.times import ExactTimes

UPRIGHT: Quaternion = (1.0, 0.0, 0.0, 0.0)


class FreeMotion:
    """Rotation about L by |L| t/Ix, after a rotation about the axis by c t.

    c = p_psi (1/Iz - 1/Ix) (Landau & Lifshitz, Mechanics, section 33). A resting vertical axis
    stays where it is, and L is along it: the same formula holds.
    """

    kind: Kind

    def __init__(self, moments: Vector, orientation: Quaternion, angular_velocity: Vector) -> None:
        Ix, Iz = Decimal(moments[0]), Decimal(moments[1])
        wx, wy, wz = (Decimal(rate) for rate in angular_velocity)
        L = (Ix * wx, Ix * wy, Iz * wz)
        size = sum((part * part for part in L), Decimal(0)).sqrt()
        # p_psi (1/Iz - 1/Ix) without the difference of reciprocals, which would cancel for a
        # body that is nearly a sphere.
        c = wz * (Ix - Iz) / Ix
        self.nutation_rate = size / Ix
        self._phases = Phases(HALF * self.nutation_rate, HALF * c, -c)
        # A top without angular momentum rests: then any axis does, and its own gives theta.
        lx, ly, lz = (float(part / size) for part in L) if size else (0.0, 0.0, 1.0)
        self._c = c
        self._direction = lx, ly, lz
        orientation = normalize(orientation)
        self._start, self._omega_z = (orientation, angular_velocity[:2]), angular_velocity[2]
        self._tilt = _angle_to_vertical(orientation, self._direction)
        self._cone = _angle_to_vertical(UPRIGHT, self._direction)
        resting = angular_velocity[0] == angular_velocity[1] == 0
        vertical = orientation[0] == orientation[3] == 0 or orientation[1] == orientation[2] == 0
        self.kind = "sleeping" if resting and vertical else classify_free(self._tilt, self._cone)

    def cayley_klein(self, t: Number | ExactTimes) -> Components:
        """Return A, B and omega_xy at times in s or exact times, as real and imaginary parts."""
        (c, s), turn, turn_omega = (phase.unit for phase in self._phases.at(t))
        lx, ly, lz = self._direction
        (w, x, y, z), omega_xy = self._start
        along, over = (c, lz * s), (lx * s, ly * s)
        a, b = multiply((w, z), along), multiply((x, y), (over[0], -over[1]))
        d, e = multiply((w, z), over), multiply((x, y), (along[0], -along[1]))
        return (
            multiply((a[0] - b[0], a[1] - b[1]), turn),
            multiply((d[0] + e[0], d[1] + e[1]), (turn[0], -turn[1])),
            multiply(omega_xy, turn_omega),
        )

    @property
    def nutation_period(self) -> float:
        """Period of theta in s."""
        rate = float(self.nutation_rate)
        return math.inf if self.kind == "sleeping" or rate == 0 else 2 * math.pi / rate

    def turning_angles(self, from_below: bool) -> tuple[float, float]:
        """Return the smallest and the largest angle in rad from the upper or the lower pole."""
        far = self._tilt + self._cone
        low, high = abs(self._tilt - self._cone), min(far, 2 * math.pi - far)
        if from_below:
            low, high = math.pi - high, math.pi - low
        return (low, high) if low <= high else (high, low)  # equal angles, each rounded

    @property
    def mean_rates(self) -> tuple[float, float]:
        """Mean phi' and psi' in rad/s.

        The circle of the axis about L goes round the upper pole, round the lower pole, or round
        neither. This decides how many turns of phi and psi belong to one turn about L.
        """
        half = HALF * self.nutation_rate
        upper, lower = self._turns
        return float((upper + lower) * half), float((upper - lower) * half + self._c)

    @property
    def precession_per_nutation(self) -> float:
        """Turns of the precession in a turn about L: 1, 0 or -1; nan for a top at rest."""
        return sum(self._turns) / 2 if self.nutation_rate else math.nan

    @property
    def spin_reverses(self) -> bool:
        """True if psi' takes both signs."""
        if self.kind == "sleeping":
            return False
        rate, omega_z = float(self.nutation_rate), self._omega_z
        return spin_reverses_free(self._tilt, self._cone, rate, omega_z)

    @property
    def _turns(self) -> tuple[int, int]:
        """Half turns of arg A and arg B in a turn about L, by the poles that are encircled."""
        upper = 1 if self._tilt + self._cone <= math.pi else -1
        return upper, 1 if self._cone >= self._tilt else -1


def _angle_to_vertical(orientation: Quaternion, direction: Vector) -> float:
    """Return the angle in rad between z' and a body-frame direction at an orientation.

    The arc tangent of cross and scalar product keeps the digits of a small angle, which the arc
    cosine of the scalar product alone would lose.
    """
    w, x, y, z = orientation
    gx, gy = 2 * (x * z - w * y), 2 * (y * z + w * x)
    gz = (w * w + z * z) - (x * x + y * y)
    lx, ly, lz = direction
    across = find_modulus((gy * lz - gz * ly, gz * lx - gx * lz))
    cross = find_modulus((across, gx * ly - gy * lx))
    return float(arc_tangent(cross, gx * lx + gy * ly + gz * lz))
