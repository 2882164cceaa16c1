"""The motion of a top from a start: the state at any time, and its constant properties."""

import math
from dataclasses import replace
from fractions import Fraction
from functools import cached_property
from typing import Any, NamedTuple, overload

import numpy as np
from numpy.typing import ArrayLike

from symtop_ros.base.arrays import Real
from symtop_ros.base.deprecation import OldName
from symtop_ros.base.one_or_many import Many, N
from symtop_ros.base.refusals import refuse, require
from symtop_ros.physics.arguments import (
    NO_FRICTION,
    NO_TORQUE,
    TORQUE_UNIT,
    pack_start,
    read_start,
    validate_times,
    validate_tolerance,
    validate_types,
    wrap_states,
)
from symtop_ros.physics.certificate import Certificate, certify
from symtop_ros.physics.jacobian import differentiate
from symtop_ros.physics.kernel import bindings, states
from symtop_ros.physics.kernel.records import Engine, Kind, PieceRecord, RatesRecord
from symtop_ros.physics.pushes import Pushes
from symtop_ros.physics.state import Rates, State
from symtop_ros.physics.times import SECOND, ExactTimes
from symtop_ros.physics.top import Friction, Top
from symtop_ros.physics.values import validate_array, validate_number, validate_one, validate_vector

MANY = " (`Motions` takes many)"


@overload
def find_period(rate: float) -> float: ...


@overload
def find_period(rate: Many) -> Real: ...


def find_period(rate: ArrayLike) -> float | Real:
    """Return the time in s of one turn at a rate in rad/s; infinite for a rate of 0.

    Parameters
    ----------
    rate : float or array_like (...)
        A rate of either sign; nan gives nan.

    Returns
    -------
    float or ndarray (...)

    Raises
    ------
    ValueError
        If a rate is not a number.

    Examples
    --------
    >>> from symtop_ros.physics import Top, find_period, regular_precession_rates
    >>> top = Top(Ix=0.000228, Iz=0.0000572, Mgl=0.068)
    >>> [round(find_period(rate), 4) for rate in regular_precession_rates(top, 0.5, 200.0)]
    [0.9671, 0.09]
    """
    if isinstance(rate, int | float | np.number):
        return 2 * math.pi / abs(float(rate)) if rate else math.inf
    try:
        rates: Real = np.abs(np.asarray(rate, np.float64))
    except (TypeError, ValueError):
        raise refuse("rate", "a number, or an array of numbers (rad/s)", rate) from None
    with np.errstate(divide="ignore"):
        return np.asarray(2 * math.pi / rates)


class Motion:
    """The motion of a top from a state.

    Without friction and applied torque it is exact at any time. With them it is integrated; turning
    angles, nutation period and mean rates are then those of the motion that would follow from the
    start under gravity alone (but `mean_precession_rate` is nan).

    `Motions` has many motions at once.

    Parameters
    ----------
    top : Top
        The top.
    start : State
        The state at t = 0.
    friction : Friction
        Friction at the pivot and in the air.
    torque : array_like (3,)
        Applied torque in the world frame, constant, in N m.
    pushes : Pushes, optional
        Pushes on the axle. The first one is at t = 0: `start` is the state that it leaves. The kind
        is then "driven". Turning angles, periods and mean rates are those of the motion from the
        start to the second push; `piece_at` has the motion between any two pushes.
    clamped : bool
        True if a hand holds phi, by the outer ring of a gimbal. The axis then falls as a pendulum
        in its vertical plane, and the body turns about it at the constant rate omega_z. At t = 0
        the hand stops phi'; theta' and the spin momentum are kept. The kind is "clamped", and p_phi
        is not constant. The axis must be tilted, and neither friction, a torque nor pushes may act.

    tolerance : float
        Local error that a step of the integration may have under friction or an applied torque, in
        rad for the attitude and relative to its size for omega: 1e-15 to 1e-6, or 0 (the default)
        for steps that are exact to rounding. A motion with a tolerance takes about half of the
        time. The errors of the steps add up. A step turns the axis by up to 4 rad about the angular
        momentum. Under gravity alone the closed form needs no steps, and the tolerance has no
        effect. It must be 0 with pushes or a clamp.

    Attributes
    ----------
    top : Top
    start : State
    friction : Friction
    applied_torque : (float, float, float)
        In the world frame, in N m.
    pushes : Pushes or None
    clamped : bool
    tolerance : float

    Raises
    ------
    ValueError
        If an argument is refused.

    Examples
    --------
    >>> from symtop_ros.physics import Motion, State, Top
    >>> top = Top(Ix=0.000228, Iz=0.0000572, Mgl=0.068)
    >>> motion = Motion(top, State.from_euler(theta=0.5, psi_dot=200.0))
    >>> motion.kind, motion.engine
    ('cusps', 'closed form')
    >>> round(motion.nutation_period, 6)
    0.159545
    >>> motion.at([0.0, 10.0, 1e6]).orientation.shape
    (3, 4)
    """

    packed_start, pack_with = OldName(), OldName()
    fill, reach = OldName(), OldName()

    def __init__(
        self,
        top: Top[float],
        start: State[float],
        friction: Friction[float] = NO_FRICTION,
        torque: ArrayLike = NO_TORQUE,
        pushes: Pushes | None = None,
        clamped: bool = False,
        tolerance: float = 0.0,
    ) -> None:
        validate_types(top, start, friction)
        validate_one(top, instead=MANY)
        validate_one(start, "start", "state", MANY)
        validate_one(friction, "friction", instead=MANY)
        require(pushes is None or isinstance(pushes, Pushes), "pushes", "Pushes", pushes)
        require(isinstance(clamped, bool), "clamped", "True or False", clamped)
        require(not (pushes and clamped), "pushes", "None for a clamped motion", pushes)
        self.top, self.start, self.friction, self.pushes = top, start, friction, pushes
        self.clamped = clamped
        self.tolerance = validate_tolerance(tolerance)
        require(
            not (self.tolerance and (pushes or clamped)),
            "tolerance",
            "0 with pushes or a clamp",
            tolerance,
        )
        self.applied_torque = validate_vector("torque", torque, TORQUE_UNIT)
        self._packed_start = pack_start(top, start, friction, self.applied_torque)
        self._open()

    def _open(self) -> None:
        """Make the motion in the kernel."""
        packed = self.pushes.packed if self.pushes else b""
        self._kernel = bindings.KernelMotion(
            self._packed_start, packed, self.clamped, self.tolerance
        )
        self._piece: Piece | None = None  # the last one that was asked for

    def restart(self, start: State[float]) -> "Motion":
        """Return the motion of the same top from another state, under the same friction and torque.

        The new motion has the same tolerance, no pushes and no clamp.

        Parameters
        ----------
        start : State
            Its state at t = 0.

        Raises
        ------
        ValueError
            If it is not one state.

        Examples
        --------
        >>> from symtop_ros.physics import Friction, Motion, State, Top, hurry
        >>> start = State.from_euler(theta=0.5, phi_dot=6.5, psi_dot=200.0)
        >>> motion = Motion(Top(0.000228, 0.0000572, 0.068), start, Friction(axial=1e-6))
        >>> kicked = motion.restart(hurry(motion.at(1.0)))
        >>> kicked.top is motion.top, kicked.friction.axial
        (True, 1e-06)
        """
        motion = object.__new__(Motion)
        motion.top = self.top
        motion.start = start
        motion.friction, motion.applied_torque = self.friction, self.applied_torque
        motion._packed_start = self._pack_with("start", start)
        motion.pushes = None
        motion.clamped = False
        motion.tolerance = self.tolerance
        motion._open()
        return motion

    def _pack_with(self, name: str, state: Any) -> bytes:
        """Return the numbers of the motion from another state, as `symtop_start` has them."""
        require(isinstance(state, State), name, "one state", state)
        validate_one(state, name, "state")
        given, omega = state.given_orientation, state.angular_velocity
        return bindings.replace_state(self._packed_start, given, omega)

    def __reduce__(self) -> tuple[Any, ...]:
        """Copy and pickle a motion by its arguments: copies share no integration."""
        acting = self.friction, self.applied_torque, self.pushes, self.clamped
        return Motion, (self.top, self.start, *acting, self.tolerance)

    def __repr__(self) -> str:
        """Return the call that makes the motion; without friction and torque, if none acts."""
        drive = (self.friction, self.applied_torque) if self.is_driven else ()
        named = [f"pushes={self.pushes!r}"] if self.pushes else []
        named += ["clamped=True"] if self.clamped else []
        named += [f"tolerance={self.tolerance!r}"] if self.tolerance else []
        return f"Motion({', '.join([*map(repr, (self.top, self.start, *drive)), *named])})"

    @cached_property
    def is_driven(self) -> bool:
        """True if friction or an applied torque acts: there is no closed form, only series."""
        return self.engine == "taylor"

    def total_torque(self, state: State) -> Real:
        """Return the torque of gravity, friction, the applied torque and a clamp about the pivot.

        Parameters
        ----------
        state : State
            One state or many.

        Returns
        -------
        ndarray (..., 3)
            In the world frame, in N m.
        """
        torque = self.top.gravity_torque(state)
        return torque + self.added_torque(state) if self.is_driven or self.clamped else torque

    def added_torque(self, state: State) -> Real:
        """Return the torque of friction, the applied torque and a clamp, without gravity.

        The torque of a clamp is p_psi times the velocity of the unit vector along the axle: p_psi
        theta', in the direction in which theta grows. Its component about the vertical is -p_psi
        theta' sin(theta).

        Parameters
        ----------
        state : State
            One state or many.

        Returns
        -------
        ndarray (..., 3)
            In the world frame, in N m.

        Examples
        --------
        >>> from symtop_ros.physics import Motion, State, Top
        >>> top = Top(Ix=0.000228, Iz=0.0000572, Mgl=0.068)
        >>> start = State.from_euler(theta=0.5, theta_dot=1.0, psi_dot=200.0)
        >>> Motion(top, start, clamped=True).added_torque(start).round(5).tolist()
        [0.0, -0.01004, -0.00548]
        """
        torque = self.friction.torque(state)
        if self.clamped:
            torque = torque + self.clamp_torque(state)
        return np.asarray(state.to_world(torque) + self.applied_torque)

    def euler_rates(self, state: State[N]) -> Rates[N]:
        """Return the rates of Euler's angles in states of this motion, in rad/s.

        They are those of `State.euler_rates`, except for a clamped motion: there phi' is exactly 0
        and psi' exactly omega_z, without rounding errors.

        Parameters
        ----------
        state : State
            One state or many of this motion.

        Returns
        -------
        Rates
            phi', theta', psi', each (...).

        Examples
        --------
        >>> from symtop_ros.physics import Motion, State, Top
        >>> top = Top(Ix=0.000228, Iz=0.0000572, Mgl=0.068)
        >>> held = Motion(top, State.from_euler(theta=0.5, psi_dot=200.0), clamped=True)
        >>> rates = held.euler_rates(held.at(0.1))
        >>> rates.phi_dot, rates.psi_dot
        (0.0, 200.0)
        """
        rates = state.euler_rates
        if not self.clamped:
            return rates
        spin = state.angular_velocity[..., 2]
        theta_dot: Any = rates.theta_dot
        held: Any = spin if np.ndim(spin) else float(spin)
        return Rates(0.0 * abs(theta_dot), theta_dot, held)

    def clamp_torque(self, state: State) -> Real:
        """Return the torque of the clamp (hand and bearing), in the body frame in N m.

        Parameters
        ----------
        state : State
            One state or many of a clamped motion.

        Returns
        -------
        ndarray (..., 3)
            p_psi times the velocity of the unit vector along the axle (derivation.md, section 11).
            The hand at the outer ring exerts the vertical part, and the bearing of the ring the
            rest (`gimbal_shares`).
        """
        x, y, _ = np.moveaxis(state.angular_velocity, -1, 0)
        across = np.stack([y, -x, np.zeros_like(x)], axis=-1)  # of the axle, at 1 m
        momentum: Real = np.asarray(self.top.axial_momentum(state))
        return np.asarray(momentum[..., np.newaxis] * across)

    @property
    def engine(self) -> Engine:
        """Method of solution.

        "closed form" (elliptic functions), "free" (circular functions: Mgl is 0, or the axis rests
        on the vertical) or "taylor" (Taylor series in time: friction or an applied torque acts).
        """
        return self._kernel.engine

    @overload
    def at(self, t: float) -> State[float]: ...

    @overload
    def at(self, t: Many) -> State[Real]: ...

    @overload
    def at(self, t: ExactTimes) -> State: ...

    def at(self, t: ArrayLike | ExactTimes) -> State:
        """Return the state at one time, or the states at many.

        Parameters
        ----------
        t : float, array_like (...) or ExactTimes
            Time since the start in s, of either sign, up to 1e15 turns of the fastest phase, or
            exact times in ns. A driven motion is integrated in steps of about 10 us of computing
            time: a few seconds for six hours of the article's top. A time that needs more than 1e7
            steps is refused.

        Returns
        -------
        State
            orientation (4,) and angular_velocity (3,), or (..., 4) and (..., 3).

        Raises
        ------
        ValueError
            If a time is not a finite number or too far, or if a driven motion becomes too fast on
            the way to it, has a friction too strong to reach it, or takes too many steps.

        Examples
        --------
        >>> from symtop_ros.physics import Motion, State, Top
        >>> top = Top(Ix=0.000228, Iz=0.0000572, Mgl=0.068)
        >>> motion = Motion(top, State.from_euler(theta=0.5, psi_dot=200.0))
        >>> round(motion.at(motion.nutation_period).euler_angles.theta, 9)
        0.5
        """
        times = t if isinstance(t, ExactTimes) else validate_times(t)
        if isinstance(times, float) or (isinstance(times, ExactTimes) and not times.shape):
            return self._compute_one(times)
        count = math.prod(times.shape)
        orientation, angular_velocity = np.empty((count, 4)), np.empty((count, 3))
        self._fill(times, orientation, angular_velocity)
        return wrap_states(orientation, angular_velocity, times.shape)

    def _compute_one(self, time: float | ExactTimes) -> State:
        numbers = None if self.is_driven else self._kernel.at(time)
        if numbers:
            # Two arrays, not views of one: `base` of a view could be written to.
            return State._wrap(np.array(numbers[:4]), np.array(numbers[4:]))
        # Of a driven motion, in steps between which signals are seen; or a time that is refused.
        orientation, omega = np.empty((1, 4)), np.empty((1, 3))
        times = time.ravel() if isinstance(time, ExactTimes) else np.array([time])
        states.fill_states(self._kernel, times, orientation, omega)
        return State._wrap(orientation[0].copy(), omega[0].copy())

    def _fill(self, times: Real | ExactTimes, orientation: Real, angular_velocity: Real) -> None:
        """Write the states at many times into arrays; the times are not validated.

        Parameters
        ----------
        times : ndarray (...) or ExactTimes () or (n,)
            Finite times in s, or exact times in ns; n in all.
        orientation : ndarray (n, 4)
            Receives the quaternions.
        angular_velocity : ndarray (n, 3)
            Receives the angular velocities.
        """
        states.fill_states(self._kernel, times.ravel(), orientation, angular_velocity)

    def _reach(self, t: float, steps: float) -> float:
        """Prepare the states up to a time, within a limited number of steps.

        Parameters
        ----------
        t : float
            Time in s.
        steps : float
            Largest number of integration steps, of which a call takes ten million at most; the
            exact engines need none.

        Returns
        -------
        float
            Time up to which `at` now answers without integrating: t, or nearer to the start. A
            driven motion that becomes too fast for doubles is reached up to there only.

        Examples
        --------
        >>> from symtop_ros.physics import Friction, Motion, State, Top
        >>> top = Top(Ix=0.000228, Iz=0.0000572, Mgl=0.068)
        >>> start = State.from_euler(theta=0.5, psi_dot=200.0)
        >>> Motion(top, start)._reach(1e6, steps=0)
        1000000.0
        >>> 0 < Motion(top, start, Friction(axial=2e-6))._reach(10.0, steps=100) < 10
        True
        """
        t = validate_number("t", t, "s")
        require(steps >= 0, "steps", ">= 0", steps)
        return states.reach(self._kernel, t, min(steps, states.LONGEST_WAY))

    def piece_at(self, t: float | ExactTimes) -> "Piece":
        """Return the motion since the last push before a time.

        Parameters
        ----------
        t : float or ExactTimes
            One time in s, or an exact one.

        Returns
        -------
        Piece
            `motion` starts at the last push up to `t`; `begin` is the time of that push in ns, and
            `number` the number of pushes up to `t`. The first push is at 0, and its piece starts
            from the start of this motion. Without pushes the piece is this motion itself, with 0
            and 0. The start of a piece is rounded to doubles, while this motion keeps 32 digits
            (docs/accuracy.md, "Pushes").

        Raises
        ------
        ValueError
            If there is no state at the time.

        Examples
        --------
        >>> from symtop_ros.physics import Motion, Pushes, State, Top
        >>> top = Top(Ix=0.000228, Iz=0.0000572, Mgl=0.068)
        >>> start = State.from_euler(theta=0.5, phi_dot=7.0, psi_dot=200.0)
        >>> piece = Motion(top, start, pushes=Pushes(5e-5, 20.0, 20)).piece_at(0.12)
        >>> piece.begin, piece.number
        (100000000, 3)
        >>> piece.motion.kind
        'unidirectional'
        """
        if isinstance(t, ExactTimes):
            validate_one(t, "t", "time")
        else:
            t = validate_number("t", t, "s")
        if not self.pushes:
            return Piece(self, 0, 0)
        if not isinstance(t, ExactTimes):
            t = ExactTimes(0, elapsed=Fraction(t) * SECOND)
        found = states.find_piece(self._kernel, t)
        piece = self._piece
        if piece is None or piece.number != found.number:
            piece = self._piece = self._make_piece(found)
        return piece

    def _make_piece(self, found: PieceRecord) -> "Piece":
        """Return a piece for the caller to keep: a driven one is integrated from its start on."""
        _, start, *_ = read_start(np.frombuffer(found.start))
        motion = self.restart(self.start if found.number == 1 else start)
        return Piece(motion, int(found.begin), int(found.number))

    def end_pushes(self, number: int) -> "Motion":
        """Return the motion with only the first pushes, up to a given number.

        Parameters
        ----------
        number : int
            At least 1: the start is the state after the first push.

        Raises
        ------
        ValueError
            If the motion has no pushes, or fewer than this number.

        Examples
        --------
        >>> from symtop_ros.physics import Motion, Pushes, State, Top
        >>> top = Top(Ix=0.000228, Iz=0.0000572, Mgl=0.068)
        >>> start = State.from_euler(theta=0.5, phi_dot=7.0, psi_dot=200.0)
        >>> pushed = Motion(top, start, pushes=Pushes(5e-5, 20.0, 20))
        >>> pushed.end_pushes(3).piece_at(1.0).begin
        100000000
        """
        number = int(validate_number("number", number))
        if not self.pushes or number > self.pushes.number:
            given = self.pushes.number if self.pushes else 0
            raise refuse("number", f"at most the {given} pushes of the motion", number)
        pushes = replace(self.pushes, number=number)
        return Motion(self.top, self.start, self.friction, self.applied_torque, pushes)

    @cached_property
    def farthest_time(self) -> float:
        """Time in s at which the fastest phase has made 1e15 turns: later states are refused.

        If a push before that time cannot be made, it is the time of this push: the axis is then
        vertical, or the top would become too fast. The time is infinite with friction or an applied
        torque, and if all phases stand still.

        Examples
        --------
        >>> from symtop_ros.physics import Motion, State, Top
        >>> top = Top(Ix=0.000228, Iz=0.0000572, Mgl=0.068)
        >>> motion = Motion(top, State.from_euler(theta=0.5, psi_dot=200.0))
        >>> f"{motion.farthest_time:.2e}"
        '1.41e+14'
        """
        return self._kernel.farthest_time

    @bindings.compute_soundly
    def jacobian(self, t: ArrayLike | ExactTimes) -> Real:
        """Return the derivatives of the state with respect to the top and the start.

        Rows 0 to 2 are those of the attitude, as a small rotation vector d in the body frame: the
        orientation becomes q (1, d/2). Rows 3 to 5 are those of omega in the body frame. Columns 0
        to 2 are derivatives by Ix, Iz and Mgl, columns 3 to 5 by a small rotation vector of the
        start in the body frame, columns 6 to 8 by its omega.

        They are differences of exact states. A block is formed by rows 0 to 2 or 3 to 5, and by
        columns 0, 1, 2, 3 to 5 or 6 to 8. The error of an element is at most 1e-8 of the largest
        element of its block. For a parameter with hardly any effect, the error is at most 1e-11 rad
        (attitude) or 1e-11 of the spin (omega), after multiplying the derivative by the size of the
        parameter: the absolute value of Ix, Iz or Mgl, 1 rad, or the fastest rate.

        Parameters
        ----------
        t : float, array_like (...) or ExactTimes
            Time since the start in s, or exact times in ns.

        Returns
        -------
        ndarray (..., 6, 9)
            In units of rad and rad/s by kg m^2, kg m^2, J, rad and rad/s.

        Raises
        ------
        ValueError
            If a time is refused by `at`, if the motion has pushes, a clamp or a tolerance, if
            double precision does not resolve the derivatives (the start is within 1e-6 rad of the
            vertical or 1e-8 of the separatrix, the time is late and the nutation far smaller than
            1e-6 rad, or a driven motion comes back to an unstable vertical), or if driven motions
            would take more than a minute.

        Examples
        --------
        >>> from symtop_ros.physics import Motion, State, Top
        >>> top = Top(Ix=0.000228, Iz=0.0000572, Mgl=0.068)
        >>> motion = Motion(top, State.from_euler(theta=0.5, psi_dot=200.0))
        >>> motion.jacobian([0.0, 1.0, 1e6]).shape
        (3, 6, 9)

        A top that spins faster by 1e-6 rad/s turns further:

        >>> round(float(motion.jacobian(10.0)[2, 8] * 1e-6), 10)
        9.9333e-06
        """
        times = t if isinstance(t, ExactTimes) else validate_array("t", t, unit="s")
        if self.pushes:
            raise refuse("pushes", "none for derivatives: take a piece", self.pushes)
        require(not self.clamped, "clamped", "False for derivatives", self.clamped)
        require(not self.tolerance, "tolerance", "0 for derivatives", self.tolerance)
        return differentiate(self, times.ravel()).reshape(*times.shape, 6, 9)

    @overload
    def certify(self, t: float) -> Certificate[float]: ...

    @overload
    def certify(self, t: Many) -> Certificate[Real]: ...

    @overload
    def certify(self, t: ExactTimes) -> Certificate: ...

    def certify(self, t: ArrayLike | ExactTimes) -> Certificate:
        """Return proved bounds of the errors of the states that `at` gives.

        The exact states are computed in ball arithmetic, without a number of the kernel. Under
        gravity alone, and clamped, a state takes some ms; 10 s of a driven top of 200 rad/s take
        half a minute.
        The extra `reference` must be installed.

        Parameters
        ----------
        t : float, array_like (...) or ExactTimes
            Time since the start in s, or exact times in ns.

        Returns
        -------
        Certificate
            Bounds of the attitude in rad, and of the angular velocity in rad/s.

        Raises
        ------
        ValueError
            If a time is refused by `at`, if the motion has pushes, if python-flint is missing, or
            if a proof would take more than 200 000 bits.

        Examples
        --------
        >>> from symtop_ros.physics import Motion, State, Top
        >>> top = Top(Ix=0.000228, Iz=0.0000572, Mgl=0.068)
        >>> motion = Motion(top, State.from_euler(theta=0.5, psi_dot=200.0))
        >>> proved = motion.certify([1.0, 1e6])
        >>> bool((proved.attitude < 1e-15).all()), bool((proved.angular_velocity < 1e-13).all())
        (True, True)
        """
        if self.pushes:
            raise refuse("pushes", "none for a certificate: take a piece", self.pushes)
        times = t if isinstance(t, ExactTimes) else validate_array("t", t, unit="s")
        drive = self.friction.coefficients, self.applied_torque
        states = self.at(times.ravel())
        return certify(self.top, self.start, drive, self.clamped, times, states)

    @property
    def kind(self) -> Kind:
        """Kind of the motion, such as "cusps", from phi' at the two turning angles.

        "regular" (the angles are equal), "unidirectional" (phi' has one sign), "cusps" (phi' is
        zero at one angle), "looping" (phi' has opposite signs), "through the pole", "asymptotic"
        (the axis approaches the vertical for ever; the separatrix) or "sleeping" (it rests on the
        vertical). The article calls a unidirectional motion spiralling. With friction, an applied
        torque or pushes the kind is "driven": the turning angles, and phi' at them, then change. If
        phi is held, it is "clamped".
        """
        return self._kernel.kind

    @cached_property
    def _rates(self) -> RatesRecord:
        return self._kernel.rates

    @property
    def nutation_period(self) -> float:
        """Period of theta in s; infinite if theta is not periodic, or if the axis is at rest."""
        return float(self._rates.nutation_period)

    @property
    def turning_angles(self) -> tuple[float, float]:
        """Smallest and largest theta in rad."""
        return self._kernel.turning_angles

    @property
    def mean_precession_rate(self) -> float:
        """Mean phi' over a nutation in rad/s.

        It is 0 for a clamped motion. It is nan under friction or an applied torque, which change it
        from nutation to nutation; for an axis that rests on the vertical; and for an axis that
        passes through a pole (not clamped): there phi jumps by half a turn, in a direction that
        depends on the rounding of the start.
        """
        if self.is_driven:
            return math.nan
        return 0.0 if self.clamped else float(self._rates.mean_precession_rate)

    @property
    def precession_period(self) -> float:
        """Mean time of one turn of the precession in s: 2 pi divided by the mean of phi', unsigned.

        It is infinite if the mean phi' is 0, and nan if the mean phi' is nan.

        Examples
        --------
        >>> from symtop_ros.physics import Motion, State, Top
        >>> top = Top(Ix=0.000228, Iz=0.0000572, Mgl=0.068)
        >>> motion = Motion(top, State.from_euler(theta=0.5, psi_dot=200.0))
        >>> round(motion.precession_period, 6)
        0.946534
        """
        return find_period(self.mean_precession_rate)

    @property
    def rounding_shows_at(self) -> float:
        """Time in s from which on the rounding of the start decides where the axis is.

        It is finite if two conditions hold: an asymptotic motion lies within 64 EPS (EPS is 2^-52)
        of the start, and a change of one number of the start in its last place turns the axis by
        0.01 rad within two nutations. Such a start is next to the separatrix, and in exact numbers
        its motion may be of another kind. It is infinite otherwise, and for motions with friction,
        a torque, pushes or a clamp.

        Examples
        --------
        In exact numbers this axis approaches the vertical for ever. The start is rounded to
        doubles, and its axis passes through the vertical.

        >>> import math
        >>> from symtop_ros.physics import Motion, State, Top
        >>> rate = 2 / math.sqrt(3)
        >>> start = State.from_euler(theta=math.pi / 3, phi_dot=rate, psi_dot=rate)
        >>> motion = Motion(Top(Ix=1.0, Iz=1.0, Mgl=1.0), start)
        >>> motion.kind, round(motion.rounding_shows_at)
        ('through the pole', 63)
        """
        if self.is_driven or self.pushes or self.clamped:
            return math.inf
        return bindings.find_doubt(self._packed_start)

    @property
    def mean_spin_rate(self) -> float:
        """Mean psi' over a nutation in rad/s.

        For a clamped motion it is p_psi/Iz. Otherwise it is nan if the axis rests on the vertical
        or passes through a pole. With friction or a torque it is that under gravity alone.
        """
        # psi' is omega_z as long as phi' is 0, and omega_z is constant.
        held = self.start.angular_velocity[2] if self.clamped else self._rates.mean_spin_rate
        return float(held)

    @property
    def precession_per_nutation(self) -> float:
        """Precession in a nutation as a fraction of a turn, 2 pi rad.

        The trace of the axis is closed if this fraction is a ratio of integers. It is nan if the
        axis rests on the vertical or passes through a pole, and for a clamped motion or one that
        does not return. With friction or a torque it is that under gravity alone.

        Examples
        --------
        >>> from symtop_ros.physics import Motion, State, Top
        >>> top = Top(Ix=0.000228, Iz=0.0000572, Mgl=0.068)
        >>> motion = Motion(top, State.from_euler(theta=0.5, psi_dot=200.0))
        >>> round(motion.precession_per_nutation, 6)
        0.168557
        """
        return float(self._rates.precession_per_nutation)

    @property
    def mean_cosine(self) -> float:
        """Mean of cos(theta) over the time of a nutation.

        Mgl times this mean is the mean potential energy.

        For Mgl > 0 the axis spends more time near its upper turning point than near its lower one,
        so the mean exceeds the middle of both heights (docs/derivation.md, section 7). For Mgl < 0
        it is below the middle, and for Mgl = 0 equal to it. For an asymptotic motion it is
        cos(theta) of the pole. For a driven motion it is the mean without friction, torque and
        pushes.

        Examples
        --------
        >>> import math
        >>> from symtop_ros.physics import Motion, State, Top
        >>> motion = Motion(Top(1.0, 0.5, 1.0), State.from_euler(theta=0.5, psi_dot=5.0))
        >>> low, high = motion.turning_angles
        >>> round(motion.mean_cosine, 6), round((math.cos(low) + math.cos(high)) / 2, 6)
        (0.802917, 0.802022)
        """
        return float(self._rates.mean_cosine)

    @property
    def spin_reverses(self) -> bool:
        """True if psi' takes both signs in a nutation, although L_z is constant.

        Examples
        --------
        >>> from symtop_ros.physics import Motion, State, Top
        >>> top = Top(Ix=0.000228, Iz=0.0000572, Mgl=0.068)
        >>> start = State.from_euler(theta=0.8, phi_dot=-60.0, psi_dot=60.0)
        >>> Motion(top, start).spin_reverses
        True
        """
        return bool(self._rates.spin_reverses)

    @property
    def nutation_rate(self) -> float:
        """2 pi divided by the nutation period in rad/s; 0 if the period is infinite."""
        return 2 * math.pi / self.nutation_period

    @property
    def fast_top_precession_rate(self) -> float:
        """Mean phi' of the fast top in rad/s: Mgl/p_psi (Goldstein, section 5.7).

        It is nan if p_psi = 0, and for a clamped motion, which does not precess. It is the
        textbooks' approximation for p_psi^2 >> 4 Ix Mgl and an axis let go at rest. The
        exact value is `mean_precession_rate`.

        Examples
        --------
        >>> from symtop_ros.physics import Motion, State, Top
        >>> top = Top(Ix=0.000228, Iz=0.0000572, Mgl=0.068)
        >>> motion = Motion(top, State.from_euler(theta=0.5, psi_dot=200.0))
        >>> round(motion.fast_top_precession_rate, 3), round(motion.mean_precession_rate, 3)
        (5.944, 6.638)
        """
        p_psi = float(self.top.axial_momentum(self.start))
        return self.top.Mgl / p_psi if p_psi and not self.clamped else math.nan

    @property
    def fast_top_nutation_rate(self) -> float:
        """Nutation rate of the fast top in rad/s: |p_psi|/Ix (Goldstein, section 5.7).

        The exact value is `nutation_rate`. It is nan for a clamped motion, which is that of a
        pendulum.

        Examples
        --------
        >>> from symtop_ros.physics import Motion, State, Top
        >>> top = Top(Ix=0.000228, Iz=0.0000572, Mgl=0.068)
        >>> motion = Motion(top, State.from_euler(theta=0.5, psi_dot=200.0))
        >>> round(motion.fast_top_nutation_rate, 2), round(motion.nutation_rate, 2)
        (50.18, 39.38)
        """
        rate = abs(float(self.top.axial_momentum(self.start))) / self.top.Ix
        return math.nan if self.clamped else rate


class Piece(NamedTuple):
    """The motion between two pushes."""

    motion: Motion  # from the state that the last push left
    begin: int  # ns of the whole motion at that push
    number: int  # of the pushes up to then; 0 of a motion without pushes
