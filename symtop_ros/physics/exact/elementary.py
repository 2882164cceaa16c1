"""Functions of one number or of an array, the same to the last bit.

The formulas of a motion are written once, for a float and for an array alike. Sums and products
round in the same way in both. NumPy's elementary functions differ from those of the C library in
the last bit, so they serve both; for a float the result goes back to a float, whose arithmetic
takes a tenth of the time of an array with one number. Complex numbers are pairs of reals, because
NumPy may round their products in another way than Python does.
"""

import math
from typing import NamedTuple, TypeAlias

import numpy as np

from symtop_ros.arrays import Real

Number: TypeAlias = float | Real
Pair: TypeAlias = tuple[Number, Number]  # real and imaginary part, or a sum of two doubles
Components: TypeAlias = tuple[Pair, Pair, Pair]  # A, B and omega_x + i omega_y

UNDERFLOW = -708.0  # below, exp(x) is no normal double
ORDERS = range(1, 5)  # of the terms of a theta series
SPLITTER = 2.0**27 + 1  # Veltkamp's, for halves of 26 bits


class Shift(NamedTuple):
    """The imaginary shift of a theta function, and the zero that belongs to it."""

    sign: float
    # K' - |shift|. The shift itself would not do: close to K' this difference, on which the small
    # coefficients depend, would be lost.
    complement: float
    is_below: bool  # True for A (theta_4), whose zero is near the lower turning point
    winding: int = 0  # the quotient is multiplied by exp(-i winding x)


class Location(NamedTuple):
    """A phase of the nutation, and its distances from the turning points.

    The distances are multiplied by K/K' for the complementary series. Each is right to rounding of
    itself, which x alone cannot give.
    """

    x: Number  # in [-pi, pi]; 0 is the lower turning point
    below: Number  # x: the distance from the lower turning point, with the sign of x
    above: Number  # pi - |x|
    low: Number = 0.0  # what rounding left of -|below| or above, of the one that is smaller


def sine(x: Number) -> Number:
    """Return sin(x)."""
    return np.sin(x) if isinstance(x, np.ndarray) else float(np.sin(x))


def cosine(x: Number) -> Number:
    """Return cos(x)."""
    return np.cos(x) if isinstance(x, np.ndarray) else float(np.cos(x))


def exponential(x: Number) -> Number:
    """Return exp(x)."""
    if isinstance(x, np.ndarray):
        return np.exp(x)
    if x < UNDERFLOW:  # the caller's NumPy may be set to raise for that
        with np.errstate(under="ignore"):
            return float(np.exp(x))
    return float(np.exp(x))


def exponential_minus_1(x: Number) -> Number:
    """Return exp(x) - 1, without loss of digits for small x."""
    return np.expm1(x) if isinstance(x, np.ndarray) else float(np.expm1(x))


def find_size(x: Number) -> Number:
    """Return |x|."""
    return np.abs(x) if isinstance(x, np.ndarray) else abs(x)


def find_sign(x: Number) -> Number:
    """Return 1 or -1, by the sign bit."""
    return np.copysign(1.0, x) if isinstance(x, np.ndarray) else math.copysign(1.0, x)


def round_to_integer(x: Number) -> Number:
    """Return the nearest integer; the even one of two."""
    return np.rint(x) if isinstance(x, np.ndarray) else float(round(x))


def choose_smaller(x: Number, y: Number, if_first: Number, if_second: Number) -> Number:
    """Return `if_first` where x < y, and `if_second` elsewhere."""
    if isinstance(x, np.ndarray):
        return np.where(x < y, if_first, if_second)
    return if_first if x < y else if_second


def find_rest(x: Pair, factor: tuple[float, float], product: Number) -> Number:
    """Return what is missing from the rounded product of two sums of two doubles.

    The first part of `factor` must have at most 26 bits. Its products with the halves of x[0] are
    then exact (T. J. Dekker, Numer. Math. 18 (1971) 224).
    """
    high, low = factor
    shifted = SPLITTER * x[0]
    upper = shifted - (shifted - x[0])
    lower = x[0] - upper
    return ((upper * high - product) + lower * high) + (x[0] * low + x[1] * high)


def multiply(a: Pair, b: Pair) -> Pair:
    """Return the product of two complex numbers, each as real and imaginary part."""
    return a[0] * b[0] - a[1] * b[1], a[0] * b[1] + a[1] * b[0]


def multiply_by_conjugate(a: Pair, b: Pair) -> Pair:
    """Return the product of a and the conjugate of b."""
    return a[0] * b[0] + a[1] * b[1], a[1] * b[0] - a[0] * b[1]


def to_complex(value: Pair) -> complex:
    """Return the complex number of a pair of floats."""
    return complex(float(value[0]), float(value[1]))
