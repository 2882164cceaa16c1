"""The text of the report, in Markdown."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from statistics import median

from workshop.speed.ahead import FRICTION, list_ahead
from workshop.speed.benchmarks import CHECK, SPAN, ArrayCost, DrivenCase, HardCase, Results
from workshop.speed.footprint import Footprint
from workshop.speed.many import ManyCost
from workshop.speed.peers import ALONE, CLOSED_FORM, TAYLOR
from workshop.speed.reference import EPS, ReferenceMotion
from workshop.speed.sweep import Curve

LEVELS = (1e-6, 1e-9, 1e-12)
SUMMARY = (
    CLOSED_FORM,
    CLOSED_FORM + ALONE,
    "heyoka, quaternion",
    "heyoka, Euler angles, two constants",
    "CyRK DOP853, Euler angles",
    "SciPy DOP853, Euler angles",
    "MuJoCo RK4",
    "Drake RK5, quaternion",
)
ARRAY = 100_000  # states of the column on arrays
BEST = ["", "largest error", "mean error", "at times", "ms", "x ours"]
BEST += [f"ms for {level:.0e}" for level in LEVELS]


@dataclass(frozen=True)
class Environment:
    """The command, the machine and the packages of a measurement."""

    command: str  # to measure again
    machine: str  # processor and system
    versions: dict[str, str]  # versions of Python and of every package that was measured
    missing: list[str]  # peers that are not installed
    limit: float  # seconds that one run of a peer could take
    engine: str = "Python"  # what computed the package's states


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
        _format_many(results.many),
        _format_hard_cases(results.hard),
        _format_ahead(results),
    ]
    return "\n\n".join(part for part in parts if part)


def format_summary(results: Results, motion: ReferenceMotion) -> str:
    """Return the table of the README: the best form of each program on one motion."""
    head = ["", "largest error, rad", "ms", f"ms for {LEVELS[1]:.0e}"]
    rows = []
    curves = {curve.peer: curve for curve in results.curves if curve.motion == motion.name}
    for curve in filter(None, map(curves.get, SUMMARY)):
        name = curve.peer
        cheapest = curve.find_cheapest(LEVELS[1])
        cells = [f"{curve.best.error:.0e}", _ms(curve.best.seconds)]
        rows.append([name, *cells, _ms(cheapest.seconds) if cheapest else "-"])
    return format_table(head, rows)


def format_table(head: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    """Return a Markdown table; the first column is aligned left, the others right."""
    lines = [head, ["---", *["--:"] * (len(head) - 1)], *rows]
    return "\n".join(f"| {' | '.join(cells)} |" for cells in lines)


def _format_environment(environment: Environment) -> str:
    versions = ", ".join(f"{name} {version}" for name, version in environment.versions.items())
    text = f"`{environment.command}` on {environment.machine}; {versions}."
    text += f" States are computed by {environment.engine}."
    if environment.missing:
        text += f" Not installed: {', '.join(environment.missing)}."
    return text + (
        " An error is the angle in rad of the rotation that would correct the attitude, "
        "2 |q - q_exact|. The exact motion is a Taylor integration of the equations of motion with "
        "32 digits. A time is that of reaching the end once, without output on the way, the median "
        "of repeated runs in one process; errors come from a separate run that is not timed. Times "
        "include the set-up of the closed form, and exclude building, loading and compiling the "
        "model of a peer."
    )


def _format_work(results: Results, motion: ReferenceMotion, limit: float) -> str:
    curves = [curve for curve in results.curves if curve.motion == motion.name]
    if not curves:
        return ""
    ours = results.find_curve(CLOSED_FORM, motion.name).best
    costs = {each.peer: each for each in results.states}
    head = [*BEST, "us a state, array", "to build, ms", "sweep ended at", "model"]
    rows = [
        [
            *(curve.peer, *_format_best(curve, ours.seconds)),
            _format_array_cost(costs.get(curve.peer)),
            _ms(curve.best.preparing),
            "" if len(curve.points) == 1 else curve.end,
            f"{results.checks[curve.peer]:.0e}",
        ]
        for curve in curves
    ]
    return (
        f"## The article's top, {motion.name}, {SPAN:g} s\n\n"
        f"![work and precision](work_precision.png)\n\n"
        f"Each at its best setting within {limit:g} s of computing time for a run.\n\n"
        f"{format_table(head, rows)}\n\n"
        "Largest and mean error: over times in (0, T], as many as the table says; peers without "
        "exact output between their steps are compared at the steps themselves. Sweep: tolerances "
        "or steps are made finer until the error grows again (turning point), a run would exceed "
        "the limit, or the program takes no finer one. "
        f"Model: the error within {CHECK:g} s at the finest setting, which shows that it is the "
        f"same top. Array: of {ARRAY:g} states in one call, set-up included. "
        f"Rounding of the input changes the state at the end by {motion.limit(SPAN):.1e} rad."
    )


def _format_array_cost(cost: ArrayCost | None) -> str:
    if not cost or ARRAY not in cost.numbers:
        return "-"
    return f"{cost.seconds[cost.numbers.index(ARRAY)] / ARRAY * 1e6:.3g}"


def _format_best(curve: Curve, ours: float) -> list[str]:
    """Return the best errors, their time, the ratio to ours (s), and the times for `LEVELS`."""
    best = curve.best
    cheapest = [curve.find_cheapest(level) for level in LEVELS]
    return [
        f"{best.error:.1e}",
        f"{best.mean_error:.1e}",
        f"{best.compared}",
        _ms(best.seconds),
        f"{best.seconds / ours:.3g}",
        *(_ms(point.seconds) if point else "-" for point in cheapest),
    ]


def _ms(seconds: float) -> str:
    return f"{seconds * 1e3:.3g}"


def _format_other_motions(results: Results, motion: ReferenceMotion) -> str:
    """Return a table of the best error of each peer on each motion, with its time."""
    others = [c for c in results.curves if c.motion not in (motion.name, FRICTION)]
    names = list(dict.fromkeys(curve.motion for curve in others))
    if not names:
        return ""
    peers = dict.fromkeys(curve.peer for curve in others)
    best = {(c.peer, c.motion): f"{c.best.error:.0e} in {_ms(c.best.seconds)}" for c in others}
    # In a report that is not complete yet, some are still to come.
    rows = [[peer, *(best.get((peer, name), "") for name in names)] for peer in peers]
    return (
        "## Other motions\n\n![speed against error, by motion](motions.png)\n\n"
        f"Largest error in {SPAN:g} s at the best setting, and its time in ms.\n\n"
        f"{format_table(['', *names], rows)}"
    )


def _format_friction(results: Results) -> str:
    curves = [curve for curve in results.curves if curve.motion == FRICTION]
    if not curves:
        return ""
    ours = results.find_curve(TAYLOR, FRICTION).best
    rows = [[curve.peer, *_format_best(curve, ours.seconds)] for curve in curves]
    return f"## Cusps with friction, {SPAN:g} s\n\n{format_table(BEST, rows)}"


def _format_driven(cases: list[DrivenCase]) -> str:
    """Return a table of the families: median and largest errors, and median times."""
    if not cases:
        return ""
    peers = list(cases[0].errors)
    labels = [peer.removeprefix("symtop_ros, ") for peer in peers]
    head = ["family", "motions"]
    for name in ("median error", "largest error", "median ms"):
        head += [f"{name}, {label}" for label in labels]
    rows = []
    for family in dict.fromkeys(case.family for case in cases):
        own = [case for case in cases if case.family == family]
        errors = [[case.errors[peer] for case in own] for peer in peers]
        seconds = [[case.seconds[peer] for case in own] for peer in peers]
        cells = [f"{median(each):.1e}" for each in errors]
        cells += [f"{max(each):.1e}" for each in errors]
        cells += [_ms(median(each)) for each in seconds]
        rows.append([family, f"{len(own)}", *cells])
    return (
        "## Friction and applied torques, by family\n\n"
        "Random tops and starts, 20 swings long in most families; 1000 swings or 50 s of the "
        "article's top in the family of tiny friction. The larger error of those at half the time "
        f"and at the end, each at its default, set-up not included for peers.\n\n"
        f"{format_table(head, rows)}"
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
    return (
        "## Long times\n\n![growth of the errors](long_times.png)\n\n"
        "Each at its best setting for ten seconds, within a limit of computing time: the error at "
        f"the end.\n\n{format_table(['', *(f'{t:g} s' for t in times)], rows)}"
    )


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
    return (
        f"## Many states\n\n![cost of a state](arrays.png)\n\nMicroseconds per state, by the "
        f"number of states, spread evenly over {SPAN:g} s; set-up or integration included.\n\n"
        f"{format_table(['', 'largest error', *(f'{n:g}' for n in numbers)], rows)}"
        f"{_format_footprint(results.footprint)}"
    )


def _format_many(costs: list[ManyCost]) -> str:
    if not costs:
        return ""
    first = costs[0]
    rows = [[each.peer, f"{each.error:.0e}", f"{each.seconds * 1e6:.3g}"] for each in costs]
    return (
        f"## Many different motions\n\nThe article's top with other weights, spins and tilts: the "
        f"same {first.motions:g} motions for each program, one state each after {SPAN:g} s. The "
        f"errors are those of the first {first.compared} motions, the times medians of "
        f"{first.runs} runs. heyoka is compiled once, with parameters for what differs, and "
        "integrates several motions at a time in batches.\n\n"
        f"{format_table(['', 'largest error', 'us a motion'], rows)}"
    )


def _format_footprint(footprint: Footprint | None) -> str:
    if not footprint:
        return ""
    return (
        f"\n\n`import symtop_ros.physics` takes {footprint.import_seconds * 1e3:.0f} ms in a fresh "
        f"process, of which NumPy takes {footprint.libraries_seconds * 1e3:.0f} "
        f"ms. {footprint.states:g} states need {footprint.peak_bytes / 2**20:.0f} MiB at most, "
        f"{footprint.peak_bytes / footprint.states:.0f} bytes a state, of which 56 are the state."
    )


def _format_ahead(results: Results) -> str:
    """Return every case of this report in which a peer is faster, or more exact."""
    text = "\n".join(f"- {line}" for line in list_ahead(results)) or "- None."
    return (
        "## Where a peer is ahead\n\nEvery case of this report: each table above is compared "
        f"row by row.\n\n{text}"
    )


def _format_hard_cases(cases: list[HardCase]) -> str:
    if not cases:
        return ""
    peers = list(dict.fromkeys(name for case in cases for name in case.peers))
    rows = []
    for family in dict.fromkeys(case.family for case in cases):
        own = [case for case in cases if case.family == family]
        lowest, highest = min(case.small for case in own), max(case.small for case in own)
        rows.append([family, f"{highest:.0e} ... {lowest:.0e}", *_format_errors(own, peers)])
    head = ["family", "from ... to", "rounding of the input, eps", "closed form, eps"]
    head += [f"{peer}, eps" for peer in peers]
    return (
        "## Hard cases\n\n![hard cases, step by step](hard_cases.png)\n\n"
        "Each family approaches its singular case by a factor of 100 per step, and ends with the "
        f"case itself. The largest errors in eps = {EPS:.1e} rad; a dash if a peer would take too "
        f"long.\n\n{format_table(head, rows)}"
    )


def _format_errors(cases: list[HardCase], peers: list[str]) -> list[str]:
    """Return the largest limit, our largest error, and that of each peer, in eps."""
    largest = [max(case.limit for case in cases), max(case.error for case in cases)]
    cells = [f"{each / EPS:.2g}" for each in largest]
    for peer in peers:
        known = [case.peers[peer] for case in cases if peer in case.peers]
        cells.append(f"{max(known) / EPS:.2g}" if known else "-")
    return cells
