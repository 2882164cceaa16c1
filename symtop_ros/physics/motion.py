"""The motion of a top from a start: the state at any time, and its constant properties."""

import math
from decimal import localcontext
from functools import cached_property
from typing import Any, Literal

import numpy as np
from numpy.typing import ArrayLike

from symtop_ros.arrays import Quaternion, Real, Vector
from symtop_ros.physics.arguments import (
    NO_FRICTION,
    NO_TORQUE,
    Setting,
    find_shape,
    is_free,
    validate_times,
    validate_torque,
    validate_types,
    wrap_states,
)
from symtop_ros.physics.derivatives.driven import differentiate_driven
from symtop_ros.physics.derivatives.gravity import GravityDerivatives, SleepingDerivatives
from symtop_ros.physics.driven.trail import DrivenMotion
from symtop_ros.physics.exact.closed_form import ClosedFormMotion
from symtop_ros.physics.exact.elementary import Number
from symtop_ros.physics.exact.free import FreeMotion
from symtop_ros.physics.exact.kind import Kind, Rates
from symtop_ros.physics.exact.precise import PRECISE
from symtop_ros.physics.kernel import PURE, find_kernel
from symtop_ros.physics.kernel.compiled import CompiledMotion
from symtop_ros.physics.state import State
from symtop_ros.physics.times import ExactTimes
from symtop_ros.physics.top import Friction, Top
from symtop_ros.physics.values import ignore_underflow, refuse, validate_array, validate_number

# Times evaluated at once. Fewer cost more calls of NumPy for each time, more leave the cache.
BLOCK = 12288


class Motion(Setting):
    """The motion of a top from a state.

    Without friction and applied torque it is exact at any time. With them it is integrated; turning
    angles, nutation period and mean rates are then those of the motion that would follow from the
    start under gravity alone.

    If an argument is an array, `Motion(...)` returns `Motions`: many motions at once.

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
    pure : bool
        True computes with Python alone; else the compiled kernel is used if it was built. States
        under gravity alone have the same bits. The default is that of the environment variable
        SYMTOP_PURE.

    Attributes
    ----------
    top : Top
    start : State
    friction : Friction
    applied_torque : (float, float, float)
        In the world frame, in N m.
    shape : tuple of int
        ().

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

    def __new__(
        cls,
        top: Top,
        start: State,
        friction: Friction = NO_FRICTION,
        torque: ArrayLike = NO_TORQUE,
        *,
        pure: bool = PURE,
    ) -> Any:
        """Return the motion, or many if an argument is an array."""
        validate_types(top, start, friction)
        if find_shape(top, start, friction, validate_torque(torque)):
            # Many motions are made of single ones, so their module imports this one.
            from symtop_ros.physics.motions import Motions  # noqa: PLC0415

            return Motions(top, start, friction, torque, pure=pure)
        return object.__new__(cls)

    def __init__(
        self,
        top: Top,
        start: State,
        friction: Friction = NO_FRICTION,
        torque: ArrayLike = NO_TORQUE,
        *,
        pure: bool = PURE,
    ) -> None:
        super().__init__(top, start, friction, validate_torque(torque), (), pure)
        self._orientation: Quaternion = tuple(start.given_orientation.tolist())
        self._omega: Vector = tuple(start.angular_velocity.tolist())
        self._is_free = is_free(top.moments, self._orientation, self._omega)
        self._driven: DrivenMotion | None = None
        if self.is_driven:
            self._driven = DrivenMotion(top, start, friction, self.applied_torque, self._compiled)

    @property
    def engine(self) -> Literal["closed form", "free", "taylor"]:
        """Method of solution.

        Elliptic functions; circular functions if Mgl is 0 or if the axis rests on the vertical;
        with friction or an applied torque Taylor series in time.
        """
        if self._driven:
            return "taylor"
        return "free" if self._is_free else "closed form"

    @cached_property
    def _engine(self) -> ClosedFormMotion | FreeMotion:
        # The closed form wants Mgl > 0. A world turned by pi about x' has the opposite gravity.
        (w, x, y, z), top = self._orientation, self.top
        moments = top.Ix, top.Iz, abs(top.Mgl)
        orientation = (-x, w, -z, y) if self._is_turned_over else self._orientation
        solver = FreeMotion if self._is_free else ClosedFormMotion
        with localcontext(PRECISE):
            return solver(moments, orientation, self._omega)

    @property
    def _is_turned_over(self) -> bool:
        return self.top.Mgl < 0

    @cached_property
    def _compiled(self) -> CompiledMotion | None:
        """The motion in the kernel, if that is to be used."""
        kernel = find_kernel(self._pure)
        if not kernel:
            return None
        state = self.top.moments, self._orientation, self._omega
        return CompiledMotion(kernel, *state, self.friction, self.applied_torque)

    def at(self, t: ArrayLike | ExactTimes) -> State:
        """Return the state at one time, or the states at many.

        Parameters
        ----------
        t : float, array_like (...) or ExactTimes
            Time since the start in s, any finite number of either sign, or exact times in ns. A
            driven motion takes exact times in extended precision, and costs about 0.04 ms for
            each radian of nutation on the way: a minute for a time of six hours. Ctrl-C ends it.

        Returns
        -------
        State
            orientation (4,) and angular_velocity (3,), or (..., 4) and (..., 3).

        Raises
        ------
        ValueError
            If a time is not a finite number, or if a driven motion becomes too fast on the way to
            it or has a friction too strong to reach it.

        Examples
        --------
        >>> from symtop_ros.physics import Motion, State, Top
        >>> top = Top(Ix=0.000228, Iz=0.0000572, Mgl=0.068)
        >>> motion = Motion(top, State.from_euler(theta=0.5, psi_dot=200.0))
        >>> round(motion.at(motion.nutation_period).euler_angles.theta, 9)
        0.5
        """
        times = validate_times(t)
        if isinstance(times, float):
            return self._compute_one(times)
        count = math.prod(times.shape)
        orientation, angular_velocity = np.empty((count, 4)), np.empty((count, 3))
        self.fill(times, orientation, angular_velocity)
        return wrap_states(orientation, angular_velocity, times.shape, len(times.shape))

    def _compute_one(self, time: float) -> State:
        if self._driven:
            return State.wrap(*self._driven.at(time))
        state = self._compiled.at(time) if self._compiled else None
        numbers = state or [*self._evaluate(time), self._omega[2]]
        # Two arrays, not views of one: `base` of a view could be written to.
        return State.wrap(np.array(numbers[:4]), np.array(numbers[4:]))

    def fill(self, times: Real | ExactTimes, orientation: Real, angular_velocity: Real) -> None:
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
        flat = times.ravel()
        if self._driven:
            self._driven.fill(flat, orientation, angular_velocity)
            return
        written = self._compiled.fill(flat, orientation, angular_velocity) if self._compiled else 0
        if written < len(orientation):  # without the kernel, or from a time on that is too far
            left = slice(written, None)
            self._fill_in_blocks(flat[left], orientation[left], angular_velocity[left])

    def _fill_in_blocks(self, times: Real | ExactTimes, orientation: Real, omega: Real) -> None:
        """Write the states at times (n,) by NumPy, in blocks that fit into a processor's cache."""
        omega[:, 2] = self._omega[2]
        for first in range(0, len(orientation), BLOCK):
            block = slice(first, first + BLOCK)
            # Terms of a series may underflow; the caller's NumPy may be set to raise for that.
            with np.errstate(under="ignore"):
                columns = self._evaluate(times[block])
            for k, column in enumerate(columns[:4]):
                orientation[block, k] = column
            omega[block, 0], omega[block, 1] = columns[4:]

    def _evaluate(self, times: Number | ExactTimes) -> tuple[Number, ...]:
        """Return w, x, y, z, omega_x and omega_y at times in s or exact times."""
        with localcontext(PRECISE):
            (w, z), (x, y), (wx, wy) = self._engine.cayley_klein(times)
        if self._is_turned_over:
            w, x, y, z = x, -w, z, -y
        # One step to norm 1. Newton's would correct A and B by the same factor, and so give a small
        # B the error of A. Least squares correct the larger one more, by |A|^2/(|A|^4 + |B|^4) of
        # the step, and B by |B|^2 over the same; a cubic of |A|^2 = 1 - |B|^2 is near enough. Of
        # equal sizes both take the same, which removes their common error.
        upper, lower = w * w + z * z, x * x + y * y
        step = 0.5 - 0.5 * (upper + lower)
        share = step * (upper - lower)
        of_B = step - upper * share
        of_A = of_B + share
        return w + w * of_A, x + x * of_B, y + y * of_B, z + z * of_A, wx, wy

    def reach(self, t: float, steps: float) -> float:
        """Prepare the states up to a time, within a limited number of steps.

        Parameters
        ----------
        t : float
            Time in s.
        steps : float
            Largest number of integration steps; the exact engines need none.

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
        >>> Motion(top, start).reach(1e6, steps=0)
        1000000.0
        >>> 0 < Motion(top, start, Friction(axial=2e-6)).reach(10.0, steps=100) < 10
        True
        """
        t = validate_number("t", t, "s")
        if not steps >= 0:
            raise refuse("steps", ">= 0", steps)
        return self._driven.reach(t, steps) if self._driven else t

    @ignore_underflow
    def jacobian(self, t: ArrayLike) -> Real:
        """Return the derivatives of the state by the top and the start.

        Rows 0 to 2 are those of the attitude, as a small rotation vector d in the body frame: the
        orientation becomes q (1, d/2). Rows 3 to 5 are those of omega in the body frame. Columns 0
        to 2 are derivatives by Ix, Iz and Mgl, columns 3 to 5 by a small rotation vector of the
        start in the body frame, columns 6 to 8 by its omega.

        Under gravity alone they follow at any time from one nutation. With friction or an applied
        torque, and where the axis takes for ever to return, they are integrated along the motion.

        Parameters
        ----------
        t : float or array_like (...)
            Time since the start in s.

        Returns
        -------
        ndarray (..., 6, 9)
            In units of rad and rad/s by kg m^2, kg m^2, J, rad and rad/s.

        Raises
        ------
        ValueError
            If a time is refused by `at`, or if derivatives that are integrated take more than some
            ten seconds.

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
        times = validate_array("t", t, unit="s")
        flat = times.reshape(-1)
        found = differentiate_driven(self, flat) if self._driven else self._derivatives.at(flat)
        return found.reshape(*times.shape, *found.shape[-2:])

    @cached_property
    def _derivatives(self) -> GravityDerivatives | SleepingDerivatives:
        if self.kind == "sleeping":
            return SleepingDerivatives(self)
        return GravityDerivatives(self, self._engine.nutation_rate)

    @property
    def kind(self) -> Kind:
        """Name of the motion, by phi' at the two turning angles.

        "regular" (the angles are equal), "unidirectional" (phi' has one sign), "cusps" (phi' is
        zero at one angle), "looping" (phi' has opposite signs), "through the pole", "asymptotic"
        (the axis approaches the vertical for ever; the separatrix) or "sleeping" (it rests on the
        vertical). The article calls a unidirectional motion spiralling. With friction or an applied
        torque it is "driven": the angles then change, and phi' at them.
        """
        if self._driven:
            return "driven"
        if self._compiled:
            return self._compiled.kind
        with localcontext(PRECISE):
            return self._engine.kind

    @cached_property
    def _rates(self) -> Rates:
        if self._compiled:
            return self._compiled.rates
        engine, sign = self._engine, -1 if self._is_turned_over else 1
        with localcontext(PRECISE):
            if engine.kind in ("sleeping", "through the pole"):
                precession = spin = turns = math.nan
            else:
                # In the world that is turned over the precession is reversed.
                precession, spin = engine.mean_rates
                precession, turns = sign * precession, sign * engine.precession_per_nutation
            return Rates(engine.nutation_period, precession, spin, turns, engine.spin_reverses)

    @property
    def nutation_period(self) -> float:
        """Period of theta in s; infinite if the motion does not return, or if the axis rests."""
        return self._rates.nutation_period

    @property
    def turning_angles(self) -> tuple[float, float]:
        """Smallest and largest theta in rad."""
        if self._compiled:
            return self._compiled.turning_angles
        with localcontext(PRECISE):
            return self._engine.turning_angles(self._is_turned_over)

    @property
    def mean_precession_rate(self) -> float:
        """Mean phi' over a nutation in rad/s.

        It is nan for an axis that rests on the vertical, and for one that passes through a pole:
        there phi jumps by half a turn, to the left or to the right as rounding will have it.
        """
        return self._rates.mean_precession_rate

    @property
    def mean_spin_rate(self) -> float:
        """Mean psi' over a nutation in rad/s; nan where the mean phi' is."""
        return self._rates.mean_spin_rate

    @property
    def precession_per_nutation(self) -> float:
        """Precession in a nutation as a fraction of a turn, 2 pi rad.

        The trace of the axis closes if it is a ratio of integers. It is nan where the mean phi' is,
        and for a motion that does not return.

        Examples
        --------
        >>> from symtop_ros.physics import Motion, State, Top
        >>> top = Top(Ix=0.000228, Iz=0.0000572, Mgl=0.068)
        >>> motion = Motion(top, State.from_euler(theta=0.5, psi_dot=200.0))
        >>> round(motion.precession_per_nutation, 6)
        0.168557
        """
        return self._rates.precession_per_nutation

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
        return self._rates.spin_reverses

    @property
    def nutation_rate(self) -> float:
        """2 pi over the nutation period in rad/s; 0 if the motion does not return."""
        return 2 * math.pi / self.nutation_period

    @property
    def fast_top_precession_rate(self) -> float:
        """Mean phi' of the fast top in rad/s: Mgl/p_psi (Goldstein, section 5.7); nan if p_psi = 0.

        It is the textbooks' approximation for p_psi^2 >> 4 Ix Mgl and an axis let go at rest. The
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
        return self.top.Mgl / p_psi if p_psi else math.nan

    @property
    def fast_top_nutation_rate(self) -> float:
        """Nutation rate of the fast top in rad/s: |p_psi|/Ix (Goldstein, section 5.7).

        The exact value is `nutation_rate`.

        Examples
        --------
        >>> from symtop_ros.physics import Motion, State, Top
        >>> top = Top(Ix=0.000228, Iz=0.0000572, Mgl=0.068)
        >>> motion = Motion(top, State.from_euler(theta=0.5, psi_dot=200.0))
        >>> round(motion.fast_top_nutation_rate, 2), round(motion.nutation_rate, 2)
        (50.18, 39.38)
        """
        return abs(float(self.top.axial_momentum(self.start))) / self.top.Ix
