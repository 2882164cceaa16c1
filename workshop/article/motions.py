"""The article's top, its motions by name, and its equations of motion.

Every start has theta = 0.5 rad, theta' = 0 and psi' = 200 rad/s; the precession rate phi' at the
start decides what follows.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from scipy.optimize import brentq

from symtop_ros.base.arrays import Real
from symtop_ros.physics import (
    Direction,
    Motion,
    State,
    Top,
    regular_precession_rates,
    theta_acceleration,
)

TOP = Top(Ix=0.000228, Iz=0.0000572, Mgl=0.068)
THETA, PSI_DOT = 0.5, 200.0  # rad, rad/s
PRINTED_ROOTS = ("6.50", "69.8")  # rad/s, with the digits that the article gives
SLOW, FAST = regular_precession_rates(TOP, THETA, PSI_DOT)

# A disc that hangs from its pivot and spins backwards: Iz > Ix, Mgl < 0, psi' < 0. At -25 rad/s
# its slow root is as fast as that of the top, so that a hurry lowers the axis by 0.044 rad.
HANGING_DISC = Top(Ix=0.0002, Iz=0.00035, Mgl=-0.05)

# f'(t) = sum of WEIGHTS[k-1] (f(t + k h) - f(t - k h)) / h, exact for polynomials of degree 8.
WEIGHTS = (4 / 5, -1 / 5, 4 / 105, -1 / 280)
STEP = 5e-4  # s; the article's top turns by a tenth of a radian in this time


@dataclass(frozen=True, slots=True)
class Rate:
    """One of the six precession rates that the article compares."""

    phi_dot: float  # precession rate at the start in rad/s
    place: str  # position relative to the two roots of regular precession, in words
    direction: Direction  # the article's statement on the top


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
    """A regular precession that is hurried, to test Perry's rule."""

    psi_dot: float  # spin rate in rad/s
    root: int  # root of regular precession before the kick: 0 for the slow one, 1 for the fast one
    place: str  # the case in words
    direction: Direction  # the article's statement on the hurried top
    disc: Top | None = None  # instead of the article's top

    def begin(self, top: Top = TOP) -> Motion:
        """Return the regular precession before the kick."""
        moved = self.disc or top
        rate = regular_precession_rates(moved, THETA, self.psi_dot)[self.root]
        return Motion(moved, start(rate, self.psi_dot))


PLACE_OF_DISC = "at the slow root for psi' < 0, Mgl < 0, Iz > Ix and theta < pi/2"
HURRIED = {
    "slow_root": HurryCase(PSI_DOT, 0, "at the slow root", "rises"),
    "fast_root": HurryCase(PSI_DOT, 1, "at the fast root", "falls"),
    "disc": HurryCase(-25.0, 0, PLACE_OF_DISC, "falls", HANGING_DISC),
}


@dataclass(frozen=True, slots=True)
class KickedMotion:
    """A motion that may be kicked: its pieces, each from its start to that of the next."""

    # the time in s at which each motion begins, ascending from 0, and the motion from there
    pieces: tuple[tuple[float, Motion], ...]

    @classmethod
    def of(cls, motion: Motion) -> "KickedMotion":
        """Return a motion that is not kicked."""
        return cls(((0.0, motion),))

    def kick(self, time: float, change: Callable[[State], State]) -> "KickedMotion":
        """Return the motion with a kick at a time in s, after all other kicks."""
        begin, motion = self.pieces[-1]
        return self._follow(time, Motion(motion.top, change(motion.at(time - begin))))

    def clamp(self, time: float) -> "KickedMotion":
        """Return the motion whose precession is held from a time in s on."""
        begin, motion = self.pieces[-1]
        return self._follow(time, Motion(motion.top, motion.at(time - begin), clamped=True))

    def _follow(self, time: float, after: Motion) -> "KickedMotion":
        return KickedMotion((*self.pieces, (time, after)))

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
    """Return the start with theta = 0.5 rad, theta' = 0 and these rates in rad/s."""
    return State.from_euler(theta=THETA, phi_dot=phi_dot, psi_dot=psi_dot)


def cusps(top: Top = TOP) -> Motion:
    """Return the motion of a top whose axis is released at rest."""
    return Motion(top, start(0.0))


def regular(top: Top = TOP) -> Motion:
    """Return the motion that starts at the slow root of the article's top, where it is regular."""
    return Motion(top, start(SLOW))


Maker = Callable[[Top], Motion]  # `cusps` or `regular`


def draw_top(random: np.random.Generator, top: Top) -> Top:
    """Return a random top with the Ix of a given one, and a weight of either sign."""
    Iz = random.uniform(0.1, 1.9)
    weight = random.uniform(20.0, 200.0) * random.choice([-1, 1])
    return Top(top.Ix, Iz * top.Ix, weight * top.Ix)


def seven_motions(top: Top = TOP) -> list[Motion]:
    """Return the motions of the six rates, then cusps."""
    return [*(Motion(top, start(rate.phi_dot)) for rate in RATES), cusps(top)]


def first_turn(motion: Motion) -> float:
    """Return the time in s at which phi has first grown or fallen by 2 pi.

    A nutation that does not fit into a turn puts it off the `precession_period`, which is a mean.
    """
    times = np.linspace(0.0, 1.5 * motion.precession_period, 6001)
    phi = np.unwrap(motion.at(times).euler_angles.phi)
    k = int(np.argmax(np.abs(phi - phi[0]) >= 2 * np.pi))

    def missing(t: float) -> float:
        return math.remainder(float(motion.at(t).euler_angles.phi) - float(phi[0]), 2 * math.pi)

    # One step more on each side: a sample may lie on the turn to rounding.
    return float(brentq(missing, times[k - 2], times[k + 1], xtol=1e-15))


def accelerations(top: Top, states: State) -> Real:
    """Return phi'', theta'', psi'' (n, 3) in rad/s^2 of n states by the article's equations.

    The equations divide by sin(theta), so the states must not be on the vertical.
    """
    theta = states.euler_angles.theta
    phi_dot, theta_dot, psi_dot = states.euler_rates
    gyration = top.Iz * psi_dot + (top.Iz - 2 * top.Ix) * phi_dot * np.cos(theta)
    phi = theta_dot / (top.Ix * np.sin(theta)) * gyration
    psi = theta_dot / top.Ix * (top.Ix * phi_dot * np.sin(theta) - gyration / np.tan(theta))
    return np.stack([phi, theta_acceleration(top, theta, phi_dot, psi_dot), psi], axis=-1)


def slope(function: Callable[[Real], Real], times: Real, step: float = STEP) -> Real:
    """Differentiate a function at n times by central differences of order 8."""
    total = np.zeros_like(function(times))
    for k, weight in enumerate(WEIGHTS, start=1):
        total += weight * (function(times + k * step) - function(times - k * step))
    return total / step


def measure_acceleration(motion: Motion, share: float | None = None) -> float:
    """Return theta'' in rad/s^2 at the start of a motion, by differentiating theta'.

    The step is `STEP`, or a share of the nutation period.
    """
    step = STEP if share is None else share * motion.nutation_period
    found = slope(lambda t: np.asarray(motion.at(t).euler_rates.theta_dot), np.zeros(1), step)
    return float(found[0])
