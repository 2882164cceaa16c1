"""The energy of a kick, and what its hold decides."""

import pytest

from symtop_ros.physics import Top
from workshop.article.answers import ledger
from workshop.article.motions import HANGING_DISC, TOP


@pytest.mark.parametrize("hold", ledger.HOLDS)
def test_of_another_top_the_energies_are_others(hold):
    for other in (Top(1.01 * TOP.Ix, TOP.Iz, TOP.Mgl), Top(TOP.Ix, TOP.Iz, 1.01 * TOP.Mgl)):
        assert not ledger.precession_lifts(other, hold).holds


def test_the_disc_of_another_weight_accelerates_otherwise():
    disc = Top(HANGING_DISC.Ix, HANGING_DISC.Iz, 1.01 * HANGING_DISC.Mgl)
    assert not ledger.hold_decides(disc).holds


def test_with_one_hold_twice_nothing_is_decided(monkeypatch):
    right = ledger.hurry
    monkeypatch.setattr(ledger, "hurry", lambda state, factor, _: right(state, factor))
    assert not ledger.hold_decides(HANGING_DISC).holds
    assert not ledger.precession_lifts(TOP, "spin_momentum").holds


@pytest.mark.parametrize("hold", ledger.HOLDS)
@pytest.mark.parametrize("name", ledger.CASES)
def test_what_the_push_puts_into_the_rest_stays_there(name, hold):
    found = ledger.hurry_ledger(*ledger.CASES[name], hold)
    # energies of 1000 mJ and less, each a sum of three terms: ten roundings of 1e-13 mJ
    assert found.kick.rest == pytest.approx(found.far.rest, abs=1e-12)
    assert found.kick.spin == pytest.approx(found.far.spin, abs=1e-12)
    assert (found.kick.spin == pytest.approx(0, abs=1e-12)) == (hold == "spin_momentum")
