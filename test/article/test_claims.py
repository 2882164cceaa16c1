import pytest

from symtop_ros.physics import Top
from workshop.article.motions import HANGING_DISC, TOP, cusps, regular
from workshop.article.nutation import momentum_does_not_close
from workshop.article.retell import check_claims


@pytest.mark.parametrize(
    "top",
    [
        HANGING_DISC,
        pytest.param(Top(TOP.Ix, TOP.Iz, 0.0), marks=pytest.mark.long),
        pytest.param(Top(TOP.Ix, TOP.Iz, 20 * TOP.Mgl), marks=pytest.mark.long),
        pytest.param(Top(1e-4, 2e-4, 1e-9), marks=pytest.mark.long),
    ],
    ids=["disc", "weightless", "heavy", "flat"],
)
def test_of_another_top_claims_fail_in_words(top):
    broken = [claim for claim in check_claims(top) if not claim.holds]
    assert len(broken) > 20
    assert all(claim.sentence.endswith(".") for claim in broken)


def test_a_claim_without_a_root_says_so():
    lost = momentum_does_not_close(cusps(HANGING_DISC), regular(HANGING_DISC))
    assert (lost.holds, lost.verdict) == (False, "FAIL")
    assert lost.measured == "cannot be measured: f(a) and f(b) must have different signs"
