"""Why the kernel is compiled without fused products and sums (-ffp-contract=off).

A fused a b + c d rounds one product and not the other. On a processor that has it (ARM always, x86
since 2013) a compiler may fuse wherever it likes, and then states have other bits than Python's and
than the same kernel elsewhere. Two things are lost:

- the imaginary part of z conj(z) is no longer zero, as formulae assume that it is;
- a log could not be checked bit for bit on another machine: half of all products of two complex
  numbers differ.
"""

import random
from fractions import Fraction

COUNT = 2000
Pair = tuple[float, float]


def multiply(z: Pair, w: Pair) -> Pair:
    """Return the product of two complex numbers, each operation rounded."""
    return z[0] * w[0] - z[1] * w[1], z[0] * w[1] + z[1] * w[0]


def multiply_fused(z: Pair, w: Pair) -> Pair:
    """Return the same where the first product of each sum is not rounded, as a compiler may."""
    real = Fraction(z[0]) * Fraction(w[0]) - Fraction(z[1] * w[1])
    imaginary = Fraction(z[0]) * Fraction(w[1]) + Fraction(z[1] * w[0])
    return float(real), float(imaginary)


def draw_numbers() -> list[Pair]:
    """Return complex numbers of the size of Cayley-Klein parameters, always the same ones."""
    source = random.Random(1)
    return [(source.uniform(-1, 1), source.uniform(-1, 1)) for _ in range(COUNT)]


def count_other_bits() -> int:
    """Return how many products of a number with the next one differ."""
    numbers = draw_numbers()
    pairs = zip(numbers, [*numbers[1:], numbers[0]], strict=True)
    return sum(multiply(z, w) != multiply_fused(z, w) for z, w in pairs)


def count_imaginary() -> tuple[int, int]:
    """Return how many z conj(z) are not real: of those rounded twice, and of fused ones."""
    pairs = [((x, y), (x, -y)) for x, y in draw_numbers()]
    rounded = sum(multiply(*pair)[1] != 0 for pair in pairs)
    return rounded, sum(multiply_fused(*pair)[1] != 0 for pair in pairs)


def main() -> None:
    """Print the counts."""
    rounded, fused = count_imaginary()
    print(f"z w with other bits if it is fused: {count_other_bits()} of {COUNT}")
    print(f"z conj(z) that are not real: {rounded} of {COUNT}, fused {fused}")


if __name__ == "__main__":
    main()
