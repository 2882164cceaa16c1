"""Prove the stored digits of exact states: of the test set, and of the table of the tests.

    python -m workshop.proofs

computes each state anew in ball arithmetic, and prints how many numbers are proved. A stored number
is proved to be the nearest with so many digits; or, if it is small besides the others of its
quaternion or its rates, to be right to half a unit in the last digit of these. What is stored as
zero is proved to be smaller than those by five more digits. It takes some minutes with two
processors; the status is 1 if a number is not proved.
"""

import json
import lzma
import sys
from collections import Counter
from collections.abc import Iterable, Iterator, Sequence
from decimal import Decimal
from fractions import Fraction
from multiprocessing import Pool
from pathlib import Path
from typing import Any, NamedTuple

from flint import arb, ctx

from symtop_ros.physics.reference.balls import ProvedState, to_ball
from symtop_ros.physics.reference.proved import prove_states
from symtop_ros.physics.reference.series import Inputs
from symtop_ros.truth.testset.score import read_problems

TABLE = Path(__file__).parents[1] / "test/physics/exact_motions.json.xz"
TABLE_DIGITS, SHOWN = 25, 30  # of the table, and of the test set
MORE, MOST = 10, 200  # digits of the balls beyond those that are stored, at first and at most
# of a unit; a little more, as a rate of a double may be exactly between two decimals
HALF = Fraction(1, 2) + Fraction(1, 10**20)
NOT_PROVED = "not proved"


class Stored(NamedTuple):
    """The stored states of a motion: rows of seven texts, at times in s."""

    store: str
    name: str
    inputs: Inputs
    drive: tuple[Sequence[float], Sequence[float]]
    times: Sequence[float]
    states: Sequence[Sequence[str]]
    digits: int


def list_problems() -> Iterator[Stored]:
    """Yield the problems of the test set."""
    for name, problem in read_problems().items():
        facts = problem.facts
        start = facts["orientation"], facts["angular_velocity"]
        inputs = Inputs.exact(facts["Ix"], facts["Iz"], facts["Mgl"], *start)
        pairs = zip(facts["orientations"], facts["angular_velocities"], strict=True)
        states = [[*q, *omega] for q, omega in pairs]
        drive = (0.0, 0.0), (0.0, 0.0, 0.0)
        yield Stored("test set", name, inputs, drive, facts["times"], states, SHOWN)


def list_motions() -> Iterator[Stored]:
    """Yield the motions of the table of the tests, whose doubles are hexadecimal."""
    for row in json.loads(lzma.decompress(TABLE.read_bytes())):
        names = "top", "q", "omega", "friction", "torque", "t"
        parts = [list(map(float.fromhex, row[name])) for name in names]
        (Ix, Iz, Mgl), q, omega, *drive, times = parts
        store = "table, driven" if any(map(any, drive)) else "table, gravity alone"
        pair = drive[0], drive[1]
        inputs = Inputs.exact(Ix, Iz, Mgl, q, omega)
        yield Stored(store, row["family"], inputs, pair, times, row["states"], TABLE_DIGITS)


def prove(stored: Stored) -> Counter[str]:
    """Return how many numbers of a motion are proved, and in which sense."""
    digits = stored.digits + MORE
    while True:
        exact = prove_states(stored.inputs, stored.times, digits, *stored.drive)
        rows = zip(stored.states, exact, strict=True)
        counts = Counter(each for row in rows for each in judge(*row, stored.digits))
        if not counts[NOT_PROVED] or digits > MOST:
            return counts
        digits *= 2


def judge(texts: Sequence[str], exact: ProvedState, digits: int) -> Iterator[str]:
    """Yield what is proved of each number of a state."""
    q = exact.orientation
    with ctx.workprec(64):  # q and -q are one attitude
        product = sum((arb(a) * b for a, b in zip(texts[:4], q, strict=True)), arb(0))
    with ctx.workprec(2000):  # a difference of numbers whose digits are the same
        q = tuple(-each for each in q) if product < 0 else q
        for part, balls in ((texts[:4], q), (texts[4:], exact.angular_velocity)):
            size = max(abs(Decimal(text)) for text in part)
            yield from (_judge(*each, size, digits) for each in zip(part, balls, strict=True))


def _judge(text: str, ball: Any, size: Decimal, digits: int) -> str:
    number = Decimal(text)
    off = abs(ball - to_ball(Fraction(number))).upper()
    if not number:
        least = to_ball(Fraction(size) / Fraction(10) ** (digits + 5))
        return "zero" if off <= least else NOT_PROVED
    for limit, name in ((number, "nearest"), (size, "right to its size")):
        if off <= to_ball(HALF * Fraction(10) ** (limit.adjusted() - digits + 1)):
            return name
    return NOT_PROVED


def main() -> int:
    """Prove all that is stored, and print the counts; return 1 if a number is not proved."""
    tasks = [*list_problems(), *list_motions()]
    with Pool() as pool:
        return report(tasks, pool.imap(prove, tasks))


def report(tasks: Iterable[Stored], proved: Iterable[Counter[str]]) -> int:
    """Print the counts of what was proved of some tasks; return 1 if a number is not proved."""
    found: dict[str, Counter[str]] = {}
    for stored, counts in zip(tasks, proved, strict=True):
        found[stored.store] = found.get(stored.store, Counter()) + counts
        if counts[NOT_PROVED]:
            print(f"{stored.store}, {stored.name}: {dict(counts)}", flush=True)
    for store, counts in found.items():
        kinds = ", ".join(f"{count} {name}" for name, count in counts.most_common())
        print(f"{store}: {counts.total()} numbers, {kinds}")
    return int(any(counts[NOT_PROVED] for counts in found.values()))


if __name__ == "__main__":
    sys.exit(main())
