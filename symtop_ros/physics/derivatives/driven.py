"""Derivatives of a motion with friction or an applied torque, integrated along it.

Euler's equations in the body frame, I omega' = torque - omega x I omega, are differentiated by the
attitude (a small rotation delta of the body frame), by omega and by the moments. They are linear in
these changes, with coefficients that the motion gives at any time.
"""

import math
from functools import partial
from typing import Any

import numpy as np

from symtop_ros.arrays import Real
from symtop_ros.physics.derivatives.collocation import LinearFlow
from symtop_ros.physics.values import refuse

WIDTH = 1.0  # of a step in units of the fastest rate, as in `gravity`
PROBES = 257  # times at which the fastest rate is looked for
MARGIN = 1.5  # for a rate between two of these times
MOST_STEPS = 2**18  # some ten seconds
Z = np.array([0.0, 0.0, 1.0])


def differentiate_driven(motion: Any, times: Real) -> Real:
    """Return the derivatives of a driven motion at times (n,) in s, (n, 6, 9)."""
    farthest = float(times[np.abs(times).argmax()]) if times.size else 0.0
    _limit(motion, farthest, 0.0)  # before the motion is followed to its fastest rate
    rate = _limit(motion, farthest, farthest)
    flow = LinearFlow(partial(_list_coefficients, motion), 6, 3, WIDTH / rate).at(times)
    # first the moments, then the start
    return np.concatenate((flow[..., 6:], flow[..., :6]), axis=-1)


def _limit(motion: Any, farthest: float, known: float) -> float:
    """Return the fastest rate up to a time; refuse times that take too many steps at it."""
    rate = _find_fastest_rate(motion, known)
    if abs(farthest) * rate > MOST_STEPS * WIDTH:
        condition = f"at most {MOST_STEPS * WIDTH / rate:.3g} s for derivatives under friction"
        raise refuse("t", condition, farthest)
    return rate


def _find_fastest_rate(motion: Any, farthest: float) -> float:
    Ix, Iz, Mgl = motion.top.moments
    omega = motion.at(np.linspace(0.0, farthest, PROBES)).angular_velocity
    swing = (abs(Mgl) + math.hypot(*motion.applied_torque)) / min(Ix, Iz)
    decay = max(motion.friction.transverse / Ix, motion.friction.axial / Iz)
    turning = float(np.linalg.norm(omega * [1.0, 1.0, max(1.0, Iz / Ix)], axis=-1).max())
    return float(MARGIN * (turning + 2 * math.sqrt(swing)) + decay)


def _list_coefficients(motion: Any, times: Real) -> tuple[Real, Real]:
    """Return the matrices (n, 6, 6) and (n, 6, 3) of the linear equations at times (n,) in s."""
    Ix, Iz, Mgl = motion.top.moments
    state, n = motion.at(times), len(times)
    omega = state.angular_velocity
    w1, w2, w3 = np.moveaxis(omega, -1, 0)
    inertia = np.array([Ix, Ix, Iz])
    applied, vertical = state.to_body(motion.applied_torque), state.vertical
    friction = motion.friction
    resisted = np.array([friction.transverse, friction.transverse, friction.axial])
    slopes, forces = np.zeros((n, 6, 6)), np.zeros((n, 6, 3))
    slopes[:, :3, :3] = -_cross(omega)
    slopes[:, :3, 3:] = np.eye(3)
    # A vector v of the world, seen from the body, changes by v x delta; gravity's torque is
    # -Mgl z' x vertical.
    turned = _cross(applied) - Mgl * _cross(Z) @ _cross(vertical)
    slopes[:, 3:, :3] = turned / inertia[:, None]
    share = (Ix - Iz) / Ix
    slopes[:, 3, 4], slopes[:, 3, 5] = share * w3, share * w2
    slopes[:, 4, 3], slopes[:, 4, 5] = -share * w3, -share * w1
    slopes[:, 3:, 3:] -= np.diag(resisted / inertia)
    torque = applied - Mgl * np.cross(Z, vertical) - resisted * omega
    forces[:, 3, 0] = (w2 * w3 * Iz - torque[:, 0]) / Ix / Ix
    forces[:, 4, 0] = (-w1 * w3 * Iz - torque[:, 1]) / Ix / Ix
    forces[:, 3, 1], forces[:, 4, 1] = -w2 * w3 / Ix, w1 * w3 / Ix
    forces[:, 5, 1] = -torque[:, 2] / Iz / Iz
    forces[:, 3:5, 2] = -np.cross(Z, vertical)[:, :2] / Ix
    return slopes, forces


def _cross(v: Real) -> Real:
    """Return the matrices (..., 3, 3) of v x."""
    matrix = np.zeros((*v.shape, 3))
    matrix[..., 0, 1], matrix[..., 0, 2], matrix[..., 1, 2] = -v[..., 2], v[..., 1], -v[..., 0]
    return np.asarray(matrix - np.swapaxes(matrix, -1, -2))
