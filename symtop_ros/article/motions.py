"""The article's top, its motions by name, and its equations of motion.

Every start has theta = 0.5 rad, theta' = 0 and psi' = 200 rad/s; the precession rate phi' at the
start decides what follows.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from symtop_ros.physics import (
    Direction,
    Motion,
    State,
    Top,
    regular_precession_rates,
    theta_acceleration,
)

Real = NDArray[np.float64]
TOP = Top(Ix=0.000228, Iz=0.0000572, Mgl=0.068)
THETA, PSI_DOT = 0.5, 200.0  # rad, rad/s
PRINTED_ROOTS = ("6.50", "69.8")  # rad/s, with the digits that the article gives
SLOW, FAST = regular_precession_rates(TOP, THETA, PSI_DOT)

# A disc that hangs from its pivot and spins backwards: Iz > Ix, Mgl < 0, psi' < 0.
HANGING_DISC = Top(Ix=0.0002, Iz=0.00035, Mgl=-0.05)

# f'(t) = sum of WEIGHTS[k-1] (f(t + k h) - f(t - k h)) / h, exact for polynomials of degree 8.
WEIGHTS = (4 / 5, -1 / 5, 4 / 105, -1 / 280)
STEP = 5e-4  # s; the article's top turns by a tenth of a radian in this time


@dataclass(frozen=True, slots=True)
class Rate:
    """One of the six precession rates that the article compares.

    Attributes
    ----------
    phi_dot : float
        Precession rate at the start in rad/s.
    place : str
        Position relative to the two roots of regular precession, in words.
    direction : {"rises", "falls", "stays"}
        The article's statement on the top.

    Examples
    --------
    >>> RATES[0].direction
    'falls'
    """

    phi_dot: float
    place: str
    direction: Direction


RATES = (
    Rate(3.0, "below the slow root", "falls"),
    Rate(SLOW, "at the slow root", "stays"),
    Rate(9.0, "between the roots, near the slow one", "rises"),
    Rate(67.0, "between the roots, near the fast one", "rises"),
    Rate(FAST, "at the fast root", "stays"),
    Rate(73.0, "above the fast root", "falls"),
)


@dataclass(frozen=True, slots=True)
class HurryCase:
    """A regular precession that is hurried, to test Perry's rule.

    Attributes
    ----------
    psi_dot : float
        Spin rate in rad/s.
    root : int
        Root of regular precession before the kick: 0 for the slow one, 1 for the fast one.
    place : str
        The case in words.
    direction : {"rises", "falls"}
        The article's statement on the hurried top.

    Examples
    --------
    >>> FAST_ROOT_HURRIED.direction
    'falls'
    """

    psi_dot: float
    root: int
    place: str
    direction: Direction


SLOW_ROOT_HURRIED = HurryCase(PSI_DOT, 0, "at the slow root", "rises")
FAST_ROOT_HURRIED = HurryCase(PSI_DOT, 1, "at the fast root", "falls")
DISC_HURRIED = HurryCase(
    -120.0, 0, "at the slow root for psi' < 0, Mgl < 0, Iz > Ix and theta < pi/2", "falls"
)


@dataclass(frozen=True, slots=True)
class Run:
    """A motion that may be kicked: motions, each from its begin to that of the next.

    Attributes
    ----------
    pieces : tuple of (float, Motion)
        The time in s at which each motion begins, ascending from 0, and the motion from there.

    Examples
    --------
    >>> run = Run.of(regular()).kick(0.5, lambda state: state)
    >>> [begin for begin, _ in run.pieces]
    [0.0, 0.5]
    """

    pieces: tuple[tuple[float, Motion], ...]

    @classmethod
    def of(cls, motion: Motion) -> Run:
        """Return the run of a motion that is not kicked."""
        return cls(((0.0, motion),))

    def kick(self, time: float, change: Callable[[State], State]) -> Run:
        """Return the run whose state is changed at a time in s, after all other kicks."""
        begin, motion = self.pieces[-1]
        after = Motion(motion.top, change(motion.at(time - begin)))
        return Run((*self.pieces, (time, after)))

    def at(self, times: Real) -> State:
        """Return the states (n,) at times in s, in ascending order from 0."""
        begins = [begin for begin, _ in self.pieces]
        owners = np.searchsorted(begins, times, side="right") - 1
        parts = [
            motion.at(times[owners == k] - begin) for k, (begin, motion) in enumerate(self.pieces)
        ]
        return State(
            np.concatenate([part.orientation for part in parts]),
            np.concatenate([part.angular_velocity for part in parts]),
        )


def start(phi_dot: float, psi_dot: float = PSI_DOT) -> State:
    """Return the start with theta = 0.5 rad, theta' = 0 and these rates in rad/s.

    Examples
    --------
    >>> start(phi_dot=9.0).euler_rates.phi
    9.0
    """
    return State.from_euler(theta=THETA, phi_dot=phi_dot, psi_dot=psi_dot)


def cusps(top: Top = TOP) -> Motion:
    """Return the motion of a top whose axis is released at rest.

    Examples
    --------
    >>> cusps().kind
    'cusps'
    """
    return Motion(top, start(0.0))


def regular(top: Top = TOP) -> Motion:
    """Return the motion that starts at the slow root of the article's top, where it is regular.

    Examples
    --------
    >>> regular().kind
    'regular'
    """
    return Motion(top, start(SLOW))


def seven_motions(top: Top = TOP) -> list[Motion]:
    """Return the motions of the six rates, then cusps.

    Examples
    --------
    >>> len(seven_motions())
    7
    """
    return [*(Motion(top, start(rate.phi_dot)) for rate in RATES), cusps(top)]


def precession_period(motion: Motion) -> float:
    """Return the time in s of one turn of the precession.

    Examples
    --------
    >>> print(f"{precession_period(regular()):.3f} s")
    0.967 s
    """
    return float(2 * np.pi / abs(motion.mean_precession_rate))


def accelerations(top: Top, states: State) -> Real:
    """Return phi'', theta'', psi'' (n, 3) in rad/s^2 of n states by the article's equations.

    The equations divide by sin(theta), so the states must not be on the vertical.

    Examples
    --------
    >>> accelerations(TOP, cusps().at([0.01, 0.02])).shape
    (2, 3)
    """
    theta = states.euler_angles.theta
    phi_dot, theta_dot, psi_dot = states.euler_rates
    gyration = top.Iz * psi_dot + (top.Iz - 2 * top.Ix) * phi_dot * np.cos(theta)
    phi = theta_dot / (top.Ix * np.sin(theta)) * gyration
    psi = theta_dot / top.Ix * (top.Ix * phi_dot * np.sin(theta) - gyration / np.tan(theta))
    return np.stack([phi, theta_acceleration(top, theta, phi_dot, psi_dot), psi], axis=-1)


class Slope(NamedTuple):
    """Numerical derivatives.

    Attributes
    ----------
    values : ndarray (n, ...)
        Derivatives at n times, in units of the function per s.
    error : float
        Largest change of the values when the step is doubled.

    Examples
    --------
    >>> slope(np.square, np.array([3.0])).values.round(9)
    array([6.])
    """

    values: Real
    error: float


def slope(function: Callable[[Real], Real], times: Real, step: float = STEP) -> Slope:
    """Differentiate a function by central differences of order 8.

    Parameters
    ----------
    function : callable
        Takes times (n,) in s, returns values (n, ...).
    times : ndarray (n,)
        In s.
    step : float
        In s.

    Examples
    --------
    >>> found = slope(np.sin, np.array([0.0, 0.1]))
    >>> bool(abs(found.values - np.cos([0.0, 0.1])).max() < 1e-10)
    True
    """
    fine, coarse = _difference(function, times, step), _difference(function, times, 2 * step)
    return Slope(fine, float(np.abs(coarse - fine).max()))


def _difference(function: Callable[[Real], Real], times: Real, step: float) -> Real:
    total = np.zeros_like(function(times))
    for k, weight in enumerate(WEIGHTS, start=1):
        total += weight * (function(times + k * step) - function(times - k * step))
    return total / step
