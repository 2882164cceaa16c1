"""A fixed camera: without perspective if it is far from the top, else a pinhole.

The picture has u to the right and v upwards. `elevation` is the angle of the line of sight to the
pivot below the horizontal (0: seen from the side, pi/2: from above), `roll` turns the picture about
that line, (u, v) is the pivot, and exp(log_scale) the distance of the point from the pivot, all in
the units of the picture. `nearness` is the length of the axis in distances of the camera from the
pivot; zero if the camera is far away. A point nearer to the camera is shown larger.

A pinhole looks at the point of the picture that is its centre; if that is not known, at the pivot.
A camera at one place that looks elsewhere sees the same lines of sight, turned. With T the picture
of the camera that looks at the pivot, in lengths of the axis, a = nearness (pivot - centre)/scale
and q^2 = 1 + a.a, Rodrigues' formula gives

    (q T + (T.a) a q/(q + 1)) / (1 - nearness T.a)

(Hartley and Zisserman, Multiple View Geometry, section 8.4). No term is divided by the nearness.
"""

from collections.abc import Mapping

import numpy as np

from symtop_ros.base.arrays import Real

LARGEST = 50.0  # log_scale; a step along a valley may go beyond any picture
CAMERA = ("u", "v", "log_scale", "elevation", "roll", "nearness")
CENTRE = ("centre_u", "centre_v")  # where a camera looks; known, or taken to be the pivot


def project(axis: Real, camera: Mapping[str, Real]) -> Real:
    """Return u, v, (k, n, 2), of axes (k, n, 3) seen by cameras with numbers (k,) each.

    A camera without a nearness is far away, and one without a centre looks at the pivot.
    """
    get = {name: np.asarray(value)[:, np.newaxis] for name, value in camera.items()}
    nearness = get.get("nearness", np.zeros((1, 1)))
    right = axis[..., 0]
    up, out = np.sin(get["elevation"]), np.cos(get["elevation"])
    high, near = axis[..., 1] * up + axis[..., 2] * out, axis[..., 2] * up - axis[..., 1] * out
    cos, sin = np.cos(get["roll"]), np.sin(get["roll"])
    seen = np.stack([cos * right - sin * high, sin * right + cos * high], axis=-1)
    seen /= (1 - nearness * near)[..., np.newaxis]
    if "centre_u" in get:
        seen = _look_away(seen, get, nearness)
    return np.asarray(_find_pivot(get) + _find_size(get) * seen)


def rectify(points: Real, camera: Mapping[str, float]) -> Real:
    """Return points (n, 2) of a picture as seen by a camera that looks at the pivot.

    The camera stays at its place. This inverts the formula above: a picture D, in lengths of the
    axis, becomes (q D - (D.a) a/(q + 1)) / (q^2 + nearness D.a).
    """
    if "centre_u" not in camera:
        return points
    get = {name: np.full((1, 1), value) for name, value in camera.items()}
    aside, q = _find_aim(get, get["nearness"])
    seen = (points - _find_pivot(get)) / _find_size(get)
    along = (seen * aside).sum(axis=-1, keepdims=True)
    turned = (q * seen - along * aside / (q + 1)) / (q * q + get["nearness"] * along)
    return np.asarray((_find_pivot(get) + _find_size(get) * turned)[0])


def _look_away(seen: Real, get: Mapping[str, Real], nearness: Real) -> Real:
    """Return pictures (k, n, 2), in lengths of the axis, of cameras that look at their centres."""
    aside, q = _find_aim(get, nearness)
    along = (seen * aside).sum(axis=-1, keepdims=True)
    turned = q * seen + along * aside * (q / (q + 1))
    return np.asarray(turned / (1 - nearness[..., np.newaxis] * along))


def _find_aim(get: Mapping[str, Real], nearness: Real) -> tuple[Real, Real]:
    """Return a, (k, 1, 2), the tangents of the angles from the centre to the pivot, and q."""
    centre = np.stack([get[name] for name in CENTRE], axis=-1)
    aside = nearness[..., np.newaxis] * (_find_pivot(get) - centre) / _find_size(get)
    return aside, np.sqrt(1 + (aside * aside).sum(axis=-1, keepdims=True))


def _find_pivot(get: Mapping[str, Real]) -> Real:
    return np.stack([get["u"], get["v"]], axis=-1)


def _find_size(get: Mapping[str, Real]) -> Real:
    return np.asarray(np.exp(np.minimum(get["log_scale"], LARGEST))[..., np.newaxis])
