"""The whole check of a log: its samples, its events and its texts, computed again and compared."""

from collections import Counter
from dataclasses import dataclass

from symtop_ros.base.refusals import one_line
from symtop_ros.run.check.differences import Agreement, DifferenceCheck
from symtop_ros.run.check.events import find_mismatches
from symtop_ros.run.check.mismatch import Mismatch, is_of_this_version, list_other_versions
from symtop_ros.run.check.samples import Deviation, LogCheck
from symtop_ros.run.check.starts import SolvedStarts, solve_again
from symtop_ros.run.check.texts import TextCheck
from symtop_ros.run.log.batch import BatchReader
from symtop_ros.run.log.catalog import Catalog
from symtop_ros.run.log.contents import DECODED
from symtop_ros.run.log.reader import LogError
from symtop_ros.run.log.top_log import TopLog
from symtop_ros.run.log.writer import METADATA
from symtop_ros.run.simulation.events import FORMAT, LAST_WITHOUT_FIELDS, WITHOUT_FIELDS
from symtop_ros.run.simulation.topics import EVENTS


@dataclass(frozen=True)
class Findings:
    """Results of a check."""

    deviations: dict[str, Deviation]  # of the samples, by our names of topics
    compared: dict[str, int]  # messages of other topics that were compared, by our names
    reasons: dict[str, str]  # why topics of the log, or messages of them, were not, by our names
    mismatches: list[Mismatch]  # in events, descriptions and diagnostics
    starts: SolvedStarts  # from what was seen
    laws: dict[str, Agreement]  # of motion, tried without the kernel
    foreign: int  # events of another version, which are not computed
    versions: list[str]  # other versions that reported events
    first: int  # number of the first event; 1 unless the log begins later than the run

    @property
    def samples_agree(self) -> bool:
        """True if the samples agree with the events."""
        return all(each.is_rounding for each in self.deviations.values())

    @property
    def laws_hold(self) -> bool:
        """True if the samples agree with each other by the laws of motion."""
        return not any(each.wrong for each in self.laws.values())

    @property
    def unjudged(self) -> int:
        """Number of samples that cannot be judged, because they follow from no event in the log."""
        each = self.deviations.values()
        return sum(one.unjudged + one.unchecked + one.unreached for one in each)


def check_run(log: TopLog) -> Findings:
    """Check a log.

    Raises
    ------
    LogError
        If the log has events without fields: the version that wrote them checks it.
    """
    catalog = log.catalog
    _demand_fields(log, catalog)
    samples, texts, differences = check_messages(log)
    events = catalog.events
    own = sum(map(is_of_this_version, events))
    compared = Counter(texts.compared) + Counter({EVENTS.name: own})
    starts = solve_again(events)
    return Findings(
        samples.deviations,
        dict(compared),
        texts.reasons,
        [*find_mismatches(events), *starts.mismatches, *texts.mismatches],
        starts,
        differences.laws,
        len(events) - own,
        list_other_versions(events),
        events[0].number if events else 0,
    )


def check_messages(log: TopLog) -> tuple[LogCheck, TextCheck, DifferenceCheck]:
    """Compare all messages of a log except events with what the events give."""
    samples, texts = LogCheck(log.catalog), TextCheck(log.catalog)
    differences = DifferenceCheck(log.catalog)
    reader = BatchReader()
    reader.frame = log.catalog.frame
    for run in log.list_messages():
        chosen = [each for each in run if each[1] in DECODED]
        data = [(name, message.data) for _, name, message in chosen]
        batch = reader.read(data, [place for place, *_ in chosen])
        samples.add_batch(batch)
        differences.add_batch(batch)
        for place, name, message in run:
            texts.add(place, name, message)
    differences.finish()
    return samples, texts, differences


def _demand_fields(log: TopLog, catalog: Catalog) -> None:
    if not all(event.has_fields for event in catalog.events):
        own = log.file.metadata.get(METADATA, {}).get("version", "")
        version = one_line(own or LAST_WITHOUT_FIELDS, 20)
        raise LogError(
            f"format of events must be {FORMAT} for a check, got {WITHOUT_FIELDS}: symtop_ros "
            f"{version}, which has recorded {log.file.path}, can check it"
        )
