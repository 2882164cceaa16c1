"""The text of the report, in Markdown."""

from dataclasses import dataclass
from statistics import median

from workshop.speed.ahead import FRICTION, OWN, find_own, list_ahead
from workshop.speed.benchmarks import CHECK, SPAN, ArrayCost, DrivenCase, HardCase, Results
from workshop.speed.footprint import format_footprint
from workshop.speed.forms import find_best, find_cheapest, find_form, find_program, write_forms
from workshop.speed.many import format_many
from workshop.speed.peers import CLOSED_FORM, TAYLOR
from workshop.speed.publish import (
    format_list,
    format_ms,
    format_table,
    format_tables,
    group,
    write_chapter,
)
from workshop.speed.reference import EPS, ReferenceMotion
from workshop.speed.sweep import Curve

LEVELS = (1e-6, 1e-9, 1e-12)
ARRAY = 100_000  # states of the column on arrays
BEST = ["", "largest error", "mean error", "at times", "ms", "x ours"]
COSTS = [f"ms for {level:.0e}" for level in LEVELS]


@dataclass(frozen=True)
class Environment:
    """The command, the machine and the packages of a measurement."""

    command: str  # to measure again
    machine: str  # processor and system
    date: str
    versions: dict[str, str]  # versions of Python and of every package that was measured
    missing: list[str]  # peers that are not installed
    limit: float  # seconds that one run of a peer could take
    load: str = ""  # programs that wanted a processor, at the end


def format_document(results: Results, motion: ReferenceMotion, environment: Environment) -> str:
    """Return the whole report; its first chapters are on one motion."""
    return f"# Speed against error\n\n{format_chapters(results, motion, environment)}"


def format_chapters(results: Results, motion: ReferenceMotion, environment: Environment) -> str:
    """Return the report without its title; what is not measured yet is left out."""
    parts = [
        _format_environment(environment),
        _format_work(results, motion, environment.limit),
        _format_other_motions(results, motion),
        _format_friction(results),
        _format_driven(results.driven),
        _format_long_times(results, motion),
        _format_arrays(results),
        format_many(results.many, SPAN),
        _format_hard_cases(results.hard),
        _format_ahead(results),
    ]
    return "\n\n".join(part for part in parts if part)


def format_summary(results: Results, motion: ReferenceMotion) -> str:
    """Return the table of docs/accuracy.md: each program in its best forms, on one motion."""
    head = ["", "its best, form", "largest error, rad", "ms", f"for {LEVELS[1]:.0e}, form", "ms"]
    curves = [curve for curve in results.curves if curve.motion == motion.name]
    rows = []
    for program, own in group(curves, lambda curve: find_program(curve.peer)).items():
        best, cheap = find_best(own), find_cheapest(own, LEVELS[1])
        rows.append(
            [
                program,
                find_form(best[0].peer),
                f"{best[1].error:.0e}",
                format_ms(best[1].seconds),
                *((find_form(cheap[0].peer), format_ms(cheap[1].seconds)) if cheap else ("-", "-")),
            ]
        )
    return format_table(head, rows)


def _format_environment(environment: Environment) -> str:
    named = (f"{name} {version}" for name, version in environment.versions.items())
    missing = ", ".join(environment.missing)
    return write_chapter(
        "conditions",
        command=environment.command,
        machine=environment.machine,
        date=environment.date,
        versions=", ".join(named),
        load=environment.load or "unknown",
        missing=f"Not installed: {missing}." if missing else "",
    )


def _format_work(results: Results, motion: ReferenceMotion, limit: float) -> str:
    curves = [curve for curve in results.curves if curve.motion == motion.name]
    if not curves:
        return ""
    ours = results.find_curve(CLOSED_FORM, motion.name).best
    errors = [
        [*_format_best(curve, ours.seconds), "" if len(curve.points) == 1 else curve.end]
        for curve in curves
    ]
    return write_chapter(
        "work",
        motion=motion.name,
        t=SPAN,
        limit=limit,
        forms=write_forms(curves, ours.seconds),
        errors=format_table([*BEST, "sweep ended at"], errors),
        costs=_format_costs(results, curves),
        array=ARRAY,
        check=CHECK,
        rounding=motion.limit(SPAN),
    )


def _format_costs(results: Results, curves: list[Curve]) -> str:
    """Return the table of times for `LEVELS`, arrays and building, with the check of the model."""
    costs = {each.peer: each for each in results.states}
    rows = [
        [
            curve.peer,
            *_format_levels(curve),
            _format_array_cost(costs.get(curve.peer)),
            format_ms(curve.best.preparing),
            f"{results.checks[curve.peer]:.0e}",
        ]
        for curve in curves
    ]
    return format_table(["", *COSTS, "us a state, array", "to build, ms", "model"], rows)


def _format_array_cost(cost: ArrayCost | None) -> str:
    if not cost or ARRAY not in cost.numbers:
        return "-"
    return f"{cost.seconds[cost.numbers.index(ARRAY)] / ARRAY * 1e6:.3g}"


def _format_best(curve: Curve, ours: float) -> list[str]:
    """Return the name of a peer, its best errors, their time, and the ratio to ours (s)."""
    best = curve.best
    return [
        curve.peer,
        f"{best.error:.1e}",
        f"{best.mean_error:.1e}",
        f"{best.compared}",
        format_ms(best.seconds),
        f"{best.seconds / ours:.3g}",
    ]


def _format_levels(curve: Curve) -> list[str]:
    """Return the times for `LEVELS`."""
    cheapest = [curve.find_cheapest(level) for level in LEVELS]
    return [format_ms(point.seconds) if point else "-" for point in cheapest]


def _format_other_motions(results: Results, motion: ReferenceMotion) -> str:
    """Return a table of the best error of each peer on each motion, with its time."""
    others = [c for c in results.curves if c.motion not in (motion.name, FRICTION)]
    names = list(dict.fromkeys(curve.motion for curve in others))
    if not names:
        return ""
    peers = dict.fromkeys(curve.peer for curve in others)
    best = {
        (c.peer, c.motion): f"{c.best.error:.0e} in {format_ms(c.best.seconds)}" for c in others
    }
    # In a report that is not complete yet, some are still to come.
    rows = [[peer, *(best.get((peer, name), "") for name in names)] for peer in peers]
    return write_chapter("other motions", t=SPAN, table=format_tables(["", *names], rows))


def _format_friction(results: Results) -> str:
    curves = [curve for curve in results.curves if curve.motion == FRICTION]
    if not curves:
        return ""
    ours = results.find_curve(TAYLOR, FRICTION).best
    errors = format_table(BEST, [_format_best(curve, ours.seconds) for curve in curves])
    costs = format_table(["", *COSTS], [[c.peer, *_format_levels(c)] for c in curves])
    forms = write_forms(curves, ours.seconds)
    return write_chapter("friction", t=SPAN, forms=forms, errors=errors, costs=costs)


def _format_driven(cases: list[DrivenCase]) -> str:
    """Return tables of the families: median and largest errors, and median times."""
    if not cases:
        return ""
    peers = list(cases[0].errors)
    labels = [peer.removeprefix(OWN) for peer in peers]
    others = [peer for peer in peers if not peer.startswith(OWN)]
    errors, seconds = [], []
    for family, own in group(cases, lambda case: case.family).items():
        of_peers = [[case.errors[peer] for case in own] for peer in peers]
        cells = [f"{summarize(each):.1e}" for summarize in (median, max) for each in of_peers]
        errors.append([family, f"{len(own)}", *cells])
        times = [median([case.seconds[peer] for case in own]) for peer in peers]
        of_names = dict(zip(peers, times, strict=True))
        ratios = (f"{of_names[peer] / of_names[find_own(peer)]:.2g}" for peer in others)
        seconds.append([family, *map(format_ms, times), *ratios])
    head = ["family", "motions"]
    head += [f"{name}, {label}" for name in ("median", "largest") for label in labels]
    heads = [f"{peer}, x ours" for peer in others]
    return write_chapter(
        "driven",
        errors=format_tables(head, errors, 2),
        seconds=format_tables(["family", *labels, *heads], seconds),
    )


def _format_long_times(results: Results, motion: ReferenceMotion) -> str:
    if not results.growth:
        return ""
    times = [t for t in motion.times if t >= SPAN]
    rows = []
    for each in results.growth:
        cells = [
            f"{error:.0e} in {seconds:.2g} s"
            for error, seconds in zip(each.errors, each.seconds, strict=True)
        ]
        rows.append([each.peer, *cells, *["-"] * (len(times) - len(cells))])
    rows.append(["rounding of the input", *(f"{motion.limit(t):.0e}" for t in times)])
    head = ["", *(f"{t:g} s" for t in times)]
    return write_chapter("long times", table=format_tables(head, rows))


def _format_arrays(results: Results) -> str:
    if not results.states:
        return ""
    numbers = results.states[0].numbers
    rows = [
        [
            each.peer,
            f"{each.error:.0e}",
            *(f"{s / n * 1e6:.3g}" for s, n in zip(each.seconds, numbers, strict=True)),
        ]
        for each in results.states
    ]
    table = format_tables(["", "largest error", *(f"{n:g}" for n in numbers)], rows)
    footprint = format_footprint(results.footprint) if results.footprint else ""
    return write_chapter("arrays", t=SPAN, table=table, footprint=footprint)


def _format_ahead(results: Results) -> str:
    """Return every case of this report in which a peer is faster, or more exact."""
    return write_chapter("ahead", cases=format_list(list_ahead(results)) or "- None.")


def _format_hard_cases(cases: list[HardCase]) -> str:
    if not cases:
        return ""
    peers = list(dict.fromkeys(name for case in cases for name in case.peers))
    rows = []
    for family, own in group(cases, lambda case: case.family).items():
        lowest, highest = min(case.small for case in own), max(case.small for case in own)
        rows.append([family, f"{highest:g} ... {lowest:g}", *_format_errors(own, peers)])
    head = ["family", "from ... to", "rounding of the input, eps", "closed form, eps"]
    head += [f"{peer}, eps" for peer in peers]
    return write_chapter("hard cases", eps=EPS, table=format_tables(head, rows))


def _format_errors(cases: list[HardCase], peers: list[str]) -> list[str]:
    """Return the largest limit, our largest error, and that of each peer, in eps."""
    largest = [max(case.limit for case in cases), max(case.error for case in cases)]
    cells = [f"{each / EPS:.2g}" for each in largest]
    for peer in peers:
        known = [case.peers[peer] for case in cases if peer in case.peers]
        cells.append(f"{max(known) / EPS:.2g}" if known else "-")
    return cells
