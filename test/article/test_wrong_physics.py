"""A claim of the article fails for another top, but for those that are true of every top."""

import pytest

from symtop_ros.physics import Top
from workshop.article.motions import HANGING_DISC, TOP
from workshop.article.retell import check_claims

# Of these the numbers come from formulas that are compared with each other; for the formulas of
# some of them test_wrong_formulas.py has another rate, root or start.
OF_EVERY_TOP = {
    1,
    2,
    3,
    8,
    9,
    10,
    14,
    20,
    21,
    27,
    28,
    29,
    42,
    44,
    49,
    50,
    57,
    60,
    66,
    72,
    73,
    75,
    78,
}
TOPS = {
    "heavier": Top(TOP.Ix, TOP.Iz, 1.01 * TOP.Mgl),
    "no weight": Top(TOP.Ix, TOP.Iz, 0.0),
    "disc": HANGING_DISC,
}


def failing(top):
    return {number for number, claim in enumerate(check_claims(top), 1) if not claim.holds}


@pytest.fixture(scope="module")
def found():
    """The numbers of the claims that fail, by the name of the top."""
    return {name: failing(top) for name, top in TOPS.items()}


def test_each_claim_fails_for_another_top_or_is_true_of_every_top(found):
    assert failing(TOP) == set()
    everything = set(range(1, len(check_claims()) + 1))
    assert everything - set().union(*found.values()) == OF_EVERY_TOP


@pytest.mark.parametrize("name", TOPS)
def test_each_change_is_noticed(name, found):
    assert found[name]
