"""The motion without a torque that turns the axis: Mgl = 0, or an axis at rest on the vertical."""

from __future__ import annotations

import math
from decimal import Decimal, localcontext

import numpy as np

from symtop_ros.physics.kind import Kind, free_kind
from symtop_ros.physics.nutation import Four, Three
from symtop_ros.physics.phase import Phases
from symtop_ros.physics.precise import HALF, PRECISE
from symtop_ros.physics.theta import Complex, Real

UPRIGHT: Four = (1.0, 0.0, 0.0, 0.0)


class FreeMotion:
    """Rotation about L by |L| t/Ix, after a rotation about the axis by c t (Landau & Lifshitz, 33).

    c = p_psi (1/Iz - 1/Ix). An axis at rest on the vertical stays there, and L is along it.
    """

    kind: Kind

    def __init__(self, moments: Three, orientation: Four, angular_velocity: Three) -> None:
        with localcontext(PRECISE):
            Ix, Iz = Decimal(moments[0]), Decimal(moments[1])
            wx, wy, wz = (Decimal(rate) for rate in angular_velocity)
            L = (Ix * wx, Ix * wy, Iz * wz)
            size = sum((part * part for part in L), Decimal(0)).sqrt()
            c = wz * (Ix - Iz) / Ix
            self.nutation_rate = size / Ix
            self._phases = Phases(HALF * self.nutation_rate, HALF * c, -c)
            lx, ly, lz = (float(part / size) if size else 0.0 for part in L)
        self._turn_rate = float(c)
        self._direction = lx, ly, lz
        self._start = orientation, complex(*angular_velocity[:2])
        self._tilt, self._cone = _tilt(orientation, self._direction), _tilt(UPRIGHT, (lx, ly, lz))
        resting = angular_velocity[0] == angular_velocity[1] == 0
        vertical = orientation[0] == orientation[3] == 0 or orientation[1] == orientation[2] == 0
        self.kind = "sleeping" if resting and vertical else free_kind(self._tilt, self._cone)

    def parameters(self, t: Real) -> Complex:
        """A, B and omega (3, n) at times t (n,) in s."""
        half, half_c, turn = self._phases.at(t)
        lx, ly, lz = self._direction
        cosine, sine = np.cos(half), np.sin(half)
        (w, x, y, z), across = self._start
        A, B = complex(w, z), complex(x, y)
        along, over = cosine + 1j * lz * sine, complex(lx, ly) * sine
        spin = np.exp(1j * half_c)
        return np.stack(
            [
                (A * along - B * over.conjugate()) * spin,
                (A * over + B * along.conjugate()) / spin,
                across * np.exp(1j * turn),
            ]
        )

    @property
    def nutation_period(self) -> float:
        """Period of theta in s."""
        rate = float(self.nutation_rate)
        return math.inf if self.kind == "sleeping" or rate == 0 else 2 * math.pi / rate

    @property
    def turning_angles(self) -> tuple[float, float]:
        """Smallest and largest theta in rad."""
        far = self._tilt + self._cone
        return abs(self._tilt - self._cone), min(far, 2 * math.pi - far)

    @property
    def mean_rates(self) -> tuple[float, float]:
        """Mean phi' and psi' in rad/s: phi counts the poles that the axis goes round."""
        if self.kind == "sleeping":
            return math.nan, math.nan
        half = float(self.nutation_rate) / 2
        a = math.copysign(half, math.pi - self._tilt - self._cone)
        b = math.copysign(half, self._cone - self._tilt)
        return a + b, a - b + self._turn_rate


def _tilt(orientation: Four, direction: Three) -> float:
    """Angle (rad) between z' and a body-frame direction at an orientation."""
    w, x, y, z = orientation
    gx, gy = 2 * (x * z - w * y), 2 * (y * z + w * x)
    gz = (w * w + z * z) - (x * x + y * y)
    lx, ly, lz = direction
    cross = math.hypot(gy * lz - gz * ly, gz * lx - gx * lz, gx * ly - gy * lx)
    return math.atan2(cross, gx * lx + gy * ly + gz * lz)
