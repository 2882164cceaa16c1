"""Numbers of 50 digits, for the set-up of a motion, and how they enter double precision.

A motion is set up once and evaluated often. With Python's decimal module the set-up takes some tens
of microseconds more than with floats, and the constants of a motion are then those of exactly the
doubles that were given: no error grows with time, and exponents have no limit.

Every operation on decimals rounds to the context of its thread, which is the caller's: with 6
digits there, states would be wrong. `Motion` therefore enters the context `PRECISE` before it calls
anything in this folder, and what is computed at import is computed in it too.
"""

import math
from decimal import Context, Decimal, DivisionByZero, InvalidOperation, localcontext

# 50 digits serve phases of 1e30 turns (design/digits.py).
PRECISE = Context(prec=50, traps=[InvalidOperation, DivisionByZero])
ZERO, HALF, ONE, TWO = Decimal(0), Decimal("0.5"), Decimal(1), Decimal(2)
TWO_PI = Decimal("6.28318530717958647692528676655900576839433879875021")

EQUAL = Decimal("2e-6")  # differences of which the sixth power is below 1e-34


def split(x: Decimal) -> tuple[float, float]:
    """Return x as a double and the remainder: 32 digits together."""
    high = float(x)
    return high, float(x - Decimal(high))


def split_short(x: Decimal) -> tuple[float, float]:
    """Return x as a double of 26 bits and the remainder: 24 digits together."""
    fraction, exponent = math.frexp(float(x))
    high = math.ldexp(math.floor(math.ldexp(fraction, 26)), exponent - 26)
    return high, float(x - Decimal(high))


def compute_cosine(x: Decimal) -> Decimal:
    """Return cos(x) to 48 digits of 1, less those of whole turns."""
    x = x - (x / TWO_PI).to_integral_value() * TWO_PI
    square, term, total, n = x * x, ONE, ONE, 0
    while abs(term) > Decimal("1e-52"):
        n += 2
        term *= -square / (n * (n - 1))
        total += term
    return total


def compute_arc_tangent(x: Decimal) -> Decimal:
    """Return the arc tangent of a number from 0 to 1, to 48 digits of 1."""
    halvings = 0
    while x > Decimal("0.01"):  # tan(a/2) = tan(a)/(1 + sqrt(1 + tan(a)^2))
        x, halvings = x / (1 + (1 + x * x).sqrt()), halvings + 1
    square, power, total, n = x * x, x, x, 1
    while abs(power) > Decimal("1e-55"):
        power, n = -power * square, n + 2
        total += power / n
    return total * Decimal(2**halvings)


def integrate_rf(x: Decimal, y: Decimal) -> Decimal:
    """Return Carlson's symmetric integral R_F(x, y, 1) to 34 digits.

    Each step of the duplication makes the arguments differ by a quarter of what they did (B. C.
    Carlson, Numer. Algorithms 10 (1995) 13, algorithm for R_F). The error of the last series is of
    the order of their sixth power.
    """
    z = ONE
    while True:
        mean = (x + y + z) / 3
        dx, dy = 1 - x / mean, 1 - y / mean
        if max(abs(dx), abs(dy), abs(dx + dy)) < EQUAL:
            break
        roots = x.sqrt(), y.sqrt(), z.sqrt()
        shift = roots[0] * roots[1] + roots[0] * roots[2] + roots[1] * roots[2]
        x, y, z = (x + shift) / 4, (y + shift) / 4, (z + shift) / 4
    dz = -(dx + dy)
    e2, e3 = dx * dy - dz * dz, dx * dy * dz
    return (1 - e2 / 10 + e3 / 14 + e2 * e2 / 24 - 3 * e2 * e3 / 44) / mean.sqrt()


with localcontext(PRECISE):
    PI_HIGH, PI_LOW = split(TWO_PI * HALF)
    TWO_PI_HIGH, TWO_PI_LOW = split_short(TWO_PI)
