"""Derivatives of the state by top and start, compared with exact ones that may grow."""

import math
from typing import NamedTuple

import numpy as np
import pytest
from drawn import Numbers
from physics.differences import FEW_DIGITS, differentiate, find_errors
from physics.exact_motions import read_motions
from physics.tops import ARTICLE, CUSPS, DISC, SLOW, precess
from trials import choose, seeds

from symtop_ros.physics import ExactTimes, Friction, Motion, Motions, State, Top
from symtop_ros.physics.arguments import NO_FRICTION

PROMISED = 1e-8  # docs/filters.md
LEAST_TILT, LEAST_GAP = 1e-6, 1e-8  # below them a refusal is promised to be possible
DIGITS = 60  # those of a derivative are a third, less what the motion magnifies
TURNS = ((1.0, 0.0), (0.6, 0.8), (-5 / 13, 12 / 13), (8 / 17, -15 / 17), (-0.8, -0.6))
RATIOS = (0.25, 0.5, 1.0, 1.5, 1.9375)  # Iz/Ix: rods, spheres, discs
DISCS = 0.05  # share of flat ones


class Case(NamedTuple):
    """A motion and a time, and how near to the vertical (rad) or the separatrix it starts."""

    family: str
    motion: Motion
    t: float
    nearness: float

    @property
    def may_be_refused(self) -> bool:
        return self.nearness < (LEAST_TILT if self.family == "vertical" else LEAST_GAP)


def make_case(number: int) -> Case:
    """The motion of a number: from the vertical if it is even, from the separatrix if odd."""
    rng = Numbers(f"unstable {number}")
    ratio = 2.0 if rng.uniform(0, 1) < DISCS else rng.choice(RATIOS)
    family, make = (("separatrix", _pass_by), ("vertical", _stand))[number % 2 == 0]
    motion, nearness = make(rng, ratio)
    period = motion.nutation_period
    unit = period if math.isfinite(period) else 10.0
    late = rng.uniform(0, 1) < 0.25
    t = rng.power(0, 4) * unit if late else rng.uniform(0, 3) * unit
    return Case(family, motion, t, nearness)


def _stand(rng: Numbers, ratio: float) -> tuple[Motion, float]:
    """A top next to the vertical, mostly too slow to stay there."""
    Mgl = rng.uniform(1, 4)
    tilt = rng.power(-6.5, -1.3)
    critical = 2 * math.sqrt(Mgl) / ratio
    spin = critical * rng.uniform(-1.2, 1.2)
    w, z = rng.choice(TURNS)
    x, y = rng.uniform(-1, 1), rng.uniform(-1, 1)
    half = tilt / 2 / math.sqrt(x * x + y * y)
    moving = rng.choice((0.0, tilt))
    across = moving * rng.uniform(-1, 1), moving * rng.uniform(-1, 1)
    # The norm is 1 + tilt^2/8.
    start = State((w, half * x, half * y, z), (*across, spin))
    return Motion(Top(1.0, ratio, Mgl), start), tilt


def _pass_by(rng: Numbers, ratio: float) -> tuple[Motion, float]:
    """A motion from the horizontal that just reaches the upper vertical, or just does not."""
    x = rng.uniform(-2, 2)
    y = rng.uniform(-2, 2)
    gap = rng.power(-8.3, -0.5)
    # On the separatrix omega_y is Iz omega_z/Ix, and omega_xy^2 is 2 Mgl/Ix.
    Mgl = (x * x + y * y) / 2 * (1 + rng.choice((gap, -gap)))
    start = State((0.5, 0.5, 0.5, 0.5), (x, y, y / ratio))
    return Motion(Top(1.0, ratio, Mgl), start), gap


def find_error(case: Case, exact: Motion | None = None) -> float | None:
    """The largest error of the derivatives, as a part of what is promised; None if refused.

    `exact` is the motion with which they are compared, if it differs.
    """
    try:
        found = case.motion.jacobian([case.t])
    except ValueError as refusal:
        if "at which double precision resolves the derivatives" not in str(refusal):
            raise
        return None
    right = differentiate(exact or case.motion, [case.t], digits=DIGITS)
    return float(find_errors(case.motion, found, right).max()) / PROMISED


HALF, FREE = Top(2e-4, 1e-4, 0.05), Top(2e-4, 1e-4, 0.0)
BELOW = DISC, State.from_euler(theta=2.0, phi_dot=3.0, theta_dot=1.0, psi_dot=-40.0)
RETURNING = {
    "cusps": (ARTICLE, CUSPS),
    "regular": (ARTICLE, precess(SLOW)),
    "looping": (ARTICLE, precess(-8.0)),
    "disc, weight below": BELOW,
    "sphere": (Top(1.0, 1.0, 1.0), precess(0.3, psi_dot=2.5, theta=1.0)),
    "pole": (ARTICLE, State.from_euler(theta=0.0, theta_dot=1.0, psi_dot=60.0)),
    "pendulum": (Top(1.0, 0.5, 1.0), State((0.5, 0.5, 0.5, 0.5), (-0.5, 0.0, 0.0))),
    "rod": (Top(1e-3, 1e-7, 0.05), precess(3.0, psi_dot=60.0, theta=1.0)),
}
NOT_RETURNING = {  # and the last time in s
    "sleeping": (ARTICLE, State.from_euler(theta=0.0, psi_dot=300.0), 0.05),
    "unstable sleeper": (ARTICLE, State.from_euler(theta=0.0, psi_dot=30.0), 0.5),
    "hanging": (HALF, State((0.0, 1.0, 0.0, 0.0), (0.0, 0.0, 40.0)), 0.5),
    "free": (FREE, precess(3.0, psi_dot=40.0, theta=1.0), 1.0),
    "weak weight": (Top(2e-4, 1e-4, 1e-9), precess(0.0, psi_dot=40.0, theta=1.0), 1.0),
    "at rest": (FREE, State.from_euler(theta=1.0), 1.0),
    "separatrix": (Top(1.0, 0.5, 2.0), State((0.5, 0.5, 0.5, 0.5), (-2.0, 0.0, 0.0)), 3.0),
}
DRIVEN = {
    "friction": (ARTICLE, CUSPS, Friction(2e-6, 1e-5), (0.0, 0.0, 0.0)),
    "torque": (ARTICLE, CUSPS, Friction(), (1e-3, 2e-3, -1e-3)),
    "both, disc": (*BELOW, Friction(1e-5, 3e-6), (1e-4, 0.0, 2e-4)),
}


def list_motions():
    """Each motion, with the times in s at which its derivatives are compared."""
    for name, arguments in RETURNING.items():
        motion = Motion(*arguments)
        yield name, motion, [0.13 * motion.nutation_period, 2.71 * motion.nutation_period]
    for name, (top, start, end) in NOT_RETURNING.items():
        yield name, Motion(top, start), [0.2 * end, end]
    for name, arguments in DRIVEN.items():
        yield name, Motion(*arguments), [0.03, 0.2]


MOTIONS = {name: each for name, *each in list_motions()}


@pytest.mark.parametrize("name", choose(MOTIONS, [*[*MOTIONS][:-3:2], "both, disc"]))
def test_derivatives_are_exact(name):
    motion, times = MOTIONS[name]
    right = differentiate(motion, times, digits=FEW_DIGITS)
    assert find_errors(motion, motion.jacobian(times), right).max() < PROMISED


@pytest.mark.long
@pytest.mark.parametrize("name", RETURNING)
def test_derivatives_after_a_million_nutations_are_exact(name):
    motion = Motion(*RETURNING[name])
    times = [1e3 * motion.nutation_period, 1.000000123e6 * motion.nutation_period]
    errors = find_errors(motion, motion.jacobian(times), differentiate(motion, times))
    assert errors.max() < PROMISED


@pytest.mark.parametrize("friction", [Friction(), Friction(axial=1e-7)])
def test_derivatives_at_exact_times_are_those_at_doubles_that_are_as_exact(friction):
    motion = Motion(ARTICLE, CUSPS, friction)
    stamps = np.array([0, 250_000_000, 5 * 10**8])  # whole eighths of a second
    found = motion.jacobian(ExactTimes(stamps))
    # The same states: the order of the sums is another, with some roundings.
    assert found == pytest.approx(motion.jacobian(stamps * 1e-9), rel=1e-10, abs=1e-10)
    assert motion.jacobian(ExactTimes(5 * 10**8)).shape == (6, 9)
    many = Motions(Top(*ARTICLE.moments[:2], [0.068, 0.07]), CUSPS, friction)
    assert many.jacobian(ExactTimes(stamps)).shape == (2, 3, 6, 9)


def test_derivatives_at_late_exact_times_are_not_those_at_the_nearest_double():
    # A ns more after a year, of which a double of s has 4 ns: the body has turned by 2e-7 rad.
    motion = Motion(ARTICLE, CUSPS)
    year = 365 * 86_400 * 10**9
    before, after = (motion.jacobian(ExactTimes(year + each)) for each in (0, 1))
    turn = 1e-9 * motion.at(ExactTimes(year)).angular_velocity[2]
    largest = np.abs(before[:2]).max()
    expected = turn * np.stack((before[1], -before[0]))  # rows of a frame that has turned
    change = after[:2] - before[:2]
    assert np.abs(change - expected).max() < 0.3 * turn * largest
    assert np.abs(expected).max() > 0.7 * turn * largest


def test_at_the_start_they_are_the_identity():
    for arguments in (*RETURNING.values(), *DRIVEN.values()):
        found = Motion(*arguments).jacobian(0.0)
        assert np.abs(found - np.eye(6, 9, 3)).max() < PROMISED


def test_shapes_follow_those_of_times_and_motions():
    motion = Motion(ARTICLE, CUSPS)
    assert motion.jacobian(1.0).shape == (6, 9)
    assert motion.jacobian(np.ones((2, 3))).shape == (2, 3, 6, 9)
    assert motion.jacobian([]).shape == (0, 6, 9)
    many = Motions(Top(ARTICLE.Ix, ARTICLE.Iz, np.array([0.06, ARTICLE.Mgl])), CUSPS)
    found = many.jacobian([0.5, 1.0])
    assert found.shape == (2, 2, 6, 9)
    assert found[1].tolist() == motion.jacobian([0.5, 1.0]).tolist()


def near_the_vertical(tilt, friction=NO_FRICTION):
    """A spin too slow to stay upright, and a start from which the axis falls and returns."""
    start = State.from_euler(theta=tilt, phi=0.3, psi=0.7, psi_dot=50.0)
    return Motion(ARTICLE, start, friction)


@pytest.mark.parametrize("t", choose((10.0, 1000.0), (10.0,)))
def test_a_step_that_turns_a_phase_by_whole_turns_is_not_taken_for_a_smooth_one(t):
    # A nutation of 1e-5 rad, of which a phase turns by 2500 rad in a second.
    motion = Motion(ARTICLE, State.from_euler(theta=0.5, psi_dot=1e4))
    error = find_error(Case("vertical", motion, t, 0.5))
    assert error is None or error < 1


@pytest.mark.parametrize("tilt", choose((1e-8, 1e-10, 1e-12), (1e-10,)))
def test_what_doubles_do_not_resolve_is_right_or_refused(tilt):
    motion = near_the_vertical(tilt)
    # on the way back to the vertical, and away from it again
    for part in (0.2, 0.9, 1.1, 1.3, 1.9):
        error = find_error(Case("vertical", motion, part * motion.nutation_period, tilt))
        assert error is None or error < 1, part


# So weak a friction does not change the derivatives, and is integrated nevertheless.
WEAK = Friction(axial=1e-28)


@pytest.mark.parametrize("tilt", choose((1e-6, 5e-6, 2e-5), (2e-5,)))
def test_driven_motions_are_right_or_beyond_an_unstable_place_refused(tilt):
    motion = near_the_vertical(tilt, WEAK)
    free = near_the_vertical(tilt)
    for part in (0.4, 0.9, 1.1, 1.9, 2.3):
        error = find_error(Case("vertical", motion, part * free.nutation_period, tilt), free)
        assert error < 1 if error is not None else tilt < 2e-5 and part > 1


IDLE_DRIVES = [(Friction(1e-300, 1e-300), (0, 0, 0)), (NO_FRICTION, (1e-60, 0, 0))]


@pytest.mark.parametrize("drive", IDLE_DRIVES)
def test_a_drive_that_changes_nothing_costs_no_derivative(drive):
    free = near_the_vertical(2e-6)
    motion = Motion(free.top, free.start, *drive)
    for part in (0.9, 1.0, 1.3, 1.5, 1.9, 2.3):
        t = part * free.nutation_period
        assert np.array_equal(motion.jacobian(t), free.jacobian(t))


# Of the table those that are asked for at these times: 27 tops, the article's and hard ones.
TIMES = [0.05, 0.2, 1.0, 5.0], [0.1, 1.0, 10.0, 1e3], [0.1, 1.0, 10.0, 1e3, 1e6]
STORED = [(each.family, each.motion, each.times) for each in read_motions() if each.times in TIMES]
STORED_NAMES = [name for name, *_ in STORED]


@pytest.mark.parametrize(("_", "motion", "times"), STORED, ids=STORED_NAMES)
def test_no_stored_motion_is_refused(_, motion, times):
    for t in times:
        assert np.isfinite(motion.jacobian(t)).all()


@pytest.mark.long
@pytest.mark.parametrize(("_", "motion", "times"), STORED, ids=STORED_NAMES)
def test_derivatives_of_stored_motions_are_exact(_, motion, times):
    right = differentiate(motion, times, digits=60)
    found = np.stack([motion.jacobian(t) for t in times])
    together = motion.jacobian(times)
    for each in (found, together):
        assert find_errors(motion, each, right, counts_start=True).max() < PROMISED


FLAT_DISCS = (7530, 7826, 8336, 8780)  # next to the vertical


@pytest.mark.parametrize("number", [*seeds(4, 400), *FLAT_DISCS])
def test_motions_next_to_what_is_unstable_are_right_or_refused(number):
    case = make_case(number)
    error = find_error(case)
    assert case.may_be_refused if error is None else error < 1


@pytest.mark.parametrize("sign", [1.0, -1.0])
@pytest.mark.parametrize("seed", seeds(5, 100))
def test_derivatives_by_the_start_are_chained(seed, sign):
    rng = np.random.default_rng(seed)
    Ix, Iz, Mgl = rng.uniform(0.5, 2.0, 3) * [1.0, 1.0, rng.choice([-1.0, 1.0])]
    names = "theta_dot", "phi_dot", "psi_dot"
    rates = dict(zip(names, rng.uniform(-3.0, 3.0, 3), strict=True))
    start = State.from_euler(theta=rng.uniform(0.2, 2.9), **rates)
    motion = Motion(Top(Ix, min(Iz, 2 * Ix), Mgl), start)
    first, then = sign * rng.uniform(10.0, 1e4, 2)
    second = Motion(motion.top, motion.at(first)).jacobian(then)[:, 3:]
    chained = second @ motion.jacobian(first)[:, 3:]
    # the rounding of the state in the middle grows with the second half, of up to 1e4 s
    off = np.abs(chained - motion.jacobian(first + then)[:, 3:]).max()
    assert off < 4 * PROMISED * np.abs(second).max()
