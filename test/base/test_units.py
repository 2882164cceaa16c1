"""Units as people type them, for top_ctl and the page."""

import pytest

from symtop_ros.base.refusals import RefusedError
from symtop_ros.base.units import QUANTITIES, UNITS, parse_quantity, read_value


def test_a_number_has_a_unit_of_its_quantity_or_none():
    typed = {"2.2s": 2.2, "2200 ms": 2.2, "2.2": 2.2, "-1e-3": -1e-3, " .5 min": 30.0, "2.": 2.0}
    assert {text: parse_quantity("t", text, "s") for text in typed} == typed


def test_decimal_parts_are_rounded_once():
    assert parse_quantity("distance", "5.5cm", "m") == 0.055
    assert parse_quantity("mass", "170g", "kg") == 0.17
    assert parse_quantity("distance", "-25.3cm", "m") == -0.253


@pytest.mark.parametrize("text", ["", "s", "3 kg", "1_0", "1 s s", "nan s", "--1", "1e", "2,2 s"])
def test_any_other_text_is_refused_with_the_units(text):
    with pytest.raises(RefusedError, match="t must be a number in s, ms or min, got "):
        parse_quantity("t", text, "s")


def test_each_quantity_has_a_unit_of_si_that_comes_first():
    assert {*QUANTITIES.values()} <= {*UNITS}
    assert all(next(iter(units.items())) == (unit, 1.0) for unit, units in UNITS.items())


def test_words_that_are_no_quantity_stay_text_or_become_numbers():
    assert read_value("precession", "slow") == "slow"
    assert read_value("precession_rate_factor", "1.4") == 1.4
    assert read_value("psi_dot", "60 rpm") == pytest.approx(6.283185307179586, rel=1e-15)
