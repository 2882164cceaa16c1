"""The experiments of design/ show what the comments at the choices say."""

import importlib
import pkgutil

import pytest
from documents import ROOT

import design
from design.digits import measure_loss
from design.extended_terms import measure_error
from design.fused_products import COUNT, count_imaginary, count_other_bits
from design.lost_sums import find_mean_spins
from design.nomes import COMPLEMENTS, count_terms
from design.phases import TIMES, measure_errors

DERIVATION = ROOT / "docs/derivation.md"
NAMES = [each.name for each in pkgutil.iter_modules(design.__path__)]


@pytest.mark.parametrize("name", NAMES)
def test_each_experiment_prints_its_table_and_is_named_where_the_choice_is(name, capsys):
    importlib.import_module(f"design.{name}").main()
    assert len(capsys.readouterr().out.splitlines()) > 1
    kernel = (ROOT / "symtop_ros/physics/kernel").rglob("*.hpp")
    texts = [each.read_bytes() for each in (*kernel, ROOT / "build_kernel.py", DERIVATION)]
    assert any(f"design/{name}.py".encode() in text for text in texts)


def test_fifty_seven_digits_serve_all_turns_and_thirty_eight_do_not():
    assert measure_loss(57) * 1e15 < 2**-64 < measure_loss(38) * 1e15
    assert measure_loss(28) * 1e15 > 1e-14  # turns


def test_a_sum_that_cancels_is_in_proportion_to_the_weight():
    (few, many), (_, heavier) = find_mean_spins(1e-48), find_mean_spins(1e-30)
    assert many == pytest.approx(1e-18 * heavier, rel=1e-14, abs=0)
    assert few != pytest.approx(many, rel=1e-3, abs=0)


def test_eight_terms_serve_two_radians_as_twelve_serve_longer_steps():
    # in parts of 2^-53: far below rounding, and of the same size
    assert measure_error(2.0, 8) < 1e-3
    assert measure_error(3.5, 12) < 1e-3 < measure_error(3.5, 11)


def test_fused_products_change_bits_and_make_squares_complex():
    assert count_other_bits() > COUNT / 3
    assert count_imaginary() == (0, COUNT)


def test_phases_lose_nothing_with_time_and_products_of_doubles_do():
    errors = [measure_errors(t) for t in TIMES]
    assert errors[-1][0] > 1e-4
    # rounding of the phase, of its cosine and of its sine
    assert max(integers for _, integers in errors) < 2 * 2.0**-52


def test_one_of_the_series_has_few_terms_for_every_modulus():
    counts = [count_terms(complement) for complement in COMPLEMENTS]
    assert max(map(min, counts)) <= 3
    assert max(map(max, counts)) > 20
