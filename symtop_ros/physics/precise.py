"""Numbers with 50 digits for setting a motion up, and how they enter double precision.

A motion is set up once and evaluated often. Python's decimal module costs some tens of microseconds
more per motion than floats would, and with it the constants of a motion are those of exactly the
doubles that were given: nothing in them grows with time, and ranges have no end.
"""

from __future__ import annotations

from decimal import Context, Decimal, DivisionByZero, InvalidOperation

PRECISE = Context(prec=50, traps=[InvalidOperation, DivisionByZero])
ZERO, HALF, ONE, TWO = Decimal(0), Decimal("0.5"), Decimal(1), Decimal(2)
TWO_PI = Decimal("6.28318530717958647692528676655900576839433879875021")


def split(x: Decimal) -> tuple[float, float]:
    """Return x as a double and what is left of it, 32 digits in all."""
    high = float(x)
    return high, float(x - Decimal(high))


def ratio(a: Decimal, b: Decimal) -> float:
    """Return a/b as a double."""
    return float(a / b)
