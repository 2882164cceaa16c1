"""Ledgers: what a stretch exchanges adds up, for every family of motions and every cause."""

import math
from itertools import pairwise

import numpy as np
import pytest
from drawn import Numbers
from mpmath import mp, mpf
from physics.families import DRAWS, draw_motion
from physics.tops import ARTICLE, CUSPS, EPS, FAMILIES, FAST, SLOW, precess, random_case
from trials import choose, seeds

from symtop_ros.physics import (
    EffectivePotential,
    Friction,
    Ledger,
    Motion,
    Pushes,
    State,
    Top,
    push_axle,
)

pytestmark = pytest.mark.numbers

FALL = Motion(ARTICLE, CUSPS)
DAMPED = Motion(ARTICLE, CUSPS, Friction(1e-6))
# A state has the attitude to 20 eps and omega_xy to 10 eps of its largest size, by the promise of
# accuracy.md; a product of a difference and a sum adds three roundings.
ATTITUDE, RATE, ROUNDINGS = 20 * EPS, 10 * EPS, 4 * EPS


def limit_kinetic(motion):
    """Return a bound of Ix omega_xy^2 in J for a motion under gravity, or clamped."""
    x, y, _ = motion.start.angular_velocity.tolist()
    return motion.top.Ix * (x * x + y * y) + 4 * abs(motion.top.Mgl)


def bound_energy(motion):
    """The error in J of a sum of gains, of states as accurate as promised."""
    kinetic, weight = limit_kinetic(motion), abs(motion.top.Mgl)
    return 2 * ((RATE + ROUNDINGS) * kinetic + (ATTITUDE + ROUNDINGS) * weight)


def bound_momentum(motion):
    """The error in N m s of a change of the angular momentum of such states."""
    across = math.sqrt(motion.top.Ix * limit_kinetic(motion))
    size = across + abs(float(motion.top.axial_momentum(motion.start)))
    return 2 * (RATE + ATTITUDE + ROUNDINGS) * size


def draw_stretch(family, number):
    """A motion of a family and the ends of a stretch in s."""
    motion, t = draw_motion(family, number)
    return motion, *sorted((t, t * Numbers(f"{family} {number}").uniform(-1, 1)))


@pytest.mark.parametrize("family", DRAWS)
@pytest.mark.parametrize("first", seeds(1, 20))
def test_under_gravity_what_one_part_gains_the_others_lose(family, first):
    for number in range(50 * first, 50 * (first + 1)):
        motion, begin, end = draw_stretch(family, number)
        found = Ledger.from_times(motion, begin, end)
        assert abs(found.gained.total) <= bound_energy(motion), number
        assert (found.work, found.vertical_momentum, found.axial_momentum) == (0, 0, 0)
        assert found.gravity.work == -found.gained.weight
        assert found.gained.spin == 0, number  # the same double at all times


@pytest.mark.parametrize("family", FAMILIES)
def test_the_hand_of_a_clamp_does_no_work_and_gives_p_phi(family):
    for seed in range(50):
        case = random_case(seed, family)
        if bool(case.start.is_vertical):
            continue
        motion = Motion(case.top, case.start, clamped=True)
        begin, end = sorted((case.t, -case.t / 3))
        found, top = Ledger.from_times(motion, begin, end), case.top
        assert abs(found.gained.total) <= bound_energy(motion), seed
        assert found.gained.precession <= bound_energy(motion)
        assert (found.clamp.work, found.axial_momentum) == (0, 0)
        first, last = motion.at(begin), motion.at(end)
        change = top.vertical_momentum(last) - top.vertical_momentum(first)
        assert abs(found.vertical_momentum - change) <= bound_momentum(motion), seed
        given = top.angular_momentum(last) - top.angular_momentum(first)
        assert np.abs(found.angular_momentum - given).max() <= bound_momentum(motion), seed


def test_the_impulse_of_the_clamp_is_its_torque_over_time():
    motion = Motion(ARTICLE, State.from_euler(theta=0.5, psi_dot=200.0), clamped=True)
    points, weights = np.polynomial.legendre.leggauss(40)
    states = motion.at(0.1 * (1 + points))
    found = Ledger.from_times(motion, 0.0, 0.2)
    for torque, impulse in (
        (motion.added_torque(states), found.clamp.angular_impulse),
        (ARTICLE.gravity_torque(states), found.gravity.angular_impulse),
    ):
        assert impulse == pytest.approx(0.1 * weights @ torque, abs=1e-15)


def draw_driven(number):
    """A motion with friction, a torque, pushes or some of them, and the ends of a stretch in s."""
    rng = Numbers(f"driven {number}")
    Ix = 2.28e-4
    top = Top(Ix, Ix * rng.uniform(0.1, 2), rng.choice([0.068, -0.068, 0.0]))
    start = State.from_euler(
        theta=rng.uniform(0.1, 3), theta_dot=rng.uniform(-3, 3), phi_dot=rng.uniform(-9, 9),
        psi_dot=rng.uniform(-200, 200),
    )  # fmt: skip
    friction = Friction(*rng.choice([(0, 0), (1e-6, 3e-6), (2e-5, 0.0), (0.0, 2e-5)]))
    torque = rng.choice([(0.0, 0.0, 0.0), (1e-4, -2e-4, 3e-4)])
    pushes = rng.choice([None, Pushes(rng.uniform(-5e-5, 5e-5), rng.uniform(3, 40), 9)])
    motion = Motion(top, start, friction, torque, pushes)
    return motion, rng.uniform(0, 0.3), rng.uniform(0.3, 1.5)


@pytest.mark.parametrize("first", seeds(1, 20))
def test_with_any_forces_what_is_gained_is_what_the_causes_gave(first):
    """Driven states are right to eps (4 + growth/10); the growth is about the turned angle."""
    for number in range(40 * first, 40 * (first + 1)):
        motion, begin, end = draw_driven(number)
        top, found = motion.top, Ledger.from_times(motion, begin, end)
        first_state, last = motion.at(begin), motion.at(end)
        rates = motion.at(np.linspace(begin, end, 200)).angular_velocity
        fastest = float(np.linalg.norm(rates, axis=-1).max())
        error = EPS * (4 + fastest * end / 10)
        moment = max(top.Ix, top.Iz)
        energy = 2 * error * (moment * fastest**2 + abs(top.Mgl))
        assert abs(found.gained.total - found.work) <= energy, number
        momentum = 2 * error * 2 * moment * fastest
        for name in ("vertical_momentum", "axial_momentum", "angular_momentum"):
            before, after = (getattr(top, name)(each) for each in (first_state, last))
            missed = getattr(found, name) - (after - before)
            assert np.abs(missed).max() <= momentum, (number, name)


def test_friction_takes_and_gives_nothing_back():
    motion = Motion(ARTICLE, CUSPS, Friction(1e-6, 2e-6))
    found = Ledger.from_times(motion, 0.0, 5.0)
    assert found.friction.work < 0
    assert found.axial_momentum == found.friction.axial_momentum < 0
    assert (found.torque.work, found.pushes.work) == (0, 0)


def test_a_torque_gives_p_phi_in_proportion_to_its_time():
    motion = Motion(ARTICLE, CUSPS, torque=(1e-4, 0.0, 5e-4))
    found = Ledger.from_times(motion, 0.25, 2.25).torque
    assert found.vertical_momentum == pytest.approx(2 * 5e-4, rel=1e-14)
    assert found.angular_impulse == pytest.approx([2e-4, 0.0, 1e-3], rel=1e-14)


@pytest.mark.parametrize("rate", [SLOW, FAST])
def test_each_push_gives_its_impulse_times_the_sine_of_the_tilt(rate):
    pushes = Pushes(5e-5, 20.0, 20)
    motion = Motion(ARTICLE, push_axle(ARTICLE, precess(rate), 5e-5), pushes=pushes)
    states = motion.at(np.arange(1, 20) / 20)
    found = Ledger.from_times(motion, 0.0, 1.0)
    given = 5e-5 * np.sin(states.euler_angles.theta).sum()
    assert found.pushes.vertical_momentum == pytest.approx(given, rel=1e-13)
    assert found.axial_momentum == 0
    assert found.gained.total == pytest.approx(found.pushes.work, abs=1e-14)
    # one after the other, a push at the end of a stretch belongs to it, and not to the next one
    edges = [*(k / 20 for k in range(19)), 1.0]
    parts = [Ledger.from_times(motion, *each).pushes.work for each in pairwise(edges)]
    assert sum(parts) == pytest.approx(found.pushes.work, rel=1e-13)


def test_on_the_way_down_the_precession_has_what_the_weight_gave():
    found = Ledger.from_times(FALL, 0.0, FALL.nutation_period / 2)
    assert f"{1e3 * found.gravity.work:.2f}" == f"{1e3 * found.gained.precession:.2f}" == "6.12"
    low, high = FALL.turning_angles
    drop = ARTICLE.Mgl * (math.cos(low) - math.cos(high))
    assert found.gravity.work == pytest.approx(drop, rel=1e-13)
    potential = EffectivePotential.from_state(ARTICLE, CUSPS)
    share = potential.at(high) - ARTICLE.Mgl * math.cos(high)
    assert found.gained.precession == pytest.approx(float(share), rel=1e-13)
    assert found.gravity.angular_impulse[2] == pytest.approx(0, abs=1e-17)


@pytest.mark.parametrize("family", ["near the top", "near the bottom", "generic"])
def test_heights_keep_their_digits_where_cosines_have_none(family):
    """Exact are the heights of the doubles of both states."""
    for number in range(100):
        motion, begin, end = draw_stretch(family, number)
        states = [motion.at(begin), motion.at(end)]
        with mp.workdps(60):
            parts = [list(map(mpf, each.orientation.tolist())) for each in states]
            sines, cosines = ([q[a] ** 2 + q[b] ** 2 for q in parts] for a, b in ((1, 2), (0, 3)))
            small, sign = min((sines, -2), (cosines, 2), key=lambda each: sum(each[0]))
            exact = sign * motion.top.Mgl * (small[1] - small[0])
            off = abs(mpf(Ledger.from_times(motion, begin, end).gained.weight) - exact)
            assert off <= 16 * EPS * abs(motion.top.Mgl) * max(small), number


def turns(motion):
    low, high = motion.turning_angles
    return not motion.is_driven and math.isfinite(motion.nutation_period) and high - low > 1e-6


@pytest.mark.parametrize("family", choose(DRAWS, ("generic", "through a pole", "Mgl < 0")))
def test_between_its_turning_points_theta_goes_from_one_to_the_other(family):
    for number in range(30):
        motion, t = draw_motion(family, number)
        if not turns(motion) or abs(t) > 1e4 * motion.nutation_period:
            continue
        found = Ledger.from_turns(motion, t)
        half = motion.nutation_period / 2
        assert found.end <= t < found.end + half * (1 + 1e-6)
        ends = sorted(motion.at(each).euler_angles.theta for each in (found.begin, found.end))
        # next to a turning point theta changes with the square of the time
        assert ends == pytest.approx(motion.turning_angles, abs=1e-7), number
        if ends[0] > 1e-3 and ends[1] < math.pi - 1e-3:  # at a pole the axis moves on
            assert abs(found.gained.nutation) <= 1e-6 * limit_kinetic(motion), number


def test_turning_points_of_a_clamped_axis_are_its_highest_and_its_lowest():
    motion = Motion(ARTICLE, precess(SLOW), clamped=True)
    found = Ledger.from_turns(motion, motion.nutation_period)
    angles = [motion.at(each).euler_angles.theta for each in (found.begin, found.end)]
    assert angles == pytest.approx([math.pi, 0.5], abs=1e-7)


def test_an_axis_that_passes_the_vertical_has_no_precession_there():
    motion = Motion(ARTICLE, State((1.0, 0.0, 0.0, 0.0), (3.0, 4.0, 150.0)))
    found = Ledger.from_times(motion, 0.0, motion.nutation_period / 2)
    assert found.gained.nutation == pytest.approx(-ARTICLE.Ix * 25 / 2, rel=1e-12)


@pytest.mark.parametrize(
    ("motion", "t", "text"),
    [
        (Motion(ARTICLE, precess(SLOW)), 1.0, "whose theta turns, got a motion that is regular"),
        (DAMPED, 1.0, "motion must be one without friction, torque and pushes, got 'driven'"),
        (FALL, math.nan, "t must be a finite number"),
    ],
)  # fmt: skip
def test_turning_points_that_are_not_there_are_refused(motion, t, text):
    with pytest.raises(ValueError, match=text):
        Ledger.from_turns(motion, t)


def test_a_stretch_that_ends_before_it_begins_is_refused():
    with pytest.raises(ValueError, match="end must be at least begin = 2 s, got 1"):
        Ledger.from_times(FALL, 2.0, 1.0)


def test_a_stretch_that_is_too_long_for_its_quadrature_is_refused():
    with pytest.raises(ValueError, match=r"end must be at most 898\.\d+ s after begin, got 1000 s"):
        Ledger.from_times(DAMPED, 1.0, 1001.0)
