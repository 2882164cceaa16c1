"""A fixed camera: without perspective if it is far from the top, else a pinhole.

The picture has u to the right and v upwards. `elevation` is the angle of the line of sight below
the horizontal (0: seen from the side, pi/2: from above), `roll` turns the picture, (u, v) is the
pivot, and exp(log_scale) the distance of the point from the pivot, all in the units of the picture.
A pinhole looks at the pivot, and `nearness` is the length of the axis in distances of the camera
from the pivot; zero if the camera is far away. What is nearer is larger.
"""

from collections.abc import Mapping

import numpy as np

from symtop_ros.base.arrays import Real

LARGEST = 50.0  # log_scale; a step along a valley may go beyond any picture
CAMERA = ("u", "v", "log_scale", "elevation", "roll", "nearness")


def project(axis: Real, camera: Mapping[str, Real]) -> Real:
    """Return u, v, (k, n, 2), of axes (k, n, 3) seen by cameras with numbers (k,) each.

    A camera without a nearness is far away.
    """
    get = {name: np.asarray(value)[:, np.newaxis] for name, value in camera.items()}
    nearness = get.get("nearness", np.zeros((1, 1)))
    right = axis[..., 0]
    up, out = np.sin(get["elevation"]), np.cos(get["elevation"])
    high, near = axis[..., 1] * up + axis[..., 2] * out, axis[..., 2] * up - axis[..., 1] * out
    size = np.exp(np.minimum(get["log_scale"], LARGEST)) / (1 - nearness * near)
    cos, sin = np.cos(get["roll"]), np.sin(get["roll"])
    u = get["u"] + size * (cos * right - sin * high)
    v = get["v"] + size * (sin * right + cos * high)
    return np.stack([u, v], axis=-1)
