"""`top_replay --check`: what was compared, what was not, and whether it agrees."""

import json
import math
import sys
from collections.abc import Mapping
from dataclasses import asdict
from typing import Any

from symtop_ros.base.counts import write_count
from symtop_ros.base.refusals import one_line
from symtop_ros.run.check.differences import UNITS, Agreement
from symtop_ros.run.check.mismatch import Mismatch
from symtop_ros.run.check.run import Findings, check_run
from symtop_ros.run.check.samples import Deviation
from symtop_ros.run.check.starts import SolvedStarts
from symtop_ros.run.log.catalog import Catalog
from symtop_ros.run.log.names import KNOWN
from symtop_ros.run.log.reader import LogError, list_problems
from symtop_ros.run.log.top_log import TopLog
from symtop_ros.run.simulation.topics import EVENTS

WIDTH = 28  # of a topic in its line
MAX_OTHERS = 20  # largest number of topics of other nodes that are listed


def check(log: TopLog, strict: bool = False, header: Mapping[str, Any] | None = None) -> int:
    """Print the results of a check; return 0 if everything agrees and nothing is missing.

    With a header they are JSON that begins with it.
    """
    catalog = log.catalog
    found = check_run(log)
    unreached = sum(each.unreached for each in found.deviations.values())
    if unreached:
        _print_problem(
            f"{write_count(unreached, 'sample')} cannot be checked: "
            "the motion is too fast or too long to integrate"
        )
    elif not any(each.samples for each in found.deviations.values()):
        raise LogError("nothing can be checked: no sample follows an event")
    for line in list_problems([_describe(catalog, each) for each in found.mismatches]):
        _print_problem(line)
    is_whole = not (catalog.problems or catalog.doubts or found.unjudged)
    lacks = strict and bool(catalog.never_recorded)
    agrees = found.samples_agree and found.laws_hold and not found.mismatches
    is_good = agrees and is_whole and not lacks
    if header is not None:
        print(json.dumps({**header, **_list_facts(catalog, found, is_good)}, indent=1))
        return int(not is_good)
    _print_verdict(found)
    if found.samples_agree and not is_whole:
        print(_describe_damage(catalog, found))
    _print_topics(catalog, found)
    _print_laws(found.laws)
    _print_starts(found.starts)
    return int(not is_good)


def _list_facts(catalog: Catalog, found: Findings, is_good: bool) -> dict[str, Any]:
    """Return the results for JSON."""
    topics = {
        topic.name: _describe_topic(found, name, topic.count)
        for name, topic in catalog.topics.items()
    }
    return {
        "node": catalog.node,
        "good": is_good,
        "samples_agree": found.samples_agree,
        "laws_hold": found.laws_hold,
        "laws": {
            name: _keep_finite({**asdict(each), "unit": UNITS[name]})
            for name, each in found.laws.items()
        },
        "starts_solved_again": found.starts.compared,
        "first_event": found.first or None,
        "foreign_events": found.foreign,
        "other_versions": found.versions,
        "problems": [*map(one_line, catalog.lines)],
        "mismatches": [asdict(each) for each in found.mismatches],
        "topics": topics,
        "never_recorded": [KNOWN[name].ros_name for name in catalog.never_recorded],
        "others": sorted(map(one_line, catalog.others)),
    }


def _describe_topic(found: Findings, name: str, count: int) -> dict[str, Any]:
    """Return what was compared of a topic."""
    if deviation := found.deviations.get(name):
        figures = {**asdict(deviation), "relative": deviation.relative}
        return {"messages": count, **_keep_finite(figures)}
    reason = None if found.compared.get(name) == count else found.reasons.get(name)
    return {"messages": count, "compared": found.compared.get(name, 0), "reason": reason}


def _keep_finite(figures: Mapping[str, Any]) -> dict[str, Any]:
    """Return figures as JSON has them: None for a number that is not finite."""
    return {
        name: None if isinstance(each, float) and not math.isfinite(each) else each
        for name, each in figures.items()
    }


def _print_problem(text: str) -> None:
    print(f"top_replay: {text}", file=sys.stderr)


def _print_verdict(found: Findings) -> None:
    if any(each.samples for each in found.deviations.values()):
        print(f"the samples {'agree' if found.samples_agree else 'DO NOT agree'} with the events")
    if not found.laws_hold:
        print("the samples DO NOT obey the laws of motion")
    if found.mismatches:
        print("events or descriptions of the motion DO NOT agree with the computation")
    if found.first > 1:
        print(f"the log begins with event {found.first} of the run")
    if found.foreign:
        by = f"symtop_ros {', '.join(found.versions)}" if found.versions else "another engine"
        events = write_count(found.foreign, "event", "are")
        their = "its" if found.foreign == 1 else "their"
        print(f"{events} of {by}: {their} words and verdicts are not judged")


def _describe_damage(catalog: Catalog, found: Findings) -> str:
    """Return what kind of damage a log has, or may have."""
    if found.unjudged or (catalog.problems and not catalog.lacks_only_its_end):
        return "the log is damaged or incomplete"
    if not catalog.problems:
        return "the log may be incomplete"
    return "the log ends early" + ", and samples before its end may be lost" * bool(catalog.doubts)


def _describe(catalog: Catalog, mismatch: Mismatch) -> str:
    is_event = mismatch.topic == EVENTS.name
    topic = catalog.topics[EVENTS.name].name if is_event else mismatch.topic
    right, got = one_line(mismatch.expected, 100), one_line(mismatch.got, 100)
    return f"{topic} at {mismatch.stamp} ns: {mismatch.field} must be {right}, got {got}"


def _print_topics(catalog: Catalog, found: Findings) -> None:
    """Print a line for each topic: how much of it was compared, or why it was not."""
    for name, topic in catalog.topics.items():
        if name in found.deviations:
            print(_row(topic.name, found.deviations[name]))
        else:
            print(f"{one_line(topic.name):{WIDTH}}{_describe_text(name, topic.count, found)}")
    lacking = "it is not in what is left of the log" if catalog.losses else "it is not in the log"
    for name in catalog.never_recorded:
        if name not in catalog.topics:
            print(f"{KNOWN[name].ros_name:{WIDTH}} not compared: {lacking}")
    others = sorted(map(one_line, catalog.others))
    if others:
        more = f" and {len(others) - MAX_OTHERS} more" if len(others) > MAX_OTHERS else ""
        names = f"{', '.join(others[:MAX_OTHERS])}{more}"
        print(f"not compared, because they are not topics of {catalog.node}: {names}")


def _print_laws(laws: Mapping[str, Agreement]) -> None:
    """Print how well the samples obey each law of motion, or why it was not tried."""
    for name, law in laws.items():
        row = f"{name:{WIDTH}}"
        slow = "the rate of the samples is too low for the motion"
        if not law.samples:
            print(f"{row} not compared: {slow if law.too_fast else 'too few samples in a stretch'}")
            continue
        what = "sample" if law.samples == 1 else "samples"
        worst = f"largest deviation {law.largest:.1e} {UNITS[name]} ({law.share:.2g} of its bound)"
        notes = f"; {law.wrong} beyond their bounds" * bool(law.wrong)
        notes += f"; {law.too_fast} not compared: {slow}" * bool(law.too_fast)
        print(f"{row}{law.samples:9} {what}, {worst}{notes}")


def _print_starts(starts: SolvedStarts) -> None:
    """Print how many starts from what was seen were solved again, if there are any."""
    row = f"{'solved starts':{WIDTH}}"
    if starts.compared:
        wrong = len(starts.mismatches)
        what = write_count(starts.compared, "start")
        print(f"{row} {what} solved again, {f'{wrong} not' if wrong else 'all'} the same")
    if starts.foreign:
        print(f"{row} not compared: {write_count(starts.foreign, 'start')} of another version")


def _describe_text(name: str, count: int, found: Findings) -> str:
    """Return how many messages of a topic without samples were compared, and why not all."""
    compared = found.compared.get(name, 0)
    reason = found.reasons.get(name)
    if not count:
        return " not compared: it has no messages"
    if not compared:
        return f" not compared: {reason or 'no message is of this node'}"
    left = f"; {count - compared} not compared: {reason}" if reason and count > compared else ""
    what = "message" if compared == 1 else "messages"
    return f"{compared:9} {what} compared{left}"


def _row(topic: str, deviation: Deviation) -> str:
    what = "sample" if deviation.samples == 1 else "samples"
    row = f"{topic:{WIDTH}}{deviation.samples:9} {what}, largest difference {deviation.largest:g}"
    if deviation.largest:
        row += f" ({deviation.relative:.1e} of its size)"
    notes = {
        "before the first event not compared": deviation.unchecked,
        "not compared: the motion is not known": deviation.unjudged,
        "not compared: the motion is too fast or too long to integrate": deviation.unreached,
    }
    return row + "".join(f"; {count} {text}" for text, count in notes.items() if count)
