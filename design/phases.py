"""Why phases are reduced to one turn in integers, and not as a product of doubles.

The spin of a top turns by rate * t. As a product of doubles it is off by half an ulp of the whole
phase, however exact the rate: 1e-16 of all turns since the start. The kernel multiplies integers
of 64 bits, a turn being 2^64; whole turns fall off by themselves, and nothing is lost. Each line
has the error of an angle after a time, in rad, by both ways.
"""

import math

from mpmath import mp, mpf

BITS = 256  # of a step, the turns in a second
RATE = mpf("205.70428665228744")  # rad/s
TIMES = (1.0, 1e3, 1e6, 1e9, 1e12)  # s


def measure_errors(t: float) -> tuple[float, float]:
    """Return the errors of the angle at t in rad: of a product of doubles, and of integers."""
    with mp.workdps(120):
        phase = RATE * t
        simple = abs(float(RATE) * t - phase)
        step = int(mp.nint(RATE / (2 * mp.pi) * 2**BITS))
        turn = step * int(t) % 2**BITS >> (BITS - 64)  # whole turns fall off, 64 bits are kept
        angle = float(2 * mp.pi * (turn - 2**64 * (turn >> 63)) / 2**64)
        off = mp.hypot(math.cos(angle) - mp.cos(phase), math.sin(angle) - mp.sin(phase))
        return float(simple), float(off)


def main() -> None:
    """Print the table."""
    print(f"{'t (s)':8}{'doubles':>10}{'integers':>10}  error in rad")
    for t in TIMES:
        print(f"{t:<8.0e}" + "".join(f"{error:10.0e}" for error in measure_errors(t)))


if __name__ == "__main__":
    main()
