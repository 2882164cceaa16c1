"""Starts from what is seen, solved again from the questions in their events."""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from typing import Any

from symtop_ros.physics import State
from symtop_ros.run.check.mismatch import Mismatch, is_of_this_version
from symtop_ros.run.simulation.changes.outcomes import Start
from symtop_ros.run.simulation.changes.seen import KNOWN, Solved, asks_to_solve, find_starts
from symtop_ros.run.simulation.events import RESTARTS, Event
from symtop_ros.run.simulation.topics import EVENTS


@dataclass(frozen=True, slots=True)
class SolvedStarts:
    """Starts that were solved again."""

    compared: int
    foreign: int  # of another version, whose solutions may differ by rounding
    mismatches: tuple[Mismatch, ...]


def solve_again(events: Iterable[Event]) -> SolvedStarts:
    """Solve the starts of a log again, and compare solutions and states to the last bit."""
    asked = [each for each in events if each.name in RESTARTS and asks_to_solve(each.request)]
    own = [each for each in asked if is_of_this_version(each)]
    found = tuple(wrong for each in own for wrong in _compare(each))
    return SolvedStarts(len(own), len(asked) - len(own), found)


def _compare(event: Event) -> Iterator[Mismatch]:
    start = event.segment().motion.start
    try:
        outcome = event.outcome()
        known = {name: float(event.request[name]) for name in KNOWN if name in event.request}
        right = find_starts(event.segment().motion.top, known)
    except ValueError as error:
        yield Mismatch(EVENTS.name, event.stamp, "request", "solvable", str(error))
        return
    solved = outcome.solved if isinstance(outcome, Start) else None
    if solved is None or solved.found != right:
        yield Mismatch(EVENTS.name, event.stamp, "solutions", str(right), str(solved))
    elif _list_numbers(_take(solved)) != _list_numbers(start):
        yield Mismatch(EVENTS.name, event.stamp, "start", str(_take(solved)), str(start))


def _take(solved: Solved) -> State | None:
    return solved.start if 1 <= solved.taken <= solved.count else None


def _list_numbers(state: State | None) -> list[Any]:
    return [each.tolist() for each in state._parts] if state else []
