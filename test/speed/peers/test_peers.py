"""Every peer that is installed integrates the same top."""

import numpy as np
import pytest

from symtop_ros.physics import Motion
from workshop.speed.benchmarks import CHECK
from workshop.speed.peers import find_peers
from workshop.speed.reference import EPS, Reference

CUSPS, *_, RUBBING = Reference.read().article
PEERS, MISSING = find_peers()
FEW = 500
# Radau is implicit and Pinocchio is stepped from Python: their finest settings take seconds.
SLOW = ("SciPy Radau", "Pinocchio")
AT_THEIR_FINEST = [
    pytest.param(peer, marks=pytest.mark.long if peer.name.startswith(SLOW) else (), id=peer.name)
    for peer in PEERS
]


def find_error(peer, problem, t, setting):
    times, orientations = peer.prepare(problem.task, setting).record(t)
    some = slice(None, None, 1 + len(times) // FEW)  # the exact motion costs a millisecond each
    return problem.errors(times[some], orientations[some]).max()


@pytest.mark.parametrize("peer", AT_THEIR_FINEST)
def test_a_peer_with_friction_has_the_same_friction(peer):
    if peer.friction == "no":
        pytest.skip("its model has no friction")
    # friction itself changes the state by 1e-3 in this time
    assert find_error(peer, RUBBING, CHECK, peer.settings[-1]) < 1e-10


@pytest.mark.parametrize("peer", PEERS, ids=lambda peer: peer.name)
def test_the_recorded_motion_is_the_one_that_is_timed(peer):
    problem = RUBBING if peer.friction == "only" else CUSPS
    solution = peer.prepare(problem.task, peer.settings[1 % len(peer.settings)])
    times, orientations = solution.record(0.125)
    assert times.max() == 0.125
    assert times.min() > 0
    # The steps are the same but for two: Radau ends with another Newton iteration, and Drake with
    # error control chooses its first step by the last one of before. Both make
    # differences of the size of the tolerance.
    adaptive = "Radau" in peer.name or "three angles" in peer.name
    close = 10 * peer.settings[1] if adaptive else 4 * EPS
    end = orientations[times.argmax()]
    np.testing.assert_allclose(end, solution.reach(0.125), rtol=0, atol=close)


WITH_ARRAYS = [peer for peer in PEERS if peer.prepare_arrays]


@pytest.mark.parametrize("peer", WITH_ARRAYS, ids=lambda peer: peer.name)
def test_arrays_of_states_are_states_at_those_times(peer):
    times = np.linspace(0.0, 1.0, 11)[1:]
    found = peer.prepare_arrays(CUSPS.task)(times)
    exact = Motion(CUSPS.task.top, CUSPS.task.start).at(times).orientation
    assert found.shape == (10, 4)
    signs = np.copysign(1.0, (found * exact).sum(axis=1))
    # at tolerances of 1e-13 and below, and a second
    assert np.abs(found - signs[:, None] * exact).max() < 1e-11
