"""The whole check of a log: its samples, its events, its texts and the bytes of its files."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

from symtop_ros.check import checksums, events, texts
from symtop_ros.check.course import Course
from symtop_ros.check.events import Mismatch
from symtop_ros.check.gaps import Grid, count_missed, describe_gaps
from symtop_ros.check.samples import Deviation, check_log
from symtop_ros.log.bag import MessageSource, SeveralFiles
from symtop_ros.log.reader import McapFile, log_errors
from symtop_ros.log.top_log import TopLog
from symtop_ros.simulation.events import Event


@dataclass(frozen=True)
class Findings:
    """Results of a check."""

    deviations: dict[str, Deviation]  # of the samples, by their topics
    mismatches: list[Mismatch]  # in events, descriptions and diagnostics
    foreign: int  # events of another version, which are not computed
    versions: list[str]  # other versions that reported events
    damage: list[str]  # in the files, apart from what reading them has found
    first: int  # number of the first event; 1 unless the log begins later than the run
    missing: list[str]  # events and samples that are missing, or there twice

    @property
    def samples_agree(self) -> bool:
        """True if the samples agree with the events."""
        return all(each.is_rounding for each in self.deviations.values())


def check_run(log: TopLog) -> Findings:
    """Check a log; LogError if it cannot be checked."""
    given = list(log.events())
    grid = Grid(log, given)
    deviations = check_log(log, grid)
    return Findings(
        deviations,
        [*events.find_mismatches(given), *texts.find_mismatches(log, given)],
        sum(not events.is_of_this_version(each) for each in given),
        events.list_other_versions(given),
        _find_damage(log.file),
        given[0].number if given else 0,
        [*_list_missing(log, given, deviations), *_describe_gaps(log, given, grid)],
    )


def _list_missing(
    log: TopLog, given: list[Event], deviations: Mapping[str, Deviation]
) -> Iterator[str]:
    """Yield what is said of events that are missing or repeated."""
    course = Course(given)
    files = len(log.file.sources) if isinstance(log.file, SeveralFiles) else 1
    yield from course.list_missing()
    yield from course.list_repeated(files - 1)
    early = max((each.unchecked for each in deviations.values()), default=0)
    if given and early:
        yield (
            f"the beginning is missing: {early} samples are before the first event, "
            f"which is number {given[0].number}"
        )


def _describe_gaps(log: TopLog, given: list[Event], grid: Grid) -> list[str]:
    has_gaps = any(each.missing for each in grid.gaps.values())
    return describe_gaps(grid.gaps, count_missed(log, given) if has_gaps else 0)


def _find_damage(file: MessageSource) -> list[str]:
    """Return the damage in all files of a run, with their names if there are several."""
    if isinstance(file, SeveralFiles):
        return [f"{each.path.name}: {text}" for each in file.sources for text in _find_damage(each)]
    with log_errors("read", file.path):
        return checksums.find_damage(file.path) if isinstance(file, McapFile) else []
