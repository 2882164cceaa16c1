"""A node without enough of the processor says nothing that is not true."""

import pytest

from workshop.load.starvation import run_trial


@pytest.mark.slow
def test_every_number_that_a_starved_node_says_is_that_of_its_samples():
    trial = run_trial(20.0)
    assert trial.false == []
    assert min(trial.read[each] for each in ("logs", "diagnostics", "answers")) > 0


@pytest.mark.long
def test_so_it_is_in_five_minutes_next_to_twice_as_many_loops():
    trial = run_trial(300.0, loops=8)
    assert trial.false == []
    assert trial.read["warnings"] > 0
