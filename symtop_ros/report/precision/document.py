"""The report in Markdown."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

from symtop_ros.report.precision.chapters import CHECK, SPAN, HardCase, Results
from symtop_ros.report.precision.measure import Curve
from symtop_ros.report.precision.peers.own import CLOSED_FORM, SPLITTING
from symtop_ros.report.precision.reference import EPS, Problem

LEVELS = (1e-6, 1e-9, 1e-12)
FRICTION = "cusps with friction"


@dataclass(frozen=True)
class Circumstances:
    """Where and how it was measured.

    Attributes
    ----------
    command, machine : str
        What to type to measure again; processor and system.
    versions : dict
        Of Python and of every package that was measured.
    missing : list of str
        Peers that are not installed.
    """

    command: str
    machine: str
    versions: dict[str, str]
    missing: list[str]


def document(results: Results, problem: Problem, around: Circumstances) -> str:
    """Return the whole report."""
    parts = [
        "# Speed against error",
        _circumstances(around),
        _work(results, problem),
        _other_motions(results, problem),
        _friction(results),
        _long_times(results, problem),
        _arrays(results),
        _hard_cases(results.hard),
    ]
    return "\n\n".join(part for part in parts if part) + "\n"


def table(head: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    """Return a table of Markdown: words left, numbers right."""
    lines = [_row(head), _row(["---", *["--:"] * (len(head) - 1)]), *map(_row, rows)]
    return "\n".join(lines)


def _row(cells: Sequence[str]) -> str:
    return f"| {' | '.join(cells)} |"


def _circumstances(around: Circumstances) -> str:
    versions = ", ".join(f"{name} {version}" for name, version in around.versions.items())
    text = f"`{around.command}` on {around.machine}; {versions}."
    if around.missing:
        text += f" Not installed: {', '.join(around.missing)}."
    return text + (
        " Errors are distances of the quaternion from a reference of 25 digits, computed by other "
        "means. Times are medians of repeated runs in one process; building, loading and compiling "
        "a model is apart (the closed form's set-up is in its time)."
    )


def _work(results: Results, problem: Problem) -> str:
    curves = [curve for curve in results.curves if curve.motion == problem.name]
    ours = next(curve for curve in curves if curve.peer == CLOSED_FORM).best
    head = ["", "model", "best error", "ms", "x ours"]
    head += [f"ms for {level:.0e}" for level in LEVELS] + ["to build, ms"]
    rows = [
        [
            curve.peer,
            f"{results.checks[curve.peer]:.0e}",
            f"{curve.best.error:.1e}",
            _ms(curve.best.seconds),
            f"{curve.best.seconds / ours.seconds:.3g}",
            *(_cheapest(curve, level) for level in LEVELS),
            _ms(curve.best.preparing),
        ]
        for curve in curves
    ]
    return (
        f"## The article's top, {problem.name}, {SPAN:g} s\n\n"
        f"![work and precision](work_precision.svg)\n\n{table(head, rows)}\n\n"
        f"Model: its error after {CHECK:g} s at its finest setting, which shows that it is the "
        f"same top. Rounding of the input changes the state by {problem.limit(SPAN):.1e}."
    )


def _ms(seconds: float) -> str:
    return f"{seconds * 1e3:.3g}"


def _cheapest(curve: Curve, error: float) -> str:
    point = curve.cheapest(error)
    return _ms(point.seconds) if point else "-"


def _other_motions(results: Results, problem: Problem) -> str:
    """Best error and its time of each peer on each motion."""
    others = [c for c in results.curves if c.motion not in (problem.name, FRICTION)]
    names = list(dict.fromkeys(curve.motion for curve in others))
    if not names:
        return ""
    peers = dict.fromkeys(curve.peer for curve in others)
    best = {(c.peer, c.motion): f"{c.best.error:.0e} in {_ms(c.best.seconds)}" for c in others}
    rows = [[peer, *(best[peer, name] for name in names)] for peer in peers]
    return (
        "## The article's other motions\n\n![the same for every motion](motions.svg)\n\n"
        f"Best error, and the ms it takes.\n\n{table(['', *names], rows)}"
    )


def _friction(results: Results) -> str:
    curves = [curve for curve in results.curves if curve.motion == FRICTION]
    ours = next(curve for curve in curves if curve.peer == SPLITTING).best
    head = ["", "best error", "ms", "x ours", *(f"ms for {level:.0e}" for level in LEVELS)]
    rows = [
        [
            curve.peer,
            f"{curve.best.error:.1e}",
            _ms(curve.best.seconds),
            f"{curve.best.seconds / ours.seconds:.3g}",
            *(_cheapest(curve, level) for level in LEVELS),
        ]
        for curve in curves
    ]
    return f"## The same with friction, {SPAN:g} s\n\n{table(head, rows)}"


def _long_times(results: Results, problem: Problem) -> str:
    times = [t for t in problem.times if t >= SPAN]
    rows = []
    for each in results.growth:
        cells = [
            f"{error:.0e} in {seconds:.2g} s"
            for error, seconds in zip(each.errors, each.seconds, strict=True)
        ]
        rows.append([each.peer, *cells, *["-"] * (len(times) - len(cells))])
    rows.append(["rounding of the input", *(f"{problem.limit(t):.0e}" for t in times)])
    return (
        "## Long times\n\n![errors as they grow](long_times.svg)\n\n"
        "Each at its best setting, as far as the budget of time allows.\n\n"
        f"{table(['', *(f'{t:g} s' for t in times)], rows)}"
    )


def _arrays(results: Results) -> str:
    numbers = results.states[0].numbers
    rows = [
        [
            each.peer,
            f"{each.error:.0e}",
            *(f"{s / n * 1e6:.3g}" for s, n in zip(each.seconds, numbers, strict=True)),
        ]
        for each in results.states
    ]
    return (
        f"## Many states\n\n![cost of a state](arrays.svg)\n\nMicroseconds for each of so many "
        f"states, evenly over {SPAN:g} s; set-up or integration included.\n\n"
        f"{table(['', 'error', *(f'{n:g}' for n in numbers)], rows)}"
    )


def _hard_cases(cases: list[HardCase]) -> str:
    peers = list(dict.fromkeys(name for case in cases for name in case.peers))
    rows = []
    for family in dict.fromkeys(case.family for case in cases):
        own = [case for case in cases if case.family == family]
        lowest, highest = min(case.small for case in own), max(case.small for case in own)
        rows.append([family, f"{highest:.0e} ... {lowest:.0e}", *_errors(own, peers)])
    head = ["family", "from ... to", "rounding of the input, eps", "closed form, eps"]
    head += [f"{peer}, eps" for peer in peers]
    return (
        "## Hard cases\n\n![hard cases, step by step](hard_cases.svg)\n\n"
        "Each family goes to its singular case in steps of a hundred and ends with the case "
        f"itself. The largest errors, in eps = {EPS:.1e}; a dash where a peer would take too long."
        f"\n\n{table(head, rows)}"
    )


def _errors(cases: list[HardCase], peers: list[str]) -> list[str]:
    limits = [max(case.limit for case in cases), max(case.error for case in cases)]
    cells = [f"{each / EPS:.2g}" for each in limits]
    for peer in peers:
        known = [case.peers[peer] for case in cases if peer in case.peers]
        cells.append(f"{max(known) / EPS:.2g}" if known else "-")
    return cells
