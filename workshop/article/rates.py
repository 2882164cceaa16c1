"""Claims on precession rates: the two roots, the six rates, the parabola, Perry's rule."""

from collections.abc import Callable
from typing import Literal

import numpy as np

from symtop_ros.physics import (
    Direction,
    Hold,
    Motion,
    State,
    Top,
    hurry,
    perrys_rule,
    regular_precession_rates,
    theta_acceleration,
)
from workshop.article.claims import Measured, claim
from workshop.article.motions import (
    HURRIED,
    PRINTED_ROOTS,
    PSI_DOT,
    RATES,
    THETA,
    HurryCase,
    Rate,
    draw_top,
    measure_acceleration,
    start,
)

STILL = 1e-3  # rad; a root printed with three digits moves the top by less
FITTED = 1e-9  # of the largest theta''; differences and the fit are good to 1e-11
SMALL, INSTANT = 1.02, 1e-5  # a small hurry, and the s after which the motion is looked at
TRIED, SEED = 120, 1890  # random tops, the same every time
Root = Literal["slow", "fast"]
# The leading coefficient of the quadratic for theta'' by what a kick holds, over cos(theta)
LEADING: dict[Hold, Callable[[Top], float]] = {
    "spin_rate": lambda top: top.Ix - top.Iz,
    "spin_momentum": lambda top: top.Ix,
}
FACTOR = 1.4  # by which the precession is hurried
PARABOLA = np.linspace(-10.0, 90.0, 41)  # rad/s
SHORT = 0.02  # of a nutation period
ROUNDING = 1e-12  # rad, or relative to the largest term of the equation for theta''


def find_departure(motion: Motion) -> tuple[set[Direction], str]:
    """Return in which directions a top leaves a start with theta' = 0, found in three ways.

    By the article's equation, by the motion after a fiftieth of the nutation period, and by the
    farther turning angle; and the three answers with their numbers.
    """
    top = motion.top
    theta = motion.start.euler_angles.theta
    rates = motion.start.euler_rates
    acceleration = float(theta_acceleration(top, theta, rates.phi_dot, rates.psi_dot))
    terms = abs(top.Iz * rates.phi_dot * rates.psi_dot) + abs(top.Mgl)
    rounding = ROUNDING * float(np.sin(theta)) / top.Ix * terms  # what it can make of zero
    after = SHORT * motion.nutation_period
    moved = float(motion.at(after).euler_angles.theta) - theta
    low, high = (angle - theta for angle in motion.turning_angles)
    farther = max(low, high, key=abs)
    directions = {
        _direction(acceleration, rounding),
        *(_direction(change, ROUNDING) for change in (moved, farther)),
    }
    return directions, (
        f"theta'' = {acceleration:.3g} rad/s^2 by the equation; theta changes by {moved:.3g} rad "
        f"in {after * 1e3:.1f} ms, and altogether from {low:+.3g} to {high:+.3g} rad"
    )


def _direction(change: float, rounding: float) -> Direction:
    """Return the direction of the axis, which rises if theta decreases."""
    if abs(change) <= rounding:
        return "stays"
    return "rises" if change < 0 else "falls"


@claim()
def roots_are_as_printed(top: Top) -> Measured:
    """Check the rates of regular precession to the digits that the article prints."""
    roots = regular_precession_rates(top, THETA, PSI_DOT)
    digits = [len(printed.partition(".")[2]) for printed in PRINTED_ROOTS]
    rounded = [f"{root:.{n}f}" for root, n in zip(roots, digits, strict=False)]
    holds = rounded == list(PRINTED_ROOTS)
    real = [f"{root:.6f}" for root in roots if np.isfinite(root)]
    return Measured(holds, listed=" and ".join(real) or "not real")


@claim()
def printed_roots_keep_the_tilt(top: Top) -> Measured:
    """Check that the article's digits are enough to see no nutation."""
    motions = [Motion(top, start(float(printed))) for printed in PRINTED_ROOTS]
    widths = [np.ptp(motion.turning_angles) for motion in motions]
    return Measured(max(widths) < STILL, widths=widths)


@claim(*RATES)
def rate_decides(top: Top, rate: Rate) -> Measured:
    """Check the article's statement on one of the six rates, by the equation and by the motion."""
    found, departure = find_departure(Motion(top, start(rate.phi_dot)))
    return Measured(found == {rate.direction}, departure=departure)


@claim()
def acceleration_is_a_parabola(top: Top) -> Measured:
    """Check that theta'' at theta' = 0 is a parabola in phi' whose zeros are both roots."""
    measured = np.array(
        [measure_acceleration(Motion(top, start(rate))) for rate in PARABOLA.tolist()]
    )
    parabola = np.polynomial.Polynomial.fit(PARABOLA, measured, 2)
    off = np.abs(parabola(PARABOLA) - measured).max() / np.abs(measured).max()
    zeros = np.sort(parabola.roots().real)
    roots = regular_precession_rates(top, THETA, PSI_DOT)
    missed = np.abs(zeros - roots).max() if np.isfinite(roots).all() else np.inf
    holds = off < FITTED and missed < FITTED * PARABOLA[-1]
    return Measured(holds, count=len(PARABOLA), off=off, zeros=zeros, missed=missed)


@claim(*HURRIED.values())
def hurrying_decides(top: Top, case: HurryCase) -> Measured:
    """Check what a hurried regular precession does, and that `perrys_rule` agrees."""
    before = case.begin(top)
    top = before.top
    rises = case.direction == "rises"
    verb = "holds" if rises else "fails"
    moved = "top" if top.Mgl > 0 else "axis"
    end = "" if top.Mgl > 0 else ", and the centre of mass, below the pivot, rises"
    rate = before.start.euler_rates.phi_dot
    found, departure = find_departure(Motion(top, hurry(before.start, FACTOR)))
    rule = perrys_rule(top, before.start, FACTOR)
    holds = found == {case.direction} and rule.rule_holds is rises
    return Measured(
        holds,
        verb=verb,
        moved=moved,
        end=end,
        rate=rate,
        hurried=FACTOR * rate,
        departure=departure,
    )


@claim("slow", "fast")
def sign_decides(top: Top, root: Root) -> Measured:
    """Check the exact rule for a small hurry, on random tops of both signs and on this one.

    From the slow root s the kick by k makes Ix theta''/sin(theta) of zero
    (k - 1) Mgl (k s/f - 1), from the fast root f it makes (k - 1) a f^2 (k - s/f), and |s| < |f|.
    The height of the centre of mass accelerates like -Mgl theta''.
    """
    counts = {hold: _count_risen(root, hold, top) for hold in LEADING}
    rule = (
        "raises the centre of mass of every top, and lowers the axis exactly if Mgl < 0"
        if root == "slow"
        else "raises the centre of mass exactly if Mgl (Ix - Iz) cos(theta) < 0, and exactly if "
        "Mgl cos(theta) < 0 if it holds the spin momentum"
    )
    listed = " and ".join(
        f"{good} of {tried} with the {hold.replace('_', ' ')} held"
        for hold, (good, tried) in counts.items()
    )
    holds = all(good == tried > 0 for good, tried in counts.values())
    return Measured(holds, rule=rule, instant=1e6 * INSTANT, listed=listed)


def _count_risen(root: Root, hold: Hold, top: Top) -> tuple[int, int]:
    """Return how many tops move as the rule says, and how many were tried."""
    random = np.random.default_rng(SEED)
    good = 0
    tried = 0
    for _ in range(TRIED):
        drawn = draw_top(random, top)
        each = drawn if tried else top
        theta = random.uniform(0.2, 2.9)
        spin = random.choice([-1, 1]) * random.uniform(30.0, 200.0)
        a = LEADING[hold](each) * np.cos(theta)
        roots = np.roots([a, -each.Iz * spin, each.Mgl])
        slow, fast = sorted(roots.tolist(), key=abs)
        if isinstance(slow, complex) or abs(slow) > 0.9 * abs(fast):
            continue
        rate = slow if root == "slow" else fast
        psi_dot = spin if hold == "spin_rate" else spin - rate * float(np.cos(theta))
        before = State.from_euler(theta=theta, phi_dot=rate, psi_dot=psi_dot)
        motion = Motion(each, hurry(before, SMALL, hold))
        fell = float(motion.at(INSTANT).euler_angles.theta) - theta
        expected = each.Mgl > 0 if root == "slow" else a < 0
        good, tried = good + ((fell < 0) == expected), tried + 1
    return good, tried
