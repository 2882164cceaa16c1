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


def quarters(m):
    """Return K and K' of a parameter, and the root of the nome."""
    K, Kc = quarter_period((1 - m) ** 0.5), quarter_period(m**0.5)
    return K, Kc, math.exp(-math.pi * K / Kc / 2)


def shifts(Kc, *complements, winding=0):
    """Return the shifts of A, B and omega_xy."""
    first, second, third = (part * Kc for part in complements)
    return (
        Shift(1.0, first, is_below=True),
        Shift(-1.0, second, is_below=False),
        Shift(1.0, third, is_below=False, winding=winding),
    )


def locate(x, stretch=1.0):
    """Return the place of phases; the complementary series stretches them."""
    return Location(x, x * stretch, (np.pi - np.abs(x)) * stretch)


def evaluate(series, location):
    """Return the quotients as complex numbers, (3, n)."""
    return np.array([real + 1j * imaginary for real, imaginary in series.values(location)])


@pytest.mark.parametrize("m", [0.45, 0.5, 0.55])
def test_both_nomes_give_the_same_quotients_up_to_a_constant(m):
    K, Kc, root_of_nome = quarters(m)
    shifted = shifts(Kc, 0.1, 0.5, 0.93)
    x = np.linspace(-3.1, 3.1, 101)
    direct = evaluate(DirectSeries(K, Kc, shifted), locate(x))
    series = ComplementarySeries(K, Kc, shifted, root_of_nome)
    complementary = evaluate(series, locate(x, K / Kc))
    ratio = direct / complementary
    # five terms of either series leave 1e-16; near its zero a quotient loses digits
    smallest = np.abs(direct).min(axis=1) / np.abs(direct).max(axis=1)
    spread = np.abs(ratio / ratio[:, :1] - 1).max(axis=1)
    assert (spread <= 32 * EPS / smallest).all()


@pytest.mark.parametrize("m", [0.02, 0.3, 0.7, 0.999, 1 - 1e-12])
@pytest.mark.parametrize("x", [-2.9, -0.4, 0.3, 1.7, 3.0])
def test_derivatives_are_those_of_the_values(m, x):
    K, Kc, root_of_nome = quarters(m)
    series, stretch = (
        choose_series(K, Kc, root_of_nome, shifts(Kc, 0.2, 0.5, 0.8)),
        max(1.0, K / Kc),
    )
    slopes = [complex(*series.slope(k, locate(x, stretch))) for k in range(3)]
    h = 1e-3 / stretch
    steps = h * np.array([-2, -1, 1, 2])
    weights = np.array([1, -8, 8, -1]) / (12 * h)
    around = evaluate(series, locate(x + steps, stretch))
    # five-point differences: h^4/30 times fifth derivatives of order (K/K')^5, and rounding/h
    atol = (1e-12 + 16 * EPS / 1e-3) * np.abs(around).max() * stretch
    np.testing.assert_allclose(around @ weights, np.array(slopes) * K / np.pi, atol=atol)  # in x


@pytest.mark.parametrize("m", [0.02, 0.7, 1 - 1e-12])
@pytest.mark.parametrize("winding", [-1, 0, 2])
def test_one_phase_gives_the_same_bits_as_an_array(m, winding):
    K, Kc, root_of_nome = quarters(m)
    series = choose_series(K, Kc, root_of_nome, shifts(Kc, 0.2, 0.5, 0.8, winding=winding))
    locations = locate(np.linspace(-3.1, 3.1, 257), max(1.0, K / Kc))
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
