"""Every case of a report in which a peer is faster, or more exact, than the package.

Each list of results has its own function here, which compares all numbers that the tables show.
"""

from collections.abc import Callable, Iterator
from statistics import median

from workshop.speed.benchmarks import CHECK, DrivenCase, HardCase, Results
from workshop.speed.peers import CLOSED_FORM, TAYLOR
from workshop.speed.sweep import Curve

OWN = "symtop_ros, "
FRICTION = "cusps with friction"


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
    ours, best = results.find_curve(own, curve.motion).best, curve.best
    faster = [point for point in curve.points if point.seconds < ours.seconds]
    if faster:
        quick = min(faster, key=lambda point: point.error)
        yield (
            f"{curve.motion}: {curve.peer} reaches {quick.error:.1e} rad in {_ms(quick.seconds)} "
            f"ms, {own.removeprefix(OWN)} {ours.error:.1e} in {_ms(ours.seconds)} ms."
        )
    if best.error < ours.error and best not in faster:
        yield (
            f"{curve.motion}: {curve.peer} is more exact, {best.error:.1e} against "
            f"{ours.error:.1e} rad, in {_ms(best.seconds)} ms."
        )
    where = f"{curve.motion}, mean error"
    yield from _compare_errors(where, curve.peer, best.mean_error, ours.mean_error)
    where = f"{curve.motion}, time to build"
    yield from _compare_times(where, curve.peer, best.preparing, ours.preparing)


def _list_growth(results: Results) -> Iterator[str]:
    own = [each for each in results.growth if each.peer == CLOSED_FORM]
    rows = {t: k for each in own for k, t in enumerate(each.times)}
    for each in results.growth:
        for t, error, seconds in zip(each.times, each.errors, each.seconds, strict=True):
            if t in rows and not each.peer.startswith(OWN):
                where, k = f"Error at {t:g} s", rows[t]
                yield from _compare_errors(where, each.peer, error, own[0].errors[k])
                yield from _compare_times(where, each.peer, seconds, own[0].seconds[k])


def _list_states(results: Results) -> Iterator[str]:
    own = [each for each in results.states if each.peer == CLOSED_FORM]
    for each in results.states:
        if not own or each.peer.startswith(OWN):
            continue
        columns = zip(own[0].numbers, own[0].seconds, each.seconds, strict=True)
        if numbers := [f"{n:g}" for n, ours, other in columns if other < ours]:
            yield f"Arrays of {', '.join(numbers)} states: {each.peer} is faster."
        yield from _compare_errors("Arrays of states", each.peer, each.error, own[0].error)


def _list_many(results: Results) -> Iterator[str]:
    own = [each for each in results.many if each.peer == CLOSED_FORM]
    for each in results.many:
        if own and not each.peer.startswith(OWN):
            where = "Many different motions"
            yield from _compare_errors(where, each.peer, each.error, own[0].error)
            yield from _compare_times(where, each.peer, each.seconds, own[0].seconds)


def _list_hard(results: Results) -> Iterator[str]:
    families: dict[str, list[HardCase]] = {}
    for case in results.hard:
        families.setdefault(case.family, []).append(case)
    for family, cases in families.items():
        ours = max(case.error for case in cases)
        for peer in dict.fromkeys(name for case in cases for name in case.peers):
            error = max(case.peers[peer] for case in cases if peer in case.peers)
            yield from _compare_errors(f"Hard cases, {family}", peer, error, ours)


def _list_driven(results: Results) -> Iterator[str]:
    families: dict[str, list[DrivenCase]] = {}
    for case in results.driven:
        families.setdefault(case.family, []).append(case)
    for family, cases in families.items():
        for peer in _leave_own(cases[0].errors):
            yield from _compare_family(f"Friction and torques, {family}", cases, peer)


def _compare_family(where: str, cases: list[DrivenCase], peer: str) -> Iterator[str]:
    errors = [[case.errors[name] for case in cases] for name in (peer, TAYLOR)]
    seconds = [median([case.seconds[name] for case in cases]) for name in (peer, TAYLOR)]
    yield from _compare_errors(f"{where}, median", peer, *map(median, errors))
    yield from _compare_errors(f"{where}, largest", peer, *map(max, errors))
    yield from _compare_times(f"{where}, median", peer, *seconds)


def _leave_own(values: dict[str, float]) -> dict[str, float]:
    return {peer: value for peer, value in values.items() if not peer.startswith(OWN)}


def _compare_errors(where: str, peer: str, error: float, ours: float) -> Iterator[str]:
    if error < ours:
        yield f"{where}: {peer} is more exact, {error:.1e} against {ours:.1e} rad."


def _compare_times(where: str, peer: str, seconds: float, ours: float) -> Iterator[str]:
    if seconds < ours:
        yield f"{where}: {peer} is faster, {_ms(seconds)} against {_ms(ours)} ms."


def _ms(seconds: float) -> str:
    return f"{seconds * 1e3:.3g}"


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
