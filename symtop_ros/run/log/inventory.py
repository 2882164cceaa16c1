"""What `metadata.yaml` of rosbag2 counts, compared with what is there."""

from collections import Counter
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from itertools import groupby
from pathlib import Path
from typing import Any, Self
from weakref import WeakValueDictionary

import yaml

from symtop_ros.base.counts import write_count
from symtop_ros.base.refusals import one_line
from symtop_ros.run.log.source import Loss, MessageSource
from symtop_ros.run.wire.layout import NANOSECONDS

FILE, ZSTD = "metadata.yaml", ".zstd"
INFORMATION = "rosbag2_bagfile_information"
LARGEST_FILE = 2**26  # bytes; of a bag of 10 000 files it has some MB
LARGEST_COUNT = 2**63
SHOWN = 4  # files or topics that a line names
LOADER = getattr(yaml, "CSafeLoader", yaml.SafeLoader)  # the first one is ten times faster


class DamagedError(ValueError):
    """Raised for a `metadata.yaml` that says something else than rosbag2 does."""


@dataclass(frozen=True, slots=True)
class Inventory:
    """The counts of a `metadata.yaml`."""

    files: tuple[str, ...]  # names without .zstd, in the order of the recording
    in_files: Mapping[str, int]  # messages by file; older versions of rosbag2 do not count them
    in_topics: Mapping[str, int]  # messages by topic
    messages: int
    end: int | None  # time (ns) of the last message; None: not known, or there is none

    @classmethod
    def of(cls, facts: Any) -> Self:
        """Return the counts of a file that was read, or raise what it lacks."""
        about = facts[INFORMATION]
        in_topics: Counter[str] = Counter()
        for each in about.get("topics_with_message_count") or []:
            in_topics[str(each["topic_metadata"]["name"])] += _count(each["message_count"])
        messages = _count(about["message_count"])
        begin = _count(about["starting_time"]["nanoseconds_since_epoch"])
        return cls(
            tuple(_name(each) for each in about["relative_file_paths"]),
            {_name(each["path"]): _count(each["message_count"]) for each in about.get("files", [])},
            in_topics,
            messages,
            begin + _count(about["duration"]["nanoseconds"]) if messages else None,
        )


def _count(value: object) -> int:
    if type(value) is not int or not 0 <= value < LARGEST_COUNT:
        raise DamagedError(f"a count is {one_line(str(value))[:40]}")
    return value


def _name(path: object) -> str:
    return Path(str(path)).name.removesuffix(ZSTD)


class Bag:
    """A folder of rosbag2 with the files that are there."""

    def __init__(self, folder: Path, files: Mapping[Path, MessageSource]) -> None:
        # Weak, as the sources have this: a cycle would keep their temporary copies.
        self._files = WeakValueDictionary({_name(path): each for path, each in files.items()})
        self._folder = folder

    def find_losses(self, read: MessageSource) -> list[Loss]:
        """Return what is missing, once all messages were read, of a source with these files."""
        path = self._folder / FILE
        try:
            inventory = _read(path)
        except OSError as error:
            return [
                Loss(f"cannot read {path}, so missing messages are not known: {error.strerror}")
            ]
        except DamagedError as error:
            return [Loss(f"{path} is damaged, so missing messages are not known: {error}")]
        return self._compare(inventory, read) if inventory else []

    def _compare(self, inventory: Inventory, read: MessageSource) -> list[Loss]:
        losses = [*self._list_absent(inventory, read)]
        found = self._count_topics()
        missing = Counter(inventory.in_topics)
        missing.subtract(found)
        missing = +missing
        lacking = max(missing.total(), inventory.messages - found.total())
        # Only then: a recorder may count a message in the file before the one that gets it, and
        # in the end of the bag what it did not write.
        if lacking > 0:
            losses += self._list_short(inventory, read)
            topics = _list([f"{count} on {name}" for name, count in missing.most_common()])
            counted = write_count(inventory.messages, "message")
            by_topic = f"{lacking} of {counted}{topics and f', {topics}'}"
            more = [by_topic, *self._describe_end(inventory)]
            last = losses.pop() if losses else self._lose_somewhere(read)
            losses.append(Loss(f"{last.text} ({FILE}: {'; '.join(more)})", last.place))
        return losses

    def _count_topics(self) -> Counter[str]:
        """Return the messages that are there by topic."""
        found: Counter[str] = Counter()
        for source in self._files.values():
            for number, count in source.counts.items():
                found[source.channels[number].topic] += count
        return found

    def _describe_end(self, inventory: Inventory) -> Iterator[str]:
        """Yield how much longer the bag was."""
        latest = max(each.latest for each in self._files.values())
        if inventory.end is not None and latest < inventory.end:
            yield f"it ended {(inventory.end - latest) / NANOSECONDS:.3g} s later"

    @staticmethod
    def _lose_somewhere(read: MessageSource) -> Loss:
        return Loss("messages of the bag are missing", read.count if len(read.files) == 1 else 0)

    def _list_absent(self, inventory: Inventory, read: MessageSource) -> Iterator[Loss]:
        """Yield the files that are missing, those that follow each other together."""
        order = list(inventory.files)
        for is_here, group in groupby(order, lambda name: name in self._files):
            if is_here:
                continue
            names = [*group]
            after = order[order.index(names[-1]) + 1 :]
            place = read.count
            if following := next((each for each in after if each in self._files), None):
                place = read.begins[_find(read, self._files[following])]
            verb = "is" if len(names) == 1 else "are"
            number = write_count(len(names), "file")
            yield Loss(f"{number} of the bag {verb} missing: {_list(names)}", place)

    def _list_short(self, inventory: Inventory, read: MessageSource) -> Iterator[Loss]:
        """Yield the files that have fewer messages than were counted.

        A file that lost its write-ahead log lost its last messages.
        """
        ends = [*read.begins[1:], read.count]
        for name, source in self._files.items():
            counted = inventory.in_files.get(name, 0)
            missing = counted - source.counts.total()
            if missing > 0:
                verb = "is" if missing == 1 else "are"
                text = f"{missing} of {write_count(counted, 'message')} {verb} missing in {name}"
                yield Loss(text, ends[_find(read, source)])


def _read(path: Path) -> Inventory | None:
    """Return the counts of a file, or None if there is none, as after `kill -9`."""
    try:
        with path.open("rb") as file:
            data = file.read(LARGEST_FILE)
    except FileNotFoundError:
        return None
    try:
        return Inventory.of(yaml.load(data, LOADER))  # a safe loader
    except DamagedError:
        raise
    except (yaml.YAMLError, LookupError, TypeError, AttributeError, ValueError, RecursionError):
        raise DamagedError("it is not what rosbag2 writes") from None


def _find(read: MessageSource, source: MessageSource) -> int:
    return next(place for place, each in enumerate(read.files) if each is source)


def _list(names: list[str]) -> str:
    """Return the first names, and the number of the others."""
    more = len(names) - SHOWN
    return ", ".join([*map(one_line, names[:SHOWN]), *([f"{more} more"] if more > 0 else [])])
