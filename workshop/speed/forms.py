"""The best form of each program for an error: which equations and methods, and at which setting."""

from collections.abc import Iterable, Iterator
from pathlib import Path

import yaml

from workshop.speed.publish import format_list, format_ms, format_table, group, write_chapter
from workshop.speed.sweep import Curve, Measurement

LEVELS = (1e-9, 1e-12)  # rad
HEAD = ["program", "for", "form", "setting", "largest error", "ms", "x ours"]
# By program: what was tried, and who could object.
PROGRAMS: dict[str, dict[str, str]] = yaml.safe_load(
    Path(__file__).with_name("peers").joinpath("programs.yaml").read_text(encoding="utf-8")
)
Form = tuple[Curve, Measurement]


def find_program(peer: str) -> str:
    """Return the program of a peer: the longest name with which its own one begins."""
    return max((name for name in PROGRAMS if peer.startswith(name)), key=len)


def find_form(peer: str) -> str:
    """Return what the name of a peer says of its form."""
    return peer.removeprefix(find_program(peer)).strip(" ,") or "-"


def find_cheapest(curves: Iterable[Curve], error: float) -> Form | None:
    """Return the fastest form with at most this error (rad), or None."""
    found = ((curve, curve.find_cheapest(error)) for curve in curves)
    good = [(curve, point) for curve, point in found if point]
    return min(good, key=lambda each: each[1].seconds, default=None)


def find_best(curves: Iterable[Curve]) -> Form:
    """Return the form with the smallest error."""
    return min(((c, c.best) for c in curves), key=lambda each: each[1].error)


def tabulate_forms(curves: Iterable[Curve], ours: float) -> str:
    """Return the table of the best forms by program; `ours` is the package's time in s."""
    rows = []
    for program, own in group(curves, lambda curve: find_program(curve.peer)).items():
        for wanted, form in _list_forms(own):
            rows.append([program, wanted, *_describe(form, ours)])
    return format_table(HEAD, rows)


def describe_programs(curves: Iterable[Curve]) -> str:
    """Return a list of what was tried for each program of some curves, and who could object."""
    names = dict.fromkeys(find_program(curve.peer) for curve in curves)
    return format_list(
        f"{name}: {PROGRAMS[name]['tried']} Who could object: {PROGRAMS[name]['objection']}"
        for name in names
    )


def write_forms(curves: list[Curve], ours: float) -> str:
    """Return the chapter of the best forms for one motion."""
    table, programs = tabulate_forms(curves, ours), describe_programs(curves)
    return write_chapter("forms", table=table, programs=programs)


def _list_forms(curves: list[Curve]) -> Iterator[tuple[str, Form]]:
    """Yield what is wanted, and the form for it; of one form that serves for several once."""
    wanted = [(f"{level:.0e}", find_cheapest(curves, level)) for level in LEVELS]
    forms = [(name, form) for name, form in [*wanted, ("its best", find_best(curves))] if form]
    for own in group(forms, lambda each: f"{each[1][0].peer} {each[1][1].setting}").values():
        yield ", ".join(name for name, _ in own), own[0][1]


def _describe(form: Form, ours: float) -> list[str]:
    curve, point = form
    return [
        find_form(curve.peer),
        f"{point.setting:.1e}" if point.setting else "-",
        f"{point.error:.1e}",
        format_ms(point.seconds),
        f"{point.seconds / ours:.3g}",
    ]
