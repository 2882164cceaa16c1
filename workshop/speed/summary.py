"""The README's figures of a motion, and where others are ahead, from the report's results."""

from collections.abc import Iterator, Sequence
from statistics import median

from workshop.speed.ahead import FRICTION, find_own
from workshop.speed.benchmarks import DRIVEN_BEST, DRIVEN_PEER, Results
from workshop.speed.forms import LEVELS, Form, find_best, find_cheapest, find_program
from workshop.speed.peers import CLOSED_FORM, TAYLOR
from workshop.speed.publish import format_ms, format_table, group
from workshop.speed.reference import ReferenceMotion
from workshop.speed.sweep import Curve, Measurement

NAME = "measured motion"
AHEAD = "others ahead"
OWN = "symtop_ros"
_LEVEL = f"{LEVELS[0]:.0e}".replace("e-0", "e-")


def format_measured(results: Results, motion: ReferenceMotion) -> str:
    """Return errors and times of this package, and of the best of the others."""
    free = [curve for curve in results.curves if curve.motion == motion.name]
    driven = [curve for curve in results.curves if curve.motion == FRICTION]
    head = [
        "",
        OWN,
        "most exact other program",
        f"fastest other program within {_LEVEL} rad",
    ]
    rows = [["gravity alone", *_compare(free, CLOSED_FORM)]]
    if driven:
        rows.append(["with friction", *_compare(driven, TAYLOR)])
    return format_table(head, rows)


def _compare(curves: Sequence[Curve], own: str) -> Iterator[str]:
    """Yield our figures, those of the most exact other form, and of the fastest for an error."""
    ours = next(curve for curve in curves if curve.peer == own)
    quick = ours.find_cheapest(LEVELS[0])
    coarse = f"; within {_LEVEL} rad {format_ms(quick.seconds)} ms" if quick else ""
    yield _describe(ours.best) + (coarse if quick != ours.best else "")
    others = [curve for curve in curves if not curve.peer.startswith(OWN)]
    best = find_best(others) if others else None  # none may be installed
    yield f"{_name(best)}: {_describe(best[1])}" if best else "-"
    fastest = find_cheapest(others, LEVELS[0])
    yield f"{_name(fastest)}: {format_ms(fastest[1].seconds)} ms" if fastest else "-"


def _describe(point: Measurement) -> str:
    return f"{point.error:.0e} rad, {format_ms(point.seconds)} ms"


def _name(form: Form) -> str:
    bits = " (80 bits)" if "80 bits" in form[0].peer else ""
    return f"{find_program(form[0].peer)}{bits}"


def format_others_ahead(results: Results) -> str:
    """Return the table of docs/accuracy.md: motions for which another program is ahead."""
    head = ["", "program and form", "time / ours", "error, rad", "our error, rad"]
    return format_table(head, [*_list_motions_ahead(results), *_list_driven_ahead(results)])


def _list_motions_ahead(results: Results) -> Iterator[list[str]]:
    """Yield the most exact form of another program, and the fastest for an error, if ahead."""
    for motion, curves in group(results.curves, lambda curve: curve.motion).items():
        own = next(curve for curve in curves if curve.peer.startswith(OWN))
        others = [curve for curve in curves if not curve.peer.startswith(OWN)]
        if not others:
            continue
        forms = [find_best(others), find_cheapest(others, LEVELS[0])]
        for n, form in enumerate(forms):
            if form is None:
                continue
            curve, point = form
            ours = (n and own.find_cheapest(LEVELS[0])) or own.best
            is_ahead = point.seconds < ours.seconds if n else point.error < ours.error
            if is_ahead:
                ratio = f"{point.seconds / ours.seconds:.2g}"
                yield [motion, curve.peer, ratio, f"{point.error:.0e}", f"{ours.error:.0e}"]


def _list_driven_ahead(results: Results) -> Iterator[list[str]]:
    """Yield in how many families with friction or a torque another program takes less time."""
    families = group(results.driven, lambda case: case.family)
    for peer in (DRIVEN_PEER, DRIVEN_BEST):
        ratios = [
            median(case.seconds[peer] for case in own)
            / median(case.seconds[find_own(peer)] for case in own)
            for own in families.values()
            if all(peer in case.errors for case in own)
        ]
        if ahead := sorted(ratio for ratio in ratios if ratio < 1):
            errors = [
                f"{max(case.errors[name] for case in results.driven):.0e}"
                for name in (peer, find_own(peer))
            ]
            yield [
                f"friction and torques: {len(ahead)} of {len(ratios)} families",
                peer,
                f"{ahead[0]:.2g} to {ahead[-1]:.2g}",
                *(f"{error} at most" for error in errors),
            ]
