"""Functions of one number or of an array, the same to the last bit on every machine.

The formulas of a motion are written once, for a float and for an array alike. Sums, products,
quotients and square roots round in the same way everywhere. The elementary functions of NumPy and
of the C library do not: their last bit depends on the version and on the processor. Those here are
sums of such operations, and so are the same in the compiled kernel. For the same reason complex
numbers are pairs of reals (a compiler may fuse a product and a sum), and floats are added one by
one (Python 3.12 compensates `sum`).
"""

import math
from decimal import Decimal, localcontext
from typing import NamedTuple, TypeAlias

import numpy as np
from numpy.typing import NDArray

from symtop_ros.arrays import Quaternion, Real
from symtop_ros.physics.exact.precise import (
    PI_LOW,
    PRECISE,
    TWO_PI,
    compute_arc_tangent,
    split,
    split_short,
)
from symtop_ros.physics.values import EPS

Number: TypeAlias = float | Real
Pair: TypeAlias = tuple[Number, Number]  # real and imaginary part, or a sum of two doubles
FloatPair: TypeAlias = tuple[float, float]
Components: TypeAlias = tuple[Pair, Pair, Pair]  # A, B and omega_x + i omega_y

ORDERS = range(1, 5)  # of the terms of a theta series
SPLITTER = 2.0**27 + 1  # Veltkamp's, for halves of 26 bits
LEAST_EXPONENT = -708.0  # below, exp(x) is no normal double; here it is zero then
SPREAD = 0.006  # relative differences of which the eighth power is below EPS/8

with localcontext(PRECISE):
    QUARTER_HIGH, QUARTER_LOW = split_short(TWO_PI / 4)
    QUARTERS = 1 / (QUARTER_HIGH + QUARTER_LOW)
    LN2_HIGH, LN2_LOW = split_short(Decimal(2).ln())
    HALF_PI_HIGH, HALF_PI_LOW = split(TWO_PI / 4)
    EIGHTHS_OF_TANGENT = tuple(
        np.array(column)
        for column in zip(
            *(split(compute_arc_tangent(Decimal(n) / 8)) for n in range(9)), strict=True
        )
    )
    DOUBLINGS = 1 / (LN2_HIGH + LN2_LOW)
# Coefficients of the Taylor series (DLMF 4.19.1, 4.19.2 and 4.2.19). On the intervals in use, pi/4
# and ln(2)/2, the first terms left out are below 2^-58 of the sum.
SINE = [(-1) ** n / math.factorial(2 * n + 1) for n in range(8, 0, -1)]
VERSINE = [(-1) ** (n + 1) / math.factorial(2 * n) for n in range(8, 0, -1)]
ARC_TANGENT = [(-1) ** n / (2 * n + 1) for n in range(7, 0, -1)]
LARGEST_ANGLE = 2.0**15  # rad, for `cosine_and_sine`
LARGEST_REDUCED = 1e15  # rad
EXPONENTIAL = [1 / math.factorial(n) for n in range(13, 1, -1)]


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


def cosine_and_sine_near_0(x: Number, rest: Number = 0.0) -> Pair:
    """Return cos and sin of x + rest, for |x| <= pi/4 and a rest that is rounding of it."""
    square = x * x
    versine, series = VERSINE[0] * square, SINE[0] * square
    for c in VERSINE[1:]:
        versine = (versine + c) * square
    for c in SINE[1:]:
        series = (series + c) * square
    return 1.0 - (versine + x * rest), x + (x * series + rest)


def cosine_and_sine(x: Number) -> Pair:
    """Return cos(x) and sin(x), for |x| up to some thousand turns."""
    # Quarter turns are subtracted in two parts, of which the product with the first is exact.
    quarters = round_to_integer(x * QUARTERS)
    part, low = x - quarters * QUARTER_HIGH, quarters * QUARTER_LOW
    near = part - low
    c, s = cosine_and_sine_near_0(near, (part - near) - low)
    if isinstance(quarters, np.ndarray):
        place = quarters.astype(np.int64)
        odd, turned, back = place & 1 == 1, (place + 1) & 2 == 2, place & 2 == 2
        c, s = np.where(odd, s, c), np.where(odd, c, s)
        return np.where(turned, -c, c), np.where(back, -s, s)
    turns = int(quarters)
    if turns & 1:
        c, s = s, c
    return -c if turns + 1 & 2 else c, -s if turns & 2 else s


def expand_exponential(x: Number) -> Pair:
    """Return a power of two, and p with exp(x) = power (1 + p); the power is 0 below -708."""
    is_array = isinstance(x, np.ndarray)
    bounded = np.maximum(x, LEAST_EXPONENT) if is_array else max(x, LEAST_EXPONENT)
    doublings = round_to_integer(bounded * DOUBLINGS)
    y = (bounded - doublings * LN2_HIGH) - doublings * LN2_LOW
    series = EXPONENTIAL[0] * y
    for c in EXPONENTIAL[1:]:
        series = (series + c) * y
    return choose_smaller(x, LEAST_EXPONENT, 0.0, _raise_2(doublings)), y + y * series


def _raise_2(exponent: Number) -> Number:
    if not isinstance(exponent, np.ndarray):
        return math.ldexp(1.0, int(exponent))
    bits: NDArray[np.int64] = (exponent.astype(np.int64) + 1023) << 52
    return bits.view(np.float64)


def exponential(x: Number) -> Number:
    """Return exp(x)."""
    power, p = expand_exponential(x)
    return power + power * p


def exponential_minus_1(x: Number) -> Number:
    """Return exp(x) - 1, without loss of digits for small x."""
    power, p = expand_exponential(x)
    return (power - 1.0) + power * p


def arc_tangent(y: Number, x: Number) -> Number:
    """Return the angle of the point (x, y) in rad, from -pi to pi, right to 1 EPS of itself.

    The ratio of the smaller coordinate to the larger one is turned back by the nearest of nine
    angles, of which the tangents are eighths; the Taylor series of what is left has the sixteenth
    part of the argument at most (DLMF 4.24.3). Signs of zero are those of `math.atan2`.
    """
    if not isinstance(y, np.ndarray) and not isinstance(x, np.ndarray):
        return _find_angle(float(y), float(x))
    y, x = np.broadcast_arrays(np.asarray(y, float), np.asarray(x, float))
    height, width = np.abs(y), np.abs(x)
    large, small = np.maximum(height, width), np.minimum(height, width)
    ratio = np.divide(small, large, out=np.zeros(large.shape), where=large > 0)
    place = np.rint(8.0 * ratio)
    high, low = (column.take(place.astype(np.int64)) for column in EIGHTHS_OF_TANGENT)
    angle = high + (_expand_arc_tangent(ratio, place) + low)
    steep = (HALF_PI_HIGH - np.copysign(angle, x)) + HALF_PI_LOW
    flat = np.where(np.signbit(x), (math.pi - angle) + PI_LOW, angle)
    return np.asarray(np.copysign(np.where(height > width, steep, flat), y))


def _find_angle(y: float, x: float) -> float:
    height, width = abs(y), abs(x)
    large, small = max(height, width), min(height, width)
    ratio = small / large if large > 0 else 0.0
    place = float(round(8.0 * ratio))
    high, low = (float(column[int(place)]) for column in EIGHTHS_OF_TANGENT)
    angle = high + (float(_expand_arc_tangent(ratio, place)) + low)
    if height > width:
        angle = (HALF_PI_HIGH - math.copysign(angle, x)) + HALF_PI_LOW
    elif math.copysign(1.0, x) < 0:
        angle = (math.pi - angle) + PI_LOW
    return math.copysign(angle, y)


def _expand_arc_tangent(ratio: Number, place: Number) -> Number:
    """Return the arc tangent of a ratio without that of the nearest eighth."""
    nearest = place * 0.125
    z = (ratio - nearest) / (1.0 + ratio * nearest)
    square = z * z
    series: Number = ARC_TANGENT[0] * square
    for c in ARC_TANGENT[1:]:
        series = (series + c) * square
    return z + z * series


def find_length(x: Number, y: Number) -> Number:
    """Return sqrt(x^2 + y^2), as `find_modulus` does, of numbers or arrays."""
    if not isinstance(x, np.ndarray):
        return find_modulus((float(x), float(y)))
    width, height = np.abs(x), np.abs(y)
    large, small = np.maximum(width, height), np.minimum(width, height)
    ratio = np.divide(small, large, out=np.zeros(large.shape), where=large > 0)
    return np.asarray(large * np.sqrt(1.0 + ratio * ratio))


def find_cosine_and_sine(angle: Number) -> Pair:
    """Return cosine and sine of angles of any size in rad.

    Of more than some thousand turns, whole ones are taken off with 50 digits of pi; of more than
    1e15 rad, where these are too few, the functions are those of the C library.
    """
    if not isinstance(angle, np.ndarray):
        return _take_turns_off(angle) if abs(angle) > LARGEST_ANGLE else cosine_and_sine(angle)
    is_large = np.abs(angle) > LARGEST_ANGLE
    c, s = map(np.array, cosine_and_sine(np.where(is_large, 0.0, angle)))
    for place in zip(*np.nonzero(is_large), strict=True):
        c[place], s[place] = _take_turns_off(float(angle[place]))
    return c, s


def _take_turns_off(angle: float) -> FloatPair:
    if abs(angle) > LARGEST_REDUCED:
        return math.cos(angle), math.sin(angle)
    with localcontext(PRECISE):
        turns = (Decimal(angle) / TWO_PI).to_integral_value()
        rest = Decimal(angle) - turns * TWO_PI
        c, s = cosine_and_sine(float(rest))
    return float(c), float(s)


def integrate_rf_in_doubles(x: float, y: float) -> float:
    """Return Carlson's symmetric integral R_F(x, y, 1); it is infinite for x = y = 0.

    See `integrate_rf`. The series is that of DLMF 19.36.1 up to the seventh power.
    """
    if x == y == 0:  # both have underflowed
        return math.inf
    z = 1.0
    while True:
        mean = (x + y + z) / 3
        dx, dy = (mean - x) / mean, (mean - y) / mean
        if max(abs(dx), abs(dy), abs(dx + dy)) < SPREAD:
            break
        root_x, root_y, root_z = math.sqrt(x), math.sqrt(y), math.sqrt(z)
        shift = root_x * root_y + root_x * root_z + root_y * root_z
        x, y, z = (x + shift) / 4, (y + shift) / 4, (z + shift) / 4
    dz = -(dx + dy)
    e2, e3 = dx * dy - dz * dz, dx * dy * dz
    square, cube = e2 * e2, e3 * e3
    high = square / 24 - 3 * e2 * e3 / 44 - 5 * square * e2 / 208 + 3 * cube / 104
    return (1 + (-e2 / 10 + e3 / 14 + (high + square * e3 / 16))) / math.sqrt(mean)


def find_size(x: Number) -> Number:
    """Return |x|."""
    return np.abs(x) if isinstance(x, np.ndarray) else abs(x)


def find_sign(x: Number) -> Number:
    """Return 1 or -1, by the sign bit."""
    return np.copysign(1.0, x) if isinstance(x, np.ndarray) else math.copysign(1.0, x)


def round_to_integer(x: Number) -> Number:
    """Return the nearest integer; the even one of two."""
    return np.rint(x) if isinstance(x, np.ndarray) else math.copysign(round(x), x)


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


def divide(a: FloatPair, b: FloatPair) -> FloatPair:
    """Return the quotient of two complex numbers (R. L. Smith, Comm. ACM 5 (1962) 435)."""
    if abs(b[0]) >= abs(b[1]):
        ratio = b[1] / b[0]
        size = b[0] + b[1] * ratio
        return (a[0] + a[1] * ratio) / size, (a[1] - a[0] * ratio) / size
    ratio = b[0] / b[1]
    size = b[0] * ratio + b[1]
    return (a[0] * ratio + a[1]) / size, (a[1] * ratio - a[0]) / size


def find_modulus(a: FloatPair) -> float:
    """Return |a|; not math.hypot, of which the rounding depends on the version of Python."""
    large, small = max(abs(a[0]), abs(a[1])), min(abs(a[0]), abs(a[1]))
    if large == 0:
        return 0.0
    ratio = small / large
    return large * math.sqrt(1.0 + ratio * ratio)


def normalize(orientation: Quaternion) -> Quaternion:
    """Return the quaternion with norm 1; one that has it to rounding is unchanged, bit for bit."""
    w, x, y, z = orientation
    norm = math.sqrt((w * w + z * z) + (x * x + y * y))
    if abs(norm - 1.0) <= 4 * EPS:
        return orientation
    return w / norm, x / norm, y / norm, z / norm


def to_floats(a: Pair) -> FloatPair:
    """Return a pair of floats for a pair of numbers."""
    return float(a[0]), float(a[1])
