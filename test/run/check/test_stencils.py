"""Derivatives by differences: exact for polynomials, and within their bounds for motions."""

from fractions import Fraction

import numpy as np
import pytest
from drawn import Numbers

from symtop_ros.run.check.stencils import EPS, MARGIN, WIDTH, find_slopes


def draw_times(random, count, jitter):
    """Times near a grid of 1/256 s, as multiples of 2^-30 s, which are exact in doubles."""
    steps = [random.randint(-jitter, jitter) for _ in range(count)]
    return np.array([k * 2.0**-8 + step * 2.0**-30 for k, step in enumerate(steps)])


@pytest.mark.parametrize("jitter", [0, 2**18])
def test_order_eight_is_exact_for_polynomials_of_degree_eight_with_any_steps(jitter):
    random = Numbers(7)
    times = draw_times(random, 40, jitter)
    for degree in range(WIDTH):
        exact = [Fraction(t) - Fraction(times[20]) for t in times]
        values = np.array([[float(t**degree)] for t in exact])
        right = [float(degree * t ** (degree - 1)) if degree else 0.0 for t in exact]
        found = find_slopes(times, values)
        error = np.abs(found.values[:, 0] - right[MARGIN:-MARGIN])
        assert (error <= found.rounding + 8 * EPS * np.abs(right[MARGIN:-MARGIN])).all()


def test_the_error_is_within_the_difference_of_both_orders():
    random = Numbers(8)
    for _ in range(200):
        times = draw_times(random, 60, random.choice((0, 2**18)))
        rates = [256 * random.uniform(0.01, 1.5) for _ in range(3)]
        phases = [random.uniform(0.0, 6.0) for _ in rates]
        weights = [1.0, random.power(-2, 0), random.power(-4, -1)]
        sums = list(zip(rates, phases, weights, strict=True))
        values = np.array([sum(w * np.sin(r * times + p) for r, p, w in sums)]).T
        right = sum(w * r * np.cos(r * times + p) for r, p, w in sums)[MARGIN:-MARGIN]
        found = find_slopes(times, values)
        error = np.abs(found.values[:, 0] - right)
        # NumPy rounds the argument of a sine of up to 90 rad, and its value, by an EPS each.
        noise = 200 * EPS * max(rates) * sum(weights)
        assert (error <= found.truncation + found.rounding + noise).all()


@pytest.mark.parametrize("rate", [2.0, 2.5, 3.0])
def test_samples_that_are_too_far_apart_do_not_converge(rate):
    times = np.arange(60) / 256
    found = find_slopes(times, np.sin(256 * rate * times)[:, np.newaxis])
    assert not found.converges.any()
    slow = find_slopes(times, np.sin(256 * times)[:, np.newaxis])
    assert slow.converges.all()
