"""Errors of random motions are proved to be within what docs/accuracy.md promises."""

import pytest
from physics.families import DRAWS
from physics.proofs import ATTITUDE, COUNT, RATES, find_largest_errors
from trials import trials

pytestmark = pytest.mark.untraced


@pytest.mark.parametrize("family", DRAWS)
@pytest.mark.parametrize("count", trials(5, COUNT))
def test_errors_of_random_motions_are_proved_to_be_within_the_promises(
    family: str, count: int
) -> None:
    attitude, rates = find_largest_errors(family, count)
    assert attitude <= ATTITUDE
    assert rates <= RATES
