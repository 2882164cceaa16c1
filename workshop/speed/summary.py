"""The README's figures of a motion, from the report's results."""

from collections.abc import Sequence

from workshop.speed.ahead import FRICTION
from workshop.speed.benchmarks import SPAN, Results
from workshop.speed.forms import LEVELS, Form, find_best, find_cheapest, find_program
from workshop.speed.peers import CLOSED_FORM, TAYLOR
from workshop.speed.publish import format_ms, format_table
from workshop.speed.reference import ReferenceMotion
from workshop.speed.sweep import Curve

NAME = "measured motion"
OWN = "symtop_ros"


def format_measured(results: Results, motion: ReferenceMotion) -> str:
    """Return errors and times of this package, and of the best of the others."""
    free = [curve for curve in results.curves if curve.motion == motion.name]
    driven = [curve for curve in results.curves if curve.motion == FRICTION]
    rows = [
        [f"{SPAN:g} s under gravity alone", *_compare(free, CLOSED_FORM)],
        [f"{SPAN:g} s with friction", *_compare(driven, TAYLOR)] if driven else [],
        ["first state in Python, warm", *_compare_first(results)],
    ]
    level = f"the fastest of the others for {LEVELS[0]:.0e} rad"
    head = ["the article's top", OWN, "the most exact of the others", level]
    return format_table(head, [row for row in rows if row])


def _compare(curves: Sequence[Curve], own: str) -> list[str]:
    ours = next(curve for curve in curves if curve.peer == own).best
    others = [curve for curve in curves if not curve.peer.startswith(OWN)]
    fastest = find_cheapest(others, LEVELS[0])
    return [
        f"{ours.error:.0e} rad, {format_ms(ours.seconds)} ms",
        _name(find_best(others)),
        _name(fastest) if fastest else "none",
    ]


def _name(form: Form) -> str:
    curve, point = form
    bits = " in 80 bits" if "80 bits" in curve.peer else ""
    return (
        f"{find_program(curve.peer)}{bits}: {point.error:.0e} rad, {format_ms(point.seconds)} ms"
    )


def _compare_first(results: Results) -> list[str]:
    """Compare the calls for one state, from Python and with the set-up, if they were measured."""
    first = {each.peer: each for each in results.states if each.numbers[0] == 1}
    ours = first.pop(CLOSED_FORM)
    others = [each for each in first.values() if each.error <= LEVELS[0]]
    fastest = min(others, key=lambda each: each.seconds[0], default=None)
    named = "none"
    if fastest:
        named = f"{fastest.peer.split(',')[0]}: {format_ms(fastest.seconds[0])} ms"
    return [f"{format_ms(ours.seconds[0])} ms", "", named]
