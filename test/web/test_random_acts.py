"""Random acts on the page: four of them, and for half an hour."""

import pytest
from web import random_acts

HALF_HOUR = 1800.0  # s


@pytest.mark.parametrize(
    ("seed", "seconds", "most"),
    [(49, HALF_HOUR, 4), pytest.param(1749, HALF_HOUR, 10**9, marks=pytest.mark.long)],
)
def test_no_act_stops_the_page_and_python_reads_its_run(browser, seed, seconds, most):
    acts = random_acts.run(browser, seed, seconds, most)
    print(f"seed {seed}: {acts.total()} acts: {dict(acts)}")
    assert acts.total() >= min(most, 1000)
