"""The motion of a top from a start: the state at any time, and what is constant about it."""

from __future__ import annotations

import math
from typing import Literal, Protocol

import numpy as np
from numpy.typing import ArrayLike, NDArray

from symtop_ros.physics.closed_form import HeavyMotion
from symtop_ros.physics.free import FreeMotion
from symtop_ros.physics.friction import Friction
from symtop_ros.physics.kind import Kind
from symtop_ros.physics.nutation import Four
from symtop_ros.physics.split_motion import SplitMotion
from symtop_ros.physics.splitting import Three
from symtop_ros.physics.state import State
from symtop_ros.physics.top import Top

Real = NDArray[np.float64]
Complex = NDArray[np.complex128]

BLOCK = 4096  # times evaluated at once: the intermediate arrays then stay in the cache
NO_FRICTION, NO_TORQUE = Friction(), (0.0, 0.0, 0.0)
WEIGHTLESS = 1e-200  # of the kinetic energy: weight that no phase can tell from none


class Engine(Protocol):
    """A solved motion with Mgl >= 0."""

    @property
    def kind(self) -> Kind:
        """Name of the motion."""

    def parameters(self, t: Real) -> Complex:
        """A, B and omega_x + i omega_y (3, n) at times t (n,) in s."""

    @property
    def nutation_period(self) -> float:
        """Period of theta in s."""

    @property
    def turning_angles(self) -> tuple[float, float]:
        """Smallest and largest theta in rad."""

    @property
    def mean_rates(self) -> tuple[float, float]:
        """Mean phi' and psi' in rad/s."""


class Motion:
    """The motion of `top` that starts from `start`: see `motion`.

    Under friction or an applied torque kind, turning angles, nutation period and mean rates are
    those at the start: of the motion that would go on from there without.

    Attributes
    ----------
    top : Top
    start : State
        The state at t = 0.
    friction : Friction
    applied_torque : (3,) of float
        In the world frame, N m.
    engine : {"closed form", "elementary", "splitting"}
        Elliptic functions; circular ones where Mgl is 0 or the axis rests on the vertical; small
        steps under friction or an applied torque.
    """

    engine: Literal["closed form", "elementary", "splitting"]

    def __init__(
        self,
        top: Top,
        start: State,
        friction: Friction = NO_FRICTION,
        torque: Three = NO_TORQUE,
    ) -> None:
        if start.orientation.ndim != 1:
            msg = f"start: got {start.orientation.shape[0]} states, allowed is one"
            raise ValueError(msg)
        self.top = top
        self.start = start
        self._mirrored = top.Mgl < 0  # solved with the world turned by pi about x'
        w, x, y, z = (float(part) for part in start.orientation)
        wx, wy, wz = (float(rate) for rate in start.angular_velocity)
        orientation: Four = (-x, w, -z, y) if self._mirrored else (w, x, y, z)
        moments = (top.Ix, top.Iz, abs(top.Mgl))
        resting = wx == wy == 0 and (w == z == 0 or x == y == 0)
        weightless = abs(top.Mgl) <= WEIGHTLESS * top.Ix * max(abs(wx), abs(wy), abs(wz)) ** 2
        solver = FreeMotion if resting or weightless else HeavyMotion
        self._engine: Engine = solver(moments, orientation, (wx, wy, wz))
        self.engine = "elementary" if solver is FreeMotion else "closed form"
        self.friction, self.applied_torque = friction, torque
        self._split: SplitMotion | None = None
        if self.driven:
            self._split = SplitMotion(top, start, friction, torque)
            self.engine = "splitting"

    @property
    def driven(self) -> bool:
        """Whether friction or an applied torque acts."""
        return bool(self.friction) or any(self.applied_torque)

    def at(self, t: ArrayLike) -> State:
        """Return the state at one time, or the states at many.

        Parameters
        ----------
        t : float or array_like (n,)
            Time since the start in s, any finite number of either sign. Under friction or an
            applied torque the cost grows with it: about 0.2 ms for each radian of nutation.

        Returns
        -------
        State
            orientation (4,) and angular_velocity (3,), or (n, 4) and (n, 3).
        """
        times = np.asarray(t, dtype=float)
        if not np.isfinite(times).all():
            msg = f"t: got {t!r}, allowed are finite times in s"
            raise ValueError(msg)
        flat = times.reshape(-1)
        orientation = np.empty((flat.size, 4))
        angular_velocity = np.empty((flat.size, 3))
        if self._split:
            self._split.fill(flat, orientation, angular_velocity)
        else:
            self._fill(flat, orientation, angular_velocity)
        shape = times.shape
        return State.unchecked(orientation.reshape(*shape, 4), angular_velocity.reshape(*shape, 3))

    def reach(self, t: float, steps: float) -> float:
        """Prepare the states up to a time.

        Parameters
        ----------
        t : float
            In s.
        steps : float
            How many steps may be spent on it; the exact engines need none.

        Returns
        -------
        float
            The time up to which `at` now answers at once, t or nearer to the start.
        """
        return self._split.reach(t, steps) if self._split else t

    def _fill(self, t: Real, orientation: Real, angular_velocity: Real) -> None:
        angular_velocity[:, 2] = self.start.angular_velocity[2]
        for first in range(0, t.size, BLOCK):
            block = slice(first, first + BLOCK)
            self._fill_block(t[block], orientation[block], angular_velocity[block])

    def _fill_block(self, t: Real, orientation: Real, angular_velocity: Real) -> None:
        A, B, across = self._engine.parameters(t)
        if self._mirrored:
            A, B = B.conj(), -A.conj()
        orientation[:, 0], orientation[:, 3] = A.real, A.imag
        orientation[:, 1], orientation[:, 2] = B.real, B.imag
        angular_velocity[:, 0], angular_velocity[:, 1] = across.real, across.imag

    def torque(self, state: State) -> Real:
        """All torque about the pivot at a state in the world frame, (..., 3), N m.

        Gravity's, friction's and the applied one.
        """
        torque = self.top.torque(state)
        return torque + self.driving_torque(state) if self.driven else torque

    def driving_torque(self, state: State) -> Real:
        """What friction and the applied torque add to gravity's, (..., 3), N m."""
        return state.to_world(self.friction.torque(state)) + self.applied_torque

    @property
    def kind(self) -> Kind:
        """What phi' does at the two turning angles, in a word.

        "regular" (they are equal), "unidirectional" (same sign), "cusps" (zero at one), "looping"
        (opposite), "through the pole", "spiralling" (towards the vertical, for ever) or "sleeping"
        (the axis rests on the vertical).
        """
        return self._engine.kind

    @property
    def nutation_period(self) -> float:
        """Period of theta in s; infinite for a motion that does not come back, or rests."""
        return self._engine.nutation_period

    @property
    def turning_angles(self) -> tuple[float, float]:
        """Smallest and largest theta in rad."""
        low, high = self._engine.turning_angles
        return (math.pi - high, math.pi - low) if self._mirrored else (low, high)

    @property
    def mean_precession_rate(self) -> float:
        """Mean phi' over a nutation in rad/s; nan for an axis at rest on the vertical."""
        rate = self._engine.mean_rates[0]
        return -rate if self._mirrored else rate

    @property
    def mean_spin_rate(self) -> float:
        """Mean psi' over a nutation in rad/s; nan for an axis at rest on the vertical."""
        return self._engine.mean_rates[1]


def motion(
    top: Top,
    start: State,
    friction: Friction = NO_FRICTION,
    torque: ArrayLike = NO_TORQUE,
) -> Motion:
    """Return the motion of a top from a state.

    Without friction and an applied torque it is exact for any time.

    Parameters
    ----------
    top : Top
    start : State
        One state, at t = 0.
    friction : Friction
        At the pivot and in the air.
    torque : array_like (3,)
        Applied torque in the world frame, constant, in N m.

    Examples
    --------
    >>> top = Top(Ix=0.000228, Iz=0.0000572, Mgl=0.068)
    >>> path = motion(top, State.from_euler(theta=0.5, psi_dot=200.0))
    >>> path.kind
    'cusps'
    >>> theta = path.at(10.0).euler_angles.theta
    """
    return Motion(top, start, friction, _checked(torque))


def _checked(torque: ArrayLike) -> Three:
    try:
        x, y, z = np.asarray(torque, dtype=float).tolist()
    except (TypeError, ValueError):
        x = y = z = math.nan
    if not (math.isfinite(x) and math.isfinite(y) and math.isfinite(z)):
        msg = f"torque: got {torque!r}, allowed are 3 finite numbers (N m, world)"
        raise ValueError(msg)
    return x, y, z
