"""Tops without weight, from 1e-12 rad on, against 50 digits: words, turning angles and means.

The axis moves on a circle of angle `cone` about L, which has the angle `tilt` to the vertical. Here
both angles come from cross and scalar products, in balls of 300 bits that prove their digits; the
kernel has neither of the two angles. What counts as zero is docs/derivation.md, section 14.
"""

import math
from dataclasses import dataclass
from typing import Any

import pytest
from drawn import PI, Numbers, cos
from flint import arb, ctx, fmpq
from physics.tops import EPS
from trials import choose

from symtop_ros.physics import Motion, State, Top, regular_precession_rates

BITS = 300
START = 64 * EPS  # of what is computed from a start: kernel/exact/nutation.hpp
EDGE = 1e-9  # next to a limit of rounding both words are right
DECADES = range(-12, 1)  # of the tilt; the last one ends at pi
FEW, MANY = 40, 5000  # starts a decade, in a run of all tests and in the long trial
# Half an EPS each of two squares, of which roots halve it, of their roots, of the quotient and of
# the arc tangent, and what its series leaves.
ANGLE = 3 * EPS


def draw_rates(rng: Numbers, top: Top, theta: float) -> dict[str, float]:
    """Rates of a start: ordinary ones, and those at which a word changes."""
    spin = rng.choice([-1, 1]) * rng.power(-2, 2)
    style = rng.choice(["let go", "any", "regular", "nearly regular", "pole", "slow"])
    if style == "let go":  # without psi'
        return {"phi_dot": spin}
    if style == "any":
        phi_dot, psi_dot, theta_dot = (spin * rng.uniform(-3, 3) for _ in range(3))
        return {"phi_dot": phi_dot, "psi_dot": psi_dot, "theta_dot": theta_dot * min(theta, 1)}
    if style == "pole":  # b = a, with omega_z = spin
        u = cos(theta)
        phi_dot, theta_dot = top.Iz / top.Ix * spin / (1 + u), spin * theta * rng.uniform(-1, 1)
        return {"phi_dot": phi_dot, "psi_dot": spin - phi_dot * u, "theta_dot": theta_dot}
    if style == "slow":
        size = spin * theta * rng.power(-18, -10)
        return {"phi_dot": size * rng.uniform(-1, 1), "psi_dot": spin, "theta_dot": size}
    rates = regular_precession_rates(top, theta, spin)
    phi_dot = float(rng.choice([each for each in rates if math.isfinite(each)]))
    if style == "nearly regular":
        phi_dot = phi_dot * (1 + rng.power(-16, -9)) + spin * rng.power(-18, -10)
    return {"phi_dot": phi_dot, "psi_dot": spin}


def draw_motion(rng: Numbers, decade: int) -> Motion:
    """A start within a decade of tilt from one of the poles."""
    Ix = rng.power(-3, 3)
    top = Top(Ix, Ix * rng.choice([1.0, 2.0, rng.uniform(0.05, 2.0)]), 0.0)
    theta = rng.uniform(1.0, PI) if decade == 0 else rng.power(decade, decade + 1)
    turned = {"phi": rng.uniform(-3, 3), "psi": rng.uniform(-3, 3)}
    start = State.from_euler(theta=theta, **turned, **draw_rates(rng, top, theta))
    if rng.random() < 0.5:  # the same distance from the other pole
        w, x, y, z = start.orientation.tolist()
        start = State((-x, w, -z, y), start.angular_velocity)
    return Motion(top, start)


@dataclass(frozen=True)
class Circle:
    """The exact circle of the axis: fractions of the start, and angles in balls."""

    a: fmpq
    b: fmpq
    spin: fmpq  # omega_z
    along: fmpq  # sin(theta)^2 phi' of the start
    rise: fmpq  # u' = -sin(theta) theta'
    u: fmpq
    across: arb  # |omega_xy|
    tilt: arb  # of L
    cone: arb  # of the axis about L

    @property
    def rate(self) -> arb:
        """|L|/Ix."""
        return (self.across**2 + arb(self.a) ** 2).sqrt()

    @property
    def angles(self) -> tuple[arb, arb]:
        """The turning angles."""
        far = self.tilt + self.cone
        return abs(self.tilt - self.cone), far if far < arb.pi() else 2 * arb.pi() - far

    @property
    def largest_sine(self) -> arb:
        least, most = self.angles
        return arb(1) if least < arb.pi() / 2 < most else max(least.sin(), most.sin())

    @property
    def largest_precession(self) -> arb:
        """The largest terms of sin(theta)^2 phi' of a nutation."""
        return (self.across + abs(arb(self.a)) * self.largest_sine) * self.largest_sine


def find_circle(motion: Motion) -> Circle:
    """Return the circle of exactly the doubles of the start."""
    Ix, Iz, _ = map(exact, motion.top.moments)
    w, x, y, z = map(exact, motion.start.given_orientation.tolist())
    wx, wy, wz = map(exact, motion.start.angular_velocity.tolist())
    square = w * w + x * x + y * y + z * z
    gx, gy = 2 * (x * z - w * y) / square, 2 * (y * z + w * x) / square
    u = (w * w + z * z - x * x - y * y) / square
    a = Iz * wz / Ix
    cross = wy * u - a * gy, a * gx - wx * u, wx * gy - wy * gx
    along = wx * gx + wy * gy
    across = arb(wx * wx + wy * wy).sqrt()
    tilt = arb.atan2(arb(sum((each * each for each in cross), fmpq())).sqrt(), arb(along + a * u))
    return Circle(
        a=a,
        b=along + a * u,
        spin=wz,
        along=along,
        rise=-cross[2],
        u=u,
        across=across,
        tilt=tilt,
        cone=arb.atan2(across, arb(a)),
    )


def exact(x: float) -> fmpq:
    return fmpq(*x.as_integer_ratio())


def is_within(size: Any, limit: Any) -> bool | None:
    """Whether a size is at most a limit; None next to it."""
    size, limit = abs(arb(size)), arb(limit)
    if size <= limit * (1 - EDGE):
        return True
    return False if size > limit * (1 + EDGE) else None


def judge_kind(circle: Circle) -> set[str]:
    """Return what may be said: two words only next to a limit of rounding."""
    sine = arb(1 - circle.u**2).sqrt()
    pull = abs(arb(circle.a * circle.along)) + circle.across**2
    bend = arb(circle.a * circle.along) - arb(circle.u) * circle.across**2
    still = is_within(circle.rise, START * circle.across * sine), is_within(bend, START * pull)
    limit = START * circle.largest_precession
    passing = [is_within(part, limit) for part in (circle.b - circle.a, circle.b + circle.a)]
    resting = [is_within(circle.across * angle.sin(), limit) for angle in circle.angles]
    words = set()
    for word, is_so in (
        ("regular", combine(still)),
        ("through the pole", True if True in passing else None if None in passing else False),
        ("regular", combine(resting)),
        ("looping" if abs(circle.b) < abs(circle.a) else "unidirectional", True),
    ):
        if is_so is not False:
            words.add(word)
        if is_so:
            break
    return words


def combine(parts: Any) -> bool | None:
    return False if False in parts else None if None in parts else True


def judge_spin(circle: Circle) -> set[bool]:
    """Return what may be said of whether psi' takes both signs."""
    a, b, spin = circle.a, circle.b, circle.spin
    heights = [angle.cos() for angle in circle.angles]
    if spin != a:
        vertex = arb(-b / (2 * (spin - a)))
        if heights[1] < vertex < heights[0]:
            heights.append(vertex)
    values = [arb(spin) - u * arb(b) - u * u * arb(spin - a) for u in heights]
    limit = START * (abs(arb(spin)) * circle.largest_sine**2 + circle.largest_precession)
    beyond = [is_within(limit, max(sign * each for each in values)) for sign in (-1, 1)]
    found = combine(beyond)
    return {True, False} if found is None else {found}


def is_near(number: float, size: arb, share: float) -> bool:
    """Return False if a number is certainly off by more than a share."""
    return not abs(arb(number) - size) > share * abs(size) + arb(2) ** (40 - BITS)


def check_angles(motion: Motion, circle: Circle) -> None:
    low, high = motion.turning_angles
    assert is_near(low, circle.angles[0], ANGLE), motion
    assert is_near(high, circle.angles[1], ANGLE), motion
    theta = float(motion.start.euler_angles.theta)  # to 5 EPS
    assert low * (1 - 8 * EPS) <= theta <= high * (1 + 8 * EPS), motion


def check_means(motion: Motion, circle: Circle) -> None:
    assert is_near(motion.mean_cosine, circle.tilt.cos() * circle.cone.cos(), EPS), motion
    if circle.rate > 0:
        assert is_near(motion.nutation_period, 2 * arb.pi() / circle.rate, 2 * EPS), motion
    if motion.kind != "through the pole":
        upper = 1 if circle.b + circle.a >= 0 else -1
        lower = 1 if circle.b >= circle.a else -1
        assert is_near(motion.mean_precession_rate, (upper + lower) / 2 * circle.rate, EPS), motion


@pytest.mark.parametrize("count", choose((FEW, MANY), (FEW,)))
@pytest.mark.parametrize("decade", DECADES)
def test_words_angles_and_means_without_weight_are_those_of_the_exact_circle(decade, count):
    rng = Numbers(f"weightless {decade}")
    said = set()
    with ctx.workprec(BITS):
        for _ in range(count):
            motion = draw_motion(rng, decade)
            circle = find_circle(motion)
            assert motion.kind in judge_kind(circle), (motion, judge_kind(circle))
            assert motion.spin_reverses in judge_spin(circle), motion
            check_angles(motion, circle)
            check_means(motion, circle)
            said.add((motion.kind, motion.spin_reverses))
    assert len(said) >= 4
