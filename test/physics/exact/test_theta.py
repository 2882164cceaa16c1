import math

import numpy as np
import pytest
from mpmath import ellipk, mp, mpf
from physics.tops import EPS

from symtop_ros.physics.exact.complementary_series import ComplementarySeries
from symtop_ros.physics.exact.direct_series import DirectSeries
from symtop_ros.physics.exact.elementary import Location, Shift
from symtop_ros.physics.exact.nutation_phase import quarter_period
from symtop_ros.physics.exact.theta import choose_series


def shifts(*complements, winding=0):
    """Return the shifts of A, B and omega_xy."""
    first, second, third = complements
    return (
        Shift(1.0, first, is_below=True),
        Shift(-1.0, second, is_below=False),
        Shift(1.0, third, is_below=False, winding=winding),
    )


def evaluate(series, location):
    """Return the quotients as complex numbers, (3, n)."""
    return np.array([real + 1j * imaginary for real, imaginary in series.values(location)])


@pytest.mark.parametrize("m", [0.45, 0.5, 0.55])
def test_both_nomes_give_the_same_quotients_up_to_a_constant(m):
    K, Kc = quarter_period((1 - m) ** 0.5), quarter_period(m**0.5)
    shifted = shifts(0.1 * Kc, 0.5 * Kc, 0.93 * Kc)
    x = np.linspace(-3.1, 3.1, 101)
    stretched = Location(x, x * K / Kc, (np.pi - np.abs(x)) * K / Kc)
    direct = evaluate(DirectSeries(K, Kc, shifted), Location(x, x, np.pi - np.abs(x)))
    root_of_nome = math.exp(-math.pi * K / Kc / 2)
    complementary = evaluate(ComplementarySeries(K, Kc, shifted, root_of_nome), stretched)
    ratio = direct / complementary
    # five terms of either series leave 1e-16; near its zero a quotient loses digits
    smallest = np.abs(direct).min(axis=1) / np.abs(direct).max(axis=1)
    spread = np.abs(ratio / ratio[:, :1] - 1).max(axis=1)
    assert (spread <= 32 * EPS / smallest).all()


@pytest.mark.parametrize("m", [0.02, 0.3, 0.7, 0.999, 1 - 1e-12])
@pytest.mark.parametrize("x", [-2.9, -0.4, 0.3, 1.7, 3.0])
def test_derivatives_are_those_of_the_values(m, x):
    K, Kc = quarter_period((1 - m) ** 0.5), quarter_period(m**0.5)
    root_of_nome = math.exp(-math.pi * K / Kc / 2)
    series = choose_series(K, Kc, root_of_nome, shifts(0.2 * Kc, 0.5 * Kc, 0.8 * Kc))

    def locate(x):
        stretch = max(1.0, K / Kc)  # of the complementary series
        return Location(x, x * stretch, (np.pi - np.abs(x)) * stretch)

    slopes = np.array([complex(*series.slope(k, locate(x))) for k in range(3)]) * K / np.pi  # in x
    h = 1e-3 / max(1.0, K / Kc)
    steps = h * np.array([-2, -1, 1, 2])
    weights = np.array([1, -8, 8, -1]) / (12 * h)
    around = evaluate(series, locate(x + steps))
    # five-point differences: h^4/30 times fifth derivatives of order (K/K')^5, and rounding/h
    scale = np.abs(around).max() * max(1.0, K / Kc)
    np.testing.assert_allclose(around @ weights, slopes, atol=(1e-12 + 16 * EPS / 1e-3) * scale)


@pytest.mark.parametrize("m", [0.02, 0.7, 1 - 1e-12])
@pytest.mark.parametrize("winding", [-1, 0, 2])
def test_one_phase_gives_the_same_bits_as_an_array(m, winding):
    K, Kc = quarter_period((1 - m) ** 0.5), quarter_period(m**0.5)
    root_of_nome, stretch = math.exp(-math.pi * K / Kc / 2), max(1.0, K / Kc)
    shifted = shifts(0.2 * Kc, 0.5 * Kc, 0.8 * Kc, winding=winding)
    series = choose_series(K, Kc, root_of_nome, shifted)
    x = np.linspace(-3.1, 3.1, 257)
    locations = Location(x, x * stretch, (np.pi - np.abs(x)) * stretch)
    singly = [
        series.values(Location(*map(float, each))) for each in zip(*locations[:3], strict=True)
    ]
    assert np.array_equal(np.moveaxis(np.array(singly), 0, -1), np.array(series.values(locations)))


@pytest.mark.parametrize("m", [0.0, 1e-9, 0.5, 0.99, 1 - 1e-12])
def test_the_quarter_period_is_the_complete_elliptic_integral(m):
    modulus = float(mp.sqrt(1 - mpf(m)))
    with mp.workdps(30):
        exact = float(ellipk(1 - mpf(modulus) ** 2))
    assert quarter_period(modulus) == pytest.approx(exact, rel=4 * EPS)
