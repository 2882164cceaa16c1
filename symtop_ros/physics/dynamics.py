"""Angular and point accelerations of a body in motion, and balances of energy and momentum.

A balance over a stretch of time says how well a motion obeys its equations of motion.
"""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from symtop_ros.base.arrays import Real, split, stack
from symtop_ros.base.refusals import require
from symtop_ros.physics.motion import Motion
from symtop_ros.physics.state import State
from symtop_ros.physics.values import (
    validate_number,
    validate_one,
    validate_positive,
    validate_vector,
)

DEFAULT_GRAVITY = 9.81  # m/s^2: that of a class's book; standard gravity is 9.80665 m/s^2
NODES = 24  # of the Gauss-Legendre quadrature: exact to rounding over a stretch of STRETCH radians
STRETCH = 4.0  # rad of the fastest rate


def angular_acceleration(motion: Motion, state: State) -> Real:
    """Return the rate of change of omega, in the world frame.

    It follows from Euler's equations (Goldstein, section 5.5), and is rotated into the world frame.
    Seen from the body and from the world, omega has the same rate of change: the two differ by
    omega x omega = 0.

    Parameters
    ----------
    motion : Motion
        Gives the moments of inertia and the torque.
    state : State
        One state or many.

    Returns
    -------
    ndarray (..., 3)
        In rad/s^2.

    Examples
    --------
    A pendulum that is let go horizontally begins to fall at Mgl/Ix.

    >>> from symtop_ros.physics import Motion, State, Top, angular_acceleration
    >>> motion = Motion(Top(Ix=1.0, Iz=0.5, Mgl=3.0), State((0.5, 0.5, 0.5, 0.5), (0, 0, 0)))
    >>> angular_acceleration(motion, motion.start).tolist()
    [0.0, 3.0, 0.0]
    """
    validate_one(motion, "motion")
    Ix, Iz, _ = motion.top.moments
    x, y, z = split(state.angular_velocity)
    torque_x, torque_y, torque_z = split(_body_torque(motion, state))
    coupling = (Ix - Iz) / Ix
    return state.to_world(
        stack(coupling * y * z + torque_x / Ix, torque_y / Ix - coupling * z * x, torque_z / Iz)
    )


def point_acceleration(motion: Motion, state: State, position: ArrayLike) -> Real:
    """Return the acceleration of a point of the body, in the body frame.

    It is alpha x p + omega x (omega x p), with the angular acceleration alpha from Euler's
    equations (Goldstein, sections 4.10 and 5.5).

    Parameters
    ----------
    motion : Motion
        Gives the moments of inertia and the torque.
    state : State
        One state or many.
    position : array_like (3,)
        The point p in the body frame, in m.

    Returns
    -------
    ndarray (..., 3)
        In m/s^2.

    Raises
    ------
    ValueError
        If the position is not three finite numbers.

    Examples
    --------
    A point at a distance of 0.5 m from an axis at rest is pulled inwards by omega^2 r.

    >>> from symtop_ros.physics import Motion, State, Top, point_acceleration
    >>> motion = Motion(Top(Ix=1.0, Iz=0.5, Mgl=0.0), State((1, 0, 0, 0), (0, 0, 4)))
    >>> point_acceleration(motion, motion.start, (0.5, 0, 0)).tolist()
    [-8.0, 0.0, 0.0]
    """
    validate_one(motion, "motion")
    a, b, c = validate_vector("position", position, "m, body frame")
    Ix, Iz, _ = motion.top.moments
    x, y, z = split(state.angular_velocity)
    torque_x, torque_y, torque_z = split(_body_torque(motion, state))
    # The sums of alpha and of products of omega are put together before they are rounded: in
    # alpha_y + x z, for one, a term (1 - 1) x z is left out.
    across_x, across_y, axial = torque_x / Ix, torque_y / Ix, torque_z / Iz
    slow = Iz / Ix
    fast = (2 * Ix - Iz) / Ix
    return stack(
        c * (slow * x * z + across_y) + b * (x * y - axial) - a * (y * y + z * z),
        c * (slow * y * z - across_x) + a * (x * y + axial) - b * (x * x + z * z),
        a * (fast * x * z - across_y) + b * (fast * y * z + across_x) - c * (x * x + y * y),
    )


def specific_force(
    motion: Motion, state: State, position: ArrayLike, gravity: float = DEFAULT_GRAVITY
) -> Real:
    """Return what an ideal accelerometer at a point of the body measures, in the body frame.

    It is the acceleration a of the point minus that of free fall: a + g z'. At rest it is g,
    upwards.

    Parameters
    ----------
    motion : Motion
    state : State
        One state or many.
    position : array_like (3,)
        Position of the accelerometer in the body frame, in m.
    gravity : float
        Acceleration of gravity in m/s^2.

    Returns
    -------
    ndarray (..., 3)
        In m/s^2.

    Examples
    --------
    >>> from symtop_ros.physics import Motion, State, Top, specific_force
    >>> motion = Motion(Top(Ix=1.0, Iz=0.5, Mgl=0.0), State((1, 0, 0, 0), (0, 0, 0)))
    >>> specific_force(motion, motion.start, (0, 0, 1)).tolist()
    [0.0, 0.0, 9.81]
    """
    g = validate_number("gravity", gravity, "m/s^2")
    return point_acceleration(motion, state, position) + g * state.vertical


def _body_torque(motion: Motion, state: State) -> Real:
    """Return the total torque about the pivot in the body frame."""
    x, y, z = split(state.vertical)
    Mgl = motion.top.Mgl
    torque = stack(Mgl * y, -Mgl * x, 0.0 * abs(z))
    if motion.is_driven:
        torque += motion.friction.torque(state) + state.to_body(motion.applied_torque)
    if motion.clamped:
        torque += motion.clamp_torque(state)
    return torque


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
        If a time is refused, or if the motion has pushes: each of them changes energy and momentum
        suddenly.

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
    require(not motion.pushes, "pushes", "none for a balance: take a piece", motion.pushes)
    end, longest = validate_number("end", end, "s"), validate_positive("longest", longest, "s")
    begin = end - min(longest, STRETCH / find_fastest_rate(motion, end))
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


def find_fastest_rate(motion: Motion, t: float) -> float:
    """Return the rate in rad/s at which torques and powers change: nutation, swing and decay.

    Parameters
    ----------
    motion : Motion
    t : float
        Time in s.
    """
    top = motion.top
    state = motion.at(t)
    nutation = float(np.linalg.norm(top.body_angular_momentum(state))) / top.Ix
    torque = float(np.linalg.norm(motion.applied_torque))
    swing = math.sqrt(abs(top.Mgl) / top.Ix + torque / min(top.Ix, top.Iz))
    decay = float(motion.friction._find_decay(top))
    return max(nutation + swing + decay, 1e-300)
