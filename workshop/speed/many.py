"""Time for many different motions: the package, and heyoka with parameters and batches."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import cache, partial
from importlib.util import find_spec
from itertools import islice, product
from statistics import median
from timeit import repeat
from typing import Any

import numpy as np

from symtop_ros.base.arrays import Real
from symtop_ros.physics import Motions, State, Top
from symtop_ros.truth.testset.score import measure_angles
from workshop.speed.peers import CLOSED_FORM
from workshop.speed.publish import format_table, write_chapter
from workshop.speed.reference import integrate, split_orientations

NAME = "many motions"  # of the section in the documentation
SEED = 1
COMPARED = 32  # motions of which the errors are taken; the exact ones take 2 s each
RUNS = 5  # of which the median counts
TOLERANCES = 1e-9, 1e-12, 2.0**-52


@dataclass(frozen=True)
class ManyCost:
    """Seconds for each of many motions, and the largest error in rad."""

    peer: str
    motions: int
    seconds: float  # the median of some runs
    error: float  # of the first `compared` motions
    compared: int
    runs: int


def draw_motions(count: int) -> Motions:
    """Return random motions about the article's cusps: other weights, spins and tilts."""
    rng = np.random.default_rng(SEED)
    top = Top(0.000228, 0.0000572, 0.068 * rng.uniform(0.8, 1.2, count))
    tilt, spin = rng.uniform(0.2, 1.0, count), rng.uniform(150.0, 250.0, count)
    return Motions(top, State.from_euler(theta=tilt, psi_dot=spin))


Program = Callable[[Motions, float], Real]  # the orientations (n, 4) at a time in s


def find_programs() -> Iterator[tuple[str, Program]]:
    """Yield the programs that can be measured, with their names."""
    yield CLOSED_FORM, compute
    if find_spec("heyoka"):
        from workshop.speed.peers.heyoka_peer import BATCHES, prepare_batches

        for form, tolerance in product(BATCHES, TOLERANCES):
            name = f"heyoka, {form}, batches, tolerance {tolerance:.0e}"
            yield name, prepare_batches(form, tolerance)


def compute(motions: Motions, t: float) -> Real:
    """Return the orientations from the package."""
    return Motions(motions.top, motions.start).at(t).orientation


@cache
def compute_exact(count: int, t: float) -> tuple[Real, Real]:
    """Return the exact orientations of the first of `count` motions, as sums of two doubles.

    They come from a Taylor integration with 32 digits, which shares no formula with the package.
    """
    first: Any = islice(draw_motions(count), COMPARED)
    high, low = zip(*(split_orientations(integrate(each), [t]) for each in first), strict=True)
    return np.concatenate(high), np.concatenate(low)


def measure_many(name: str, program: Program, count: int, t: float) -> ManyCost:
    """Measure a program with a number of motions, which are the same for all programs."""
    motions = draw_motions(count)
    exact = compute_exact(count, t)
    found = program(motions, t)  # a first time, of which what is done only once is a part
    seconds = median(repeat(partial(program, motions, t), number=1, repeat=RUNS))
    compared = len(exact[0])
    error = float(measure_angles(found[:compared], *exact).max())
    return ManyCost(name, count, seconds / count, error, compared, RUNS)


def format_many(costs: list[ManyCost], t: float) -> str:
    """Return the chapter of the report, on states at a time in s."""
    if not costs:
        return ""
    return write_chapter("many", first=costs[0], t=t, table=tabulate(costs))


def tabulate(costs: list[ManyCost]) -> str:
    """Return the table of the chapter, which docs/many.md has as well."""
    rows = [[each.peer, f"{each.error:.0e}", f"{each.seconds * 1e6:.3g}"] for each in costs]
    return format_table(["", "largest error", "us a motion"], rows)
