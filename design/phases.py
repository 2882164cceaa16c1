"""Why phases are reduced to one turn in integers, and not as a product of doubles.

The spin of a top turns by rate * t. As a product of doubles it is off by half an ulp of the whole
phase, however exact the rate: 1e-16 of all turns since the start. `Phases` multiplies integers of
64 bits, a turn being 2^64; whole turns fall off by themselves, and nothing is lost. Each line has
the error of an angle after a time, in rad, by both ways.
"""

import math
from decimal import Decimal, localcontext

from symtop_ros.physics.exact.phases import PER_TURN, Phases
from symtop_ros.physics.exact.precise import PRECISE

RATE = Decimal("205.70428665228744")  # rad/s
TIMES = (1.0, 1e3, 1e6, 1e9, 1e12)  # s


def measure_errors(t: float) -> tuple[float, float]:
    """Return the errors of the angle at t in rad: of a product of doubles, and of `Phases`."""
    with localcontext(PRECISE) as context:
        context.prec = 80
        turns = RATE * PER_TURN * Decimal(t)
        product = Decimal(float(RATE)) * Decimal(t)
        rounded = Decimal(float(RATE) * t)
        simple = float(abs(rounded - product))
        exact = 2 * math.pi * float(turns - turns.to_integral_value())
    with localcontext(PRECISE):
        [phase] = Phases(RATE).at(t)
        cosine, sine = phase.unit
    apart = math.hypot(cosine - math.cos(exact), sine - math.sin(exact))
    return simple, apart


def main() -> None:
    """Print the table."""
    print(f"{'t (s)':8}{'doubles':>10}{'integers':>10}  error in rad")
    for t in TIMES:
        print(f"{t:<8.0e}" + "".join(f"{error:10.0e}" for error in measure_errors(t)))


if __name__ == "__main__":
    main()
