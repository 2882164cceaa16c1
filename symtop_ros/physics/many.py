"""Many motions at once: tops, starts, frictions and torques, broadcast together.

The kernel computes the states of all motions in one call. Without it they are computed one after
the other, which gives the same bits.
"""

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import wraps
from typing import Any, TypeVar

import numpy as np
from numpy.typing import NDArray

from symtop_ros.arrays import Real, Vector
from symtop_ros.physics.state import State
from symtop_ros.physics.top import Friction, Top
from symtop_ros.physics.values import refuse

T = TypeVar("T")
Function = Callable[[Any], T]

# Below this share of the kinetic energy the weight changes no digit of any phase, and the largest
# root of the cubic, of the order of 1/Mgl, would leave the range of doubles.
WEIGHTLESS = 1e-200


def for_each(function: Function[T]) -> Function[T]:
    """Return a function of one motion that gives many an array, or a tuple of arrays."""

    @wraps(function)
    def collect(motion: Any) -> Any:
        if not motion.shape:
            return function(motion)
        results = np.array([function(member) for member in motion.members])
        columns = results.reshape(*motion.shape, *results.shape[1:])
        return tuple(np.moveaxis(columns, -1, 0)) if results.ndim > 1 else columns

    return collect


def find_shape(top: Top, start: State, friction: Friction, torque: Any) -> tuple[int, ...]:
    """Return the shape of the motions; () for one."""
    if (
        not top.shape
        and not friction.shape
        and start.orientation.ndim == 1
        and type(torque) is tuple
    ):
        return ()  # the common case, and NumPy needs 10 us for the question
    shapes = top.shape, start.orientation.shape[:-1], friction.shape, np.shape(torque)[:-1]
    try:
        return np.broadcast_shapes(*shapes)
    except ValueError:
        names = "top, start, friction and torque"
        text = ", ".join(map(str, shapes))
        raise refuse(names, "of shapes that fit together", text) from None


@dataclass(frozen=True, slots=True)
class Arguments:
    """Arguments of n motions."""

    moments: Real  # (n, 3)
    orientation: Real  # (n, 4), as given
    omega: Real  # (n, 3)
    friction: Real  # (n, 2), axial and transverse
    torque: Real  # (n, 3)

    @classmethod
    def of(
        cls, top: Top, start: State, friction: Friction, torque: Any, shape: tuple[int, ...]
    ) -> "Arguments":
        """Return the arguments of motions of this shape."""
        arrays = (
            np.stack(top.moments, axis=-1),
            start.given_orientation,
            start.angular_velocity,
            np.stack([friction.axial, friction.transverse], axis=-1),
            np.asarray(torque),
        )
        count = math.prod(shape)
        spread = [
            np.broadcast_to(each, (*shape, each.shape[-1])).reshape(count, each.shape[-1])
            for each in arrays
        ]
        return cls(*spread)

    def __iter__(self) -> Iterator[tuple[Top, State, Friction, Vector]]:
        """Yield the arguments of one motion after the other."""
        columns = self.moments.tolist(), self.friction.tolist(), self.torque.tolist()
        for n, (moments, friction, torque) in enumerate(zip(*columns, strict=True)):
            start = State(self.orientation[n], self.omega[n])
            yield Top(*moments), start, Friction(*friction), tuple(torque)

    def fill(self, kernel: Any, times: Real, orientation: Real, omega: Real) -> list[int]:
        """Write the states at times in s into (n, ..., 4) and (n, ..., 3), with the kernel.

        The numbers of the motions that are left are returned: those that need no elliptic
        functions, and those for which a time is too far.
        """
        count, flat = len(self.moments), times.reshape(-1)
        with np.errstate(under="ignore"):  # of a rate far below the weight
            free = is_free(self.moments.T, self.orientation.T, self.omega.T)
        kept = np.flatnonzero(~free)
        starts, is_turned_over = self._turn_over()
        far = np.zeros(len(kept), dtype=np.uint8)
        written: tuple[Real, ...] = orientation, omega  # in place, if no motion is left out
        if len(kept) < count:
            written = tuple(np.empty((len(kept), *each.shape[1:])) for each in (orientation, omega))
        kernel.fill_many(starts[kept], is_turned_over[kept], flat, *written, far)
        if len(kept) < count:
            orientation[kept], omega[kept] = written
        left = np.ones(count, dtype=bool)
        left[kept[far == 0]] = False
        return np.flatnonzero(left).tolist()

    def _turn_over(self) -> tuple[Real, NDArray[np.bool_]]:
        """Return (n, 10) arguments of the closed form, which wants Mgl > 0, and those turned."""
        is_turned_over = self.moments[:, 2] < 0
        moments, q = self.moments.copy(), self.orientation
        moments[:, 2] = np.abs(moments[:, 2])
        turned = np.stack([-q[:, 1], q[:, 0], -q[:, 3], q[:, 2]], axis=1)
        q = np.where(is_turned_over[:, np.newaxis], turned, q)
        return np.concatenate([moments, q, self.omega], axis=1), is_turned_over


def is_free(moments: Any, orientation: Any, omega: Any) -> Any:
    """Return True if no torque turns the axis: for circular functions instead of elliptic ones.

    The arguments are numbers, or arrays (3, n), (4, n) and (3, n) of many motions.
    """
    (Ix, Iz, Mgl), (w, x, y, z), (wx, wy, wz) = moments, orientation, omega
    is_vertical = ((w == 0) & (z == 0)) | ((x == 0) & (y == 0))
    free, weight = (wx == 0) & (wy == 0) & is_vertical, abs(Mgl) / Ix
    for rate in (wx, wy, Iz / Ix * wz):  # not wz: a rod may spin fast
        free |= weight <= WEIGHTLESS * rate * rate
    return free
