"""The state of the top: a unit quaternion and a body angular velocity, for one instant or many."""

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import chain
from typing import Any, Generic, NamedTuple, overload

import numpy as np
from numpy.typing import ArrayLike

from symtop_ros.base.arrays import Mask, Real, rotate, split, stack
from symtop_ros.base.deprecation import OldName, warn_of_name
from symtop_ros.base.one_or_many import N
from symtop_ros.base.refusals import Words, refuse, require, show
from symtop_ros.physics.kernel import bindings
from symtop_ros.physics.times import ExactTimes, to_seconds
from symtop_ros.physics.values import (
    EPS,
    LARGEST_ANGULAR_VELOCITY,
    are_floats,
    validate_array,
    validate_together,
)

NORM_TOLERANCE = 1e-3  # a norm further from 1 is refused: it is an error of the caller
NORM_ROUNDING = 4 * EPS  # a norm this close to 1 is left alone: normalising would only add rounding
SMALLEST = 1e-100  # the square of anything smaller would underflow
NAMES = ("phi", "theta", "psi", "phi_dot", "theta_dot", "psi_dot")
UNITS = (*("rad",) * 3, *("rad/s",) * 3)
COLUMNS = (
    "t",
    "w",
    "x",
    "y",
    "z",
    "wx",
    "wy",
    "wz",
    "phi",
    "theta",
    "psi",
    "phi_dot",
    "theta_dot",
    "psi_dot",
)


class Angles(NamedTuple, Generic[N]):
    """Euler angles z-x-z.

    Attributes
    ----------
    phi : float or ndarray (...)
        Precession, in rad.
    theta : float or ndarray (...)
        Tilt of the axis from the vertical, in rad.
    psi : float or ndarray (...)
        Spin, in rad.

    Examples
    --------
    >>> from symtop_ros.physics import State
    >>> State.from_euler(theta=0.5, psi_dot=200.0).euler_angles
    Angles(phi=0.0, theta=0.5, psi=0.0)
    """

    phi: N
    theta: N
    psi: N


class Rates(NamedTuple, Generic[N]):
    """Rates of Euler's angles z-x-z.

    Attributes
    ----------
    phi_dot : float or ndarray (...)
        Precession rate, in rad/s.
    theta_dot : float or ndarray (...)
        Rate of the tilt, in rad/s.
    psi_dot : float or ndarray (...)
        Spin rate, in rad/s.

    Examples
    --------
    >>> from symtop_ros.physics import State
    >>> State.from_euler(theta=0.5, psi_dot=200.0).euler_rates
    Rates(phi_dot=0.0, theta_dot=0.0, psi_dot=200.0)
    """

    phi_dot: N
    theta_dot: N
    psi_dot: N

    @property
    def phi(self) -> N:
        """Old name of `phi_dot`; will be removed in 0.8."""
        return warn_of_name("Rates.phi", "phi_dot", self.phi_dot)

    @property
    def theta(self) -> N:
        """Old name of `theta_dot`; will be removed in 0.8."""
        return warn_of_name("Rates.theta", "theta_dot", self.theta_dot)

    @property
    def psi(self) -> N:
        """Old name of `psi_dot`; will be removed in 0.8."""
        return warn_of_name("Rates.psi", "psi_dot", self.psi_dot)


@dataclass(frozen=True, eq=False, repr=False)
class State(Generic[N]):
    """Orientation and angular velocity at one instant, or at many.

    A state keeps the numbers that were given. Copies, kicks and selections from many states keep
    `given_orientation`, too. Two states are equal if their given numbers are equal.

    Parameters
    ----------
    orientation : array_like (..., 4)
        Unit quaternion (w, x, y, z), body to world. It is normalised. Components below 1e-100 are
        set to zero, here and in the angular velocity.
    angular_velocity : array_like (..., 3)
        Angular velocity in the body frame, in rad/s, at most 1e100.

    Attributes
    ----------
    given_orientation : ndarray (..., 4)
        The orientation before it is normalised. A motion starts from these doubles, normalised with
        57 digits: the rounding of `orientation` would be an error that grows with time.

    Raises
    ------
    ValueError
        If the shapes do not match, a number is not finite, a norm differs from 1 by more than
        1e-3, or an angular velocity is too large.

    Examples
    --------
    >>> from symtop_ros.physics import State
    >>> state = State(orientation=(1, 0, 0, 0), angular_velocity=(0, 0, 200))
    >>> state.euler_rates.psi_dot
    200.0
    """

    orientation: Real
    angular_velocity: Real
    given_orientation: Real  # not normalised: a motion normalises it with 57 digits

    @overload
    def __init__(
        self: "State[float]", orientation: Sequence[float], angular_velocity: Sequence[float]
    ) -> None: ...

    @overload
    def __init__(
        self: "State[Real]",
        orientation: Sequence[Sequence[float]],
        angular_velocity: Sequence[Sequence[float]],
    ) -> None: ...

    @overload
    def __init__(self, orientation: ArrayLike, angular_velocity: ArrayLike) -> None: ...

    def __init__(self, orientation: ArrayLike, angular_velocity: ArrayLike) -> None:
        q = _flush_tiny(validate_array("orientation", orientation, 4))
        omega = _flush_tiny(validate_array("angular_velocity", angular_velocity, 3, "rad/s"))
        if q.shape[:-1] != omega.shape[:-1]:
            raise refuse(
                "angular_velocity",
                f"of shape {(*q.shape[:-1], 3)} to match the orientation",
                Words(f"shape {omega.shape}"),
            )
        largest = float(np.abs(omega).max(initial=0.0))
        if largest > LARGEST_ANGULAR_VELOCITY:
            raise refuse("angular_velocity", f"at most {LARGEST_ANGULAR_VELOCITY:g} rad/s", largest)
        self._set(q, _normalize(q), omega)

    wrap, of_given, parts = OldName(), OldName(), OldName()

    @classmethod
    def _wrap(
        cls,
        orientation: Real,
        angular_velocity: Real,
        given: Real | None = None,
    ) -> "State":
        """Return the state of arrays that are known to be valid, without copying them.

        The arrays become read-only. This skips the validation of many computed states.

        Parameters
        ----------
        orientation : ndarray (..., 4)
            Finite quaternions of norm 1 to rounding; they are not normalised.
        angular_velocity : ndarray (..., 3)
            Finite angular velocities of the same leading shape, in rad/s.
        given : ndarray (..., 4), optional
            The orientation before it was normalised.
        """
        state = object.__new__(cls)
        state._set(orientation if given is None else given, orientation, angular_velocity)
        return state

    @classmethod
    def _of_given(cls, given: Real, angular_velocity: Real) -> "State":
        """Return the state of orientations that are valid but for their norm, and of their rates.

        Parameters
        ----------
        given : ndarray (..., 4)
            Finite quaternions of norm 1 within 1e-3.
        angular_velocity : ndarray (..., 3)
            Finite angular velocities of the same leading shape, in rad/s.
        """
        return cls._wrap(_normalize(given), angular_velocity, given)

    def _set(self, given: Real, orientation: Real, omega: Real) -> None:
        orientation.setflags(write=False)
        omega.setflags(write=False)
        if given is not orientation:
            given.setflags(write=False)
        # The class is frozen; its dictionary takes half the time of object.__setattr__.
        vars(self).update(
            given_orientation=given,
            orientation=orientation,
            angular_velocity=omega,
        )

    def __reduce__(self) -> tuple[Any, ...]:
        """Copy and pickle a state by its arrays, which are read-only in the copy, too."""
        given, (q, omega) = self.given_orientation, self._parts
        return State._wrap, (q.copy(), omega.copy(), given.copy())

    def __repr__(self) -> str:
        """Return the call that makes one state; of many, their shape."""
        if self.orientation.ndim > 1:
            return f"<State of shape {self.orientation.shape[:-1]}>"
        orientation, omega = (tuple(part.tolist()) for part in self._given)
        return f"State(orientation={orientation}, angular_velocity={omega})"

    @property
    def shape(self) -> tuple[int, ...]:
        """Shape of the states: () for one state, (...) for many."""
        return self.orientation.shape[:-1]

    @property
    def _parts(self) -> tuple[Real, Real]:
        """Orientation and angular velocity."""
        return self.orientation, self.angular_velocity

    @property
    def _given(self) -> tuple[Real, Real]:
        """The arguments; what was done to them follows from them."""
        return self.given_orientation, self.angular_velocity

    @overload
    @classmethod
    def from_euler(
        cls,
        *,
        theta: float,
        phi: float = 0.0,
        psi: float = 0.0,
        theta_dot: float = 0.0,
        phi_dot: float = 0.0,
        psi_dot: float = 0.0,
    ) -> "State[float]": ...

    @overload
    @classmethod
    def from_euler(
        cls,
        *,
        theta: ArrayLike,
        phi: ArrayLike = 0.0,
        psi: ArrayLike = 0.0,
        theta_dot: ArrayLike = 0.0,
        phi_dot: ArrayLike = 0.0,
        psi_dot: ArrayLike = 0.0,
    ) -> "State[Real]": ...

    @classmethod
    def from_euler(
        cls,
        *,
        theta: ArrayLike,
        phi: ArrayLike = 0.0,
        psi: ArrayLike = 0.0,
        theta_dot: ArrayLike = 0.0,
        phi_dot: ArrayLike = 0.0,
        psi_dot: ArrayLike = 0.0,
    ) -> "State":
        """Return the state with these Euler angles z-x-z and rates, or many states.

        The quaternion and the angular velocity have rounding errors. The motion then starts from
        exactly these doubles.

        Parameters
        ----------
        theta, phi, psi : float or array_like, broadcast to (...)
            Tilt, precession and spin angle in rad.
        theta_dot, phi_dot, psi_dot : float or array_like, broadcast to (...)
            Their rates in rad/s.

        Raises
        ------
        ValueError
            If a value is not a finite number, or if the shapes do not fit together.

        Examples
        --------
        >>> from symtop_ros.physics import State
        >>> state = State.from_euler(theta=0.5, phi_dot=6.5, psi_dot=200.0)
        >>> round(state.euler_rates.phi_dot, 12)
        6.5
        >>> State.from_euler(theta=[0.4, 0.5, 0.6], psi_dot=200.0)
        <State of shape (3,)>
        """
        values: Any = phi, theta, psi, phi_dot, theta_dot, psi_dot
        if not are_floats(values):
            values = validate_together(dict(zip(NAMES, values, strict=True)), UNITS)
        table = np.array(values)  # (6, ...)
        if table.ndim > 1:
            table = np.moveaxis(table, 0, -1)
        q, omega = bindings.from_angles(table[..., :3], table[..., 3:])
        return cls._of_given(q, omega)

    @cached_property
    @bindings.compute_soundly
    def vertical(self) -> Real:
        """World z' in the body frame, (..., 3): sin theta sin psi, sin theta cos psi, cos theta.

        The components are sums of products of the quaternion's components. No angle and no quotient
        is formed, so a small tilt keeps all its digits.
        """
        w, x, y, z = self._components
        up = stack(2 * (x * z - w * y), 2 * (y * z + w * x), (w * w + z * z) - (x * x + y * y))
        up.setflags(write=False)
        return up

    @property
    def is_vertical(self) -> np.bool_ | Mask:
        """True where the axis is exactly vertical and phi' is undefined, (...)."""
        is_vertical: np.bool_ | Mask = (self.vertical[..., 0] == 0) & (self.vertical[..., 1] == 0)
        return is_vertical

    @cached_property
    def _components(self) -> tuple[Any, Any, Any, Any]:
        w, x, y, z = split(self.orientation)
        return w, x, y, z

    @property
    def euler_angles(self) -> Angles[N]:
        """Angles (phi, theta, psi) in rad, with 0 <= theta <= pi; phi is 0 on the vertical."""
        return Angles(*split(bindings.find_angles(self.orientation)))

    @cached_property
    def euler_rates(self) -> Rates[N]:
        """Rates (phi', theta', psi') in rad/s; phi' is 0 on the vertical."""
        return Rates(*split(bindings.find_angle_rates(*self._parts)))

    @bindings.compute_soundly
    def to_world(self, vector: ArrayLike) -> Real:
        """Rotate body-frame vectors into the world frame.

        Parameters
        ----------
        vector : array_like (..., 3)
            Components in the body frame.

        Returns
        -------
        ndarray (..., 3)
            Components in the world frame.
        """
        return rotate(*self._components, np.asarray(vector, dtype=float))

    @bindings.compute_soundly
    def to_body(self, vector: ArrayLike) -> Real:
        """Rotate world-frame vectors into the body frame.

        Parameters
        ----------
        vector : array_like (..., 3)
            Components in the world frame.

        Returns
        -------
        ndarray (..., 3)
            Components in the body frame.
        """
        w, x, y, z = self._components
        return rotate(-w, x, y, z, np.asarray(vector, dtype=float))

    @property
    @bindings.compute_soundly
    def matrix(self) -> Real:
        """Rotation matrices from body to world, (..., 3, 3): the columns are the body's axes.

        Examples
        --------
        >>> from symtop_ros.physics import State
        >>> State((0, 0, 0, 1), (0, 0, 5)).matrix.tolist()
        [[-1.0, 0.0, 0.0], [0.0, -1.0, 0.0], [0.0, 0.0, 1.0]]
        """
        w, x, y, z = self._components
        rows = (
            stack((w * w + x * x) - (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)),
            stack(2 * (x * y + w * z), (w * w + y * y) - (x * x + z * z), 2 * (y * z - w * x)),
            stack(2 * (x * z - w * y), 2 * (y * z + w * x), (w * w + z * z) - (x * x + y * y)),
        )
        return np.stack(rows, axis=-2)

    @classmethod
    @bindings.compute_soundly
    def from_matrix(cls, matrix: ArrayLike, angular_velocity: ArrayLike) -> "State":
        """Return the state with these rotation matrices from body to world.

        The largest component of each quaternion is computed from the diagonal of the matrix, and
        the others from this component (S. W. Shepperd, J. Guidance and Control 1 (1978) 223), so no
        digits cancel.

        Parameters
        ----------
        matrix : array_like (..., 3, 3)
            Orthogonal matrices of determinant 1, within 1e-3.
        angular_velocity : array_like (..., 3)
            Angular velocity in the body frame, in rad/s.

        Raises
        ------
        ValueError
            If a matrix is no rotation, or an argument of `State` is refused.

        Examples
        --------
        >>> from symtop_ros.physics import State
        >>> State.from_matrix([[1, 0, 0], [0, -1, 0], [0, 0, -1]], (0, 0, 5)).orientation.tolist()
        [0.0, 1.0, 0.0, 0.0]
        """
        R = validate_array("matrix", matrix, 3)
        require(R.shape[-2:] == (3, 3), "matrix", "of shape (..., 3, 3)", Words(f"shape {R.shape}"))
        off = np.abs(R @ np.swapaxes(R, -1, -2) - np.eye(3)).max(initial=0.0)
        if off > NORM_TOLERANCE or (np.linalg.det(R) < 0).any():
            raise refuse(
                "matrix",
                f"a rotation (orthogonal within {NORM_TOLERANCE:g}, determinant 1)",
                matrix,
            )
        # 4 q q^T for each quaternion: its row with the largest diagonal is the best one.
        a, b, c = R[..., 0, 0], R[..., 1, 1], R[..., 2, 2]
        wx, wy, wz = (R[..., i, j] - R[..., j, i] for i, j in ((2, 1), (0, 2), (1, 0)))
        xy, xz, yz = (R[..., i, j] + R[..., j, i] for i, j in ((0, 1), (0, 2), (1, 2)))
        rows = np.stack(
            [
                np.stack([1 + a + b + c, wx, wy, wz], axis=-1),
                np.stack([wx, 1 + a - b - c, xy, xz], axis=-1),
                np.stack([wy, xy, 1 - a + b - c, yz], axis=-1),
                np.stack([wz, xz, yz, 1 - a - b + c], axis=-1),
            ],
            axis=-2,
        )
        best = np.diagonal(rows, axis1=-2, axis2=-1).argmax(axis=-1)
        q = np.take_along_axis(rows, best[..., np.newaxis, np.newaxis], axis=-2)[..., 0, :]
        return cls(q / np.linalg.norm(q, axis=-1, keepdims=True), angular_velocity)

    def table(self, times: ArrayLike | ExactTimes) -> dict[str, Real]:
        """Return the states as named columns, for pandas, xarray, Polars or `numpy.savetxt`.

        Parameters
        ----------
        times : array_like (n,) or ExactTimes (n,)
            Times of the states in s, or exact times in ns.

        Returns
        -------
        dict of str to ndarray (n,)
            t; w, x, y, z (body to world); wx, wy, wz (body frame, rad/s), named as in the
            files of `top_testset`; phi, theta, psi (rad); phi_dot, theta_dot, psi_dot (rad/s).

        Raises
        ------
        ValueError
            If the number of states is not n.

        Examples
        --------
        >>> from symtop_ros.physics import Motion, State, Top
        >>> times = [0.0, 0.5, 1.0]
        >>> motion = Motion(Top(1.0, 1.0, 1.0), State.from_euler(theta=1.0, psi_dot=3.0))
        >>> table = motion.at(times).table(times)
        >>> list(table)[:6], table["psi_dot"].shape
        (['t', 'w', 'x', 'y', 'z', 'wx'], (3,))

        ``pandas.DataFrame(table)`` makes it a data frame.
        """
        t = validate_array("times", to_seconds(times), unit="s")
        shape = self.orientation.shape[:-1]
        require(len(shape) == 1, "states", "of shape (n,)", Words(f"shape {shape}"))
        require(
            t.shape == shape,
            "times",
            f"of shape {shape}, one for each state",
            Words(f"shape {t.shape}"),
        )
        vectors = *map(split, self._parts), self.euler_angles, self.euler_rates
        return dict(zip(COLUMNS, (t, *map(np.array, chain(*vectors))), strict=True))

    def __getitem__(self, place: Any) -> "State":
        """Return some of many states, as NumPy's indexing of the leading axes does.

        Examples
        --------
        >>> from symtop_ros.physics import Motion, State, Top
        >>> states = Motion(Top(1.0, 1.0, 1.0), State((1, 0, 0, 0), (1, 0, 0))).at([0.0, 1.0, 2.0])
        >>> len(states), states[-1] == states[1:][1]
        (3, True)
        """
        if self.orientation.ndim == 1:
            raise IndexError("one state has no places; orientation and angular_velocity have")
        places = place if isinstance(place, tuple) else (place,)
        has_gap = any(each is Ellipsis for each in places)
        where = (*places, slice(None)) if has_gap else (*places, ..., slice(None))
        orientation, omega, given = (part[where] for part in (*self._parts, self.given_orientation))
        return State._wrap(orientation, omega, given)

    def __len__(self) -> int:
        """Return the number of states along the first axis."""
        if self.orientation.ndim == 1:
            raise TypeError("one state has no length")
        return len(self.orientation)

    def __bool__(self) -> bool:
        """Return True: an empty array of states is a state, too."""
        return True

    def __iter__(self) -> Iterator["State"]:
        """Iterate over many states along the first axis."""
        return (self[n] for n in range(len(self)))

    def __eq__(self, other: object) -> bool:
        """Compare what was given, number by number (q and -q differ)."""
        return isinstance(other, State) and all(
            np.array_equal(a, b) for a, b in zip(self._given, other._given, strict=True)
        )

    def __hash__(self) -> int:
        """Return a hash of one state; many cannot be hashed."""
        if self.orientation.ndim > 1:
            raise TypeError("many states cannot be hashed")
        return hash(tuple(tuple(part.tolist()) for part in self._given))


def _flush_tiny(array: Real) -> Real:
    """Set to zero, in place, the numbers whose squares would underflow; a zero keeps its sign."""
    array[np.abs(array) < SMALLEST] *= 0.0
    return array


def _normalize(q: Real) -> Real:
    """Return unit quaternions; those with norm 1 to rounding are unchanged, bit for bit."""
    if q.ndim == 1:  # the common case, without NumPy in a fifth of the time
        w, x, y, z = q.tolist()
        if abs(math.sqrt((w * w + z * z) + (x * x + y * y)) - 1) <= NORM_ROUNDING:
            return q
    w, x, y, z = np.moveaxis(q, -1, 0)
    with np.errstate(over="ignore"):
        norm = np.sqrt((w * w + z * z) + (x * x + y * y))[..., np.newaxis]
    deviation = np.abs(norm - 1)
    largest = deviation.max(initial=0.0)
    if largest <= NORM_ROUNDING:
        return q
    if largest > NORM_TOLERANCE:
        raise refuse(
            "orientation",
            f"a quaternion of norm 1 within {NORM_TOLERANCE:g}",
            Words(f"a norm of {show(norm.flat[deviation.argmax()])}"),
        )
    bindings.demand_arithmetic()
    return np.asarray(np.where(deviation > NORM_ROUNDING, q / norm, q))
