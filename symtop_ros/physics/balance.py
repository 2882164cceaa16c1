"""Balances of a motion over a stretch of time: how well it obeys the equations it stands for."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from symtop_ros.physics.motion import Motion

Real = NDArray[np.float64]

NODES = 24  # of a Gauss-Legendre quadrature: to rounding over a stretch of STRETCH radians
STRETCH = 4.0  # rad of the fastest rate


@dataclass(frozen=True)
class Balance:
    """What changed over a stretch of a motion, less what should have changed it.

    Attributes
    ----------
    energy : float
        Change of the energy less the work of friction and applied torque (dE/dt = torque . omega;
        gravity's is in the potential), in J.
    angular_momentum : ndarray (3,)
        Change of L less the integral of all torque (dL/dt = torque), world frame, in N m s.
    """

    energy: float
    angular_momentum: Real


def balance(path: Motion, end: float, longest: float) -> Balance:
    """Return the balances up to a time.

    Parameters
    ----------
    path : Motion
    end : float
        In s.
    longest : float
        Length of the stretch before it, in s; less where the motion is faster than a quadrature of
        24 nodes can follow.
    """
    begin = end - min(longest, STRETCH / _rate(path, end))
    points, weights = np.polynomial.legendre.leggauss(NODES)
    half = (end - begin) / 2
    states = path.at(begin + half * (1 + points))
    added = (path.driving_torque(states) * states.to_world(states.angular_velocity)).sum(axis=-1)
    before, after = path.at(begin), path.at(end)
    top = path.top
    return Balance(
        float(top.energy(after) - top.energy(before) - half * (weights @ added)),
        top.angular_momentum(after)
        - top.angular_momentum(before)
        - half * (weights @ path.torque(states)),
    )


def _rate(path: Motion, t: float) -> float:
    """Rate in rad/s at which the vectors of the balance change: nutation, swing and decay."""
    top, state = path.top, path.at(t)
    nutation = float(np.linalg.norm(top.body_angular_momentum(state))) / top.Ix
    torque = float(np.linalg.norm(path.applied_torque))
    swing = math.sqrt(abs(top.Mgl) / top.Ix + torque / min(top.Ix, top.Iz))
    decay = path.friction.transverse / top.Ix + path.friction.axial / top.Iz
    return max(nutation + swing + decay, 1e-300)
