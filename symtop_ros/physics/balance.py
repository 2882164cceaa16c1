"""Balances of a motion over a stretch of time: how well it obeys its equations of motion."""

import math
from dataclasses import dataclass

import numpy as np

from symtop_ros.arrays import Real
from symtop_ros.physics.motion import Motion
from symtop_ros.physics.top import validate_one
from symtop_ros.physics.values import refuse, validate_number

NODES = 24  # of the Gauss-Legendre quadrature: exact to rounding over a stretch of STRETCH radians
STRETCH = 4.0  # rad of the fastest rate


@dataclass(frozen=True)
class Balance:
    """Residuals of the equations of motion, integrated over a stretch of a motion.

    Attributes
    ----------
    energy : float
        Change of the energy minus the work of friction and applied torque, in J. Gravity's work is
        in the potential.
    angular_momentum : ndarray (3,)
        Change of L minus the integral of the total torque, world frame, in N m s.

    Examples
    --------
    >>> from symtop_ros.physics import Motion, State, Top, balance
    >>> top = Top(Ix=0.000228, Iz=0.0000572, Mgl=0.068)
    >>> motion = Motion(top, State.from_euler(theta=0.5, psi_dot=200.0))
    >>> abs(balance(motion, end=2.0, longest=1.0).energy) < 1e-13
    True
    """

    energy: float
    angular_momentum: Real


def balance(motion: Motion, end: float, longest: float) -> Balance:
    """Return the balances of energy and angular momentum over a stretch that ends at a time.

    Parameters
    ----------
    motion : Motion
    end : float
        End of the stretch in s.
    longest : float
        Largest length of the stretch in s, > 0. It is shorter if the motion is too fast for a
        quadrature of 24 nodes.

    Raises
    ------
    ValueError
        If a time is refused.

    Examples
    --------
    >>> import numpy as np
    >>> from symtop_ros.physics import Friction, Motion, State, Top, balance
    >>> top = Top(Ix=0.000228, Iz=0.0000572, Mgl=0.068)
    >>> motion = Motion(top, State.from_euler(theta=0.5, psi_dot=200.0), Friction(axial=2e-6))
    >>> bool(np.abs(balance(motion, end=2.0, longest=1.0).angular_momentum).max() < 1e-13)
    True
    """
    validate_one(motion, "motion")
    end, longest = validate_number("end", end, "s"), validate_number("longest", longest, "s")
    if longest <= 0:
        raise refuse("longest", "> 0 s", longest)
    begin = end - min(longest, STRETCH / _fastest_rate(motion, end))
    points, weights = np.polynomial.legendre.leggauss(NODES)
    half = (end - begin) / 2
    states = motion.at(begin + half * (1 + points))
    power = (motion.added_torque(states) * states.to_world(states.angular_velocity)).sum(axis=-1)
    before, after = motion.at(begin), motion.at(end)
    top = motion.top
    return Balance(
        float(top.energy(after) - top.energy(before) - half * (weights @ power)),
        top.angular_momentum(after)
        - top.angular_momentum(before)
        - half * (weights @ motion.total_torque(states)),
    )


def _fastest_rate(motion: Motion, t: float) -> float:
    """Rate in rad/s at which the integrands change: nutation, swing and decay."""
    top, state = motion.top, motion.at(t)
    nutation = float(np.linalg.norm(top.body_angular_momentum(state))) / top.Ix
    torque = float(np.linalg.norm(motion.applied_torque))
    swing = math.sqrt(abs(top.Mgl) / top.Ix + torque / min(top.Ix, top.Iz))
    decay = motion.friction.transverse / top.Ix + motion.friction.axial / top.Iz
    return max(nutation + swing + decay, 1e-300)
