"""Motions whose starts, states and times are arrays on the device."""

import math
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from symtop_ros.base.refusals import refuse, require
from symtop_ros.physics.arguments import read_start
from symtop_ros.physics.gpu.toolchain import open_cupy, open_functions
from symtop_ros.physics.kernel import bindings
from symtop_ros.physics.motion import Motion
from symtop_ros.physics.state import State
from symtop_ros.physics.top import Top

NUMBERS = 15  # of a start: moments, orientation, angular velocity; friction and torque are zero
STATE_BYTES = 8 * 7 + 1
Array = Any  # a CuPy array
Numbers = Any  # a number, or an array of CuPy, of NumPy, or of a library with DLPack


@dataclass(frozen=True)
class States:
    """States on the device.

    Attributes
    ----------
    orientation : cupy.ndarray (..., 4)
        Unit quaternions w, x, y, z, body to world; nan where there is no state.
    angular_velocity : cupy.ndarray (..., 3)
        In the body frame, in rad/s.
    status : cupy.ndarray (...) of uint8
        0, or the number of the reason why there is no state: that of the motion, or a time that is
        not finite or beyond 1e15 turns (`symtop_status` of symtop.h).
    """

    orientation: Array
    angular_velocity: Array
    status: Array


class Motions:
    """Motions under gravity on a GPU, each with the bits of `symtop_ros.physics.Motion`.

    Starts are read and states are written on the device; nothing is copied to the host. A start
    that is refused makes no motion: its states are nan, and `status` and `refusals` say why. Kind,
    period, energy and derivatives are not there: take `motions[i]`, a motion of the CPU.

    Parameters
    ----------
    top : Top, or three of number or array (n,)
        Ix, Iz (kg m^2) and Mgl (J).
    start : State, or two of array (4,) or (n, 4), and (3,) or (n, 3)
        Orientation (w, x, y, z, body to world) and angular velocity (body frame, rad/s) at t = 0.

        Arrays are those of CuPy, of any library with DLPack (PyTorch, JAX, Warp), or of NumPy,
        which are copied to the device. They are broadcast together along n.

    Raises
    ------
    ValueError
        If shapes do not fit, or if the motions do not fit into the memory of the device.
    ImportError, DeviceError
        Without CuPy, without a GPU, or if the GPU has other bits than the CPU.

    Examples
    --------
    >>> import cupy  # doctest: +SKIP
    >>> from symtop_ros.physics import State  # doctest: +SKIP
    >>> from symtop_ros.physics.gpu import Motions  # doctest: +SKIP
    >>> weight = cupy.linspace(0.05, 0.08, 1_000_000)  # doctest: +SKIP
    >>> top = (0.000228, 0.0000572, weight)  # doctest: +SKIP
    >>> motions = Motions(top, State.from_euler(theta=0.5, psi_dot=200.0))  # doctest: +SKIP
    >>> motions.at([0.0, 10.0]).orientation.shape  # doctest: +SKIP
    (1000000, 2, 4)
    """

    def __init__(self, top: Top | tuple[Numbers, ...], start: State | tuple[Numbers, ...]) -> None:
        self._functions = open_functions()
        self._starts = _join(_list_columns(top, start))
        _demand_memory("motions", len(self._starts), self._functions.motion_bytes)
        self._motions, self._status = self._functions.prepare(self._starts)

    def __len__(self) -> int:
        """Return the number of motions."""
        return len(self._starts)

    def __getitem__(self, place: int) -> Motion:
        """Return one motion, as the CPU has it."""
        top, start, friction, torque = read_start(self._starts[place].get())
        return Motion(top, start, friction, torque)

    @property
    def status(self) -> Array:
        """0 for each motion (n,), or the number of the reason why its start is refused."""
        return self._status

    @cached_property
    def refusals(self) -> dict[int, str]:
        """The reasons of the starts that are refused, by their places. It waits for the device."""
        found = self._status.get()
        return {int(i): str(bindings.refuse_status(int(found[i]))) for i in np.flatnonzero(found)}

    def at(self, times: Numbers) -> States:
        """Return the states of all motions at common times.

        Parameters
        ----------
        times : number or array (m,)
            In s; negative ones too.

        Returns
        -------
        States
            Of the shape (n, m); (n,) for a number.
        """
        given = _to_device(times)
        require(given.ndim <= 1, "times", "a number or of shape (m,)", given.shape)
        return self._read(given.reshape(-1), given.size, 0, given.shape)

    def at_each(self, times: Numbers) -> States:
        """Return the states of each motion at its own times.

        Parameters
        ----------
        times : array (n,) or (n, m)
            In s.

        Returns
        -------
        States
            Of the shape of the times.
        """
        given = _to_device(times)
        is_valid = given.ndim in (1, 2) and given.shape[0] == len(self)
        require(is_valid, "times", f"of shape ({len(self)},) or ({len(self)}, m)", given.shape)
        each = math.prod(given.shape[1:])
        return self._read(given.reshape(-1), each, each, given.shape[1:])

    def _read(self, times: Array, each: int, stride: int, shape: tuple[int, ...]) -> States:
        _demand_memory("states", len(self) * each, STATE_BYTES)
        q, omega, status = self._functions.read(self._motions, times, each, stride)
        whole = (len(self), *shape)
        return States(q.reshape(*whole, 4), omega.reshape(*whole, 3), status.reshape(whole))


def _list_columns(top: Any, start: Any) -> list[Array]:
    """Return the numbers of the starts in the order of `symtop_start`, as arrays (n or 1, k)."""
    moments = top.moments if isinstance(top, Top) else top
    if isinstance(start, State):
        start = start.given_orientation, start.angular_velocity
    names = ("Ix", "Iz", "Mgl", "orientation", "angular_velocity")
    sizes = (0, 0, 0, 4, 3)
    given = (*moments, *start)
    require(len(given) == len(names), "top and start", "of 3 and 2 arrays", len(given))
    return [_to_column(*each) for each in zip(names, given, sizes, strict=True)]


def _to_column(name: str, given: Numbers, size: int) -> Array:
    """Return an argument as an array (n or 1, k)."""
    array = _to_device(given)
    if size:
        fits = array.ndim in (1, 2) and array.shape[-1] == size
        require(fits, name, f"of shape ({size},) or (n, {size})", array.shape)
        return array.reshape(-1, size)
    require(array.ndim <= 1, name, "a number or of shape (n,)", array.shape)
    return array.reshape(-1, 1)


def _join(columns: list[Array]) -> Array:
    """Return the starts (n, 15), whose friction and torque are zero."""
    counts = {len(each) for each in columns} - {1}
    require(len(counts) <= 1, "arrays", "of one length or 1", sorted(counts))
    starts = open_cupy().zeros((max(counts, default=1), NUMBERS))
    first = 0
    for each in columns:
        starts[:, first : first + each.shape[1]] = each
        first += each.shape[1]
    return starts


def _to_device(given: Numbers) -> Array:
    """Return an array of doubles on the device, without a copy where there is one already."""
    cupy = open_cupy()
    if not isinstance(given, cupy.ndarray | np.ndarray) and hasattr(given, "__dlpack_device__"):
        given = cupy.from_dlpack(given)
    return cupy.asarray(given, dtype=np.float64, order="C")


def _demand_memory(name: str, count: int, size: int) -> None:
    """Refuse what does not fit into the free memory of the device, and say how many do."""
    cupy = open_cupy()
    free = cupy.cuda.Device().mem_info[0] + cupy.get_default_memory_pool().free_bytes()
    if count * size > free:
        raise refuse(name, f"at most {free // size} (of {size} bytes, in free memory)", count)
