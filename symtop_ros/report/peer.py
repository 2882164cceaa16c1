"""The equations of motion, for integrators that the closed form is compared with."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray


def derivative(
    t: float,
    y: NDArray[np.float64],
    Ix: float,
    Iz: float,
    Mgl: float,
    axial: float = 0.0,
    transverse: float = 0.0,
) -> NDArray[np.float64]:
    """Return q' = q omega/2 and Euler's equations for (w, x, y, z, wx, wy, wz).

    With friction -axial wz on the axis and -transverse (wx, wy) across it.
    """
    w, x, y_, z, wx, wy, wz = y
    gx, gy = 2 * (x * z - w * y_), 2 * (y_ * z + w * x)
    return np.array(
        [
            (-x * wx - y_ * wy - z * wz) / 2,
            (w * wx + y_ * wz - z * wy) / 2,
            (w * wy - x * wz + z * wx) / 2,
            (w * wz + x * wy - y_ * wx) / 2,
            ((Ix - Iz) * wy * wz + Mgl * gy - transverse * wx) / Ix,
            ((Iz - Ix) * wz * wx - Mgl * gx - transverse * wy) / Ix,
            -axial * wz / Iz,
        ]
    )
