"""The catalog of a log: all that is known of it, found out once, for everything that reads it.

For each interval of time it has the motion that is known, or why none is; for each topic its name,
its rate and its count; what is damaged, missing or repeated; and what the log does not determine.
"""

import math
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import groupby, pairwise
from pathlib import Path

import numpy as np

from symtop_ros.base.arrays import Places, Stamps
from symtop_ros.base.counts import write_count
from symtop_ros.run.log.checksums import find_damage
from symtop_ros.run.log.contents import Contents, read_contents
from symtop_ros.run.log.event_order import Ordered, order_events
from symtop_ros.run.log.grid import (
    Gap,
    Grid,
    GridFindings,
    Recording,
    list_absent_files,
    list_recordings,
)
from symtop_ros.run.log.intervals import (
    NO_BEGINNING,
    NO_PROOF,
    NOWHERE,
    REPEATED,
    Finder,
    Interval,
    Mark,
    Proofs,
    find_missing,
    partition,
)
from symtop_ros.run.log.names import KNOWN, TELLING, Names, read_names
from symtop_ros.run.log.reader import list_problems
from symtop_ros.run.log.source import Loss, MessageSource
from symtop_ros.run.log.stamps import ROUNDING, StampRows
from symtop_ros.run.log.writer import ENDING, METADATA
from symtop_ros.run.simulation.events import WHOLE, Event
from symtop_ros.run.simulation.topics import DESCRIPTION, DIAGNOSTICS, EVENTS, STATE_TOPICS

GUESSED = (
    "topics are recognised by their types and the ends of their names: the log does not say how "
    "they were remapped"
)


@dataclass(frozen=True, slots=True)
class CatalogTopic:
    """The catalog of a topic of the top."""

    name: str  # full name
    type: str
    count: int  # messages
    rate: float | None  # samples per s, of the first ones; None for topics without samples
    missing: int  # samples, beyond those that the node has counted as missed
    is_least: bool  # True if more of them may be missing
    uncounted: int  # missing samples after the last count of the node
    repeated: int  # samples with the stamp of another sample
    has_more: bool  # True if more of them may be repeated
    is_repeat: bool  # False if the clock may have gone back: then they are different samples
    unreadable: str  # why messages cannot be read; empty: all can


@dataclass(frozen=True)
class Catalog:
    """All that is known of a log."""

    path: Path
    node: str | None  # full name; None: the log has no top
    topics: Mapping[str, CatalogTopic]  # those of the top that the log has, by our names
    guess: str  # note for a log that does not name the topics of the top; else empty
    others: Mapping[str, str]  # types of the other topics of the log, by their full names
    ordered: Ordered  # its events
    intervals: tuple[Interval, ...]  # in the order of the run
    undecided: tuple[Interval, ...]  # in which the order does not show to which a sample belongs
    end: int | None  # stamp (ns) of the last sample; None without samples
    count: int  # messages of all topics
    losses: tuple[Loss, ...]  # found while the files were read
    never_recorded: tuple[str, ...]  # topics that the node has and the log lacks, by our names
    problems: tuple[str, ...]  # everything that is damaged, missing or there twice
    doubts: tuple[str, ...]  # possible losses: the log ends before the next count of the node
    notes: tuple[str, ...]  # what else a reader should know

    @property
    def events(self) -> tuple[Event, ...]:
        """The events, each once, in the order of the run."""
        return self.ordered.events

    @property
    def frame(self) -> str | None:
        """Child frame of the top on /tf, which is shared; None if no event names it."""
        return self.events[0].values.get("top_frame") if self.events else None

    @property
    def unknown(self) -> tuple[Interval, ...]:
        """The intervals of which the motion is not known."""
        return tuple(each for each in self.intervals if each.event is None)

    def list_continuous(self) -> list[Interval]:
        """Return the intervals with motions, up to where the motion may have changed.

        What is not known before the first event, and between two events of one motion, is passed
        over.
        """
        found: list[Interval] = []
        is_open = False  # True after an interval of which the motion is not known
        for each in self.intervals:
            if each.event and is_open and found and not each.event.has_motion_of(found[-1].event):
                break
            is_open = each.event is None
            found += [each] if each.event else []
        return found

    @property
    def lacks_messages(self) -> bool:
        """True if messages are lost, or may be, as far as reading the files has found."""
        return any(each.place is not None for each in self.losses)

    @property
    def lacks_its_end(self) -> bool:
        """True if messages after the last one are lost, or may be."""
        return any(each.place == self.count for each in self.losses)

    @property
    def lacks_only_its_end(self) -> bool:
        """True if nothing but the end of the log is lost, as after `kill -9`."""
        return len(self.problems) == len(self.losses) == 1 and self.lacks_its_end

    @property
    def has_top(self) -> bool:
        """True if the log has messages of a top."""
        return any(name in self.topics and self.topics[name].count for name in TELLING)

    @property
    def lines(self) -> list[str]:
        """Problems and doubts, then notes, each in one line: what a program prints first."""
        return [*self.problem_lines, *list_problems(self.notes), *filter(None, [self.guess])]

    @property
    def problem_lines(self) -> list[str]:
        """The first problems and doubts, each in one line, and the number of the others."""
        return list_problems([*self.problems, *self.doubts])

    def find_topic(self, full: str) -> CatalogTopic | None:
        """Return what the log has of a topic of the top, by its full name."""
        return next((each for each in self.topics.values() if each.name == full), None)


def read_catalog(file: MessageSource, names: Names) -> Catalog:
    """Return the catalog of a log."""
    contents = read_contents(file, names)
    return _Conclusions(file, names, contents).conclude()


class _Conclusions:
    """The conclusions from the contents of a log."""

    def __init__(self, file: MessageSource, names: Names, contents: Contents) -> None:
        self._file, self._names, self._contents = file, names, contents
        self._ordered = order_events(contents.events, file.begins)
        self._recordings = list_recordings(file)
        grid = Grid(self._ordered, self._recordings)
        self._passes = grid.passes
        self._found = {name: grid.judge(name, rows) for name, rows in contents.rows.items()}
        # the topic with the fewest gaps: in each of its gaps the other topics have one, too
        self._main = min(
            self._found,
            key=lambda name: (self._found[name].missing, -contents.rows[name].count),
            default="",
        )
        self._rows = contents.rows.get(self._main, StampRows())
        self._counted = self._count_missed()
        marks = [*contents.marks, *self._list_repeated()]
        self._proofs = Proofs(self._ordered, marks, bool(contents.counts[DIAGNOSTICS.name]))
        self._uncounted = self._find_uncounted()
        ends = [row.last for rows in contents.rows.values() for row in rows.rows]
        self._end = max(ends, default=None)
        losses, doubts = self._list_losses(), self._list_doubtful_places()
        finder = Finder(self._ordered, self._proofs, losses, self._rows, self._end, doubts)
        self._intervals = tuple(finder.list_intervals())
        self._topics = self._list_topics()

    def conclude(self) -> Catalog:
        """Return the catalog."""
        file, names = self._file, self._names
        others = {
            channel.topic: schema.name if (schema := file.schemas.get(channel.schema_id)) else ""
            for number, channel in file.channels.items()
            if not names.find(number)
        }
        lacking = tuple(self._list_never_recorded())
        return Catalog(
            path=file.path,
            node=names.node,
            topics=self._topics,
            guess=GUESSED if names.is_guessed else "",
            others=others,
            ordered=self._ordered,
            intervals=self._intervals,
            undecided=tuple(self._list_undecided()),
            end=self._end,
            count=file.count,
            losses=tuple(file.losses),
            never_recorded=lacking,
            problems=tuple(self._list_problems()),
            doubts=tuple(self._list_doubts()),
            notes=tuple(self._list_notes(lacking)),
        )

    # What the node has counted, and what is shown of the events

    def _count_missed(self) -> int:
        """Return the samples that the node itself has counted as missed while it recorded."""
        begins = [each.place for each in self._recordings]
        ends = [*begins[1:], self._file.count + 1]
        return sum(map(self._count_in_recording, self._recordings, begins, ends))

    def _count_in_recording(self, recording: Recording, begin: int, end: int) -> int:
        shown = [count for place, count in self._contents.missed if begin <= place < end]
        at_ends = [count for place, count in self._list_counts_at_ends() if begin <= place < end]
        if WHOLE.fullmatch(recording.missed):
            at_begin = int(recording.missed)
        else:
            begins_later = any(event.number > 1 for event in self._ordered.events[:1])
            at_begin = shown[0] if shown and begins_later else 0
        return max(0, max([*shown, *at_ends], default=0) - at_begin)

    def _list_counts_at_ends(self) -> Iterator[tuple[int, int]]:
        """Yield the counts in the records of the ends of files, with the last place of each."""
        begins = [*self._file.begins, self._file.count]
        for file, (begin, end) in zip(self._file.files, pairwise(begins), strict=False):
            text = file.metadata.get(ENDING, {}).get("missed", "")
            if begin < end and WHOLE.fullmatch(text):
                yield end - 1, int(text)

    def _find_uncounted(self) -> frozenset[tuple[int, int]]:
        """Return the gaps of all topics that no count of the node follows, by their stamps.

        The node may have missed these samples, or they are lost from the log.
        """
        found = self._found.get(self._main, GridFindings())
        if found.missing <= self._counted:
            return frozenset()
        lost = [each.place for each in self._file.losses if each.place is not None]
        without_loss = (
            gap for gap in found.gaps if not any(gap.place <= k <= gap.until for k in lost)
        )
        return frozenset(each.stamps for each in without_loss if self._precedes_no_count(each))

    def _precedes_no_count(self, gap: Gap) -> bool:
        """Return True if no count follows a gap, up to the next recording or run of the node."""
        begins = (*(each.place for each in self._recordings), *self._proofs.begins)
        end = min((each for each in begins if each >= gap.place), default=NOWHERE)
        counts = (*self._contents.missed, *self._list_counts_at_ends())
        return gap.until < end and not any(gap.until <= place < end for place, _ in counts)

    def _list_repeated(self) -> Iterator[Mark]:
        """Yield what events show that a recorder has repeated at the beginning of a file."""
        for place, event in self._ordered.repeated:
            stamp = self._rows.find_stamp(0, place)
            yield Mark(place, event.stamp if stamp is None else stamp + 1, event.number)

    def _list_doubtful_places(self) -> Iterator[int]:
        """Yield the places at which samples show that an event may have been lost."""
        found = self._found.get(self._main, GridFindings())
        if found.missing > self._counted:
            in_doubt = [gap for gap in found.gaps if gap.stamps in self._uncounted]
            is_rest_counted = found.missing - _count_missing(in_doubt) <= self._counted
            yield from (gap.place for gap in (in_doubt if is_rest_counted else found.gaps))
        yield from found.returns

    def _list_losses(self) -> Iterator[int]:
        """Yield the places at which messages of any topic are lost, or an event."""
        places = (each.place for each in self._file.losses if each.place is not None)
        # after the last message nothing is judged
        yield from (place for place in places if place < self._file.count)
        yield from self._contents.lost_events
        # The node begins each file with its latest event.
        heads = {place for place, _ in self._contents.events}
        for begin, file in zip(self._file.begins, self._file.files, strict=False):
            if METADATA in file.metadata and begin not in heads:
                yield begin

    def _list_undecided(self) -> Iterator[Interval]:
        """Yield intervals that a clock which went back repeats, if the log is not in that order."""
        rows = (each.expand() for each in self._contents.rows.values() if each.rows)
        passes = self._passes
        if passes.count == 1 or all(passes.find_by_place(*each) is not None for each in rows):
            return
        for (begin, holding), (end, _) in pairwise(partition(self._intervals)):
            if len(holding) > 1:
                yield Interval(begin, end, None, REPEATED)

    # Topics

    def _list_topics(self) -> dict[str, CatalogTopic]:
        channels: dict[str, str] = {}
        for number, channel in self._file.channels.items():
            channels.setdefault(self._names.find(number), channel.topic)
        return {
            name: self._describe_topic(name, channels[name]) for name in KNOWN if name in channels
        }

    def _describe_topic(self, name: str, full: str) -> CatalogTopic:
        found = self._found.get(name, GridFindings())
        gaps = self._list_gaps(name)
        missing = _count_missing(gaps)
        uncounted = _count_missing(self._list_uncounted(name))
        # Others may be at an event, in a gap that an event explains, or at an end of a file.
        is_open = any(gap.has_event or gap.place == NOWHERE for gap in gaps)
        is_open |= any(loss.place in (0, self._file.count) for loss in self._file.losses)
        is_open |= any(each.reason == NO_BEGINNING for each in self._intervals)
        return CatalogTopic(
            name=full,
            type=KNOWN[name].type,
            count=self._contents.counts[name],
            rate=found.rate,
            missing=missing if missing > self._counted else 0,
            is_least=is_open or missing != found.missing - uncounted,
            uncounted=uncounted,
            repeated=found.repeated,
            has_more=found.is_least,
            is_repeat=not (found.returns or self._lacks_events),
            unreadable=self._contents.unreadable.get(name, ""),
        )

    @cached_property
    def _lacks_events(self) -> bool:
        """True if events are lost, of which one may have set the clock."""
        missing = find_missing(self._ordered, self._proofs).values()
        is_begun = all(event.number == 1 for event in self._ordered.events[:1])
        return not (is_begun and self._ordered.events) or not all(each.is_off for each in missing)

    def _list_gaps(self, name: str) -> list[Gap]:
        """Return the gaps of a topic, except those that a lost event may explain."""
        # After a gap that is not counted, a gap in one topic alone is not caused by an event.
        passed = {gap.place for gap in self._list_uncounted(self._main)}
        intervals = (each for each in self._intervals if each.event is None)
        unknown = [each for each in intervals if each.places[0] not in passed]
        gaps = [
            gap
            for gap in self._found.get(name, GridFindings()).gaps
            if gap.stamps not in self._uncounted
            and not any(_may_explain(each, gap) for each in unknown)
        ]
        # A gap at an end of a file may be seen in both ways.
        for absent in self._list_absent(name):
            same = [each for each in gaps if _overlaps(each, absent)]
            if all(each.missing < absent.missing for each in same):
                gaps = [*(each for each in gaps if each not in same), absent]
        return gaps

    def _list_uncounted(self, name: str) -> list[Gap]:
        """Return the gaps of a topic that no count of the node follows."""
        gaps = self._found.get(name, GridFindings()).gaps
        return [gap for gap in gaps if gap.stamps in self._uncounted]

    def _list_absent(self, name: str) -> Iterator[Gap]:
        """Yield the gaps at the begin and the end of each file of the node.

        It has all samples of each topic that the node has, so other topics show the missing ones.
        """
        begins = [*self._file.begins, self._file.count + 1]
        for file, (begin, end) in zip(self._file.files, pairwise(begins), strict=False):
            given = read_names(file.metadata.get(METADATA, {}))
            if name in STATE_TOPICS and given and name in given.topics.values():
                yield from self._compare_ends(name, begin, end)

    def _compare_ends(self, name: str, begin: int, end: int) -> Iterator[Gap]:
        """Yield the gaps of a topic at both ends of a range of places, compared with another."""
        stamps, places = _cut(*self._samples, begin, end)
        if (np.diff(stamps) <= 0).sum() >= self._passes.count > 1:
            return  # messages are in another order, and the first may be any
        own_stamps, own = _cut(*self._contents.rows.get(name, StampRows()).expand(), begin, end)
        if not len(own):
            found = [stamps]
        else:
            if self._passes.count == 1:  # places are those of a grid, and stamps are exact
                before, after = stamps < own_stamps.min(), stamps > own_stamps.max()
            else:
                before, after = places < own[0], places > own[-1]
            around = ((before, own_stamps[0]), (after, own_stamps[-1]))
            found = [stamps[a][np.abs(stamps[a] - s) > ROUNDING] for a, s in around]
        for absent in map(np.unique, found):
            if len(absent):  # a file may begin and end within a sample
                missing = len(absent) - bool(len(own))
                yield Gap(int(absent[0]), int(absent[-1]), NOWHERE, missing)

    @cached_property
    def _samples(self) -> tuple[Stamps, Places]:
        """Stamps and places of the topic that has most samples."""
        return self._rows.expand()

    def _list_never_recorded(self) -> Iterator[str]:
        """Yield the topics that the node has and the log lacks."""
        expected = EVENTS.name, *STATE_TOPICS, DIAGNOSTICS.name, DESCRIPTION.name
        is_named = any(map(self._names.find_given, KNOWN))
        for name in KNOWN:
            is_there = name in self._topics and (is_named or self._topics[name].count)
            is_of_node = self._names.find_given(name) if is_named else name in expected
            if is_of_node and not is_there:
                yield name

    # Sentences

    def _list_problems(self) -> Iterator[str]:
        yield from self._file.problems
        yield from find_damage(self._file)
        for number in self._contents.channels:
            if number not in self._file.channels:
                yield f"channel {number} is not described: its messages are lost"
        yield from (f"{name}: {text}" for name, text in self._contents.unreadable.items())
        missing = find_missing(self._ordered, self._proofs).values()
        yield from (each.describe() for each in missing if not each.is_off)
        yield from self._describe_events()
        yield from self._describe_samples()

    def _list_doubts(self) -> Iterator[str]:
        places = {gap.place for gap in self._list_uncounted(self._main)}
        yield from self._describe_unproved(lambda place: place in places)
        lines: dict[str, list[str]] = {}
        for name in self._topics:
            if gaps := self._list_uncounted(name):
                lines.setdefault(_describe_uncounted(gaps), []).append(name)
        yield from _join(lines)

    def _describe_events(self) -> Iterator[str]:
        """Yield what is said of a beginning that is missing, and of events that are there twice."""
        ordered = self._ordered
        if not ordered.events and self._rows.count:
            yield f"the log has no {EVENTS.name}: the motion is not known"
        if ordered.doubled:
            yield f"{write_count(ordered.doubled, 'event', 'are')} repeated"
        for event in ordered.contradicting:
            yield f"event {event.number} at {event.stamp} ns is there twice, and the two differ"
        begin = min((event.stamp for event in ordered.events), default=None)
        if begin is not None:
            rows = self._contents.rows.values()
            if early := max((_count_before(each, begin) for each in rows), default=0):
                yield (
                    f"the beginning is missing: {_count_samples(early)} before the first event, "
                    f"which is number {ordered.events[0].number}"
                )
        places = {gap.place for gap in self._list_uncounted(self._main)}
        yield from self._describe_unproved(lambda place: place not in places)

    def _describe_unproved(self, chosen: Callable[[int], bool]) -> Iterator[str]:
        """Yield since when no proof follows, so that the motion is unknown, by the first place."""
        unproved = (each for each in self._intervals if each.reason.startswith(NO_PROOF))
        for (place, _), parts in groupby(unproved, key=lambda each: each.places):
            first = next(parts)
            if chosen(place):
                yield f"from {first.begin} ns on the motion is not known: {first.reason}"

    def _describe_samples(self) -> Iterator[str]:
        """Yield what is missing and repeated; topics of which the same is said share a line."""
        lines: dict[str, list[str]] = {}
        for name, topic in self._topics.items():
            if topic.missing:
                text = self._describe_missing(name, topic)
                lines.setdefault(text, []).append(name)
            if topic.repeated:
                text = _describe_repeated(topic)
                lines.setdefault(text, []).append(name)
        yield from _join(lines)

    def _describe_missing(self, name: str, topic: CatalogTopic) -> str:
        """Return how many samples of a topic are missing, at least, and where."""
        count = ("at least " if topic.is_least else "") + _count_samples(topic.missing)
        where = _describe_where(self._list_gaps(name))
        return f"{count} missing, {where}; the node has counted {self._counted} as missed"

    def _list_notes(self, lacking: Sequence[str]) -> Iterator[str]:
        names = self._names
        if not any(self._contents.counts[name] for name in TELLING):
            return
        if absent := list_absent_files(self._file):
            what = "files" if len(absent) > 1 else "file"
            are = "are" if len(absent) > 1 else "is"
            yield f"{what} {', '.join(map(str, absent))} of the recording {are} not in the log"
        stated = [each for each in lacking if each in STATE_TOPICS or names.find_given(each)]
        if stated:
            yield f"the log has no {', no '.join(stated)}"
        if names.others:
            yield (
                f"the node is {names.node}; others can be chosen by --node: "
                f"{', '.join(sorted(names.others))}"
            )
        missing = find_missing(self._ordered, self._proofs).values()
        yield from (each.describe() for each in missing if each.is_off)


def _join(lines: Mapping[str, Sequence[str]]) -> Iterator[str]:
    """Yield what is said of some topics, after their names."""
    yield from (f"{', '.join(names)}: {text}" for text, names in lines.items())


def _count_missing(gaps: Iterable[Gap]) -> int:
    return sum(gap.missing for gap in gaps)


def _describe_uncounted(gaps: Sequence[Gap]) -> str:
    """Return how many samples are missing, and where; the cause is not known."""
    least = "at least " if any(gap.has_event for gap in gaps) else ""
    return (
        f"{least}{_count_samples(_count_missing(gaps))} missing, {_describe_where(gaps)}; no count "
        "of the node follows in the log: it may have missed them, or they are lost"
    )


def _describe_where(found: Iterable[Gap]) -> str:
    """Return where samples are missing: in the widest gap if it has most of them."""
    gaps = [gap for gap in found if gap.missing]
    widest = max(gaps, key=lambda gap: gap.missing)
    if 2 * widest.missing <= _count_missing(gaps):
        begin, end = min(gap.before for gap in gaps), max(gap.after for gap in gaps)
        return f"in {len(gaps)} gaps between {begin} and {end} ns"
    most = "most of them " if len(gaps) > 1 else ""
    return f"{most}between {widest.before} and {widest.after} ns"


def _may_explain(unknown: Interval, gap: Gap) -> bool:
    """Return True if an event that is lost in an interval may explain a gap."""
    begin, end = unknown.places
    is_inside = begin <= gap.place <= end
    return is_inside or (unknown.begin < gap.after and gap.before < unknown.end)


def _overlaps(gap: Gap, absent: Gap) -> bool:
    return gap.before <= absent.after and absent.before <= gap.after


def _describe_repeated(topic: CatalogTopic) -> str:
    least = "at least " if topic.has_more else ""
    if topic.is_repeat:
        return f"{least}{_count_samples(topic.repeated)} repeated, at the stamps of others"
    count = write_count(topic.repeated, "sample", "have")
    return f"{least}{count} the stamps of others: repeated, or an event that set the clock is lost"


def _count_samples(count: int) -> str:
    """Return a number of samples as the subject of a sentence, with its verb."""
    return write_count(count, "sample", "are")


def _cut(stamps: Stamps, places: Places, begin: int, end: int) -> tuple[Stamps, Places]:
    """Return the samples in a range of places."""
    inside = (places >= begin) & (places < end)
    return stamps[inside], places[inside]


def _count_before(rows: StampRows, stamp: int) -> int:
    """Return the number of samples before a stamp (ns)."""
    return sum(
        row.samples
        if row.last < stamp
        else math.ceil((stamp - row.first) / max(1, row.last - row.first) * (row.samples - 1))
        for row in rows.rows
        if row.first < stamp
    )
