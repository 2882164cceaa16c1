"""Exchanges in words: who gave, who has it, and what is rounding only."""

import pytest
from physics.families import DRAWS, draw_motion
from physics.tops import ARTICLE, CUSPS, SLOW, precess

from symtop_ros.physics import Exchange, Friction, Ledger, Motion, Pushes, State, Top, push_axle
from symtop_ros.words import write

pytestmark = pytest.mark.wording
KEPT = "p_phi and p_psi are constant"
PUSHED = Motion(ARTICLE, push_axle(ARTICLE, precess(SLOW), 5e-5), pushes=Pushes(5e-5, 20.0, 20))


def tell(motion, end=0.05):
    return str(Ledger.from_times(motion, 0.0, end))


def test_under_gravity_the_weight_gives_what_the_others_have():
    assert tell(Motion(ARTICLE, CUSPS)) == (
        "In 0.05 s the weight gave 4.22 mJ, the precession got 3.3 mJ, the nutation got "
        f"0.919 mJ; {KEPT}."
    )


@pytest.mark.parametrize("start", [precess(SLOW), State((1.0, 0.0, 0.0, 0.0), (0.0, 0.0, 9.0))])
def test_where_theta_stays_nothing_is_exchanged(start):
    assert tell(Motion(ARTICLE, start), 3.3) == f"In 3.3 s no energy was exchanged; {KEPT}."


def test_what_a_fast_top_exchanges_is_not_lost_beside_its_spin():
    """The spin has 2.9 GJ; the weight gives some 1e-12 J."""
    fast = Motion(ARTICLE, State.from_euler(theta=0.5, psi_dot=1e7))
    exchange = Exchange.from_ledger(Ledger.from_times(fast, 0.0, fast.nutation_period / 2))
    assert [(each.kind, each.who) for each in exchange.shares] == [
        ("gave", "weight"),
        ("got", "precession"),
    ]
    low, high = fast.turning_angles
    assert exchange.shares[0].amount == pytest.approx(
        1e3 * ARTICLE.Mgl * 0.479425538604203 * (high - low), rel=1e-3
    )


def test_a_hand_that_clamps_gives_to_p_phi_only():
    assert tell(Motion(ARTICLE, CUSPS, clamped=True), 0.1) == (
        "In 0.1 s the weight gave 45.8 mJ, the nutation got 45.8 mJ; the hand at the ring took "
        "0.00771 N m s from p_phi."
    )


def test_pushes_give_energy_and_p_phi():
    assert tell(PUSHED, 1.0) == (
        "In 1 s the precession gave 0.635 mJ, the pushes gave 2.66 mJ, the weight got 3.29 mJ, "
        "the nutation got 0.00531 mJ; the pushes gave 0.000407 N m s to p_phi."
    )


def test_friction_takes_from_both_momenta():
    text = tell(Motion(ARTICLE, CUSPS, Friction(1e-6, 2e-6)), 2.0)
    assert "the spin gave" in text
    assert "the friction took" in text
    for name in ("p_phi", "p_psi"):
        assert f"N m s from {name}" in text
    assert "the torque" not in text


@pytest.mark.parametrize("family", DRAWS)
def test_in_every_family_what_is_given_is_what_is_got(family):
    for number in range(30):
        motion, t = draw_motion(family, number)
        ledger = Ledger.from_times(motion, *sorted((0.0, t)))
        exchange, sizes = Exchange.from_ledger(ledger), ledger.sizes
        gave = sum(each.amount for each in exchange.shares if each.kind == "gave")
        got = sum(each.amount for each in exchange.shares if each.kind != "gave")
        # each of three parts may be left out, and their sum is off by rounding: 1e-12 of the sizes
        least = 1e3 * 4 * 1e-12 * (sizes.weight + sizes.precession + sizes.nutation)
        assert gave == pytest.approx(got, rel=0, abs=least), number
        assert exchange.momenta.kind == "kept"
        assert write("exchange", exchange).endswith(f"{KEPT}.")
        assert exchange.shares == tuple(
            sorted(exchange.shares, key=lambda each: each.kind != "gave")
        )


def test_a_weightless_top_has_no_weight_to_give():
    motion = Motion(Top(1.0, 1.0, 0.0), State.from_euler(theta=0.5, theta_dot=1.0, psi_dot=3.0))
    assert (
        tell(motion, 1.0) == f"In 1 s the nutation gave 266 mJ, the precession got 266 mJ; {KEPT}."
    )
