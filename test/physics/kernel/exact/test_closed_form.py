"""Accuracy against 30 digits: the reference motions, and random tops of all kinds."""

import json
import lzma
import random
from dataclasses import replace
from pathlib import Path

import pytest
from drawn import ten_to
from mpmath import mp, mpf
from physics.tops import ARTICLE, EPS, Case, attitude_error, error, exact_euler, random_case, seeds

from symtop_ros.physics import Motion, State, Top
from workshop.testset.exact import error_and_limit

pytestmark = pytest.mark.untraced
FAMILIES = ["any", "weak gravity", "fast", "critical", "pendulum", "from below"]
PACKED = Path(__file__).parents[2] / "motions.json.xz"
MOTIONS = json.loads(lzma.decompress(PACKED.read_bytes()))


def solved(motion_data):
    top = Top(*(motion_data[name] for name in ("Ix", "Iz", "Mgl")))
    return Motion(top, State(motion_data["q0"], motion_data["omega_body0"]))


@pytest.mark.parametrize("data", MOTIONS, ids=[data["name"] for data in MOTIONS])
def test_a_reference_motion_is_met_at_every_time(data):
    motion = solved(data)
    for t, q, omega in zip(data["t"], data["q"], data["omega_body"], strict=True):
        state, size = motion.at(t), float(mp.norm(map(mpf, omega))) or 1.0
        # The start is taken as exact and phases are reduced with 32 digits: rounding of the last
        # few operations is all that is left, whatever t is: 5 eps are promised (docs/accuracy.md).
        assert attitude_error(q, state.orientation) <= 5 * EPS
        assert error(omega, state.angular_velocity, size) <= 5 * EPS


def test_there_are_27_reference_motions():
    assert len(MOTIONS) == 27


@pytest.mark.parametrize("family", FAMILIES[:-1])
@pytest.mark.parametrize("seed", seeds(8, 40))
def test_a_random_top_is_met_to_rounding(family, seed):
    case = random_case(seed, family)
    # Up to 1e9 s; an angle of 10 eps, which is a distance of 5, is promised.
    assert attitude_error(case.exact[0], case.found.orientation) <= 5 * EPS


@pytest.mark.parametrize("family", FAMILIES)
@pytest.mark.parametrize("seed", seeds(2, 20))
def test_rates_of_a_random_top_are_met_to_the_limit_of_its_inputs(family, seed):
    case = random_case(seed + 100, family)
    state = case.found
    off, rate_error, limit = error_and_limit(case.inputs, case.t, *state.parts)
    assert off <= 4 * limit + 8 * EPS
    # Relative to the angular velocity of that instant, which vanishes now and then for a pendulum:
    # compare with its largest one instead.
    largest = max(abs(case.start.angular_velocity).max(), (abs(case.top.Mgl) / case.top.Ix) ** 0.5)
    now = float(abs(state.angular_velocity).max())
    assert rate_error * min(1.0, now / largest) <= 4 * limit + 8 * EPS


@pytest.mark.parametrize("tilt", [ten_to(-k) for k in range(1, 16)])
@pytest.mark.parametrize("spin", [0.0, 30.0, 137.7, 200.0])
def test_a_tilt_however_small_keeps_its_digits(tilt, spin):
    case = Case(ARTICLE, State.from_euler(theta=tilt, psi_dot=spin), 0.7)
    inclined = case.exact[0][1:3]
    # the small components of q are right to rounding of themselves, not only of 1; an unstable
    # top magnifies rounding of the tilt alone by no more than the tilt itself grows
    assert attitude_error(inclined, case.found.orientation[1:3], mp.norm(inclined)) <= 32 * EPS


@pytest.mark.parametrize("tilt", [1e-3, 1e-5, 1e-8])
def test_the_tilt_of_a_top_that_falls_and_comes_back_keeps_its_digits(tilt):
    start = State.from_euler(theta=tilt, psi_dot=100.0)
    chance = random.Random(tilt)
    for t in [chance.uniform(1.0, 1e6) for _ in range(12)]:
        case = Case(ARTICLE, start, t)
        with mp.workdps(30):
            (phi, theta, _), _ = exact_euler(*case.exact)
            size = ARTICLE.Mgl * mp.sin(theta)
            exact, state = (size * mp.cos(phi), size * mp.sin(phi), 0), case.found
        # As promised for theta in docs/accuracy.md.
        assert abs(state.euler_angles.theta - theta) <= 4 * EPS * theta
        assert error(exact, ARTICLE.gravity_torque(state), size) <= 4 * EPS


@pytest.mark.parametrize("theta_dot", [-20.0, 30.0, -60.0])
def test_an_axis_that_passes_the_pole_keeps_the_digits_of_its_tilt(theta_dot):
    start = State.from_euler(theta=0.9, theta_dot=theta_dot, phi=0.3)
    motion, chance = Motion(ARTICLE, start), random.Random(theta_dot)
    times = [chance.uniform(1.0, 1e6) for _ in range(1000)]
    tilts = zip(times, motion.at(times).euler_angles.theta.tolist(), strict=True)
    for t, tilt in [each for each in tilts if 1e-3 < each[1] < 0.05][:8]:
        with mp.workdps(30):
            (_, theta, _), _ = exact_euler(*Case(ARTICLE, start, t).exact)
            # As promised. Below 1e-3 rad 2^-62 of a turn, to which phases are known, counts.
            assert abs(tilt - theta) <= 4 * EPS * theta


def test_the_separatrix_itself_is_a_pendulum_that_rises_for_ever():
    # theta'' = sin(theta): from hanging with theta' = -2 it is theta = 4 atan(exp(-t))
    motion = Motion(Top(1.0, 0.5, 1.0), State((0.0, 1.0, 0.0, 0.0), (-2.0, 0.0, 0.0)))
    assert motion.kind == "asymptotic"
    assert motion.nutation_period == float("inf")
    for t in (0.0, 0.5, 3.0, 10.0, 30.0, -2.0):
        exact = 4 * mp.atan(mp.exp(-abs(t)))
        assert float(motion.at(t).euler_angles.theta) == pytest.approx(float(exact), rel=16 * EPS)


@pytest.mark.long
def test_near_the_separatrix_every_step_is_met():
    for k in range(1, 16):
        for sign in (1, -1):
            omega = -2.0 * (1 + sign * ten_to(-k))
            start = State((0.0, 1.0, 0.0, 0.0), (omega, 0.0, 0.1))
            case = Case(Top(1.0, 0.5, 1.0), start, 7.0)
            off, _, limit = error_and_limit(case.inputs, 7.0, *case.found.parts)
            assert off <= 4 * limit + 8 * EPS


@pytest.mark.parametrize("t", [1e9, -3e10, 1e11, 5e11])
@pytest.mark.parametrize("name", ["article", "near critical", "fast"])
def test_a_time_of_any_length_is_met(name, t):
    spin = {"article": 200.0, "near critical": ARTICLE.critical_spin * (1 + 1e-10), "fast": 1e4}
    start = State.from_euler(theta=0.5 if name != "near critical" else 1e-3, psi_dot=spin[name])
    case = Case(ARTICLE, start, t)
    # up to 1e15 turns: frequencies have 48 digits, so that rounding of the last operations remains
    assert attitude_error(case.exact[0], case.found.orientation) <= 5 * EPS


@pytest.mark.parametrize("seed", seeds(10, 20))
def test_a_spin_within_1e_9_of_critical_is_met_after_a_long_time(seed):
    case = replace(random_case(seed, "critical"), t=ten_to(seed % 10))
    assert attitude_error(case.exact[0], case.found.orientation) <= 5 * EPS
