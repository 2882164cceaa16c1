"""Many motions at once: of many tops, or from many states."""

import math
from collections.abc import Callable, Iterator
from dataclasses import astuple
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from symtop_ros.base.arrays import Real
from symtop_ros.base.one_or_many import Many
from symtop_ros.base.refusals import Words, require
from symtop_ros.physics.arguments import (
    NO_FRICTION,
    NO_TORQUE,
    STARTS,
    describe_starts,
    fill_states,
    find_shape,
    list_starts,
    read_start,
    validate_times,
    validate_tolerance,
    validate_torque,
    validate_types,
    wrap_states,
)
from symtop_ros.physics.certificate import Certificate
from symtop_ros.physics.kernel import bindings
from symtop_ros.physics.kernel.records import ENGINES, KINDS
from symtop_ros.physics.motion import Motion, find_period
from symtop_ros.physics.state import Rates, State
from symtop_ros.physics.times import ExactTimes, to_seconds
from symtop_ros.physics.top import Friction, Top
from symtop_ros.physics.values import validate_array


class Motions:
    """The motions of many tops, or from many states.

    Tops, starts, frictions and torques are one or many each; they are broadcast together. States
    have the shape of the motions, followed by that of the times, and properties have the shape of
    the motions. Each motion is the same, bit for bit, as alone. The states of motions under gravity
    alone are computed in one call, the others one motion after the other.

    ``len(motions)`` and ``motions[0]`` count along the first axis, as for arrays.

    Parameters
    ----------
    top : Top
        One top, or many of shape (...).
    start : State
        The state at t = 0, or many of shape (...), such as those that other motions have reached.
    friction : Friction
        One friction, or many of shape (...).
    torque : array_like (..., 3)
        Applied torque in the world frame, constant, in N m.
    tolerance : float
        Local error that a step of each motion may have under friction or an applied torque, as for
        `Motion`.

    Attributes
    ----------
    top : Top
    start : State
    friction : Friction
    applied_torque : (float, float, float) or ndarray (..., 3)
        In the world frame, in N m.
    tolerance : float
    shape : tuple of int
        Shape (...) of the motions.

    Raises
    ------
    ValueError
        If an argument is refused.

    Examples
    --------
    Two tops from one start, at three times:

    >>> from symtop_ros.physics import Motions, State, Top
    >>> tops = Top(Ix=0.000228, Iz=0.0000572, Mgl=[0.068, 0.07])
    >>> motions = Motions(tops, State.from_euler(theta=0.5, psi_dot=200.0))
    >>> motions.at([0.0, 10.0, 1e6]).orientation.shape, motions.kind.tolist()
    ((2, 3, 4), ['cusps', 'cusps'])
    >>> len(motions), motions[1].top
    (2, Top(Ix=0.000228, Iz=5.72e-05, Mgl=0.07))
    """

    def __init__(
        self,
        top: Top,
        start: State,
        friction: Friction = NO_FRICTION,
        torque: ArrayLike = NO_TORQUE,
        tolerance: float = 0.0,
    ) -> None:
        validate_types(top, start, friction)
        self.tolerance = validate_tolerance(tolerance)
        self.top, self.start, self.friction = top, start, friction
        self.applied_torque = validate_torque(torque)
        self.shape = find_shape(top, start, friction, self.applied_torque)
        self._made: dict[int, Motion] = {}

    def __reduce__(self) -> tuple[Any, ...]:
        """Copy and pickle motions by their arguments: copies share no integration."""
        acting = self.friction, self.applied_torque, self.tolerance
        return Motions, (self.top, self.start, *acting)

    def __repr__(self) -> str:
        """Return the number of motions, as their arrays would fill pages."""
        return f"<Motions of shape {self.shape}>"

    def __len__(self) -> int:
        """Return the number of motions along the first axis."""
        if not self.shape:
            raise TypeError("one motion has no length")
        return self.shape[0]

    def __getitem__(self, place: Any) -> "Motion | Motions":
        """Return one motion, or some, as NumPy's indexing does."""
        numbers = np.arange(math.prod(self.shape)).reshape(self.shape)[place]
        if not np.ndim(numbers):
            return self._find_member(int(numbers))
        moments, q, omega, friction, torque, _ = np.split(self._starts[numbers], STARTS, axis=-1)
        start = State._of_given(np.array(q), np.array(omega))
        top = Top(*np.moveaxis(moments, -1, 0))
        drag = Friction(*np.moveaxis(friction, -1, 0))
        return Motions(top, start, drag, torque, self.tolerance)

    def __iter__(self) -> Iterator["Motion | Motions"]:
        """Iterate along the first axis."""
        return (self[n] for n in range(len(self)))

    def _find_member(self, n: int) -> Motion:
        # Kept, because the pieces of an integration are.
        if n not in self._made:
            start = read_start(self._starts[n])
            self._made[n] = Motion(*start, tolerance=self.tolerance)
        return self._made[n]

    @cached_property
    def _starts(self) -> Real:
        return list_starts(self.top, self.start, self.friction, self.applied_torque, self.shape)

    def at(self, t: ArrayLike | ExactTimes) -> State[Real]:
        """Return the states of all motions at one time or at many times.

        Parameters
        ----------
        t : float, array_like (m, ...) or ExactTimes
            Times, as in `Motion.at`.

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
        count = math.prod(self.shape)
        many = math.prod(shape)
        orientation, omega = np.empty((count, many, 4)), np.empty((count, many, 3))
        left = fill_states(self._starts, flat, orientation, omega)
        for n in np.flatnonzero(left.any(axis=1)).tolist():
            self._find_member(n)._fill(flat, orientation[n], omega[n])
        return wrap_states(orientation, omega, (*self.shape, *shape))

    def at_each(self, times: ArrayLike | ExactTimes) -> State[Real]:
        """Return the states of each motion at its own times.

        Parameters
        ----------
        times : array_like (..., m, ...) or ExactTimes
            Times in s, or exact times in ns; the first axes are those of the motions.

        Returns
        -------
        State
            orientation (..., m, ..., 4) and angular_velocity (..., m, ..., 3).

        Raises
        ------
        ValueError
            If the times do not begin with the shape of the motions, or a motion has no state.

        Examples
        --------
        >>> from symtop_ros.physics import Motions, State, Top
        >>> motions = Motions(Top(1.0, 1.0, [1.0, 2.0]), State.from_euler(theta=1.0, psi_dot=3.0))
        >>> motions.at_each(motions.nutation_period).euler_angles.theta.round(9).tolist()
        [1.0, 1.0]
        """
        t = times if isinstance(times, ExactTimes) else validate_array("times", times, unit="s")
        require(
            t.shape[: len(self.shape)] == self.shape,
            "times",
            f"an array whose shape begins with that of the motions, {self.shape}",
            Words(f"shape {t.shape}"),
        )
        flat = t.ravel()
        shape = (math.prod(self.shape), math.prod(t.shape[len(self.shape) :]))
        places = np.arange(math.prod(t.shape)).reshape(shape)
        orientation, omega = np.empty((*shape, 4)), np.empty((*shape, 3))
        for n, row in enumerate(places):
            self._find_member(n)._fill(flat[row], orientation[n], omega[n])
        return wrap_states(orientation, omega, t.shape)

    def table(self, times: ArrayLike | ExactTimes) -> dict[str, Any]:
        """Return the states at times as named columns, one row for each motion and time.

        Parameters
        ----------
        times : array_like (m,) or ExactTimes (m,)
            Times in s, or exact times in ns, the same for all n motions.

        Returns
        -------
        dict of str to ndarray (n m,)
            motion, the number of the motion in a flat array; the others as in `State.table`.

        Examples
        --------
        >>> from symtop_ros.physics import Motions, State, Top
        >>> motions = Motions(Top(1.0, 1.0, [1.0, 2.0]), State.from_euler(theta=1.0, psi_dot=3.0))
        >>> motions.table([0.0, 0.5])["motion"].tolist()
        [0, 0, 1, 1]
        """
        given = times if isinstance(times, ExactTimes) else validate_array("times", times, unit="s")
        require(len(given.shape) == 1, "times", "of shape (m,)", Words(f"shape {given.shape}"))
        count = math.prod(self.shape)
        states = self.at(given)
        t = to_seconds(given)
        orientation, omega = (np.array(part) for part in states._parts)
        flat = wrap_states(orientation, omega, (count * len(t),))
        return {"motion": np.repeat(np.arange(count), len(t)), **flat.table(np.tile(t, count))}

    def jacobian(self, t: ArrayLike | ExactTimes) -> Real:
        """Return the derivatives of each motion's state, as `Motion.jacobian` does.

        Parameters
        ----------
        t : float, array_like (...) or ExactTimes
            Times since the start in s, or exact times in ns, the same for all motions.

        Returns
        -------
        ndarray (..., 6, 9)
            In the shape of the motions, followed by that of the times.
        """
        found = np.array(self._ask_each(lambda motion: motion.jacobian(t)))
        shape = t.shape if isinstance(t, ExactTimes) else np.shape(t)
        return found.reshape(*self.shape, *shape, 6, 9)

    def _spread(self, states: State) -> Top:
        """Return the tops in the shape of states of these motions."""
        shape = states.orientation.shape[:-1]
        require(
            shape[: len(self.shape)] == self.shape,
            "states",
            f"states of these motions, of a shape that begins with {self.shape}",
            Words(f"shape {shape}"),
        )
        return self.top.spread(self.shape, shape)

    def energy(self, states: State) -> Real:
        """Return the kinetic and potential energy of states of these motions, (..., m, ...), in J.

        Parameters
        ----------
        states : State
            States that `at` or `at_each` has returned.

        Examples
        --------
        >>> from symtop_ros.physics import Motions, State, Top
        >>> motions = Motions(Top(1.0, 1.0, [1.0, 2.0]), State.from_euler(theta=1.0))
        >>> motions.energy(motions.at([0.0, 1.0, 2.0])).round(9).tolist()
        [[0.540302306, 0.540302306, 0.540302306], [1.080604612, 1.080604612, 1.080604612]]
        """
        return np.asarray(self._spread(states).energy(states))

    def axial_momentum(self, states: State) -> Real:
        """Return L_z = p_psi of states of these motions, (..., m, ...), in N m s."""
        return np.asarray(self._spread(states).axial_momentum(states))

    def vertical_momentum(self, states: State) -> Real:
        """Return L_z' = p_phi of states of these motions, (..., m, ...), in N m s."""
        return np.asarray(self._spread(states).vertical_momentum(states))

    def angular_momentum(self, states: State) -> Real:
        """Return the angular momentum in the world frame, (..., m, ..., 3), in N m s."""
        return self._spread(states).angular_momentum(states)

    def gravity_torque(self, states: State) -> Real:
        """Return the torque of gravity in the world frame, (..., m, ..., 3), in N m."""
        return self._spread(states).gravity_torque(states)

    def total_torque(self, states: State) -> Real:
        """Return the torque of gravity, friction and the applied torque, (..., m, ..., 3), in N m.

        It is in the world frame, about the pivot.
        """
        return np.asarray(self.gravity_torque(states) + self.added_torque(states))

    def added_torque(self, states: State) -> Real:
        """Return the torque of friction and the applied torque, (..., m, ..., 3), in N m.

        It is in the world frame, about the pivot.
        """
        self._spread(states)
        shape = states.orientation.shape[:-1]
        friction = self.friction.spread(self.shape, shape)
        applied = np.broadcast_to(self.applied_torque, (*self.shape, 3))
        axes = (1,) * (len(shape) - len(self.shape))
        applied = applied.reshape(*self.shape, *axes, 3)
        return np.asarray(states.to_world(friction.torque(states)) + applied)

    def euler_rates(self, states: State[Real]) -> Rates[Real]:
        """Return the rates of Euler's angles in states of these motions, each (..., m, ...).

        They are those of `State.euler_rates`: none of these motions is clamped.
        """
        self._spread(states)
        return states.euler_rates

    def certify(self, t: float | Many | ExactTimes) -> Certificate[Real]:
        """Return proved bounds of the errors of the states, as `Motion.certify` does.

        Parameters
        ----------
        t : float, array_like (m, ...) or ExactTimes
            Times since the start in s, or exact times in ns, the same for all motions.

        Returns
        -------
        Certificate
            Its bounds are ndarray (..., m, ...): in the shape of the motions, then of the times.

        Examples
        --------
        >>> from symtop_ros.physics import Motions, State, Top
        >>> motions = Motions(Top(1.0, 1.0, [1.0, 2.0]), State.from_euler(theta=1.0, psi_dot=3.0))
        >>> proved = motions.certify([0.0, 1.0, 2.0])
        >>> proved.attitude.shape, bool((proved.attitude < 1e-15).all())
        ((2, 3), True)
        """
        found = self._ask_each(lambda motion: astuple(motion.certify(t)))
        shape = t.shape if isinstance(t, ExactTimes) else np.shape(t)
        bounds = np.reshape(found, (-1, 2, *shape))
        attitude, rates = (bounds[:, k].reshape(*self.shape, *shape) for k in range(2))
        return Certificate(attitude, rates)

    def _ask_each(self, ask: Callable[[Motion], Any]) -> list[Any]:
        """Return what each motion answers, in the order of a flat array."""
        return [ask(self._find_member(n)) for n in range(math.prod(self.shape))]

    @property
    def farthest_time(self) -> Real:
        """Times in s from which on states are refused, as in `Motion.farthest_time`."""
        found = self._ask_each(lambda motion: motion.farthest_time)
        return np.array(found, np.float64).reshape(self.shape)

    @property
    def rounding_shows_at(self) -> Real:
        """Times in s from which on rounding shows, as in `Motion.rounding_shows_at`."""
        found = self._ask_each(lambda motion: motion.rounding_shows_at)
        return np.array(found, np.float64).reshape(self.shape)

    @property
    def is_driven(self) -> NDArray[np.bool_]:
        """True where friction or an applied torque acts."""
        return np.asarray(self.engine == "taylor")

    @property
    def engine(self) -> NDArray[np.str_]:
        """Methods of solution, as in `Motion.engine`."""
        return np.take(ENGINES, self._constants["engine"]).reshape(self.shape)

    @cached_property
    def _constants(self) -> NDArray[Any]:
        return describe_starts(self._starts)

    def _find_rates(self, name: str) -> Real:
        rates = self._constants["rates"][name]
        return np.ascontiguousarray(rates, np.float64).reshape(self.shape)

    @property
    def kind(self) -> NDArray[np.str_]:
        """Names of the motions, as in `Motion.kind`."""
        return np.take(KINDS, self._constants["kind"]).reshape(self.shape)

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
        """Mean phi' in rad/s, as in `Motion.mean_precession_rate`; nan if `is_driven`."""
        return np.where(self.is_driven, np.nan, self._find_rates("mean_precession_rate"))

    @property
    def precession_period(self) -> Real:
        """Mean times of one turn of the precession in s, as in `Motion.precession_period`."""
        return find_period(self.mean_precession_rate)

    @property
    def mean_spin_rate(self) -> Real:
        """Mean psi' in rad/s, as in `Motion.mean_spin_rate`."""
        return self._find_rates("mean_spin_rate")

    @property
    def precession_per_nutation(self) -> Real:
        """Precession in a nutation as a fraction of a turn."""
        return self._find_rates("precession_per_nutation")

    @property
    def mean_cosine(self) -> Real:
        """Means of cos(theta) over a nutation, as in `Motion.mean_cosine`."""
        return self._find_rates("mean_cosine")

    @property
    def spin_reverses(self) -> NDArray[np.bool_]:
        """True where psi' takes both signs in a nutation."""
        return np.asarray(self._find_rates("spin_reverses") != 0)

    @property
    @bindings.compute_soundly
    def fast_top_precession_rate(self) -> Real:
        """Mgl/p_psi in rad/s, as in `Motion.fast_top_precession_rate`."""
        Iz, Mgl, omega_z = self._starts[:, [1, 2, 9]].T
        with np.errstate(divide="ignore", invalid="ignore", over="ignore", under="ignore"):
            p_psi = Iz * omega_z
            rates: Real = np.where(p_psi == 0, np.nan, Mgl / p_psi)
        return rates.reshape(self.shape)

    @property
    @bindings.compute_soundly
    def fast_top_nutation_rate(self) -> Real:
        """|p_psi|/Ix in rad/s."""
        Ix, Iz, omega_z = self._starts[:, [0, 1, 9]].T
        return np.asarray(np.abs(Iz * omega_z / Ix).reshape(self.shape))
