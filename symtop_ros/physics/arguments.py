"""Arguments of one motion or of many: tops, starts, frictions and torques, broadcast together."""

import math
from struct import Struct
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from symtop_ros.base.arrays import Mask, Real, Vector
from symtop_ros.base.refusals import refuse
from symtop_ros.physics.kernel import bindings
from symtop_ros.physics.kernel.records import FRICTION_KINDS
from symtop_ros.physics.state import State
from symtop_ros.physics.times import ExactTimes
from symtop_ros.physics.top import Friction, Top
from symtop_ros.physics.values import fit_shapes, validate_array, validate_number, validate_vectors

NO_FRICTION = Friction()
NO_TORQUE = (0.0, 0.0, 0.0)
TORQUE_UNIT = "N m, world frame"
LEAST_TOLERANCE, LARGEST_TOLERANCE = 1e-15, 1e-6  # of kernel/functions/arguments.hpp
# States in one call of the kernel, some ms: Python sees signals, such as Ctrl-C, between two calls.
# To set up a motion takes the time of some hundred states.
STATES = 2**16
STATES_OF_SETUP = 200
# Ends of the columns of starts: moments, orientation as given, omega, friction, torque.
STARTS = (3, 7, 10, 10 + len(FRICTION_KINDS), bindings.START)
_pack_start = Struct(f"{bindings.START}d").pack


def validate_torque(torque: Any) -> Any:
    """Return three floats, or an array (..., 3)."""
    return NO_TORQUE if torque is NO_TORQUE else validate_vectors("torque", torque, TORQUE_UNIT)


def validate_times(t: ArrayLike | ExactTimes) -> float | Real | ExactTimes:
    """Return one time as a float, many as an array, and exact times unchanged."""
    if isinstance(t, ExactTimes) or (type(t) is float and math.isfinite(t)):
        return t
    if type(t) is np.ndarray and t.dtype == np.float64 and t.ndim and np.isfinite(t).all():
        return t  # the common case: no copy
    array = validate_array("t", t, unit="s")
    return array if array.ndim else float(array)


def validate_tolerance(tolerance: Any) -> float:
    """Return the local error that steps may have, or 0."""
    value = validate_number("tolerance", tolerance)
    if value and not LEAST_TOLERANCE <= value <= LARGEST_TOLERANCE:
        allowed = f"0, or {LEAST_TOLERANCE:g} to {LARGEST_TOLERANCE:g}"
        raise refuse("tolerance", allowed, tolerance)
    return value


def validate_types(top: Any, start: Any, friction: Any) -> None:
    """Refuse arguments of other classes."""
    for name, given, kind in (
        ("top", top, Top),
        ("start", start, State),
        ("friction", friction, Friction),
    ):
        if not isinstance(given, kind):
            raise refuse(name, f"a {kind.__name__}", given)


def wrap_states(orientation: Real, angular_velocity: Real, shape: tuple[int, ...]) -> State:
    """Return the states of arrays (n, 4) and (n, 3), in a shape."""
    for array in (orientation, angular_velocity):
        array.flags.writeable = False  # so that it cannot be written to as `base` of a view
    return State._wrap(orientation.reshape(*shape, 4), angular_velocity.reshape(*shape, 3))


def find_shape(top: Top, start: State, friction: Friction, torque: Any) -> tuple[int, ...]:
    """Return the shape of the motions; () for one."""
    if (
        not top.shape
        and not friction.shape
        and start.orientation.ndim == 1
        and type(torque) is tuple
    ):
        return ()  # the common case, and NumPy needs 10 us for the question
    return fit_shapes(
        "top, start, friction and torque",
        top.shape,
        start.orientation.shape[:-1],
        friction.shape,
        np.shape(torque)[:-1],
    )


def pack_start(top: Top, start: State, friction: Friction, torque: Vector) -> bytes:
    """Return the arguments of one motion, as `symtop_start` has them."""
    state = *start.given_orientation.tolist(), *start.angular_velocity.tolist()
    return _pack_start(*top.moments, *state, *friction.coefficients, *torque)


def list_starts(
    top: Top, start: State, friction: Friction, torque: Any, shape: tuple[int, ...]
) -> Real:
    """Return the arguments of the motions of a shape, (n, 15), as `symtop_start` has them."""
    if not shape:
        return np.frombuffer(pack_start(top, start, friction, torque)).reshape(1, -1)
    arrays = (
        np.stack(top.moments, axis=-1),
        start.given_orientation,
        start.angular_velocity,
        np.stack(friction.coefficients, axis=-1),
        np.asarray(torque),
    )
    spread = [np.broadcast_to(each, (*shape, each.shape[-1])) for each in arrays]
    return np.concatenate(spread, axis=-1).reshape(math.prod(shape), STARTS[-1])


def read_start(row: Real) -> tuple[Top, State, Friction, Vector]:
    """Return the arguments of one motion, from its numbers."""
    moments, orientation, omega, coefficients, (x, y, z) = np.split(row, STARTS[:-1])
    start = State._of_given(orientation.copy(), omega.copy())
    friction = Friction(*coefficients.tolist()) if coefficients.any() else NO_FRICTION
    return Top(*moments.tolist()), start, friction, (float(x), float(y), float(z))


def fill_states(starts: Real, times: Real | ExactTimes, orientation: Real, omega: Real) -> Mask:
    """Write the states at times (m,), in s or exact, into (n, m, 4) and (n, m, 3).

    Returns (n, m), True for the states that are left: those of driven motions, those from a time on
    that is too far, and all those at exact times.
    """
    left = np.ones((len(starts), math.prod(times.shape)), np.uint8)
    if isinstance(times, ExactTimes):
        return left.view(np.bool_)
    kept = np.flatnonzero(~starts[:, STARTS[2] :].any(axis=1))  # neither friction nor a torque
    rows = max(1, STATES // (times.size + STATES_OF_SETUP))
    for first in range(0, len(kept), rows):
        some = kept[first : first + rows]
        whole = len(some) == some[-1] - some[0] + 1
        place: Any = slice(some[0], some[-1] + 1) if whole else some
        # In place if the motions are neighbours: an indexed array would be a copy.
        parts = orientation[place], omega[place], left[place]
        bindings.fill_many(starts[some], times, *parts)
        if not whole:
            orientation[place], omega[place], left[place] = parts
    return left.view(np.bool_)


def describe_starts(starts: Real) -> NDArray[Any]:
    """Return the constants of motions, as records (n,) of `bindings.CONSTANTS`."""
    rows = STATES // STATES_OF_SETUP
    blocks = [starts[first : first + rows] for first in range(0, len(starts), rows)]
    return np.concatenate([bindings.describe_many(block) for block in blocks or [starts]])
