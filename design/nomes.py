"""Why there are two series of theta functions, in the nome and in the complementary one.

Terms of theta functions fall as q^(n^2). The nome q is small for a nutation of small amplitude and
approaches 1 at the separatrix, where the series needs ever more terms, and they cancel. After
Jacobi's imaginary transformation the nome q' does the contrary. With the smaller of both no nome
exceeds exp(-pi), and four terms are enough for a double. Each line has the number of terms that are
not negligible in either series, from the middle of the parameters to the separatrix.
"""

import math

from mpmath import ellipk, mp, mpf

NEGLIGIBLE = 1e-17  # of a sum
COMPLEMENTS = (0.9, 0.5, 1e-2, 1e-6, 1e-12, 1e-24, 1e-48)  # 1 - m


def count_terms(complement: float) -> tuple[int, int]:
    """Return the numbers of terms in the nome and in the complementary nome, for 1 - m."""
    with mp.workdps(60):
        ratio = float(ellipk(complement) / ellipk(1 - mpf(complement)))  # K'/K
    return _count(math.pi * ratio), _count(math.pi / ratio)


def _count(decay: float) -> int:
    """Return the number of terms exp(-decay n^2) that are not negligible."""
    return math.floor(math.sqrt(-math.log(NEGLIGIBLE) / decay))


def main() -> None:
    """Print the table."""
    print(f"{'1 - m':8}{'nome':>6}{'complementary':>15}  terms")
    for complement in COMPLEMENTS:
        direct, complementary = count_terms(complement)
        print(f"{complement:<8.0e}{direct:6}{complementary:15}")


if __name__ == "__main__":
    main()
