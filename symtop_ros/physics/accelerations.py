"""Accelerations of a body in a given motion: of its angles and of its points."""

from numpy.typing import ArrayLike

from symtop_ros.arrays import Real, split, stack
from symtop_ros.physics.motion import Motion
from symtop_ros.physics.state import State
from symtop_ros.physics.values import validate_vector

STANDARD_GRAVITY = 9.81  # m/s^2


def angular_acceleration(motion: Motion, state: State) -> Real:
    """Return the rate of change of omega, in the world frame.

    It is that of Euler's equations (Goldstein, section 5.5), turned into the world: the rates of
    change of a vector in the body and in the world differ by omega x omega = 0.

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

    >>> from symtop_ros.physics import Motion, State, Top
    >>> motion = Motion(Top(Ix=1.0, Iz=0.5, Mgl=3.0), State((0.5, 0.5, 0.5, 0.5), (0, 0, 0)))
    >>> angular_acceleration(motion, motion.start).tolist()
    [0.0, 3.0, 0.0]
    """
    Ix, Iz, _ = motion.top.moments
    x, y, z = split(state.angular_velocity)
    torque_x, torque_y, torque_z = split(_body_torque(motion, state))
    coupling = (Ix - Iz) / Ix
    body = stack(coupling * y * z + torque_x / Ix, torque_y / Ix - coupling * z * x, torque_z / Iz)
    return state.to_world(body)


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

    >>> from symtop_ros.physics import Motion, State, Top
    >>> motion = Motion(Top(Ix=1.0, Iz=0.5, Mgl=0.0), State((1, 0, 0, 0), (0, 0, 4)))
    >>> point_acceleration(motion, motion.start, (0.5, 0, 0)).tolist()
    [-8.0, 0.0, 0.0]
    """
    a, b, c = validate_vector("position", position, "m, body frame")
    Ix, Iz, _ = motion.top.moments
    x, y, z = split(state.angular_velocity)
    torque_x, torque_y, torque_z = split(_body_torque(motion, state))
    # The sums of alpha and of products of omega are put together before they are rounded: in
    # alpha_y + x z, for one, a term (1 - 1) x z is left out.
    across_x, across_y, axial = torque_x / Ix, torque_y / Ix, torque_z / Iz
    slow, fast = Iz / Ix, (2 * Ix - Iz) / Ix
    return stack(
        c * (slow * x * z + across_y) + b * (x * y - axial) - a * (y * y + z * z),
        c * (slow * y * z - across_x) + a * (x * y + axial) - b * (x * x + z * z),
        a * (fast * x * z - across_y) + b * (fast * y * z + across_x) - c * (x * x + y * y),
    )


def specific_force(
    motion: Motion, state: State, position: ArrayLike, gravity: float = STANDARD_GRAVITY
) -> Real:
    """Return what an ideal accelerometer at a point of the body measures, in the body frame.

    It is the acceleration of the point minus that of free fall, a + g z': at rest g upwards.

    Parameters
    ----------
    motion : Motion
    state : State
        One state or many.
    position : array_like (3,)
        Of the accelerometer, in the body frame, in m.
    gravity : float
        Acceleration of gravity in m/s^2.

    Returns
    -------
    ndarray (..., 3)
        In m/s^2.

    Examples
    --------
    >>> from symtop_ros.physics import Motion, State, Top
    >>> motion = Motion(Top(Ix=1.0, Iz=0.5, Mgl=0.0), State((1, 0, 0, 0), (0, 0, 0)))
    >>> specific_force(motion, motion.start, (0, 0, 1)).tolist()
    [0.0, 0.0, 9.81]
    """
    return point_acceleration(motion, state, position) + gravity * state.vertical


def _body_torque(motion: Motion, state: State) -> Real:
    """Return the total torque about the pivot in the body frame."""
    x, y, z = split(state.vertical)
    Mgl = motion.top.Mgl
    torque = stack(Mgl * y, -Mgl * x, 0.0 * abs(z))
    if motion.is_driven:
        torque += motion.friction.torque(state) + state.to_body(motion.applied_torque)
    return torque
