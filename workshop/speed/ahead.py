"""Every case of a report in which a peer is faster, or more exact, than the package.

Each list of results has its own function here, which compares all numbers that the tables show.
"""

from collections.abc import Callable, Iterator, Sequence
from itertools import product
from statistics import median
from typing import TypeVar

from workshop.speed.benchmarks import (
    CHECK,
    DRIVEN_BEST,
    DRIVEN_OWN,
    ArrayCost,
    DrivenCase,
    Growth,
    Results,
)
from workshop.speed.many import ManyCost
from workshop.speed.peers import CLOSED_FORM, TAYLOR
from workshop.speed.publish import format_ms, group
from workshop.speed.sweep import Curve

OWN = "symtop_ros, "
FRICTION = "cusps with friction"
Entry = TypeVar("Entry", Growth, ArrayCost, ManyCost)


def list_ahead(results: Results) -> Iterator[str]:
    """Yield a sentence for each case."""
    for find in TABLES.values():
        yield from find(results)


def _list_checks(results: Results) -> Iterator[str]:
    ours = results.checks.get(CLOSED_FORM, 0.0)
    for peer, error in _leave_own(results.checks).items():
        yield from _compare_errors(f"The first {CHECK:g} s of the first motion", peer, error, ours)


def _list_curves(results: Results) -> Iterator[str]:
    for curve in results.curves:
        if not curve.peer.startswith(OWN):
            yield from _compare_curves(results, curve)


def _compare_curves(results: Results, curve: Curve) -> Iterator[str]:
    own = TAYLOR if curve.motion == FRICTION else CLOSED_FORM
    own_curve = results.find_curve(own, curve.motion)
    ours, best = own_curve.best, curve.best
    faster = [
        point
        for point in curve.points
        if point.seconds < (own_curve.find_cheapest(point.error) or ours).seconds
    ]
    if faster:
        quick = min(faster, key=lambda point: point.error)
        same = own_curve.find_cheapest(quick.error) or ours
        yield (
            f"{curve.motion}: {curve.peer} reaches {quick.error:.1e} rad in "
            f"{format_ms(quick.seconds)} ms, {own.removeprefix(OWN)} {same.error:.1e} in "
            f"{format_ms(same.seconds)} ms."
        )
    if best.error < ours.error and best not in faster:
        yield (
            f"{curve.motion}: {curve.peer} is more exact, {best.error:.1e} against "
            f"{ours.error:.1e} rad, in {format_ms(best.seconds)} ms."
        )
    where = f"{curve.motion}, mean error"
    yield from _compare_errors(where, curve.peer, best.mean_error, ours.mean_error)
    where = f"{curve.motion}, time to build"
    yield from _compare_times(where, curve.peer, best.preparing, ours.preparing)


def _list_growth(results: Results) -> Iterator[str]:
    for own, each in _pair(results.growth):
        # Each has the first of the same times: a slow peer has fewer.
        columns = zip(each.times, each.errors, own.errors, each.seconds, own.seconds, strict=False)
        for t, error, our_error, seconds, our_seconds in columns:
            yield from _compare_errors(f"Error at {t:g} s", each.peer, error, our_error)
            yield from _compare_times(f"Error at {t:g} s", each.peer, seconds, our_seconds)


def _list_states(results: Results) -> Iterator[str]:
    for own, each in _pair(results.states):
        columns = zip(own.numbers, own.seconds, each.seconds, strict=True)
        if numbers := [f"{n:g}" for n, ours, other in columns if other < ours]:
            yield f"Arrays of {', '.join(numbers)} states: {each.peer} is faster."
        yield from _compare_errors("Arrays of states", each.peer, each.error, own.error)


def _list_many(results: Results) -> Iterator[str]:
    for own, each in _pair(results.many):
        where = "Many different motions"
        yield from _compare_errors(where, each.peer, each.error, own.error)
        yield from _compare_times(where, each.peer, each.seconds, own.seconds)


def _pair(entries: Sequence[Entry]) -> Iterator[tuple[Entry, Entry]]:
    """Yield the entry of the closed form with that of each peer."""
    own = (each for each in entries if each.peer == CLOSED_FORM)
    return product(own, [each for each in entries if not each.peer.startswith(OWN)])


def _list_hard(results: Results) -> Iterator[str]:
    for family, cases in group(results.hard, lambda case: case.family).items():
        ours = max(case.error for case in cases)
        for peer in dict.fromkeys(name for case in cases for name in case.peers):
            error = max(case.peers[peer] for case in cases if peer in case.peers)
            yield from _compare_errors(f"Hard cases, {family}", peer, error, ours)


def _list_driven(results: Results) -> Iterator[str]:
    for family, cases in group(results.driven, lambda case: case.family).items():
        for peer in _leave_own(cases[0].errors):
            yield from _compare_family(f"Friction and torques, {family}", cases, peer)


def _compare_family(where: str, cases: list[DrivenCase], peer: str) -> Iterator[str]:
    errors = [[case.errors[name] for case in cases] for name in (peer, TAYLOR)]
    own = find_own(peer)
    seconds = [median([case.seconds[name] for case in cases]) for name in (peer, own)]
    yield from _compare_errors(f"{where}, median", peer, *map(median, errors))
    yield from _compare_errors(f"{where}, largest", peer, *map(max, errors))
    yield from _compare_times(f"{where}, median", peer, *seconds)


def find_own(peer: str) -> str:
    """Return the setting of the series with which a peer's driven motions are compared."""
    return DRIVEN_OWN if peer == DRIVEN_BEST else TAYLOR


def _leave_own(values: dict[str, float]) -> dict[str, float]:
    return {peer: value for peer, value in values.items() if not peer.startswith(OWN)}


def _compare_errors(where: str, peer: str, error: float, ours: float) -> Iterator[str]:
    if error < ours:
        yield f"{where}: {peer} is more exact, {error:.1e} against {ours:.1e} rad."


def _compare_times(where: str, peer: str, seconds: float, ours: float) -> Iterator[str]:
    if seconds < ours:
        yield f"{where}: {peer} is faster, {format_ms(seconds)} against {format_ms(ours)} ms."


# By the fields of `Results`: a test finds one that is missing.
TABLES: dict[str, Callable[[Results], Iterator[str]]] = {
    "checks": _list_checks,
    "curves": _list_curves,
    "growth": _list_growth,
    "states": _list_states,
    "many": _list_many,
    "hard": _list_hard,
    "driven": _list_driven,
}
