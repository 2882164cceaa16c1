"""A claim of the article fails for another top, but for those that are true of every top."""

import pytest

from symtop_ros.physics import Top
from workshop.article.claims import check_claims
from workshop.article.motions import HANGING_DISC, TOP

OF_EVERY_TOP = 23  # claims, whose numbers come from formulas that are compared with each other
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
    assert len(everything - set().union(*found.values())) == OF_EVERY_TOP
    assert all(found.values())
