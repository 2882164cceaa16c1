"""Why a step of a driven motion has 34 orders, ten of them in parts, and one common factor.

A motion with a tolerance has 22 orders in doubles instead. Operations are counted here: sums and
products of four lanes in a step without a torque. They are divided by the length of a step, which
goes with the root of what may be left out, 1e-20. Columns: the first orders as sums of two doubles,
in parts, and in parts with the turn of the frame cut off after six orders, as without a torque.

Times were measured in pairs in one run (best of 1500 runs of 10 s of the article's top with
friction, compiled by GCC 12 for AVX2, two cores of an AMD EPYC that other programs used as well):

- before: 0.50 ms, 277 steps of 1.8 us, of which the first ten orders took 1.0, the other twenty
  0.5, and the end of the step 0.2 us; with eight orders 1.6, with two 1.1 us: what 32 digits cost;
- the first ten orders in parts, and shuffles that are one instruction: 0.38 ms;
- last digits of constants left out in the other orders, where they are below 1e-23: 0.36 ms;
- one factor for all products, so that it is read once: 0.35 ms (with the other factor spread out
  when it is read, 0.41 ms); two orders at a time without it: 0.38 ms;
- 34 orders: 0.34 ms; 38: 0.34; 30: 0.36; 26: 0.42; with eight orders in parts 26: 0.40, 24: 0.44,
  22: 0.49, 20: 0.59 ms;
- the norm in parts, powers of two without the library, the turn of the frame cut off: 0.32 ms,
  0.64 of the time before; with a torque 0.71 (0.95 against 1.34 ms).

Not kept: eight orders in parts take 5 % less, but after 1000 s the error is 87 eps instead of 1;
six are no faster, 1100 eps. Steps for 1e-19 instead of 1e-20 are 7 % longer, and errors after 1000
s ten times as large. AVX-512 (in pairs, 400 runs of an Intel processor that has it): a third
variant of the same source takes 5 % less, for a library that is larger by a tenth. Sums of two
orders in one register of eight numbers take 20 % more: a factor of both is read when its second
half has just been written. Not tried: several motions in the lanes.

A step now takes 3840 cycles (same motion, 3.7 GHz, all data in the first cache): 1140 for the first
ten orders, 1850 for the other 24, of which the products alone take 890 at two products and two sums
a cycle, and 850 for its length and its end. Lengths without calls of the C library save 3 %. Tried
for the 24 orders: products with the newest terms last, 5 % less of their time (3 % of a step, not
kept, as last bits would change), and no less if these terms are turned in advance; products added
to the sums of later orders as soon as both factors are known, 5 % more; all loops unrolled, 50 %
more. An order costs its products and the wait for the last one, whatever the order in the source.

So a motion with a tolerance has fewer orders, all in doubles, with the newest terms last: there
this saves a third. For 10 s of the article's top with friction 16 orders take 117 us for an error
of 6e-11 rad, 20 take 111 for 2e-11, 22 take 108 for 9e-12 and 24 take 107 for 5e-11. In pairs with
0.6.0, in 14 families (50 pairs each, set-up included): to rounding 0.54 to 1.01 of the time, median
0.69; with a tolerance of 1e-14 0.20 to 0.39, with 1e-12 0.19 to 0.33, with 1e-10 0.14 to 0.31.
"""

from collections.abc import Callable

LAST = 1e-20
ORDERS = (20, 24, 26, 30, 34, 38)
FIRST = 10  # orders with more digits
BLOCKS = 4  # of products: by omega_x, omega_y, the turn of the frame, and the weight
TURNING = 6  # orders of the turn that count if it only decays
IN_SUMS, IN_PARTS, IN_DOUBLES = 14, 6, 2  # operations for a product and its sum
BETWEEN = {IN_SUMS: 120, IN_PARTS: 60, IN_DOUBLES: 30}  # operations of an order beside its products


def count_products(order: int, turning: int) -> int:
    """Return the products of four lanes of an order."""
    return (BLOCKS - 1) * (order + 1) + min(order + 1, turning)


def count_operations(orders: int, kind: int, turning: int) -> int:
    """Return the operations of all orders of a step, the first ones of a kind."""
    low, high = range(FIRST), range(FIRST, orders)
    first = sum(kind * count_products(n, turning) + BETWEEN[kind] for n in low)
    others = sum(IN_DOUBLES * count_products(n, turning) + BETWEEN[IN_DOUBLES] for n in high)
    return first + others


def find_length(orders: int) -> float:
    """Return the length of a step by the distance of the nearest singularity."""
    return float(LAST ** (1 / orders))


def main() -> None:
    """Print the table."""
    kinds: list[tuple[str, Callable[[int], int]]] = [
        ("sums of doubles", lambda p: count_operations(p, IN_SUMS, p)),
        ("parts", lambda p: count_operations(p, IN_PARTS, p)),
        ("parts, turn cut off", lambda p: count_operations(p, IN_PARTS, TURNING)),
    ]
    print("orders  length" + "".join(f"{name:>22}" for name, _ in kinds))
    for orders in ORDERS:
        length = find_length(orders)
        cells = (f"{count(orders) / length:22.0f}" for _, count in kinds)
        print(f"{orders:6}{length:8.3f}" + "".join(cells))


if __name__ == "__main__":
    main()
