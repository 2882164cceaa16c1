import numpy as np
import pytest
from mpmath import ellipk, mp, mpf
from physics.tops import EPS

from symtop_ros.physics.closed_form import quarter_period
from symtop_ros.physics.theta import ComplementarySeries, DirectSeries

SIGN = np.array([[1.0], [-1.0], [1.0]])


@pytest.mark.parametrize("m", [0.45, 0.5, 0.55])
def test_both_nomes_give_the_same_quotients_up_to_a_constant(m):
    K, Kc = quarter_period((1 - m) ** 0.5), quarter_period(m**0.5)
    rest = Kc * np.array([[0.1], [0.5], [0.93]])
    x = np.linspace(-3.1, 3.1, 101)
    direct = DirectSeries(K, Kc, SIGN, rest).values(x)
    complementary = ComplementarySeries(K, Kc, SIGN, rest).values(x)
    ratio = direct / complementary
    # five terms of either series leave 1e-16; near its zero a quotient loses digits
    smallest = np.abs(direct).min(axis=1) / np.abs(direct).max(axis=1)
    spread = np.abs(ratio / ratio[:, :1] - 1).max(axis=1)
    assert (spread <= 32 * EPS / smallest).all()


@pytest.mark.parametrize("m", [0.02, 0.3, 0.7, 0.999, 1 - 1e-12])
@pytest.mark.parametrize("x", [-2.9, -0.4, 0.3, 1.7, 3.0])
def test_derivatives_are_those_of_the_values(m, x):
    K, Kc = quarter_period((1 - m) ** 0.5), quarter_period(m**0.5)
    kind = DirectSeries if Kc >= K else ComplementarySeries
    series = kind(K, Kc, SIGN, Kc * np.array([[0.2], [0.5], [0.8]]))
    values, slopes = series.at_start(x)
    h = 1e-3 / max(1.0, K / Kc)
    steps = h * np.array([-2, -1, 1, 2])
    weights = np.array([1, -8, 8, -1]) / (12 * h)
    around = series.values(x + steps)
    np.testing.assert_allclose(values, series.values(np.array([x]))[:, 0], rtol=8 * EPS)
    # five-point differences: h^4/30 times fifth derivatives of order (K/K')^5, and rounding/h
    scale = np.abs(values).max() * max(1.0, K / Kc)
    np.testing.assert_allclose(around @ weights, slopes, atol=(1e-12 + 16 * EPS / 1e-3) * scale)


@pytest.mark.parametrize("m", [0.0, 1e-9, 0.5, 0.99, 1 - 1e-12])
def test_the_quarter_period_is_the_complete_elliptic_integral(m):
    modulus = float(mp.sqrt(1 - mpf(m)))
    with mp.workdps(30):
        exact = float(ellipk(1 - mpf(modulus) ** 2))
    assert quarter_period(modulus) == pytest.approx(exact, rel=4 * EPS)
