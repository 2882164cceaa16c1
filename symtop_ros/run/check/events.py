"""Events, each compared with what follows from its act on the segment of the event before it."""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from symtop_ros.run.check.mismatch import Mismatch, compare_fields, is_of_this_version
from symtop_ros.run.simulation.budget import FREE_STEPS, SPARE_STEPS, StepBudget
from symtop_ros.run.simulation.changes.follow import RULES, Act, Change, follow
from symtop_ros.run.simulation.changes.outcomes import Start
from symtop_ros.run.simulation.changes.requests import read_kick
from symtop_ros.run.simulation.events import KICKS, RESTARTS, Event
from symtop_ros.run.simulation.segment import Segment
from symtop_ros.run.simulation.topics import EVENTS

BEFORE = ("before.orientation", "before.angular_velocity", "before.pushes")


def find_mismatches(events: Sequence[Event]) -> Iterator[Mismatch]:
    """Yield the fields of events that are not as computed."""
    budget = StepBudget(SPARE_STEPS)
    for previous, event in zip([None, *events], events, strict=False):
        if is_of_this_version(event):
            is_known = (
                previous is not None
                and previous.number == event.number - 1
                and is_of_this_version(previous)
            )
            yield from _judge(previous if is_known else None, event, budget)


def _judge(previous: Event | None, event: Event, budget: StepBudget) -> Iterable[Mismatch]:
    """Return the fields of one event; nothing is known before it if `previous` is None."""
    if event.name not in RULES:
        return [Mismatch(EVENTS.name, event.stamp, "name", ", ".join(RULES), event.name)]
    try:
        event.outcome()
    except ValueError as error:
        return [Mismatch(EVENTS.name, event.stamp, "outcome", "readable", str(error))]
    try:
        expected = _compute(previous.segment() if previous else None, event, budget)
    except (ValueError, ArithmeticError) as error:  # a request that every node refuses
        return [Mismatch(EVENTS.name, event.stamp, "request", str(error), str(event.request))]
    right, got = (
        {**each.values, "name": each.name, "message": each.verdict} for each in (expected, event)
    )
    return compare_fields(EVENTS.name, event.stamp, right, got)


def _compute(previous: Segment | None, event: Event, budget: StepBudget) -> Event:
    """Return the event as a node reports it."""
    act = read_act(event)
    is_known = event.number == 1
    if previous and _is_near(previous, act, budget):
        change = follow(previous, act)
        is_known = True
    else:
        following = event.segment()
        before = following.state_at(event.stamp) if is_known else event.state_before()
        outcome = act.told
        if event.name in RESTARTS:
            outcome = Start.of(following.motion, act.solved)
        change = Change(act, before, following, outcome)
    right = Event.of(change, event.number, event.values.get("top_frame", ""))
    given = {} if is_known else {n: event.values[n] for n in BEFORE if n in event.values}
    return replace(right, values={**right.values, **given})


def read_act(event: Event) -> Act:
    """Return what an event says was done.

    What a request does not state is taken from the event itself: initial conditions from
    parameters, paths of logs, real-time factors, and the state after a bug of the node.
    """
    given, told = event.segment(), event.outcome()
    request: Mapping[str, Any] = event.request
    match event.name:
        case name if name in KICKS:
            request = read_kick(request)
        case "torque":
            request = {"torque": tuple(map(float, request.get("torque", "").split()))}
        case "clock":  # a jump takes effect at the time that the clock has then
            request = {"from": event.previous_end, "to": event.stamp}
    return Act(
        event.name,
        event.stamp,
        request,
        start=given.motion.start,
        factor=given.factor,
        told=told,
        left=given if event.name == "failure" else None,
        clamped=given.motion.clamped,
        solved=told.solved if isinstance(told, Start) else None,
    )


def _is_near(previous: Segment, act: Act, budget: StepBudget) -> bool:
    """Return False if the state before an act takes too long to compute."""
    if "reached" in act.request:
        return budget.reach(previous.motion, float(act.request["reached"]), FREE_STEPS)
    stamp = act.request["from"] if act.name == "clock" else act.stamp
    return budget.reach_stamps(previous, np.array([stamp]))
