"""Every peer that is installed integrates the same top; what is not installed is skipped."""

import numpy as np
import pytest

from symtop_ros.physics import Friction, motion
from symtop_ros.report.precision.chapters import CHECK, RIGHT, dense
from symtop_ros.report.precision.measure import task_of
from symtop_ros.report.precision.peers import OPTIONAL, installed
from symtop_ros.report.precision.peers.own import CLOSED_FORM, SPLITTING
from symtop_ros.report.precision.peers.peer import Task
from symtop_ros.report.precision.reference import Reference

CUSPS, *_, RUBBING = Reference.read().article
PEERS, MISSING = installed()
GREEDY = Task(CUSPS.top, CUSPS.start, Friction())


def finest(peer, problem, t):
    return problem.error(t, peer.prepare(task_of(problem), peer.settings[-1])(t))


@pytest.mark.parametrize("peer", PEERS, ids=lambda peer: peer.name)
def test_a_peer_is_right_at_its_finest_setting(peer):
    problem = RUBBING if peer.friction == "only" else CUSPS
    assert finest(peer, problem, CHECK) < RIGHT


@pytest.mark.parametrize("peer", PEERS, ids=lambda peer: peer.name)
def test_a_peer_with_friction_has_the_same_friction(peer):
    if peer.friction == "no":
        pytest.skip("its model has none")
    # friction itself changes the state by 6e-3 in this time
    assert finest(peer, RUBBING, CHECK) < 1e-10


@pytest.mark.parametrize("peer", PEERS, ids=lambda peer: peer.name)
def test_finer_settings_are_better(peer):
    if len(peer.settings) == 1:
        pytest.skip("it has no settings")
    coarse, fine = (CUSPS.error(0.1, peer.prepare(GREEDY, peer.settings[k])(0.1)) for k in (0, -2))
    assert fine < coarse / 8


@pytest.mark.parametrize("peer", PEERS, ids=lambda peer: peer.name)
def test_a_peer_starts_anew_each_time(peer):
    problem = RUBBING if peer.friction == "only" else CUSPS
    solve = peer.prepare(task_of(problem), peer.settings[0])
    first = problem.error(0.1, solve(0.1))
    solve(0.2)
    # the same but for the first step, which Drake chooses by the last one of before
    assert problem.error(0.1, solve(0.1)) <= 4 * first


@pytest.mark.parametrize(("name", "arrays"), list(dense(PEERS)), ids=lambda each: str(each)[:20])
def test_arrays_of_states_are_states_at_those_times(name, arrays):
    times = np.linspace(0.0, 1.0, 11)[1:]
    found = arrays(task_of(CUSPS))(times)
    exact = motion(CUSPS.top, CUSPS.start).at(times).orientation
    assert found.shape == (10, 4), name
    # at tolerances of 1e-13 and below, and a second
    assert np.abs(found - np.copysign(1.0, (found * exact).sum(axis=1))[:, None] * exact).max() < (
        1e-11
    )


def test_what_is_not_installed_is_named():
    assert set(MISSING) <= set(OPTIONAL)
    assert [peer.name for peer in PEERS][:2] == [CLOSED_FORM, SPLITTING]
    assert sum(peer.name.startswith("SciPy") for peer in PEERS) == 6
