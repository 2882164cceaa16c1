"""Events, each compared with what it makes of the segment that the event before it began.

What a request leaves open is taken from the event itself: initial conditions that come from
parameters, the paths of logs, factors of real time, and what a bug of the node left.
"""

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from symtop_ros import __version__
from symtop_ros.physics import (
    Friction,
    State,
    Top,
    kick_verdict,
)
from symtop_ros.simulation.budget import FREE_STEPS, SPARE_STEPS, StepBudget
from symtop_ros.simulation.changes.kick import plan_kick, read_kick
from symtop_ros.simulation.changes.outcomes import (
    ClockJump,
    Outcome,
    Parameters,
    Pause,
    Setting,
    Start,
    Step,
    Torque,
)
from symtop_ros.simulation.events import RESTARTS, Event
from symtop_ros.simulation.segment import Segment
from symtop_ros.simulation.topics import EVENTS
from symtop_ros.simulation.validation import one_line

NOTHING = "nothing"
BEFORE = ("before.orientation", "before.angular_velocity")
MOMENTS = ("top.Ix", "top.Iz", "top.Mgl", "friction.axial", "friction.transverse")


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
        follows = previous is not None and previous.number == event.number - 1
        is_known = follows and previous is not None and is_of_this_version(previous)
        known = previous if is_known else None
        yield from _judge(known, event, budget)


def _judge(previous: Event | None, event: Event, budget: StepBudget) -> Iterator[Mismatch]:
    """Yield the fields of one event; nothing is known before it if `previous` is None."""
    got = {**event.values, "name": event.name, "message": event.verdict}
    if event.name not in FOLLOW:
        yield Mismatch(EVENTS.name, event.stamp, "name", ", ".join(FOLLOW), event.name)
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
    following = event.segment()
    outcome = Start.of(following.motion) if event.name in RESTARTS else event.outcome()
    before = _state_before(previous, event, budget) if previous else None
    if previous and before:
        following, outcome = FOLLOW[event.name](Known(previous, event, before, following))
    elif event.number == 1:
        before = following.state_at(event.stamp)
    frame = event.values.get("top_frame", "")
    state = before or event.state_before()
    # A jump of the clock takes effect at the time that the clock has then.
    request = event.request | ({"to": str(event.stamp)} if event.name == "clock" else {})
    found = Event.of(
        event.stamp, event.name, outcome, request, state, following, frame, event.number
    )
    own = () if before else BEFORE
    given = {name: event.values[name] for name in own if name in event.values}
    return replace(found, values={**found.values, **given})


def _state_before(previous: Segment, event: Event, budget: StepBudget) -> State | None:
    """Return the state before an event; None if it takes too long to compute."""
    if "reached" in event.request:  # a motion that was slowed down, or that could not continue
        reached = float(event.request["reached"])
        is_near = budget.reach(previous.motion, reached, FREE_STEPS)
        return previous.motion.at(reached) if is_near else None
    stamp = event.previous_end
    is_near = budget.reach_stamps(previous, np.array([stamp]))
    return previous.state_at(stamp) if is_near else None


class Known(NamedTuple):
    """An event before it is computed, with its past."""

    previous: Segment
    event: Event
    before: State
    given: Segment  # the one of the event


Following = tuple[Segment, Outcome | None]  # the segment that follows, and what is said of it


def _restart(known: Known) -> Following:
    following = known.previous.restart(known.given.motion.start, known.event.stamp)
    return following, Start.of(following.motion)


def _kick(known: Known) -> Following:
    motion, hold = plan_kick(known.previous.motion, known.before, read_kick(known.event.request))
    following = known.previous.replace_motion(motion, known.event.stamp)
    return following, kick_verdict(motion, known.before, hold)


def _pause(known: Known) -> Following:
    following, request = known.previous, known.event.request
    if "reached" in request:
        reached = float(request["reached"])
        following = following.slow_down(reached, following.factor, known.event.stamp)
    following = following.pause(known.event.stamp)
    return following, Pause(following.begin_time)


def _resume(known: Known) -> Following:
    following = known.previous.resume(known.event.stamp)
    return following, Pause(following.begin_time)


def _step(known: Known) -> Following:
    previous, event = known.previous, known.event
    if "to" in event.request:  # the motion runs together with its clock
        following = previous.resume(event.stamp)
        return following, Step("stepped", float(following.time_at(int(event.request["to"]))))
    if not event.request:
        return previous, Step("none")
    following = previous.step(float(event.request["duration"]), event.stamp)
    return following, Step("stepped", following.begin_time)


def _move_clock(known: Known) -> Following:
    before, after = known.event.previous_end, known.event.stamp
    return known.previous.move(before, after), ClockJump(before, after)


def _change_pace(known: Known) -> Following:
    previous, event, factor = known.previous, known.event, known.given.factor
    if "reached" in event.request:
        reached = float(event.request["reached"])
        return previous.slow_down(reached, factor, event.stamp), event.outcome()
    if factor != previous.factor:
        previous = previous.set_factor(factor, event.stamp)
    return previous, event.outcome()


def _change_torque(known: Known) -> Following:
    previous, outcome = known.previous, known.event.outcome()
    x, y, z = map(float, known.event.request.get("torque", "").split())
    if (x, y, z) != previous.motion.applied_torque:
        previous = previous.change(known.event.stamp, torque=(x, y, z))
    return previous, replace(outcome, torque=(x, y, z)) if isinstance(outcome, Torque) else None


def _change_parameters(known: Known) -> Following:
    previous, given, stamp = known.previous, known.given, known.event.stamp
    request, following, friction = known.event.request, previous, previous.motion.friction
    before = (*previous.motion.top.moments, friction.axial, friction.transverse)
    after = [float(request.get(name, each)) for name, each in zip(MOMENTS, before, strict=True)]
    if tuple(after) != before:
        following = previous.change(stamp, Top(*after[:3]), Friction(*after[3:]))
    if "real_time_factor" in request and given.factor != previous.factor:
        # With a published clock the factor stays 1, whatever is asked.
        following = following.set_factor(float(request["real_time_factor"]), stamp)
    if "publish_rate" in request and previous.rig.imu:
        imu = replace(previous.rig.imu, rate=float(request["publish_rate"]))
        following = replace(following, rig=replace(previous.rig, imu=imu))
    return following, _list_changes(known.event)


def _list_changes(event: Event) -> Outcome | None:
    """Return the outcome of changed parameters; lists and flags are written in two ways."""
    given = event.outcome()
    if not isinstance(given, Parameters):
        return given
    pairs = zip(event.request.items(), given.changes, strict=True)
    numbers = [
        Setting(name, text if _is_number(text) else each.value) for (name, text), each in pairs
    ]
    return Parameters(tuple(numbers))


def _is_number(text: str) -> bool:
    try:
        return math.isfinite(float(text))
    except ValueError:
        return False


def _change_nothing(known: Known) -> Following:
    return known.previous, known.event.outcome()


def _fail(known: Known) -> Following:
    # A request with a bug may have taken effect before it failed.
    return known.given, known.event.outcome()


FOLLOW: dict[str, Callable[[Known], Following]] = {
    "start": _restart,
    "reset": _restart,
    "kick": _kick,
    "pause": _pause,
    "resume": _resume,
    "step": _step,
    "clock": _move_clock,
    "pace": _change_pace,
    "torque": _change_torque,
    "parameters": _change_parameters,
    "record": _change_nothing,
    "failure": _fail,
}
