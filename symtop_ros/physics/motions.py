"""Many motions at once, with the interface of one."""

import math
from collections.abc import Callable
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from symtop_ros.arrays import Real
from symtop_ros.physics.arguments import (
    NO_FRICTION,
    NO_TORQUE,
    Setting,
    describe_starts,
    fill_states,
    find_shape,
    list_starts,
    read_start,
    validate_times,
    validate_torque,
    validate_types,
    wrap_states,
)
from symtop_ros.physics.kernel.door import ENGINES, KINDS
from symtop_ros.physics.motion import Motion
from symtop_ros.physics.state import State
from symtop_ros.physics.times import ExactTimes
from symtop_ros.physics.top import Friction, Top


class Motions(Setting):
    """The motions of many tops, or from many states.

    Tops, starts, frictions and torques are one or many each; they are broadcast together. States
    have the shape of the motions, followed by that of the times, and properties have the shape of
    the motions. Each motion is the same, bit for bit, as alone. The states of motions
    under gravity alone are computed in one call, the others one motion after the other.

    Parameters
    ----------
    top : Top
        One top, or many of shape (...).
    start : State
        The state at t = 0, or many of shape (...).
    friction : Friction
        One friction, or many of shape (...).
    torque : array_like (..., 3)
        Applied torque in the world frame, constant, in N m.

    Attributes
    ----------
    top : Top
    start : State
    friction : Friction
    applied_torque : (float, float, float) or ndarray (..., 3)
        In the world frame, in N m.
    shape : tuple of int
        Shape (...) of the motions.

    Raises
    ------
    ValueError
        If an argument is refused.

    Examples
    --------
    Two tops from one start, at three times:

    >>> from symtop_ros.physics import Motion, State, Top
    >>> tops = Top(Ix=0.000228, Iz=0.0000572, Mgl=[0.068, 0.07])
    >>> motions = Motion(tops, State.from_euler(theta=0.5, psi_dot=200.0))
    >>> motions.at([0.0, 10.0, 1e6]).orientation.shape, motions.kind.tolist()
    ((2, 3, 4), ['cusps', 'cusps'])
    """

    def __init__(
        self,
        top: Top,
        start: State,
        friction: Friction = NO_FRICTION,
        torque: ArrayLike = NO_TORQUE,
    ) -> None:
        validate_types(top, start, friction)
        torque = validate_torque(torque)
        shape = find_shape(top, start, friction, torque)
        super().__init__(top, start, friction, torque, shape)
        self._made: dict[int, Motion] = {}

    @property
    def members(self) -> list[Motion]:
        """The motions one by one, in the order of a flat array."""
        return [self._find_member(n) for n in range(math.prod(self.shape))]

    def _find_member(self, n: int) -> Motion:
        # Kept, because the pieces of an integration are.
        if n not in self._made:
            self._made[n] = Motion(*read_start(self._starts[n]))
        return self._made[n]

    @cached_property
    def _starts(self) -> Real:
        return list_starts(self.top, self.start, self.friction, self.applied_torque, self.shape)

    def at(self, t: ArrayLike | ExactTimes) -> State:
        """Return the states at one time, or at many.

        Parameters
        ----------
        t : float, array_like (m, ...) or ExactTimes
            Times, as in `Motion.at`; the same for all motions.

        Returns
        -------
        State
            orientation (..., m, ..., 4) and angular_velocity (..., m, ..., 3).

        Raises
        ------
        ValueError
            If one of the motions has no state at one of the times.
        """
        times = validate_times(t)
        shape = times.shape if isinstance(times, ExactTimes) else np.shape(times)
        flat = np.array([times]) if isinstance(times, float) else times.ravel()
        count, many = math.prod(self.shape), math.prod(shape)
        orientation, omega = np.empty((count, many, 4)), np.empty((count, many, 3))
        left = np.ones((count, many), np.bool_)
        if not isinstance(flat, ExactTimes):
            left = fill_states(self._starts, flat, orientation, omega)
        for n in np.flatnonzero(left.any(axis=1)).tolist():
            self._fill_member(n, flat, left[n], (orientation[n], omega[n]))
        return wrap_states(orientation, omega, (*self.shape, *shape), len(shape))

    def _fill_member(
        self, n: int, times: Real | ExactTimes, left: NDArray[np.bool_], target: tuple[Real, Real]
    ) -> None:
        """Write the states of one motion at the times that are left."""
        member, (orientation, omega) = self._find_member(n), target
        if left.all():
            member.fill(times, orientation, omega)
            return
        states = member.at(times[left])
        orientation[left], omega[left] = states.orientation, states.angular_velocity

    def jacobian(self, t: ArrayLike) -> Real:
        """Return the derivatives of each motion's state, as `Motion.jacobian` does.

        Parameters
        ----------
        t : float or array_like (...)
            Times since the start in s, the same for all motions.

        Returns
        -------
        ndarray (..., 6, 9)
            In the shape of the motions, followed by that of the times.
        """
        found = np.array([motion.jacobian(t) for motion in self.members])
        return found.reshape(*self.shape, *np.shape(t), 6, 9)

    def _collect(self, ask: Callable[[Motion], Any], dtype: Any = np.float64) -> Any:
        """Return what each motion answers, in the shape of the motions."""
        answers = np.array([ask(member) for member in self.members], dtype)
        return answers.reshape(self.shape)

    @property
    def engine(self) -> NDArray[np.str_]:
        """Methods of solution, as in `Motion.engine`."""
        names: NDArray[np.str_] = np.array(ENGINES)[self._constants["engine"]]
        return names.reshape(self.shape)

    @cached_property
    def _constants(self) -> NDArray[Any]:
        return describe_starts(self._starts)

    def _find_rates(self, name: str) -> Real:
        rates: Real = np.ascontiguousarray(self._constants["rates"][name], np.float64)
        return rates.reshape(self.shape)

    @property
    def kind(self) -> NDArray[np.str_]:
        """Names of the motions, as in `Motion.kind`."""
        names: NDArray[np.str_] = np.array(KINDS)[self._constants["kind"]]
        return names.reshape(self.shape)

    @property
    def nutation_period(self) -> Real:
        """Periods of theta in s."""
        return self._find_rates("nutation_period")

    @property
    def nutation_rate(self) -> Real:
        """2 pi over the nutation periods in rad/s."""
        return 2 * np.pi / self.nutation_period

    @property
    def turning_angles(self) -> tuple[Real, Real]:
        """Smallest and largest theta in rad."""
        smallest, largest = self._constants["turning_angles"].T.copy()
        return smallest.reshape(self.shape), largest.reshape(self.shape)

    @property
    def mean_precession_rate(self) -> Real:
        """Mean phi' in rad/s, as in `Motion.mean_precession_rate`."""
        return self._find_rates("mean_precession_rate")

    @property
    def mean_spin_rate(self) -> Real:
        """Mean psi' in rad/s, as in `Motion.mean_spin_rate`."""
        return self._find_rates("mean_spin_rate")

    @property
    def precession_per_nutation(self) -> Real:
        """Precession in a nutation as a fraction of a turn."""
        return self._find_rates("precession_per_nutation")

    @property
    def spin_reverses(self) -> NDArray[np.bool_]:
        """True where psi' takes both signs in a nutation."""
        return np.asarray(self._find_rates("spin_reverses") != 0)

    @property
    def fast_top_precession_rate(self) -> Real:
        """Mgl/p_psi in rad/s, as in `Motion.fast_top_precession_rate`."""
        return np.asarray(self._collect(lambda motion: motion.fast_top_precession_rate))

    @property
    def fast_top_nutation_rate(self) -> Real:
        """|p_psi|/Ix in rad/s."""
        return np.asarray(self._collect(lambda motion: motion.fast_top_nutation_rate))
