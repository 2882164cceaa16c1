"""Scores of many trajectories of the test set: a table, orders of convergence, and a ranking."""

import json
import math
import re
from collections import defaultdict
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from statistics import median
from typing import Any

import numpy as np

from symtop_ros.truth.testset.score import (
    Problem,
    Score,
    find_problem,
    format_engine,
    list_descriptions,
    score_trajectory,
)
from symtop_ros.truth.testset.tables import TABLES

# rk4-0.001 and rk4-1e-3: the step of this entry. The first part is as short as it can be, so that
# the sign of an exponent belongs to the step.
STEP = re.compile(r"(.+?)-(\d+(?:\.\d*)?(?:e[-+]?\d+)?)")
SOLVED = 0.01  # rad; an attitude that is never further off
# ratio of the errors in two descriptions of a body, above which an engine treats them differently
APART = 3.0
LEAST_ORDER = 0.5  # between the two smallest steps; Euler's method has 1
# relative difference of the errors at two steps, below which the step does not cause the error
SAME = 0.3
# Limits of single precision: the rounding of inputs is about one at all steps, that of an engine's
# own steps differs between them. g = 9.80665 is 90 or more off.
SINGLE = 10.0
ROUNDING = 1e3  # limits; errors below this are rounding as well, and show no order


@dataclass(frozen=True, eq=False)
class Entry:
    """A trajectory and its score."""

    name: str  # stem of its file
    score: Score

    @property
    def problem(self) -> dict[str, Any]:
        """The problem in problems.json."""
        return self.score.problem.facts

    @property
    def described(self) -> tuple[str, str]:
        """Names of the problem and of the description, which is empty for the plain body."""
        name, _, description = self.problem["name"].partition(".")
        return name, description

    @property
    def limits(self) -> float:
        """Largest error of the attitude in limits of double precision."""
        return float(self.score.in_limits.max())

    @property
    def error(self) -> float:
        """Largest error of the attitude in rad."""
        return float(self.score.angles.max())

    @property
    def step(self) -> tuple[str, float] | None:
        """Name of the method and its step, if the entry is called METHOD-STEP."""
        found = STEP.fullmatch(self.name)
        return (found[1], float(found[2])) if found and float(found[2]) else None

    def facts(self) -> dict[str, Any]:
        """Return the score as numbers for JSON."""
        return {"entry": self.name, **self.score.facts()}


def read_entries(problems: dict[str, Problem], folder: Path) -> list[Entry]:
    """Return the scores of all PROBLEM/NAME.csv in a folder; PROBLEM.turned is a description."""
    entries = [
        Entry(path.stem, score_trajectory(path, problem))
        for problem in _list_described(problems)
        for path in sorted((folder / problem.facts["name"]).glob("*.csv"))
        if not _is_table(path)
    ]
    if not entries:
        raise ValueError(f"{folder} must have trajectories PROBLEM/NAME.csv, got none")
    return entries


def _is_table(path: Path) -> bool:
    """Return True for a table of the set: the problem and its exact motion are no entries.

    An engine's trajectory may have the name of one, but its rows do not begin with a problem's.
    """
    with path.open("rb") as file:
        return path.name in TABLES and file.readline().startswith(b"name,")


def _list_described(problems: dict[str, Problem]) -> Iterator[Problem]:
    """Yield each problem, and then in the other descriptions of its body."""
    for name, problem in problems.items():
        yield problem
        for each in list_descriptions(name):
            yield find_problem(problems, f"{name}.{each}")


@dataclass(frozen=True)
class Order:
    """How the errors of a method in a problem depend on its step."""

    order: float  # slope of the errors by their steps
    left: float | None = None  # rad that no smaller step removes; None: errors become smaller
    left_float32: float = 0.0  # the same in limits of single precision

    def describe(self, problem: str, method: str) -> str:
        """Return the order, or that there is none, in a line."""
        if self.left is None:
            return f"order of {method} in {problem}: {self.order:.2f}"
        also = ", or computes in single precision" * (self.left_float32 < SINGLE)
        return (
            f"{method} in {problem} does not converge to this motion{also}: "
            f"smaller steps leave {self.left:.1e} rad"
        )


def find_orders(entries: Sequence[Entry]) -> dict[tuple[str, str], Order]:
    """Return how the errors of each method in each problem depend on its step."""
    methods: dict[tuple[str, str], dict[float, Entry]] = defaultdict(dict)
    for each in entries:
        if each.step:
            method, step = each.step
            methods[each.problem["name"], method][step] = each
    found = {key: _find_order(own) for key, own in sorted(methods.items())}
    return {key: order for key, order in found.items() if order}


def _find_order(own: Mapping[float, Entry]) -> Order | None:
    """Return the order of a method from its entries by their steps, if they show one."""
    good = {step: each for step, each in own.items() if each.limits > ROUNDING and each.error < 1}
    if len(good) < 2:
        return None
    steps, errors = np.log([(step, each.error) for step, each in good.items()]).T
    order = float(np.polyfit(steps, errors, 1)[0])
    small, large = sorted(own)[:2]
    if {small, large} <= {*good} and _is_stuck(small, large, own):
        least = own[small].score
        return Order(order, own[small].error, float(least.in_float32_limits.max()))
    return Order(order)


def _is_stuck(small: float, large: float, own: Mapping[float, Entry]) -> bool:
    """Return True if the smaller of two steps leaves the errors as they are, at all times.

    Of errors that happen to vanish at a step, as a*h - b*h^2 does at h = a/b, the largest ones
    alone would show the same.
    """
    angles, before = own[small].score.angles, own[large].score.angles
    gained = math.log(own[large].error / own[small].error) / math.log(large / small)
    is_same = float(np.abs(angles - before).max()) < SAME * own[small].error
    return gained < LEAST_ORDER and is_same


def find_differences(entries: Sequence[Entry]) -> dict[tuple[str, str], dict[str, float]]:
    """Return the errors (rad) by description, if they differ by more than rounding."""
    found: dict[tuple[str, str], dict[str, Entry]] = {}
    for each in entries:
        name, description = each.described
        found.setdefault((name, each.name), {})[description or "plain"] = each
    return {
        key: {description: each.error for description, each in own.items()}
        for key, own in found.items()
        if max(each.limits for each in own.values()) > ROUNDING
        and max(each.error for each in own.values())
        > APART * min(each.error for each in own.values())
    }


@dataclass(frozen=True)
class Rank:
    """Result of an entry in the problems of a level."""

    entry: str
    solved: int  # problems with an error of at most SOLVED
    tried: int
    of: int  # problems that the level has
    median_limits: float  # of those solved; if none is, of those tried


def rank(
    entries: Sequence[Entry], problems: Mapping[str, Problem]
) -> Iterator[tuple[int, list[Rank]]]:
    """Yield each level with its entries, best first: those that solved most of its problems.

    Other descriptions of a body are no further problems.

    Of those that solved as many, the one with the smaller median of these comes first. If nothing
    is solved, the median is that of all problems, and the worst for those that were not tried.
    Those that tried fewer than half have no such median: first come those that tried more, then
    those with the smaller median of what they tried.
    """
    plain = [each for each in entries if each.problem["name"] in problems]
    for level in sorted({each.problem["level"] for each in plain}):
        count = sum(each.facts["level"] == level for each in problems.values())
        ours = [each for each in plain if each.problem["level"] == level]
        rows = []
        for name in {each.name for each in ours}:
            own = [each for each in ours if each.name == name]
            good = [each.limits for each in own if each.error <= SOLVED]
            tried = [each.limits for each in own]
            whole = good or [*tried, *[math.inf] * (count - len(own))]
            row = Rank(name, len(good), len(own), count, median(good or tried))
            rows.append((-row.solved, median(whole), -row.tried, row.median_limits, name, row))
        yield level, [row for *_, row in sorted(rows)]


def format_table(entries: Sequence[Entry], problems: Mapping[str, Problem]) -> str:
    """Return the table of all entries, the orders, and the ranking of each level."""
    width = max(19, *(len(each.problem["name"]) + 1 for each in entries))
    scores = [
        f"{each.problem['name']:{width}}{each.problem['level']:>5}  {each.name:24}"
        f"{each.error:>11.1e}{each.limits:>10.2g}"
        for each in entries
    ]
    starts = [
        f"{each.problem['name']}, {each.name}: {each.score.format_start()}"
        for each in entries
        if each.score.start
    ]
    orders = [
        order.describe(problem, method) for (problem, method), order in find_orders(entries).items()
    ]
    head = f"{'problem':{width}}{'level':>5}  {'entry':24}{'error, rad':>11}{'limits':>10}"
    lines = [head, *scores, *starts, *orders]
    for (problem, name), errors in find_differences(entries).items():
        each = ", ".join(f"{description} {error:.2g}" for description, error in errors.items())
        lines.append(f"descriptions of {problem} differ in {name}: {each} rad")
    for level, rows in rank(entries, problems):
        lines.append(f"level {level}, by problems solved (within {SOLVED:g} rad) and by limits:")
        lines += [
            f"  {place}. {row.entry}: solved {row.solved} of {row.of}, tried {row.tried}, "
            f"median {row.median_limits:.2g} limits"
            for place, row in enumerate(rows, start=1)
        ]
    return "\n".join([*lines, *_list_engines(entries)])


def _list_engines(entries: Sequence[Entry]) -> Iterator[str]:
    """Yield what computed the entries of each name, as their files say."""
    engines: dict[str, set[str]] = defaultdict(set)
    for each in entries:
        engines[each.name].add(each.score.engine)
    for name, found in engines.items():
        yield f"{name}, {'; '.join(map(format_engine, sorted(found)))}"


def format_json(
    header: Mapping[str, Any], entries: Sequence[Entry], problems: Mapping[str, Problem]
) -> str:
    """Return the same as JSON, with the errors at each time."""
    facts = {
        **header,
        "scores": [each.facts() for each in entries],
        "orders": [
            {"problem": problem, "method": method, **asdict(order)}
            for (problem, method), order in find_orders(entries).items()
        ],
        "differences": [
            {"problem": problem, "entry": name, "errors": errors}
            for (problem, name), errors in find_differences(entries).items()
        ],
        "ranking": {
            level: [asdict(row) for row in rows] for level, rows in rank(entries, problems)
        },
    }
    return json.dumps(facts, indent=1)
