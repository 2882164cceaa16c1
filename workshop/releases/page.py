"""Tables of releases: which of them changed a score, and which were not scored."""

from collections.abc import Iterator, Mapping
from itertools import pairwise
from pathlib import Path

from workshop.releases.engines import ENGINES
from workshop.releases.measure import LEVELS, Row, find_jumps, measure_engine
from workshop.speed.publish import format_list, format_table, write_chapter, write_results

NAME = "releases"  # of its section in the docs
SHOWN = 4  # names of scores in a row


def measure_releases(folder: Path, docs: Path | None = None) -> None:
    """Write releases.md and releases.json."""
    facts = {engine.name: measure_engine(engine) for engine in ENGINES}
    write_results(NAME, facts, format_releases(facts), folder, docs)
    print(f"{folder / 'releases.md'} and releases.json")


def format_releases(facts: Mapping[str, Mapping[str, Row]]) -> str:
    """Return the tables and the list of a measurement."""
    changes: list[list[str]] = []
    ends: list[list[str]] = []
    lines: list[str] = []
    for engine in ENGINES:
        good = {each: row for each, row in facts[engine.name].items() if "scores" in row}
        for release in dict.fromkeys([*[*good][:1], *[*good][-1:]]):
            ends += _list_levels(f"{engine.name} {release}", good[release]["scores"])
        for before, after in pairwise(good):
            found = _group_jumps(good[before], good[after])
            changes += ([f"{engine.name} {after}", before, *cells] for cells in found)
            if found and after in engine.log:
                lines.append(f"{engine.name} {after}: {engine.log[after]}")
    head = ["release", "compared with", "integrator", "scores", "first: was (rad)", "is (rad)"]
    levels = ["median, worst (rad)", *(f"level {each}" for each in LEVELS)]
    return write_chapter(
        "releases",
        changes=format_table(head, changes),
        logs=format_list(lines),
        ends=format_table(levels, ends),
        failures=format_table(["release", "reason"], _list_failures(facts)),
    )


def _list_failures(facts: Mapping[str, Mapping[str, Row]]) -> Iterator[list[str]]:
    for name, rows in facts.items():
        for release, row in rows.items():
            if "reason" in row:
                yield [f"{name} {release}", row["reason"]]


def _list_levels(name: str, scores: Mapping[str, float]) -> Iterator[list[str]]:
    for variant in dict.fromkeys(each.partition(":")[0] for each in scores):
        keys = [f"{variant}: level {level}, " for level in LEVELS]
        cells = [
            f"{scores[key + 'median']:.1e}, {scores[key + 'worst']:.1e}"
            if key + "median" in scores
            else "-"
            for key in keys
        ]
        yield [f"{name}, {variant}", *cells]


def _group_jumps(before: Row, after: Row) -> list[list[str]]:
    """Return a row for each variant: the scores that changed, and the largest change."""
    found, rows = find_jumps(before, after), []
    for variant in dict.fromkeys(each.partition(":")[0] for each in found):
        own = [each for each in found if each.partition(":")[0] == variant]
        text = "; ".join(each.partition(": ")[2] for each in own[:SHOWN])
        more = f" and {len(own) - SHOWN} more" if len(own) > SHOWN else ""
        numbers = [f"{row['scores'][own[0]]:.1e}" for row in (before, after)]
        rows.append([variant, text + more, *numbers])
    return rows
