"""Estimates of a gyroscope whose range ends below the spin: what is said, and where nothing is."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation
from truth.judge.cases import SECOND, make_estimates, truth_and_stamps

from symtop_ros.truth.judge.judgement import judge
from symtop_ros.truth.judge.saturated import find_saturated
from symtop_ros.truth.topics.estimates import Estimates

LIMIT = 34.906585  # rad/s; 2000 deg/s
TRUTH, _ = truth_and_stamps(2)
STAMPS = SECOND + np.arange(1500) * SECOND // 1000
EXACT = make_estimates(TRUTH, STAMPS)


def integrate(rates):
    """Return attitudes that turn by rates (n, 3) from row to row, as a filter without noise has."""
    q = Rotation.from_quat(EXACT.orientations[0, [1, 2, 3, 0]])
    found = []
    for rate in rates:
        found.append(q.as_quat()[[3, 0, 1, 2]])
        q = q * Rotation.from_rotvec(rate * 1e-3)
    return Estimates.of(STAMPS, found)


@pytest.mark.parametrize("part", [1.0, 32767 / 32768])
def test_rates_at_the_limit_are_named_with_the_exact_rate(part):
    clipped = np.clip(EXACT.angular_velocities, -part * LIMIT, part * LIMIT)
    found = find_saturated(replace(EXACT, angular_velocities=clipped), TRUTH)
    assert (found.of, found.limit, found.share) == ("rates", part * LIMIT, 1.0)
    assert found.exact == pytest.approx(200.0, rel=1e-9)
    (note,) = judge(replace(EXACT, angular_velocities=clipped), TRUTH, "log").notes
    assert "a rate is at 34.90" in note
    assert "in 100% of the estimates, where the exact rate is 200 rad/s" in note


def test_attitudes_that_turn_at_the_limit_are_named():
    noise = 0.05 * np.sin(np.arange(len(STAMPS)) ** 2)[:, np.newaxis]
    clipped = np.clip(EXACT.angular_velocities + noise, -LIMIT, LIMIT)
    found = find_saturated(integrate(clipped), TRUTH)
    assert (found.of, found.limit) == ("turns", pytest.approx(LIMIT, rel=1e-8))
    assert "the attitudes turn about an axis of the body at 34.907 rad/s (2000 deg/s)" in (
        found.describe()
    )


def test_nothing_is_said_of_rates_within_the_range_and_of_units():
    assert find_saturated(EXACT, TRUTH) is None
    assert find_saturated(integrate(EXACT.angular_velocities), TRUTH) is None
    degrees = replace(EXACT, angular_velocities=np.degrees(EXACT.angular_velocities))
    assert find_saturated(degrees, TRUTH) is None


def test_two_attitudes_at_one_time_have_no_rate():
    stamps = STAMPS.copy()
    stamps[7] = stamps[6]
    twice = replace(integrate(np.clip(EXACT.angular_velocities, -LIMIT, LIMIT)), stamps=stamps)
    assert find_saturated(twice, TRUTH) is None


def test_turns_that_may_be_more_than_are_seen_say_nothing():
    """At 10 Hz 200 rad/s are three turns and more from row to row."""
    few = integrate(np.clip(EXACT.angular_velocities, -LIMIT, LIMIT)).select(
        np.arange(len(STAMPS)) % 100 == 0
    )
    assert find_saturated(few, TRUTH) is None
