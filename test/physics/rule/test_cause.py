"""Each sentence on why the axis moves as it does is true of the motion, which is looked at itself.

What is said comes from constants of the motion and its turning angles. Here states all over a
nutation are turned into vectors of the world, and each claim is tested on them.
"""

import math
from collections import Counter

import numpy as np
import pytest
from drawn import PI, Numbers
from physics.tops import find_roots
from trials import trials

from symtop_ros.physics import (
    Friction,
    Motion,
    State,
    Top,
    apply_impulse,
    hurry,
    kick_verdict,
    perrys_rule,
)

SAMPLES = 1001
FAMILIES = ("any", "fast", "slow", "steady", "weightless", "vertical", "spinless", "rest", "near")
# A sum of some products of doubles, and the state's own error of some EPS: 1e-9 of its terms is far
# above both, and far below what a sentence could be about.
TINY = 1e-9
ARTICLE = Top(Ix=0.000228, Iz=0.0000572, Mgl=0.068)


def draw_start(rng, family):
    """Return a top and a state; rates are in units of the pendulum's or of the top's own."""
    Ix = rng.power(-4, 0)
    Iz = Ix * rng.choice([rng.uniform(0.05, 2.0), rng.uniform(1.0, 2.0), 1.0, 0.25])
    unit = rng.power(0, 1.5)
    Mgl = 0.0 if family == "weightless" else rng.choice([1, 1, -1]) * Ix * unit * unit
    spins = {"fast": 40.0, "slow": 1.5, "spinless": 0.0, "near": 8.0}
    spin = rng.uniform(-1, 1) * spins.get(family, 8.0) * Ix / Iz * unit
    theta = rng.uniform(0.05, 3.1)
    if family == "near":
        theta = rng.choice([rng.power(-4, -1), PI - rng.power(-4, -1)])
    top = Top(Ix, Iz, Mgl)
    theta_dot = rng.choice([0.0, 0.0, rng.uniform(-1, 1)]) * unit
    phi_dot = rng.choice([0.0, rng.uniform(-3, 3), rng.uniform(-20, 20)]) * unit
    turned = {"phi": rng.uniform(-3, 3), "psi": rng.uniform(-3, 3)}
    if family == "vertical":
        pole = rng.choice([0.0, PI])
        rest = State.from_euler(theta=pole, psi_dot=spin)
        return top, apply_impulse(top, rest, [rng.choice([0.0, 0.3]) * Ix * unit, 0.0, 0.0])
    if family == "steady":
        rates = find_roots(top, theta, spin)
        phi_dot, theta_dot = (rng.choice(rates), 0.0) if rates else (phi_dot, theta_dot)
    if family == "rest":
        phi_dot = theta_dot = 0.0
        spin *= rng.choice([0.0, 1.0])
    if family == "spinless":  # p_psi = 0, as far as doubles can say it
        return top, make_spinless(theta, phi_dot, theta_dot, turned["psi"])
    rates = {"phi_dot": phi_dot, "theta_dot": theta_dot, "psi_dot": spin}
    return top, State.from_euler(theta=theta, **turned, **rates)


def make_spinless(theta, phi_dot, theta_dot, psi):
    made = State.from_euler(theta=theta, psi=psi, phi_dot=phi_dot, theta_dot=theta_dot)
    x, y, _ = made.angular_velocity.tolist()
    return State(made.orientation, (x, y, 0.0))


def kick(rng, top, state):
    """Return the state after a kick, and what it holds."""
    if state.is_vertical or rng.random() < 0.2:
        size = top.Ix * max(1.0, float(np.abs(state.angular_velocity).max()))
        return apply_impulse(top, state, [size * rng.uniform(-1, 1) for _ in range(3)]), None
    hold = rng.choice(["spin_rate", "spin_momentum"])
    return hurry(state, rng.choice([1.4, 1 / 1.4, 2.5, 0.0, 1.02, 7.0]), hold), hold


class Seen:
    """A motion over a nutation (or a time of its size, if it has none), as vectors of the world."""

    def __init__(self, top, start):
        self.top = top
        self.motion = Motion(top, start)
        period = self.motion.nutation_period
        speed = top.Ix / max(np.linalg.norm(top.angular_momentum(start)), 1e-300)
        self.period = period if math.isfinite(period) else min(20 * speed, 1e3)
        self.times = np.linspace(0.0, self.period, SAMPLES)
        states = self.motion.at(self.times)
        self.L = top.angular_momentum(states)
        self.torque = top.gravity_torque(states)
        self.omega = states.to_world(states.angular_velocity)
        self.axle = states.to_world(np.array([0.0, 0.0, 1.0]))
        self.size = np.linalg.norm(self.L, axis=1)
        change = np.cross(self.omega, self.axle)
        level = self.axle[:, 0] ** 2 + self.axle[:, 1] ** 2
        with np.errstate(all="ignore"):
            self.phi_dot = (self.axle[:, 0] * change[:, 1] - self.axle[:, 1] * change[:, 0]) / level
        self.weight = top.Mgl * self.axle[:, 2]
        self.sine = np.sqrt(level)

    def up_to_turning(self):
        return slice(0, SAMPLES // 2 + 1)


def from_line(vectors, lines):
    """Return angles between vectors and lines (n, 3), without the digits that a cosine loses."""
    across = np.linalg.norm(np.cross(vectors, lines), axis=-1)
    return np.arctan2(across, np.abs(np.sum(vectors * lines, axis=-1)))


def azimuth(vectors):
    return np.unwrap(np.arctan2(vectors[:, 1], vectors[:, 0]))


def are_parts(values, sizes):
    """True if values vanish compared with sizes."""
    return bool(np.all(np.abs(values) <= TINY * np.maximum(sizes, 1e-300)))


def is_constant(vectors):
    return are_parts(np.linalg.norm(vectors - vectors[0], axis=-1), np.linalg.norm(vectors[0]))


def is_fixed(seen, _):
    return is_constant(seen.L) and is_constant(seen.axle) and not seen.torque.any()


def is_free(seen, _):
    angles = from_line(seen.L, seen.axle)
    return is_constant(seen.L) and np.ptp(angles) < TINY and not is_constant(seen.axle)


def is_upright(seen, _):
    return is_constant(seen.L) and is_constant(seen.axle) and seen.sine.max() == 0


def is_steady(seen, _):
    across = np.sum(seen.torque * seen.L, axis=1)
    turned = azimuth(seen.L), azimuth(seen.axle)
    ways = [each - each[0] for each in turned]
    # L may be next to the vertical; its horizontal part is the torque over phi'
    level = np.hypot(seen.L[:, 0], seen.L[:, 1]) / seen.size
    close = np.abs(ways[0] - ways[1]) * level <= 1e-6 * (1 + np.abs(ways[1]))
    # a start on a root misses it by some EPS of the terms, and nods by the like of it
    is_perpendicular = np.all(
        np.abs(across) <= 1e-6 * np.linalg.norm(seen.torque, axis=1) * seen.size
    )
    return bool(is_perpendicular and close.all()) and np.ptp(seen.sine) < 1e-6


def is_plane(seen, _):
    normal = seen.torque[np.argmax(np.linalg.norm(seen.torque, axis=1))]
    normal = normal / np.linalg.norm(normal)
    beside = np.linalg.norm(np.cross(seen.L, normal), axis=1)
    return are_parts(beside, seen.size.max()) and are_parts(seen.axle @ normal, 1.0)


def is_without_spin(seen, _):
    order = np.argsort(seen.sine)
    rates = np.abs(seen.phi_dot[order])
    same_part = are_parts(np.sum(seen.L * seen.axle, axis=1), seen.size)
    vertical = are_parts(np.ptp(seen.L[:, 2]), seen.size.max())
    return same_part and vertical and bool(np.all(np.diff(rates) <= TINY * rates[:-1]))


def goes_about(seen, cause):
    tilt = from_line(seen.L, np.array([[0.0, 0.0, 1.0]]))
    near = tilt.max() <= PI / 18 + TINY and tilt.max() <= cause.momentum_from_vertical[2] + TINY
    one_way = np.all(seen.phi_dot > 0) or np.all(seen.phi_dot < 0)
    around = from_line(seen.L, seen.axle).min() > tilt.max()
    return bool(near and one_way and around)


def nods_further_than_it_advances(seen):
    """True of loops, and where the tilt spans more than the way round at the middle of its ends.

    None next to the vertical, where phi' has a spike between two samples.
    """
    if seen.sine.min() < 1e-2 * seen.sine.max():
        return None
    least, most = seen.phi_dot.min(), seen.phi_dot.max()
    if least * most < 0 and min(-least, most) > TINY * max(-least, most):  # else rounding of a cusp
        return True
    tilts = np.arctan2(seen.sine, seen.axle[:, 2])
    advance = np.ptp(azimuth(seen.axle)) * np.sin((tilts.min() + tilts.max()) / 2)
    return bool(np.ptp(tilts) > advance)


def circles(seen, _):
    """The axle goes once round L in a nutation; L moves by less than a right angle meanwhile."""
    pole = seen.L / seen.size[:, None]
    level = np.array([0.0, 0.0, 1.0]) - pole[:, 2:] * pole
    beside = np.cross(pole, level)
    place = np.arctan2(np.sum(seen.axle * beside, 1), np.sum(seen.axle * level, 1))
    once = abs(np.unwrap(place)[-1] - place[0])
    is_slow = 4 * np.linalg.norm(seen.torque, axis=1) / seen.size < seen.size / seen.top.Ix
    is_round = abs(once - 2 * PI) < 1e-3
    return bool(is_round and is_slow.all()) and nods_further_than_it_advances(seen) is not False


def goes_with(seen, cause):
    tilts = from_line(seen.L, seen.axle), from_line(seen.omega, seen.axle)
    near = tilts[0].max() <= cause.momentum_from_axle[2] + TINY <= PI / 6 + 2 * TINY
    near = near and tilts[1].max() <= cause.omega_from_axle[2] + TINY
    off = PI / 2 - from_line(seen.torque, seen.L)
    is_turned = off.max() <= cause.torque_from_perpendicular[1] + 1e-6 <= PI / 6 + 2e-6
    turning = np.sign(np.cross(seen.L, seen.torque)[:, 2])
    one_way = len(set(turning.tolist())) == 1
    line = np.sign(np.sum(seen.L * seen.axle, axis=1))[:, None] * seen.L
    # always within a quarter of a turn of L: in the long run both turn as often
    apart = np.abs((azimuth(line) - azimuth(seen.axle) + PI) % (2 * PI) - PI)
    is_followed = bool(near and is_turned and one_way and apart.max() < PI / 2)
    return is_followed and not nods_further_than_it_advances(seen)


def swings(seen, cause):
    off = PI / 2 - from_line(seen.torque, seen.L)
    longer = np.diff(seen.size**2)
    lower = -np.diff(seen.weight)
    rounding = TINY * np.maximum(np.abs(longer).max(), 1e-300)
    agree = np.sign(longer) == np.sign(lower)
    is_along = bool(np.all(agree | (np.abs(longer) <= rounding))) and off.max() > PI / 6 - 0.02
    return is_along and np.ptp(seen.size) > 0.049 * seen.size.max()


CLAIMS = {
    "fixed": is_fixed,
    "free": is_free,
    "upright": is_upright,
    "steady": is_steady,
    "plane": is_plane,
    "no_spin": is_without_spin,
    "about_momentum": goes_about,
    "with_momentum": goes_with,
    "circles": circles,
    "swings": swings,
}


def demand_turn(seen, turn):
    """phi' against the rate at which the torque turns L, and where the weight goes from there."""
    L, torque, phi_dot = seen.L[0], seen.torque[0], seen.phi_dot[0]
    rate = 0.0
    if turn == "rests":
        assert abs(phi_dot) <= TINY * abs(seen.omega).max()
    elif turn != "vertical":
        rate = np.cross(L, torque)[2] / (L[0] ** 2 + L[1] ** 2)
    if turn == "against":
        assert phi_dot * rate < 0
    elif turn == "vertical":  # L has no horizontal part that could be turned
        assert from_line(L[None], np.array([[0.0, 0.0, 1.0]])) <= 2e-7
        assert abs(phi_dot) > TINY * abs(seen.omega).max()
    elif turn != "rests":
        assert phi_dot * rate > 0
        assert (abs(phi_dot) > abs(rate)) == (turn == "faster")
    heights = seen.weight[seen.up_to_turning()]
    gain = np.diff(heights) * (1 if turn == "faster" else -1)
    assert np.all(gain >= -TINY * np.ptp(heights) - 1e-15 * np.abs(heights).max())
    assert np.ptp(heights) > 0


def demand_pace(seen, pace):
    rates = np.abs(seen.phi_dot[seen.up_to_turning()])
    change = np.diff(rates) * (1 if pace == "speeds" else -1)
    # phi' is a quotient: next to the vertical it has lost the digits of sin^2
    rounding = 1e-15 * np.abs(seen.omega).max() / seen.sine.min() ** 2
    assert np.all(change >= -TINY * rates.max() - rounding)
    # a person sees it: one in twenty, but for the sample next to the turning point
    assert np.sum(change) >= 0.049 * rates.max()


def demand_numbers(seen, cause):
    """The angles in samples: the extremes between samples are missed by their squares."""
    vertical = np.array([[0.0, 0.0, 1.0]])
    found = {
        "momentum_from_axle": from_line(seen.L, seen.axle),
        "omega_from_axle": from_line(seen.omega, seen.axle),
        "momentum_from_vertical": from_line(seen.L, vertical),
    }
    if seen.size.min() < 1e-3 * seen.size.max():
        return  # where L vanishes its direction is that of rounding
    for name, angles in found.items():
        now, least, most = getattr(cause, name)
        assert now == pytest.approx(angles[0], abs=1e-7), name
        assert least <= angles.min() + 1e-7, name
        assert most >= angles.max() - 1e-7, name
        if math.isfinite(seen.motion.nutation_period):  # both turning points were passed
            steps = np.abs(np.diff(angles)).max()
            assert angles.max() >= most - 2 * steps - 1e-7, name
            assert angles.min() <= least + 2 * steps + 1e-7, name
    assert cause.rate_about_momentum == pytest.approx(seen.size[0] / seen.top.Ix, rel=1e-12)


def demand_constant(seen, cause):
    if "size" in cause.constant:
        assert np.ptp(seen.size) <= 1e-6 * seen.size.max()
    if "direction" in cause.constant:
        assert is_constant(seen.L)
    if "tilt" in cause.constant:
        assert np.ptp(seen.sine) <= 1e-6


def demand(top, start, cause):
    """Each claim of a cause, of the motion from a start on."""
    seen = Seen(top, start)
    if cause.explanation:
        assert CLAIMS[cause.explanation](seen, cause), (cause.explanation, top, start)
    if cause.turn:
        demand_turn(seen, cause.turn)
    if cause.pace:
        demand_pace(seen, cause.pace)
    demand_numbers(seen, cause)
    demand_constant(seen, cause)


@pytest.mark.parametrize("family", FAMILIES)
@pytest.mark.parametrize("count", trials(40, 1200))
def test_what_is_said_of_a_start_and_of_a_kick_is_true_of_the_motion(family, count):
    rng = Numbers(f"causes {family}")
    said = Counter()
    for _ in range(count):
        top, state = draw_start(rng, family)
        cause = perrys_rule(top, state).cause
        demand(top, state, cause)
        after, hold = kick(rng, top, state)
        kicked = kick_verdict(Motion(top, after), state, hold).cause
        assert kicked == perrys_rule(top, after).cause
        demand(top, after, kicked)
        for each in (cause, kicked):
            said.update([each.explanation, each.turn, each.pace and f"{each.turn} {each.pace}"])
    assert sum(said[each] for each in CLAIMS) > count / 4  # of both, most can be explained


@pytest.mark.parametrize("count", trials(100, 3000))
def test_of_a_sphere_whose_momentum_is_vertical_all_of_the_torque_is_left(count):
    """Its L is that of omega: along the vertical if the axis only precesses, but for rounding."""
    rng = Numbers("spheres")
    for _ in range(count):
        Ix, unit = rng.power(-4, 0), rng.power(0, 1.5)
        top = Top(Ix, Ix, rng.choice([1, -1]) * Ix * unit * unit)
        rate = rng.choice([-1, 1]) * rng.power(-1, 1) * unit
        start = State.from_euler(theta=rng.uniform(0.05, 3.1), phi=rng.uniform(-3, 3), phi_dot=rate)
        cause = perrys_rule(top, start).cause
        assert cause.turn == "vertical"
        demand(top, start, cause)


@pytest.mark.parametrize("rate", [3.0, -0.5])
def test_a_level_axis_without_spin_goes_round_faster_and_faster(rate):
    """The change of phi' with the height is zero there, and nowhere on the way."""
    half = math.sqrt(0.5)
    top = Top(1.0, 0.25, 8.0)
    start = State((half, half, 0.0, 0.0), (0.0, rate, 0.0))
    cause = perrys_rule(top, start).cause
    assert (cause.explanation, cause.pace) == ("no_spin", "speeds")
    demand(top, start, cause)


@pytest.mark.parametrize("is_hanging", [False, True])
def test_next_to_the_vertical_angles_are_those_of_the_motion(is_hanging):
    """The turning angles read the same, and L may be at up to a right angle to the axle."""
    rng = Numbers(f"next to the vertical {is_hanging}")
    for _ in range(200):
        Ix, tilt, unit = rng.power(-4, 0), rng.power(-8, -7.1), rng.power(0, 1.5)
        top = Top(Ix, Ix * rng.uniform(0.05, 2.0), (1 if is_hanging else -1) * Ix * unit * unit)
        theta = PI - tilt if is_hanging else tilt
        start = State.from_euler(theta=theta, psi_dot=unit * rng.choice([0.0, rng.power(-9, 1)]))
        cause = perrys_rule(top, start).cause
        seen = Seen(top, start)
        assert cause.momentum_from_axle[2] == pytest.approx(
            from_line(seen.L, seen.axle).max(), rel=1e-3
        )
        assert cause.omega_from_axle[2] == pytest.approx(
            from_line(seen.omega, seen.axle).max(), rel=1e-3
        )
        if cause.explanation:
            assert CLAIMS[cause.explanation](seen, cause), (cause, top, start)


def test_of_a_driven_motion_nothing_is_said():
    before = State.from_euler(theta=0.5, psi_dot=200.0)
    motion = Motion(ARTICLE, hurry(before), Friction(axial=2e-6))
    cause = kick_verdict(motion, before, "spin_rate").cause
    assert (cause.explanation, cause.turn, cause.pace) == (None, None, None)
    assert cause.momentum_from_axle is None
    assert cause.rate_about_momentum is None
