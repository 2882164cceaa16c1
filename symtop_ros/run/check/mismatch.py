"""Fields of messages that are not as computed, and whether they can be compared at all."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

from symtop_ros import __version__
from symtop_ros.base.refusals import one_line
from symtop_ros.run.simulation.events import Event

NOTHING = "nothing"


def is_of_this_version(event: Event) -> bool:
    """Return True if the version that reported an event has the wording of this one."""
    return event.values.get("version") == __version__


def list_other_versions(events: Sequence[Event]) -> list[str]:
    """Return the versions, other than this one, that reported events."""
    names = {event.values.get("version", "") or "an unknown version" for event in events}
    return sorted(one_line(name, 20) for name in names - {__version__})


@dataclass(frozen=True, slots=True)
class Mismatch:
    """A field of a message that is not as computed."""

    topic: str
    stamp: int  # ns
    field: str
    expected: str
    got: str


def compare_fields(
    topic: str, stamp: int, expected: Mapping[str, str], got: Mapping[str, str]
) -> Iterator[Mismatch]:
    """Yield the fields of a message that differ, are missing or are too many."""
    for name in dict.fromkeys([*expected, *got]):
        right, found = expected.get(name, NOTHING), got.get(name, NOTHING)
        if right != found:
            yield Mismatch(topic, stamp, name, right, found)
