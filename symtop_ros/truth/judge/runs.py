"""The input of `top_judge`: a run with its exact motion, and the estimates of some sources.

Problems of the logs are printed first. The status is 1 if estimates may be missing, or if some
cannot be judged.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Iterator
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING

from symtop_ros.base.counts import write_count
from symtop_ros.base.progress import Progress
from symtop_ros.base.refusals import RefusedError
from symtop_ros.run.wire.messages import TRANSFORM
from symtop_ros.truth.judge.attitude_table import AttitudeTable, read_attitudes
from symtop_ros.truth.judge.times import read_times
from symtop_ros.truth.judge.truth import Truth, read_events, scene_truth
from symtop_ros.truth.tables.forms import is_table
from symtop_ros.truth.topics.estimates import Estimates, read_topic

if TYPE_CHECKING:  # logs need mcap
    from symtop_ros.run.log.catalog import Catalog, CatalogTopic

BODY, SENSOR = ATTITUDES = "body", "sensor"


@dataclass(frozen=True, eq=False)
class Run:
    """A run, and the catalog of its log; None for one that is in no log."""

    truth: Truth
    catalog: Catalog | None = None


@dataclass(frozen=True, eq=False)
class Source:
    """Estimates of a topic or a file, and the catalog of the log in which they are."""

    name: str
    estimates: Estimates
    catalog: Catalog | None = None
    topic: CatalogTopic | None = None  # if they are those of a top of this log


def read_run(options: argparse.Namespace) -> Run:
    """Return the run that the options select."""
    if options.scene:
        return Run(scene_truth(options.scene))
    if [path.suffix for path in options.files] == [".json"]:  # as top_imu writes them
        return Run(read_events(options.files[0]))
    from symtop_ros.run.log.bags import open_run  # logs need mcap
    from symtop_ros.run.log.top_log import TopLog

    catalog = TopLog(open_run(options.files), options.node).catalog
    print_problems(catalog)
    if not catalog.events:
        raise RefusedError(f"{catalog.path} must have the events of a top (~/events), got none")
    return Run(Truth.of(catalog), catalog)


def read_sources(options: argparse.Namespace, run: Run) -> list[Source]:
    """Return the estimates that the options select."""
    other: Path | None = options.estimates
    if other and is_table(other):
        table = _read_table(other, options.rpy)
        of_sensor = options.attitude_of == SENSOR
        return [Source(str(other), read_times(table, run.truth, str(other), of_sensor))]
    if not options.topic:
        raise RefusedError(f"--topic must name the estimates in {other}, got none")
    from symtop_ros.run.log.bags import open_run
    from symtop_ros.run.log.catalog import read_catalog  # logs need mcap
    from symtop_ros.run.log.names import Names

    file = open_run([other] if other else options.files)
    catalog = read_catalog(file, Names(file)) if other else run.catalog
    if catalog and other:
        print_problems(catalog)
    found = (
        (topic, read_topic(file, topic, options.frame).count_once()) for topic in options.topic
    )
    return [
        Source(
            name,
            _choose_frame(each, options.attitude_of),
            catalog,
            _find_topic(catalog, name, options.frame),
        )
        for name, each in found
    ]


def _read_table(path: Path, order: str | None) -> AttitudeTable:
    """Return the attitudes of a table, and show progress."""
    progress, size = Progress("top_judge"), path.stat().st_size if path.exists() else 1
    table = read_attitudes(path, order, lambda done: progress.report(done / size, "reading"))
    progress.end()
    return table


def _find_topic(catalog: Catalog | None, name: str, frame: str | None) -> CatalogTopic | None:
    """Return what is known of a topic of the top; on /tf other frames are not of it."""
    is_other = catalog is not None and frame is not None and frame != catalog.frame
    topic = catalog.find_topic(name) if catalog else None
    return None if topic and is_other and topic.type == TRANSFORM.type else topic


def _choose_frame(estimates: Estimates, attitude_of: str | None) -> Estimates:
    return replace(estimates, of_sensor=attitude_of == SENSOR) if attitude_of else estimates


def print_problems(catalog: Catalog) -> None:
    """Print what is wrong with a log, before anything else."""
    for line in catalog.problem_lines:
        print(f"top_judge: {line}", file=sys.stderr)


def report_faults(run: Run, sources: list[Source]) -> int:
    """Print what is wrong with the estimates; return 1 if anything is, else 0."""
    faults = [f"{each.name}: {text}" for each in sources for text in _list_faults(each, run)]
    guessed = [run.catalog.guess] if run.catalog and run.catalog.guess else []
    for line in [*faults, *guessed]:
        print(f"top_judge: {line}", file=sys.stderr)
    return 1 if faults else 0


def _list_faults(source: Source, run: Run) -> Iterator[str]:
    """Yield why estimates of a source are damaged, missing or cannot be judged."""
    estimates, catalog, topic = source.estimates, source.catalog, source.topic
    for number, reason in _count_unjudged(estimates, run):
        if number:
            yield f"{write_count(number, 'estimate')} cannot be judged: {reason}"
    if estimates.unreadable:
        yield f"{write_count(estimates.unreadable, 'message')} cannot be read"
    if catalog and catalog.lacks_messages:
        how = "ends early" if catalog.lacks_only_its_end else "is damaged"
        yield f"estimates may be missing: the log {how}"
    if topic and topic.missing:
        least = "at least " if topic.is_least else ""
        yield f"{least}{write_count(topic.missing, 'estimate', 'are')} missing"
    if topic and topic.uncounted:
        why = "the node may have missed them, or they are lost"
        yield f"{write_count(topic.uncounted, 'estimate', 'are')} missing: {why}"
    if topic and topic.repeated:
        least = "at least " if topic.has_more else ""
        repeated = write_count(topic.repeated, "estimate", "are" if topic.is_repeat else "have")
        yield f"{least}{repeated} {'repeated' if topic.is_repeat else 'the stamps of others'}"


def _count_unjudged(estimates: Estimates, run: Run) -> Iterator[tuple[int, str]]:
    """Yield numbers of estimates that cannot be judged, and why."""
    truth, stamps = run.truth, estimates.stamps
    unjudged, repeated = truth.find_unjudged(stamps), truth.find_repeated(stamps)
    yield int((unjudged & ~repeated).sum()), "the motion is not known there"
    yield int(repeated.sum()), "more than one motion may hold there, as the clock went back"
    within = estimates.select(~unjudged)
    inside = len(within) - sum(truth.count_outside(within.stamps))
    yield inside - len(truth.select(within)), "the motion takes too long to integrate"
    if run.catalog and run.catalog.lacks_its_end:
        late = truth.count_outside(stamps)[1]
        yield late, "they are after the part of the log that is left"
