"""A claim of the article fails for another top, but for those that are true of every top."""

from symtop_ros.physics import Top
from workshop.article.claims import check_claims
from workshop.article.motions import HANGING_DISC, TOP

OF_EVERY_TOP = 23  # claims, whose numbers come from formulas that are compared with each other
TOPS = Top(TOP.Ix, TOP.Iz, 0.0), HANGING_DISC


def test_each_claim_fails_for_another_top_or_is_true_of_every_top():
    claims = [[claim.holds for claim in check_claims(top)] for top in TOPS]
    assert sum(map(all, zip(*claims, strict=True))) == OF_EVERY_TOP
    assert not any(map(all, claims))
