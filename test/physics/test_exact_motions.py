"""The kernel against stored motions of many digits: hard cases, and tops of many families."""

import math
import re
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from mpmath import mp, mpf
from physics.exact_motions import DIGITS, ExactMotion, agree, read_motions
from physics.proofs import ATTITUDE, RATES, find_errors
from physics.tops import EPS, FAMILIES, attitude_error, error, random_case
from trials import choose

from symtop_ros.physics import Motion
from workshop.digits import ClosedForm

pytestmark = pytest.mark.untraced
MOTIONS = read_motions()
UNDER_GRAVITY = [each for each in MOTIONS if not each.motion.is_driven]
DRIVEN = [each for each in MOTIONS if each.motion.is_driven]
NEAR = 20.0  # rad: so far the series takes less than a second


def of_family(family, motions=MOTIONS):
    return [each for each in motions if each.family == family]


def families(motions):
    """Parameter `family`: those of some motions."""
    return pytest.mark.parametrize("family", {each.family: None for each in motions})


def test_there_are_motions_of_every_family():
    page = (Path(__file__).parents[2] / "docs/accuracy.md").read_text(encoding="utf-8")
    told = re.findall(r"(\d+) stored motions (?:with .*? )?(?:of|in) (\d+) families", page)
    found = [(len(some), len({each.family for each in some})) for some in (UNDER_GRAVITY, DRIVEN)]
    assert [(int(count), int(families)) for count, families in told] == found


PROMISED = 20 / 2 * EPS  # docs/accuracy.md; attitudes as distances, half the angles
OMEGA_PROMISED = 10 * EPS


@pytest.mark.slow
def test_the_largest_errors_of_stored_motions_are_those_of_the_docs():
    """The same on every machine, as states have the same bits."""
    page = (Path(__file__).parents[2] / "docs/accuracy.md").read_text(encoding="utf-8")
    told = re.search(r"at most ([\d.]+) eps\s+for the attitude and ([\d.]+) eps", page).groups()
    errors = np.array(
        [
            (
                2 * attitude_error(q, state.orientation),
                error(omega[:2], state.angular_velocity[:2])
                / max(float.fromhex(each.row["largest"]), 1e-300),
            )
            for each in UNDER_GRAVITY
            for t, (q, omega) in zip(each.times, each.states, strict=True)
            for state in [each.motion.at(t)]
        ],
        dtype=float,
    )
    largest = errors.max(axis=0) / EPS
    # rounded up, as they are said to be the most
    assert [math.ceil(10 * each) / 10 for each in largest] == [float(each) for each in told]


@families(UNDER_GRAVITY)
def test_states_under_gravity_are_as_right_as_the_docs_say(family):
    """Whatever the time."""
    for each in of_family(family):
        largest = float.fromhex(each.row["largest"])
        for t, (q, omega) in zip(each.times, each.states, strict=True):
            state = each.motion.at(t)
            assert attitude_error(q, state.orientation) <= PROMISED
            off = error(omega[:2], state.angular_velocity[:2])
            assert off <= OMEGA_PROMISED * largest
            assert state.angular_velocity[2] == each.motion.start.angular_velocity[2]


@settings(max_examples=100)
@given(st.integers(0, 10**9), st.sampled_from(FAMILIES))
def test_states_drawn_from_all_families_are_as_right_as_promised(seed, family):
    case = random_case(seed, family)
    attitude, rates = find_errors(Motion(case.top, case.start), case.t)
    assert attitude <= ATTITUDE
    assert rates <= RATES


@families(DRIVEN)
def test_driven_states_are_right_to_a_part_of_what_rounding_changes(family):
    """As docs/accuracy.md promises: of angles, twice the distances, eps (4 + growth/10)."""
    for each in of_family(family):
        facts = zip(each.times, each.states, each.row["growth"], strict=True)
        for t, (q, omega), growth in facts:
            state = each.motion.at(t)
            promised = EPS * (2 + growth / 10)
            assert attitude_error(q, state.orientation) <= promised
            largest = np.abs(each.motion.at(np.linspace(0, t, 50)).angular_velocity).max()
            assert error(omega, state.angular_velocity) <= 2 * promised * largest


@families(UNDER_GRAVITY)
def test_periods_and_mean_rates_are_right_to_rounding(family):
    for each in of_family(family):
        motion = each.motion
        exact = float(each.row["period"])
        assert (motion.kind == "asymptotic") == (exact == math.inf and motion.engine != "free")
        if motion.engine == "free" or math.isnan(exact):
            continue  # nothing nods, or nothing falls
        assert motion.nutation_period == pytest.approx(exact, rel=2 * EPS)
        found = motion.mean_precession_rate, motion.mean_spin_rate
        if each.row["rates"] and math.isfinite(found[0]):  # nan through a pole
            for rate, right in zip(found, each.row["rates"], strict=True):
                assert abs(mpf(rate) - mpf(right)) <= EPS * abs(mpf(right))


def rate_of(motion):
    """A rate in rad/s that no phase exceeds by much."""
    top = motion.top
    spin = np.abs(motion.start.angular_velocity).max()
    return max(math.sqrt(abs(top.Mgl) / top.Ix), float(spin))


NAMES = [*dict.fromkeys(each.family for each in MOTIONS)]


@pytest.mark.parametrize("family", choose(NAMES, NAMES[::5]))
def test_the_closed_form_and_a_taylor_series_have_the_digits_that_are_stored(family):
    """They share no formula. The first time of each family that is near enough for the series."""
    for each in of_family(family):
        near = [k for k, t in enumerate(each.times) if abs(t) * rate_of(each.motion) < NEAR]
        for k in near[:1]:
            # of a motion under gravity as many as are compared with those of the closed form
            found = [each.series(45 if each.motion.is_driven else 60).at(each.times[k])]
            assert agree([each.states[k]], found, DIGITS - 1)
            if not each.motion.is_driven:
                assert agree([ClosedForm(each.inputs, 120).at(each.times[k])], found, 38)
            return


@pytest.mark.long
@families(MOTIONS)
def test_the_table_holds_what_its_program_writes(family):
    for each in of_family(family):
        assert agree(ExactMotion(each.solve()).states, each.states, DIGITS - 1)


def test_a_tilt_however_small_keeps_its_digits():
    """Also x and y of the quaternion, which are as small as the tilt."""
    for each in of_family("tilt"):
        q, _ = each.states[0]
        state = each.motion.at(each.times[0])
        # an unstable top magnifies rounding of the tilt by no more than the tilt itself grows
        off = attitude_error(q[1:3], state.orientation[1:3], mp.norm(q[1:3]))
        assert off <= 32 * EPS
