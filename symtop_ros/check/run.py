"""The whole check of a log: its samples, its events, its texts and the bytes of its files."""

from dataclasses import dataclass

from symtop_ros.check import checksums, events, texts
from symtop_ros.check.course import Course
from symtop_ros.check.events import Mismatch
from symtop_ros.check.samples import Deviation, check_log
from symtop_ros.log.bag import MessageSource, SeveralFiles
from symtop_ros.log.reader import McapFile, log_errors
from symtop_ros.log.top_log import TopLog


@dataclass(frozen=True)
class Findings:
    """Results of a check."""

    deviations: dict[str, Deviation]  # of the samples, by their topics
    mismatches: list[Mismatch]  # in events, descriptions and diagnostics
    foreign: int  # events of another version or engine, which are not computed
    damage: list[str]  # in the files, apart from what reading them has found
    missing: list[str]  # events between others

    @property
    def samples_agree(self) -> bool:
        """True if the samples agree with the events."""
        return all(each.is_rounding for each in self.deviations.values())


def check_run(log: TopLog) -> Findings:
    """Check a log; LogError if it cannot be checked."""
    deviations, given = check_log(log), list(log.events())
    return Findings(
        deviations,
        [*events.find_mismatches(given), *texts.find_mismatches(log, given)],
        sum(not events.is_own(each) for each in given),
        _find_damage(log.file),
        Course(given).list_missing(),
    )


def _find_damage(file: MessageSource) -> list[str]:
    """Return the damage in all files of a run, with their names if there are several."""
    if isinstance(file, SeveralFiles):
        return [f"{each.path.name}: {text}" for each in file.sources for text in _find_damage(each)]
    with log_errors("read", file.path):
        return checksums.find_damage(file.path) if isinstance(file, McapFile) else []
