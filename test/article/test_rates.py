import pytest

from symtop_ros.physics import Motion, Top
from workshop.article import rates
from workshop.article.motions import FAST, RATES, SLOW, TOP, Rate, start
from workshop.article.rates import Departure, claims_on_rates, rate_decides

HEAVIER = Top(TOP.Ix, TOP.Iz, 1.01 * TOP.Mgl)


def test_for_a_top_one_percent_heavier_the_roots_are_not_as_printed():
    failed = {claim.sentence for claim in claims_on_rates(HEAVIER) if not claim.holds}
    assert sum("stays" in sentence for sentence in failed) == 2
    assert any("phi' = 6.50 and 69.8" in sentence for sentence in failed)


def test_a_top_too_heavy_for_regular_precession_fails_without_an_error():
    claims = claims_on_rates(Top(TOP.Ix, TOP.Iz, 0.6))
    assert not claims[0].holds
    assert [claim.holds for claim in claims if "Perry" in claim.sentence] == [False, False, True]


@pytest.mark.parametrize("direction", ["rises", "falls", "stays"])
@pytest.mark.parametrize("rate", RATES, ids=lambda rate: f"{rate.phi_dot:.3g}")
def test_the_claim_on_a_rate_holds_only_with_the_direction_of_the_top(rate, direction):
    claim = rate_decides(TOP, Rate(rate.phi_dot, rate.place, direction))
    assert claim.holds == (direction == rate.direction)


@pytest.mark.parametrize("off", [1e-2, 1e-4, 1e-6, 1e-8])
@pytest.mark.parametrize("root", [SLOW, FAST])
def test_a_rate_a_little_off_a_root_does_not_stay(root, off):
    for sign in (-1, 1):
        expected = "rises" if sign == (1 if root == SLOW else -1) else "falls"
        departure = Departure.of(Motion(TOP, start(root * (1 + sign * off))))
        # the motion in a short time is left out: it is below rounding for the smallest of them
        assert departure.directions[0] == departure.directions[2] == expected


# The leading coefficient of a kick that holds the other quantity, and a delay in place of a hurry.
WRONG = {
    "LEADING": {"spin_rate": lambda top: top.Ix, "spin_momentum": lambda top: top.Ix - top.Iz},
    "SMALL": 1 / rates.SMALL,
}


@pytest.mark.parametrize("name", WRONG)
@pytest.mark.parametrize("root", ["slow", "fast"])
def test_the_exact_rule_fails_if_one_of_its_constants_is_changed(root, name, monkeypatch):
    assert rates.sign_decides(root, TOP).holds
    monkeypatch.setattr(rates, name, WRONG[name])
    assert not rates.sign_decides(root, TOP).holds
