"""The top and its friction: moments of inertia, gravity, and what follows from a state."""

import math
from dataclasses import dataclass
from typing import Any, Generic, Self, cast, overload

import numpy as np
from numpy.typing import ArrayLike

from symtop_ros.base.arrays import Real, split, stack
from symtop_ros.base.deprecation import OldName
from symtop_ros.base.one_or_many import Many, N
from symtop_ros.base.refusals import Words, refuse, show_limit
from symtop_ros.physics.kernel import bindings
from symtop_ros.physics.kernel.records import FRICTION_KINDS
from symtop_ros.physics.state import State
from symtop_ros.physics.values import (
    EPS,
    LARGEST_MOMENT,
    SMALLEST_MOMENT,
    validate_one,
    validate_together,
)


class _Numbers:
    """Numbers of one thing, or arrays of many: compared, hashed and copied by what was given."""

    __slots__: tuple[str, ...] = ()

    @property
    def _given(self) -> tuple[Any, ...]:
        """The arguments, validated."""
        return tuple(getattr(self, name) for name in self.__slots__)

    @property
    def shape(self) -> tuple[int, ...]:
        """() for one, (...) for many."""
        return getattr(getattr(self, self.__slots__[0]), "shape", ())

    def spread(self, motions: tuple[int, ...], states: tuple[int, ...]) -> Self:
        """Return the same numbers in the shape of states at times of motions of a shape."""
        if not self.shape:
            return self
        found = object.__new__(type(self))
        times = (1,) * (len(states) - len(motions))
        for name, value in zip(self.__slots__, self._given, strict=True):
            column = np.broadcast_to(value, motions).reshape(*motions, *times)
            object.__setattr__(found, name, np.broadcast_to(column, states))
        return found

    def __eq__(self, other: object) -> bool:
        """Compare all numbers."""
        if not isinstance(other, type(self)):
            return NotImplemented
        return all(map(np.array_equal, self._given, other._given))

    def __hash__(self) -> int:
        """Return a hash of one; many cannot be hashed."""
        return hash(self._given)

    def __reduce__(self) -> tuple[Any, ...]:
        """Copy and pickle by the arguments."""
        return type(self), self._given


@dataclass(frozen=True, slots=True, init=False, eq=False)
class Top(_Numbers, Generic[N]):
    """A heavy symmetric top with a fixed pivot, or many of them.

    Parameters
    ----------
    Ix : float or array_like (...)
        Transverse moment of inertia about the pivot, in kg m^2; 1e-100 to 1e100.
    Iz : float or array_like (...)
        Axial moment of inertia, in kg m^2; 1e-100 <= Iz <= 2 Ix, as for every rigid body.
    Mgl : float or array_like (...)
        Weight times the distance of the centre of mass from the pivot, in J, at most 1e100 in size.
        It is positive if the centre of mass is on the +z side of the body; it may be negative or
        zero.

    Raises
    ------
    ValueError
        If a value is not a finite number or out of range, or if the shapes do not fit together.

    Examples
    --------
    >>> from symtop_ros.physics import Top
    >>> top = Top(Ix=0.000228, Iz=0.0000572, Mgl=0.068)
    >>> round(top.critical_spin, 2)
    137.68
    >>> Top(Ix=0.000228, Iz=0.0000572, Mgl=[0.068, 0.1, -0.068]).shape
    (3,)
    """

    Ix: N
    Iz: N
    Mgl: N

    @overload
    def __init__(self: "Top[float]", Ix: float, Iz: float, Mgl: float) -> None: ...

    @overload
    def __init__(self: "Top[Real]", Ix: Many, Iz: ArrayLike, Mgl: ArrayLike) -> None: ...

    @overload
    def __init__(self: "Top[Real]", Ix: ArrayLike, Iz: Many, Mgl: ArrayLike) -> None: ...

    @overload
    def __init__(self: "Top[Real]", Ix: ArrayLike, Iz: ArrayLike, Mgl: Many) -> None: ...

    def __init__(self, Ix: ArrayLike, Iz: ArrayLike, Mgl: ArrayLike) -> None:
        given = {"Ix": Ix, "Iz": Iz, "Mgl": Mgl}
        values = validate_together(given, ("kg m^2", "kg m^2", "J"))
        for name, value in zip(given, values, strict=True):
            object.__setattr__(self, name, value)
        columns = [each.ravel().tolist() if self.shape else [each] for each in values]
        for moments in zip(*columns, strict=True):
            _validate_moments(*moments)

    @property
    def moments(self) -> tuple[N, N, N]:
        """(Ix, Iz, Mgl)."""
        return self.Ix, self.Iz, self.Mgl

    @property
    @bindings.compute_soundly
    def critical_spin(self) -> N:
        """Smallest |omega_z| in rad/s at which sleeping upright is stable; 0 for Mgl <= 0.

        Sleeping upright is stable if and only if p_psi^2 >= 4 Ix Mgl (Goldstein, section 5.7);
        for Mgl = 0, if and only if omega_z is not 0.
        """
        moments: Any = self.moments
        Ix, Iz, Mgl = moments
        spin: Any = 2 * np.sqrt(Ix) * np.sqrt(np.maximum(Mgl, 0.0)) / Iz
        return spin if self.shape else cast(N, float(spin))

    @bindings.compute_soundly
    def sleeping_is_stable(self: "Top[float]", state: State[float]) -> bool:
        """Return True if an axis at rest on the vertical stays near it after a small kick.

        A centre of mass above the pivot needs p_psi^2 >= 4 Ix |Mgl|; below the pivot the axis is
        always stable. Without weight the axis is stable if the top spins. If it does not, it keeps
        turning after a small kick.

        Parameters
        ----------
        state : State
            One state, with a vertical axis.
        """
        validate_one(self)
        validate_one(state, "state")
        weight = self.Mgl if state.vertical[2] > 0 else -self.Mgl
        if weight == 0:
            return bool(state.angular_velocity[2] != 0)
        if weight < 0:
            return True
        # Roots, not squares: those would overflow. The critical spin itself is stable, whichever
        # way its double is rounded.
        least = 2 * math.sqrt(self.Ix) * math.sqrt(weight)
        return abs(float(self.axial_momentum(state))) >= (1 - 8 * EPS) * least

    @bindings.compute_soundly
    def body_angular_momentum(self, state: State) -> Real:
        """Return the angular momentum about the pivot in the body frame, (..., 3), in N m s."""
        Ix, Iz = match(self.Ix, state), match(self.Iz, state)
        x, y, z = split(state.angular_velocity)
        return stack(x * Ix, y * Ix, z * Iz)

    @bindings.compute_soundly
    def angular_momentum(self, state: State) -> Real:
        """Return the angular momentum about the pivot in the world frame, (..., 3), in N m s."""
        return state.to_world(self.body_angular_momentum(state))

    @bindings.compute_soundly
    def gravity_torque(self, state: State) -> Real:
        """Return the torque of gravity about the pivot in the world frame, (..., 3), in N m.

        It is Mgl sin(theta) (cos phi, sin phi, 0), along the line of nodes.
        """
        Mgl = match(self.Mgl, state)
        none = 0.0 * abs(Mgl)
        x, y, z = split(state.to_world(stack(none, none, Mgl)))
        return stack(-y, x, 0.0 * abs(z))

    @overload
    def energy(self: "Top[float]", state: State[float]) -> float: ...

    @overload
    def energy(self: "Top[Real]", state: State) -> Real: ...

    @overload
    def energy(self, state: State[Real]) -> Real: ...

    @bindings.compute_soundly
    def energy(self, state: State) -> Any:
        """Return the kinetic and potential energy, (...), in J; the potential is Mgl cos(theta)."""
        kinetic = (self.body_angular_momentum(state) * state.angular_velocity).sum(axis=-1) / 2
        return kinetic + match(self.Mgl, state) * state.vertical[..., 2]

    @overload
    def axial_momentum(self: "Top[float]", state: State[float]) -> float: ...

    @overload
    def axial_momentum(self: "Top[Real]", state: State) -> Real: ...

    @overload
    def axial_momentum(self, state: State[Real]) -> Real: ...

    @bindings.compute_soundly
    def axial_momentum(self, state: State) -> Any:
        """Return L_z = p_psi = Iz omega_z, (...), in N m s; constant under gravity alone."""
        return match(self.Iz, state) * state.angular_velocity[..., 2]

    @overload
    def vertical_momentum(self: "Top[float]", state: State[float]) -> float: ...

    @overload
    def vertical_momentum(self: "Top[Real]", state: State) -> Real: ...

    @overload
    def vertical_momentum(self, state: State[Real]) -> Real: ...

    @bindings.compute_soundly
    def vertical_momentum(self, state: State) -> Any:
        """Return L_z' = p_phi = L . z', (...), in N m s; constant under gravity alone."""
        return (self.body_angular_momentum(state) * state.vertical).sum(axis=-1)


def _validate_moments(Ix: float, Iz: float, Mgl: float) -> None:
    if Ix <= 0:
        raise refuse("Ix", "> 0 kg m^2", Ix)
    if not 0 < Iz <= 2 * Ix:
        raise refuse("Iz", f"> 0 and <= 2 Ix = {show_limit(2 * Ix)} kg m^2", Iz)
    for name, moment in (("Ix", Ix), ("Iz", Iz)):
        if not SMALLEST_MOMENT <= moment <= LARGEST_MOMENT:
            raise refuse(name, f"{SMALLEST_MOMENT:g} to {LARGEST_MOMENT:g} kg m^2", moment)
    if abs(Mgl) > LARGEST_MOMENT:
        raise refuse("Mgl", f"at most {LARGEST_MOMENT:g} J in size", Mgl)


def match(value: Any, state: State) -> Any:
    """Return a number of one top, or of tops that have the shape of their states; else refuse."""
    states = state.angular_velocity.shape[:-1]
    if not isinstance(value, float) and np.shape(value) != states:
        raise refuse(
            "top and state",
            "one of each for each other (`Motions.energy` and its like take many times)",
            Words(f"shapes {np.shape(value)} and {states}"),
        )
    return value


@dataclass(frozen=True, slots=True, init=False, eq=False)
class Friction(_Numbers, Generic[N]):
    """Friction proportional to the angular velocity, at the pivot and in the air.

    The torque in the body frame is -axial omega_z along the axis and
    -transverse (omega_x, omega_y) across it. A friction is true if a coefficient is not zero.

    Parameters
    ----------
    axial, transverse : float or array_like (...)
        Coefficients in N m s, >= 0.

    Raises
    ------
    ValueError
        If a coefficient is not a finite number >= 0, or if the shapes do not fit together.

    Examples
    --------
    >>> from symtop_ros.physics import Friction, State
    >>> Friction(axial=0.25, transverse=0.5).torque(State((1, 0, 0, 0), (1, 0, 8))).tolist()
    [-0.5, -0.0, -2.0]
    >>> bool(Friction())
    False
    """

    axial: N
    transverse: N

    find_decay = OldName()

    @overload
    def __init__(self: "Friction[float]", axial: float = 0.0, transverse: float = 0.0) -> None: ...

    @overload
    def __init__(self: "Friction[Real]", axial: Many, transverse: ArrayLike = 0.0) -> None: ...

    @overload
    def __init__(self: "Friction[Real]", axial: ArrayLike = 0.0, *, transverse: Many) -> None: ...

    @overload
    def __init__(self: "Friction[Real]", axial: ArrayLike, transverse: Many) -> None: ...

    def __init__(self, axial: ArrayLike = 0.0, transverse: ArrayLike = 0.0) -> None:
        given = {"friction.axial": axial, "friction.transverse": transverse}
        units = ("N m s",) * len(given)
        for name, value in zip(given, validate_together(given, units), strict=True):
            if np.min(value, initial=0.0) < 0:
                raise refuse(name, ">= 0 N m s", float(np.min(value)))
            object.__setattr__(self, name.removeprefix("friction."), value)

    def __bool__(self) -> bool:
        """Return True if a coefficient is not zero."""
        given: Any = self.coefficients
        if self.shape:
            return any(map(np.any, given))
        return any(given)  # asked of every motion

    @property
    def coefficients(self) -> tuple[N, N]:
        """The coefficients in N m s, in the order of the kernel: (axial, transverse)."""
        axial, transverse = (getattr(self, name) for name in FRICTION_KINDS)
        return axial, transverse

    def _find_decay(self, top: Top) -> Any:
        """Return the fastest rate in 1/s, (...), at which friction slows a top."""
        return np.maximum(self.axial / top.Iz, self.transverse / top.Ix)

    @bindings.compute_soundly
    def torque(self, state: State) -> Real:
        """Return the torque of friction in the body frame, (..., 3), in N m."""
        across, along = -match(self.transverse, state), -match(self.axial, state)
        x, y, z = split(state.angular_velocity)
        return stack(x * across, y * across, z * along)
