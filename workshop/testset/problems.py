"""The seventy problems of the test set: tops, starts and times, from easy to hard.

Starts have six digits, so that they can be copied by hand, or a few more where a distance of 1e-9
counts. Regular precession, merging roots and the critical spin need all digits of a double.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from symtop_ros.physics import Body, State, Top
from workshop.article.motions import FAST, SLOW, TOP

UNIT = Top(1.0, 0.5, 1.0)
DISC = Top(0.0002, 0.00035, 0.05)
# The body of Brüls, Cardona and Arnold 2012; its axis is y there.
CARDONA = Body(mass=15.0, arm=1.0, Ix=0.234375, Iz=0.46875, gravity=9.81)
# Bodies of the gentle level: all numbers are exact in doubles, and in single precision but for g.
STICK = Body(mass=2.0, arm=0.25, Ix=0.125, Iz=0.125, gravity=9.81)
DISH = Body(mass=2.0, arm=0.125, Ix=0.09375, Iz=0.1875, gravity=9.81)
KNOWN = {each.top: each for each in (CARDONA, STICK, DISH)}
SMALL = Top(2.0e-12, 1.5e-12, 3.0e-9)
LARGE = Top(3.0e6, 1.0e6, 4.0e7)
UP, DOWN = (1.0, 0.0, 0.0, 0.0), (0.0, 1.0, 0.0, 0.0)
HALF = (0.5, 0.5, 0.5, 0.5)  # theta = pi/2, a unit quaternion without rounding
ALONG_Y = (0.5, -0.5, -0.5, -0.5)  # x, y, z of the body along z, x, y of the world
COUNT = 20  # times of each problem


@dataclass(frozen=True)
class Setting:
    """A problem without its solution.

    `level` is 0 (gentle: two seconds at 10 rad/s), 1 (slow), 2 (an ordinary top), 3 (fast, or of
    an unusual shape), 4 (at the vertical) or 5 (close to a separatrix, critical, or long);
    `has_period` is False if theta does not swing.
    """

    level: int
    name: str
    what: str
    top: Top
    start: State
    duration: float  # s
    has_period: bool = True

    @property
    def body(self) -> Body:
        """The body that has a name here, or the one that the package chooses."""
        return KNOWN.get(self.top) or Body.of(self.top)

    @property
    def times(self) -> list[float]:
        """Times of the exact states, in s."""
        return [self.duration * k / COUNT for k in range(1, COUNT + 1)]


def euler(theta: float, **others: float) -> State:
    """A start with these Euler angles and rates, in decimals of six digits."""
    start = State.from_euler(theta=theta, **others)
    return State(*([float(f"{x:.6g}") for x in part] for part in start.parts))


def article(phi_dot: float) -> State:
    """Return a start of the article's top."""
    return euler(0.5, phi_dot=phi_dot, psi_dot=200.0)


def regular(phi_dot: float, psi_dot: float = 200.0) -> State:
    """A start of the article's top whose every bit counts."""
    return State.from_euler(theta=0.5, phi_dot=phi_dot, psi_dot=psi_dot)


def spinning(theta: float, factor: float, digits: int = 10) -> State:
    """A start at rest that spins at a multiple of the critical spin."""
    spin = float(f"{TOP.critical_spin * factor:.{digits}g}")
    return State(euler(theta).given_orientation, (0.0, 0.0, spin))


def pendulum(theta_dot: float) -> State:
    """Return a horizontal start of a pendulum."""
    return State(HALF, (-float(f"{theta_dot:.12g}"), 0.0, 0.0))


ROOT = math.sqrt(2.0)  # theta' of UNIT at theta = pi/2 from which the axis comes to rest on top

SETTINGS = [
    Setting(0, "gentle_cusps", "a dish, let go", DISH.top, euler(0.5, psi_dot=10.0), 2),
    Setting(
        0, "gentle_looping", "pushed backwards", DISH.top, euler(0.8, phi_dot=-2.0, psi_dot=10.0), 2
    ),
    Setting(0, "gentle_fall", "a stick too slow to stand", STICK.top, euler(0.2, psi_dot=10.0), 2),
    Setting(0, "gentle_pendulum", "no spin, let go", STICK.top, euler(2.0), 2),
    Setting(
        0,
        "gentle_hanging",
        "below the pivot",
        STICK.top,
        euler(2.6, phi_dot=3.0, psi_dot=10.0),
        2,
    ),
    Setting(0, "gentle_pole", "passes upright", DISH.top, State(UP, (2.0, 0.0, 10.0)), 2),
    Setting(
        0, "gentle_free", "no weight", Top(0.125, 0.1875, 0.0), State(HALF, (2.0, 0.0, 10.0)), 2
    ),
    Setting(1, "plane_pendulum", "no spin, let go", UNIT, euler(1.0), 20),
    Setting(1, "pendulum_hanging", "no spin, below the pivot", UNIT, euler(2.5, phi=0.3), 20),
    Setting(1, "spherical_pendulum", "no spin", UNIT, euler(2.0, phi_dot=0.8), 20),
    Setting(1, "hanging_top", "slow spin", UNIT, euler(2.8, psi_dot=3.0), 20),
    Setting(1, "falling_top", "spins too slowly to stand", UNIT, euler(0.1, psi_dot=1.0), 20),
    Setting(1, "sphere", "Iz = Ix", Top(1.0, 1.0, 1.0), euler(1.0, phi_dot=0.5, psi_dot=2.0), 20),
    Setting(1, "free_rod", "no weight, Iz < Ix", Top(1.0, 0.5, 0.0), State(HALF, (0.5, 0, 2)), 20),
    Setting(
        1, "free_disc", "no weight, Iz = 2 Ix", Top(1.0, 2.0, 0.0), State(HALF, (0.5, 0, 2)), 20
    ),
    Setting(1, "light", "a weight of 1e-9 J", Top(1.0, 0.5, 1e-9), euler(1.0, psi_dot=2.0), 20),
    Setting(
        1, "below", "the same above and below", Top(1.0, 0.5, -1.0), euler(0.7, psi_dot=4.0), 20
    ),
    Setting(2, "cusps", "the article's top, let go", TOP, article(0.0), 10),
    Setting(2, "slow_precession", "regular, slow root", TOP, regular(SLOW), 10, False),
    Setting(2, "fast_precession", "regular, fast root", TOP, regular(FAST), 10, False),
    Setting(2, "rising", "between both roots", TOP, article(20.0), 10),
    Setting(2, "looping", "pushed backwards", TOP, article(-15.0), 10),
    Setting(2, "hurried", "1.4 times the slow root", TOP, article(9.1), 10),
    Setting(2, "very_hurried", "beyond the fast root", TOP, article(90.0), 10),
    Setting(2, "nodding", "theta' at the start", TOP, euler(0.8, theta_dot=5.0, psi_dot=180.0), 10),
    Setting(2, "low", "tilted below the pivot", TOP, euler(2.2, phi_dot=4.0, psi_dot=120.0), 10),
    Setting(
        2,
        "heavy_top",
        "15 kg at 1 m, of Brüls, Cardona and Arnold",
        CARDONA.top,
        State(ALONG_Y, (-4.61538, 0.0, 150.0)),
        10,
    ),
    Setting(3, "disc", "Iz > Ix", DISC, euler(0.6, phi_dot=2.0, psi_dot=120.0), 10),
    Setting(3, "flat_disc", "Iz = 1.99 Ix", Top(1.0, 1.99, 2.0), euler(1.2, psi_dot=12.0), 10),
    Setting(
        3,
        "perry_fails",
        "Iz > Ix, hangs, spins back",
        Top(0.0002, 0.00035, -0.05),
        euler(0.5, phi_dot=1.2, psi_dot=-120.0),
        10,
    ),
    Setting(3, "rod", "Iz = Ix/20", Top(1.0, 0.05, 1.0), euler(0.9, psi_dot=100.0), 10),
    Setting(3, "needle", "Iz = Ix/1000", Top(1.0, 0.001, 1.0), euler(0.9, psi_dot=4000.0), 10),
    Setting(3, "spin_1000", "1000 rad/s", TOP, euler(0.5, theta_dot=3.0, psi_dot=1e3), 10),
    Setting(3, "spin_10000", "10 000 rad/s", TOP, euler(0.5, theta_dot=3.0, psi_dot=1e4), 2),
    Setting(3, "tumbling", "faster across than along", TOP, euler(1.0, theta_dot=300.0), 5),
    Setting(3, "small", "a mass of 0.15 mg", SMALL, euler(0.7, psi_dot=300.0), 10),
    Setting(3, "large", "a mass of 13 000 t", LARGE, euler(0.7, phi_dot=0.2, psi_dot=30.0), 10),
    # Integrators that damp or drive free bodies change the angle between axis and momentum here.
    Setting(
        3,
        "free_rod_fast",
        "no weight, Iz = Ix/10",
        Top(1.0, 0.1, 0.0),
        State(HALF, (6.0, 0.0, 20.0)),
        10,
    ),
    Setting(
        3,
        "free_disc_fast",
        "no weight, Iz = 1.9 Ix",
        Top(1.0, 1.9, 0.0),
        State(HALF, (3.0, 0.0, 20.0)),
        10,
    ),
    Setting(
        3,
        "free_somersault",
        "no weight, faster across than along",
        Top(1.0, 0.05, 0.0),
        State(HALF, (20.0, 0.0, 10.0)),
        10,
    ),
    Setting(4, "upper_pole", "passes upright", TOP, State(UP, (20.0, 0.0, 150.0)), 10),
    Setting(4, "lower_pole", "passes hanging", TOP, State(DOWN, (20.0, 0.0, 150.0)), 10),
    Setting(
        4,
        "upper_pole_near",
        "misses upright by 1e-6",
        TOP,
        euler(1e-6, theta_dot=20.0, psi_dot=150.0),
        10,
    ),
    Setting(
        4,
        "lower_pole_near",
        "misses hanging by 1e-6",
        TOP,
        euler(math.pi - 1e-6, theta_dot=20.0, psi_dot=150.0),
        10,
    ),
    Setting(4, "whirling", "a pendulum that goes over the top", UNIT, pendulum(3.0), 20, False),
    Setting(
        4, "sleeping", "upright, and nothing else", TOP, State(UP, (0.0, 0.0, 200.0)), 10, False
    ),
    Setting(4, "sleeping_1e-3", "a tilt of 1e-3", TOP, euler(1e-3, psi_dot=200.0), 10),
    Setting(4, "sleeping_1e-9", "a tilt of 1e-9", TOP, euler(1e-9, psi_dot=200.0), 10),
    Setting(
        4, "hanging_1e-9", "a tilt of 1e-9 below", TOP, euler(math.pi - 1e-9, psi_dot=200.0), 10
    ),
    Setting(
        4,
        "pole_unit",
        "passes upright, p_phi = p_psi",
        Top(1.0, 0.5, 3.0),
        State(HALF, (3.0, 2.0, 4.0)),
        20,
    ),
    Setting(5, "waking_1e-3", "too slow to sleep, 1e-3", TOP, euler(1e-3, psi_dot=100.0), 5),
    Setting(5, "waking_1e-6", "too slow to sleep, 1e-6", TOP, euler(1e-6, psi_dot=100.0), 5),
    Setting(5, "waking_1e-12", "too slow to sleep, 1e-12", TOP, euler(1e-12, psi_dot=100.0), 5),
    Setting(5, "critical", "critical spin", TOP, spinning(1e-3, 1.0, 17), 10),
    Setting(5, "above_critical", "1e-6 above", TOP, spinning(1e-3, 1 + 1e-6), 10),
    Setting(5, "below_critical", "1e-6 below", TOP, spinning(1e-3, 1 - 1e-6), 10),
    Setting(
        5,
        "separatrix",
        "approaches upright for ever, exact in doubles",
        Top(1.0, 0.5, 0.5),
        State(HALF, (-1.0, 0.0, 0.0)),
        10,
        False,
    ),
    Setting(
        5,
        "separatrix_spinning",
        "the same with spin, exact in doubles",
        Top(1.0, 0.5, 0.625),
        State(HALF, (-1.0, 0.5, 1.0)),
        10,
        False,
    ),
    Setting(5, "nearly_over", "1e-3 too slow for the top", UNIT, pendulum(ROOT * (1 - 1e-3)), 20),
    Setting(5, "nearly_over_1e-9", "1e-9 too slow", UNIT, pendulum(ROOT * (1 - 1e-9)), 20),
    Setting(5, "barely_over_1e-9", "1e-9 too fast", UNIT, pendulum(ROOT * (1 + 1e-9)), 20, False),
    Setting(5, "balanced_1e-6", "a pendulum let go 1e-6 from the top", UNIT, euler(1e-6), 40),
    Setting(
        5,
        "merging_roots",
        "slow and fast root nearly equal",
        TOP,
        regular(
            27.5,
            2.0 * math.sqrt((TOP.Ix - TOP.Iz) * TOP.Mgl * math.cos(0.5)) / TOP.Iz * (1 + 1e-9),
        ),
        10,
    ),
    Setting(5, "nearly_regular", "1e-9 beside the slow root", TOP, regular(SLOW * (1 + 1e-9)), 10),
    Setting(5, "cusps_100", "the article's top, 100 s", TOP, article(0.0), 100),
    Setting(5, "cusps_1000", "the article's top, 1000 s", TOP, article(0.0), 1000),
    Setting(5, "cusps_100000", "the article's top, a day and more", TOP, article(0.0), 100000),
    Setting(5, "looping_1000", "the article's top, 1000 s", TOP, article(-15.0), 1000),
    Setting(5, "pendulum_10000", "no spin, 1000 swings and more", UNIT, euler(2.0), 10000),
    Setting(
        5,
        "heavy_top_1000",
        "the same for 1000 s",
        CARDONA.top,
        State(ALONG_Y, (-4.61538, 0.0, 150.0)),
        1000,
    ),
]
