"""Types of arrays and short tuples that all folders share, and products of quaternions.

Quaternions are (w, x, y, z), one or many. The components of one are Python's floats: their sums and
products are those of NumPy, bit for bit, in a tenth of its time.
"""

from collections.abc import Iterable
from typing import Any

import numpy as np
from numpy.typing import NDArray

Real = NDArray[np.float64]
Stamps = NDArray[np.int64]  # ns
Mask = NDArray[np.bool_]
Places = NDArray[np.intp]  # of elements of an array
Vector = tuple[float, float, float]
CONJUGATE = np.array([1.0, -1.0, -1.0, -1.0])


def multiply(p: Iterable[Any], q: Iterable[Any]) -> tuple[Any, Any, Any, Any]:
    """Return the components of the product p q, from those of both: numbers or arrays of any kind.

    They are the rotation q, followed by p.
    """
    (w, x, y, z), (a, b, c, d) = p, q
    return (
        w * a - x * b - y * c - z * d,
        w * b + x * a + y * d - z * c,
        w * c - x * d + y * a + z * b,
        w * d + x * c - y * b + z * a,
    )


def compose(p: Real, q: Real) -> Real:
    """Return the products p q, (..., 4)."""
    p, q = np.asarray(p), np.asarray(q)
    parts = multiply((p[..., k] for k in range(4)), (q[..., k] for k in range(4)))
    product = np.empty((*parts[0].shape, 4))  # NumPy's own stack takes twice the time
    product[..., 0], product[..., 1], product[..., 2], product[..., 3] = parts
    return product


def invert(q: Real) -> Real:
    """Return the inverse of unit quaternions, (..., 4)."""
    return np.asarray(q * CONJUGATE)


def split(v: Real) -> list[Any]:
    """Return the components of vectors (..., n): floats of one, arrays (...) of many."""
    return v.tolist() if v.ndim == 1 else [v[..., k] for k in range(v.shape[-1])]


def axis_of(quaternions: Real) -> Real:
    """Return the symmetry axis in the world frame (n, 3) from those x, y, z, w of messages."""
    x, y, z, w = quaternions.T
    return np.stack(
        [2 * (x * z + w * y), 2 * (y * z - w * x), (w * w + z * z) - (x * x + y * y)], axis=1
    )


def rotate(w: Any, x: Any, y: Any, z: Any, v: Real) -> Real:
    """Return q v q*, (..., 3), for the components (...) of q.

    It is v + w t + (x, y, z) x t with t = 2 (x, y, z) x v.
    """
    a, b, c = split(v)
    t, u, s = 2 * (y * c - z * b), 2 * (z * a - x * c), 2 * (x * b - y * a)
    return stack(
        a + w * t + (y * s - z * u), b + w * u + (z * t - x * s), c + w * s + (x * u - y * t)
    )


def stack(x: Any, y: Any, z: Any) -> Real:
    """Return vectors (..., 3) from their components; NumPy's own takes twice the time."""
    if isinstance(x, float):
        return np.array((x, y, z))
    vector = np.empty((*x.shape, 3))
    vector[..., 0], vector[..., 1], vector[..., 2] = x, y, z
    return vector


def find_rotation_vectors(q: Real) -> Real:
    """Return the vectors of the rotations of quaternions of any norm, of at most half a turn."""
    sine = np.sqrt(np.square(q[..., 1:]).sum(axis=-1, keepdims=True))
    angle = 2 * np.arctan2(sine, np.abs(q[..., :1]))
    scale = np.where(sine, angle / np.where(sine, sine, 1.0), 0.0)
    return np.asarray(np.copysign(scale, q[..., :1]) * q[..., 1:])
