"""A rigid body with any tensor about its pivot: a Taylor series that shares nothing with the rest.

    J omega' = (J omega) x omega - g m c x e,   e' = e x omega,   q' = q omega / 2,

with the vertical e and the centre of mass c in the frame of the link.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from mpmath import mp, mpf
from testset.model_files import DIGITS, Described, rotation

ORDER = 34  # terms; with a turn of STEP the last one is 1e-33 of the first
STEP = 0.5  # rad
Terms = list[list[Any]]  # of each component


def integrate(body: Described, gravity: float, t: float) -> tuple[list[Any], list[Any]]:
    """Return quaternion and angular velocity after a time in s."""
    with mp.workdps(DIGITS):
        inverse, e = body.moments**-1, rotation(list(body.orientation))[2, :]
        q, omega, e = list(body.orientation), list(body.angular_velocity), list(e)
        pull = abs(gravity) * mp.norm(body.weighted) * mp.mnorm(inverse, 1)  # rad/s^2
        fastest = mp.norm(omega) + mp.sqrt(pull)
        count = int(mp.ceil(mpf(t) * fastest / STEP))
        for _ in range(count):
            q, omega, e = advance(body, inverse, gravity, (q, omega, e), mpf(t) / count)
        return q, omega


def advance(body: Described, inverse: Any, gravity: float, state: Any, h: Any) -> Any:
    """Return the state after a step."""
    q, omega, e = ([[each] for each in part] for part in state)
    J, m = body.moments, [mpf(gravity) * each for each in body.weighted]
    spin: Terms = [[], [], []]
    for k in range(ORDER):
        for i in range(3):
            spin[i].append(mp.fdot((J[i, j], omega[j][k]) for j in range(3)))
        torque = cross(spin, omega, k)
        for i, (a, b) in enumerate(((1, 2), (2, 0), (0, 1))):
            torque[i] -= m[a] * e[b][k] - m[b] * e[a][k]
        change = cross(e, omega, k)
        turn = quaternion_rate(q, omega, k)
        for i in range(3):
            omega[i].append(mp.fdot((inverse[i, j], torque[j]) for j in range(3)) / (k + 1))
            e[i].append(change[i] / (k + 1))
        for i in range(4):
            q[i].append(turn[i] / (2 * (k + 1)))
    return [[add_up(each, h) for each in part] for part in (q, omega, e)]


def add_up(terms: Sequence[Any], h: Any) -> Any:
    """Return the sum of a series, by Horner's scheme."""
    total = mpf(0)
    for each in reversed(terms):
        total = total * h + each
    return total


def product(a: Sequence[Any], b: Sequence[Any], k: int) -> Any:
    """Return term k of the product of two series."""
    return mp.fdot(a[: k + 1], b[k::-1])


def cross(a: Terms, b: Terms, k: int) -> list[Any]:
    places = (1, 2), (2, 0), (0, 1)
    return [product(a[i], b[j], k) - product(a[j], b[i], k) for i, j in places]


def quaternion_rate(q: Terms, omega: Terms, k: int) -> list[Any]:
    """Return term k of the product of a quaternion and a vector."""
    w, x, y, z = q
    a, b, c = omega
    signs = (
        ((x, a, -1), (y, b, -1), (z, c, -1)),
        ((w, a, 1), (y, c, 1), (z, b, -1)),
        ((w, b, 1), (z, a, 1), (x, c, -1)),
        ((w, c, 1), (x, b, 1), (y, a, -1)),
    )
    return [sum((s * product(p, r, k) for p, r, s in row), mpf(0)) for row in signs]
