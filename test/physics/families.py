"""Random motions of twenty families: ordinary ones, and those next to what is singular."""

import math
from collections.abc import Callable

from drawn import Numbers, cos, sin, sqrt
from physics.tops import FAMILIES, random_case

from symtop_ros.physics import Motion, State, Top, regular_precession_rates

# A top, its start, and a time in units of 1/swing, a swing being sqrt(|Mgl|/Ix).
Draw = tuple[Top, State, float]
FARTHEST = 0.99  # of `Motion.farthest_time`


class Ordinary:
    """Numbers of an ordinary motion, which each family changes."""

    def __init__(self, rng: Numbers) -> None:
        self.rng = rng
        self.Ix = rng.power(-6, 1)
        ratio = rng.choice([rng.uniform(0.01, 2), 1.0, 2.0, rng.power(-6, 0)])
        self.Iz = self.Ix * ratio
        self.Mgl = self.Ix * rng.power(0, 4) * self.sign()
        self.swing = sqrt(abs(self.Mgl) / self.Ix)
        self.spin = self.sign() * self.swing / ratio * rng.power(-1, 2)
        self.across = self.swing * rng.power(-2, 1)
        self.tilt = rng.uniform(0, math.pi)
        self.t = self.sign() * rng.power(-2, 6) / self.swing

    def sign(self) -> int:
        return self.rng.choice([-1, 1])

    @property
    def top(self) -> Top:
        return Top(self.Ix, self.Iz, self.Mgl)

    def lean(self) -> tuple[float, ...]:
        """Return a quaternion with the tilt."""
        c, s = cos(self.tilt / 2), sin(self.tilt / 2)
        plus, minus = self.rng.uniform(-3, 3), self.rng.uniform(-3, 3)
        return c * cos(plus), s * cos(minus), s * sin(minus), c * sin(plus)

    def finish(self) -> Draw:
        """Return the motion, with the rates across the axis in any direction."""
        angle = self.rng.uniform(-3, 3)
        rates = self.across * cos(angle), self.across * sin(angle), self.spin
        return self.top, State(self.lean(), rates), self.t

    def stand(self) -> tuple[float, ...]:
        """Return a quaternion whose axis is exactly on the vertical."""
        c, s = cos(self.spin), sin(self.spin)
        return self.rng.choice([(c, 0.0, 0.0, s), (0.0, c, s, 0.0)])


def draw_generic(one: Ordinary) -> Draw:
    return one.finish()


def draw_hanging(one: Ordinary) -> Draw:
    one.Mgl = -abs(one.Mgl)
    return one.finish()


def draw_flat(one: Ordinary) -> Draw:
    one.Iz = one.Ix * one.rng.uniform(1.0, 2.0)
    return one.finish()


def draw_near_the_top(one: Ordinary) -> Draw:
    one.tilt = one.rng.power(-14, -2)
    one.across *= one.rng.choice([0, 1e-9, one.tilt])
    return one.finish()


def draw_near_the_bottom(one: Ordinary) -> Draw:
    one.tilt = math.pi - one.rng.power(-14, -2)
    one.across *= one.rng.choice([0, 1e-9, 1])
    return one.finish()


def draw_through_a_pole(one: Ordinary) -> Draw:
    rates = one.across, -one.across * one.rng.random(), one.spin * one.rng.choice([0, 1])
    return one.top, State(one.stand(), rates), one.t


def draw_near_the_separatrix(one: Ordinary) -> Draw:
    """Upright, below the critical spin, and pushed a little."""
    rng, one.Mgl = one.rng, abs(one.Mgl)
    spin = 2 * one.swing * one.Ix / one.Iz * rng.uniform(0, 1)
    one.tilt = rng.choice([0.0, rng.power(-15, -1)])
    push = one.swing * rng.choice([0.0, rng.power(-15, -1)])
    return one.top, State(one.lean(), (push, 0.0, spin)), rng.power(-1, 2) / one.swing


def draw_to_its_balance(one: Ordinary) -> Draw:
    """A pendulum from below with enough to rise to the top, exactly or nearly."""
    rng = one.rng
    n = 2.0 ** one.rng.randint(-6, 6)
    push = 2 * n * (1 + rng.choice([0, 0, 2.0**-52, -(2.0**-40)]))
    top = Top(1.0, rng.uniform(0.1, 2), n * n)
    start = State((0.0, 1.0, 0.0, 0.0), (push, 0.0, 0.0))
    return top, start, rng.uniform(0.1, 40) / n


def draw_asymptotic(one: Ordinary) -> Draw:
    """Exactly on the separatrix: u = 1 is a double root, and the start has u = 0, g = (0, 1)."""
    rng = one.rng
    n = 2.0 ** one.rng.randint(-5, 5)
    Iz = rng.choice([0.25, 0.5, 1.0, 2.0])
    x, y = n * rng.randint(-99, 99), n * (rng.randint(-99, 99) or 1)
    start = State((0.5, 0.5, 0.5, 0.5), (x, y, y / Iz))
    t = one.sign() * rng.uniform(0.05, 12) / sqrt(x * x + y * y)
    return Top(1.0, Iz, (x * x + y * y) / 2), start, t


def draw_sleeping(one: Ordinary) -> Draw:
    return one.top, State(one.stand(), (0.0, 0.0, one.spin)), one.t


def draw_regular(one: Ordinary) -> Draw:
    theta = one.rng.uniform(0.05, 3.0)
    spin = one.spin
    rates = regular_precession_rates(one.top, theta=theta, psi_dot=spin)
    rate = one.rng.choice([each for each in rates if math.isfinite(each)] or [0.0])
    return one.top, State.from_euler(theta=theta, phi_dot=rate, psi_dot=spin), one.t


def draw_weightless(one: Ordinary) -> Draw:
    one.Mgl = 0.0
    return one.finish()


def draw_nearly_weightless(one: Ordinary) -> Draw:
    one.Mgl *= one.rng.power(-60, -10)
    return one.finish()


def draw_late(one: Ordinary) -> Draw:
    one.t = 1e13 / max(abs(one.spin), one.swing) * one.rng.uniform(0.5, 5)
    return one.finish()


def draw_case(family: str) -> Callable[[Ordinary], Draw]:
    def draw(one: Ordinary) -> Draw:
        case = random_case(one.rng.randrange(10**9), family)
        return case.top, case.start, case.t

    return draw


DRAWS: dict[str, Callable[[Ordinary], Draw]] = {
    "generic": draw_generic,
    "Mgl < 0": draw_hanging,
    "Iz > Ix": draw_flat,
    "near the top": draw_near_the_top,
    "near the bottom": draw_near_the_bottom,
    "through a pole": draw_through_a_pole,
    "near the separatrix": draw_near_the_separatrix,
    "to its balance": draw_to_its_balance,
    "asymptotic": draw_asymptotic,
    "sleeping": draw_sleeping,
    "regular": draw_regular,
    "weightless": draw_weightless,
    "nearly weightless": draw_nearly_weightless,
    "late": draw_late,
    **{family: draw_case(family) for family in FAMILIES},
}


def draw_motion(family: str, number: int) -> tuple[Motion, float]:
    """Return a motion of a family, and a time in s."""
    top, start, t = DRAWS[family](Ordinary(Numbers(f"{family} {number}")))
    motion = Motion(top, start)
    return motion, math.copysign(min(abs(t), FARTHEST * motion.farthest_time), t)
