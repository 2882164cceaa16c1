"""A fixed camera that is far from the top: it draws the axis without perspective.

The picture has u to the right and v upwards. `elevation` is the angle of the line of sight below
the horizontal (0: seen from the side, pi/2: from above), `roll` turns the picture, (u, v) is the
pivot, and exp(log_scale) the distance of the point from the pivot, all in the units of the picture.
"""

from collections.abc import Mapping

import numpy as np

from symtop_ros.base.arrays import Real

CAMERA = ("u", "v", "log_scale", "elevation", "roll")


def project(axis: Real, camera: Mapping[str, Real]) -> Real:
    """Return u, v, (k, n, 2), of axes (k, n, 3) seen by cameras with numbers (k,) each."""
    get = {name: np.asarray(camera[name])[:, np.newaxis] for name in CAMERA}
    right = axis[..., 0]
    high = axis[..., 1] * np.sin(get["elevation"]) + axis[..., 2] * np.cos(get["elevation"])
    size, cos, sin = np.exp(get["log_scale"]), np.cos(get["roll"]), np.sin(get["roll"])
    u = get["u"] + size * (cos * right - sin * high)
    v = get["v"] + size * (sin * right + cos * high)
    return np.stack([u, v], axis=-1)
