"""Why the first ten terms of a step have more digits than a double, for a turn of at most 2 rad.

A step of a driven motion is a Taylor series of 34 terms, and its error must be far below the
rounding of a double, because errors of one sign add up over the steps. A term in doubles is off by
2^-53 of its size; so the terms that need more digits are those that are not small. Each line has
the largest error of exp(i x), x up to the turn of a step, if the first terms are exact and the
others are doubles, in parts of 2^-53.

Beyond the largest terms each further one gains a factor of about n/x. A turn of 2 rad with ten
terms errs as little as one of 3.5 rad with fourteen; and a term with more digits costs as much as
some three in one double, so that the shorter steps take less time (`kernel/driven/piece.hpp`). The
last terms of a step are 1e-20, which is 9e-5 of 2^-53: with eight terms, 8e-4, rounding would be
the larger part of what adds up.
"""

from fractions import Fraction

EPS = Fraction(1, 2**53)
TURNS = (2.0, 3.5)  # rad
TERMS, PLACES = 34, 16


def sum_series(x: Fraction, exact_terms: int) -> tuple[Fraction, Fraction]:
    """Return exp(i x) as a series of which the first terms are exact, and the others doubles."""
    parts = [Fraction(1), Fraction(0)]
    term = Fraction(1)
    for n in range(1, TERMS + 1):
        term = term * x / n
        rounded = term if n <= exact_terms else Fraction(float(term))
        parts[n % 2] += -rounded if n % 4 in (2, 3) else rounded
    return parts[0], parts[1]


def measure_error(turn: float, exact_terms: int) -> float:
    """Return the largest error within a step, in parts of 2^-53."""
    worst = Fraction(0)
    for k in range(1, PLACES + 1):
        x = Fraction(turn) * k / PLACES
        pairs = zip(sum_series(x, exact_terms), sum_series(x, TERMS), strict=True)
        worst = max(worst, *(abs(found - exact) for found, exact in pairs))
    return float(worst / EPS)


def main() -> None:
    """Print the table."""
    print("exact terms" + "".join(f"{turn:>10} rad" for turn in TURNS))
    for exact_terms in range(15):
        errors = (measure_error(turn, exact_terms) for turn in TURNS)
        print(f"{exact_terms:11}" + "".join(f"{error:14.1e}" for error in errors))


if __name__ == "__main__":
    main()
