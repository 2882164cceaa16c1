"""Events, each compared with what follows from its act on the segment of the event before it."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import Any

import numpy as np

from symtop_ros import __version__
from symtop_ros.simulation.budget import FREE_STEPS, SPARE_STEPS, StepBudget
from symtop_ros.simulation.changes.follow import RULES, Act, follow
from symtop_ros.simulation.changes.outcomes import Start
from symtop_ros.simulation.changes.requests import read_kick
from symtop_ros.simulation.events import KICKS, RESTARTS, Event
from symtop_ros.simulation.segment import Segment
from symtop_ros.simulation.topics import EVENTS
from symtop_ros.simulation.validation import one_line

NOTHING = "nothing"
BEFORE = ("before.orientation", "before.angular_velocity", "before.pushes")


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


def find_mismatches(events: Sequence[Event]) -> Iterator[Mismatch]:
    """Yield the fields of events that are not as computed."""
    budget = StepBudget(SPARE_STEPS)
    for previous, event in pairwise([None, *events]):
        if event is None or not is_of_this_version(event):
            continue
        is_known = (
            previous is not None
            and previous.number == event.number - 1
            and is_of_this_version(previous)
        )
        yield from _judge(previous if is_known else None, event, budget)


def _judge(previous: Event | None, event: Event, budget: StepBudget) -> Iterator[Mismatch]:
    """Yield the fields of one event; nothing is known before it if `previous` is None."""
    got = {**event.values, "name": event.name, "message": event.verdict}
    if event.name not in RULES:
        yield Mismatch(EVENTS.name, event.stamp, "name", ", ".join(RULES), event.name)
        return
    try:
        event.outcome()
    except ValueError as error:
        yield Mismatch(EVENTS.name, event.stamp, "outcome", "readable", str(error))
        return
    try:
        expected = _compute(previous.segment() if previous else None, event, budget)
    except (ValueError, ArithmeticError) as error:  # a request that no node grants
        yield Mismatch(EVENTS.name, event.stamp, "request", str(error), str(event.request))
        return
    right = {**expected.values, "name": expected.name, "message": expected.verdict}
    yield from compare_fields(EVENTS.name, event.stamp, right, got)


def _compute(previous: Segment | None, event: Event, budget: StepBudget) -> Event:
    """Return the event as a node reports it."""
    act, is_known, pushes = read_act(event), event.number == 1, None
    if previous and _is_near(previous, act, budget):
        before, following, outcome, pushes = follow(previous, act)
        is_known = True
    else:
        before, following, outcome = event.state_before(), event.segment(), act.told
        if event.name in RESTARTS:
            outcome = Start.of(following.motion)
        if is_known:
            before = following.state_at(event.stamp)
    frame = event.values.get("top_frame", "")
    found = Event.of(
        event.stamp,
        event.name,
        outcome,
        act.request,
        before,
        following,
        frame,
        event.number,
        pushes,
    )
    given = {} if is_known else {n: event.values[n] for n in BEFORE if n in event.values}
    return replace(found, values={**found.values, **given})


def read_act(event: Event) -> Act:
    """Return what an event says was done.

    What a request leaves open is taken from the event itself: initial conditions that come from
    parameters, the paths of logs, factors of real time, and what a bug of the node left.
    """
    given = event.segment()
    request: Mapping[str, Any] = event.request
    if event.name in KICKS:
        request = read_kick(request)
    elif event.name == "torque":
        request = {"torque": tuple(map(float, request.get("torque", "").split()))}
    elif event.name == "clock":  # a jump takes effect at the time that the clock has then
        request = {"from": event.previous_end, "to": event.stamp}
    return Act(
        event.name,
        event.stamp,
        request,
        given.motion.start,
        given.factor,
        event.outcome(),
        given if event.name == "failure" else None,
    )


def _is_near(previous: Segment, act: Act, budget: StepBudget) -> bool:
    """Return False if the state before an act takes too long to compute."""
    if "reached" in act.request:
        return budget.reach(previous.motion, float(act.request["reached"]), FREE_STEPS)
    stamp = act.request["from"] if act.name == "clock" else act.stamp
    return budget.reach_stamps(previous, np.array([stamp]))
