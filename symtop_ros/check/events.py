"""Events, each compared with what follows from its act on the segment of the event before it.

Descriptions, fixed frames and diagnostics are compared with what the events give. Of the
diagnostics those of the motion and of balances are computed again. Pace, log and duplicates
describe the machine.
"""

import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import chain, pairwise
from typing import Any
from xml.sax.saxutils import unescape

import numpy as np
from mcap.records import Message

from symtop_ros import __version__
from symtop_ros.check.course import Course
from symtop_ros.log.top_log import TopLog
from symtop_ros.models.urdf import robot_description
from symtop_ros.physics import Top
from symtop_ros.session.diagnostics import balance_status, motion_status
from symtop_ros.session.outputs import list_fixed_frames
from symtop_ros.simulation.budget import FREE_STEPS, SPARE_STEPS, StepBudget
from symtop_ros.simulation.changes.follow import RULES, Act, Following, follow
from symtop_ros.simulation.changes.outcomes import Start
from symtop_ros.simulation.changes.requests import read_kick
from symtop_ros.simulation.events import KICKS, RESTARTS, Event, decode_events
from symtop_ros.simulation.segment import Segment
from symtop_ros.simulation.sensor.imu import Rig, find_body
from symtop_ros.simulation.topics import DIAGNOSTICS, EVENTS, TF_STATIC, choose_description
from symtop_ros.simulation.validation import one_line
from symtop_ros.wire.diagnostics import Status, decode_statuses
from symtop_ros.wire.layout import DecodeError, Reader
from symtop_ros.wire.messages import encode_transforms

NOTHING = "nothing"
BEFORE = ("before.orientation", "before.angular_velocity", "before.pushes")
Described = tuple[Top, Rig, str]  # what a description depends on: top, gravity and sensor, frame
STATUSES = {"motion": motion_status, "balance": balance_status}
# What is left of a balance is rounding, and the order of its sums is that of the linear algebra of
# the machine.
ROUNDING = ("energy.balance", "angular_momentum.balance")


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
    except (ValueError, ArithmeticError) as error:  # a request that no node grants
        return [Mismatch(EVENTS.name, event.stamp, "request", str(error), str(event.request))]
    right, got = (
        {**each.values, "name": each.name, "message": each.verdict} for each in (expected, event)
    )
    return compare_fields(EVENTS.name, event.stamp, right, got)


def _compute(previous: Segment | None, event: Event, budget: StepBudget) -> Event:
    """Return the event as a node reports it."""
    act, is_known = read_act(event), event.number == 1
    if previous and _is_near(previous, act, budget):
        found, is_known = follow(previous, act), True
    else:
        following = event.segment()
        before = following.state_at(event.stamp) if is_known else event.state_before()
        outcome = Start.of(following.motion) if event.name in RESTARTS else act.told
        found = Following(before, following, outcome)
    right = Event.of(
        event.stamp,
        event.name,
        found.outcome,
        act.request,
        found.before,
        found.segment,
        event.values.get("top_frame", ""),
        event.number,
        found.pushes,
    )
    given = {} if is_known else {n: event.values[n] for n in BEFORE if n in event.values}
    return replace(right, values={**right.values, **given})


def read_act(event: Event) -> Act:
    """Return what an event says was done.

    What a request leaves open is taken from the event itself: initial conditions that come from
    parameters, the paths of logs, factors of real time, and what a bug of the node left.
    """
    given = event.segment()
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


class TextCheck:
    """The messages of one node that are neither events nor samples."""

    def __init__(self, node: str, events: Sequence[Event], all_readable: bool = True) -> None:
        self._node, self._events = node, events
        self._course, self._budget = Course(events, all_readable), StepBudget(SPARE_STEPS)
        self._names = {
            choose_description(node).resolve(node): self._judge_description,
            TF_STATIC.resolve(node): self._judge_frames,
            DIAGNOSTICS.resolve(node): self._judge_diagnostics,
        }
        self._kinds = list(dict.fromkeys(map(_kind, events)))
        numbers = [event.number for event in events]
        # Of a run with an event that is missing, the top of a description may not be known.
        self._is_whole = (
            all_readable
            and all(map(is_of_this_version, events))
            and all(after <= before + 1 for before, after in pairwise(numbers))
        )

    def judge(self, name: str, message: Message, place: int) -> Iterator[Mismatch]:
        """Yield what is wrong in a message; `place` is the number of events before it."""
        if name in self._names:
            try:
                yield from self._names[name](name, message, place)
            except DecodeError as error:
                yield Mismatch(name, message.log_time, "message", "readable", str(error))

    def _judge_description(self, name: str, message: Message, _: int) -> Iterator[Mismatch]:
        if not self._is_whole:
            return
        text = Reader(message.data).string()
        link = re.search(r'<link name="([^"]*)"/>', text)  # the first is that of the world
        world = unescape(link[1], {"&quot;": '"'}) if link else ""
        right = [
            robot_description(
                top, world, frame, tf_moves_it=moves, body=find_body(top, rig.gravity)
            )
            for top, rig, frame in self._kinds
            for moves in (True, False)
        ]
        if text not in right:
            yield Mismatch(name, message.log_time, "text", "that of a top of the run", "another")

    def _judge_frames(self, name: str, message: Message, _: int) -> Iterator[Mismatch]:
        reader = Reader(message.data)
        reader.count()
        stamp = reader.stamp()
        child = self._kinds[0][2].encode()
        if not self._is_whole or child not in message.data:
            return  # of another node
        right = [
            encode_transforms(stamp, list_fixed_frames(frame, rig.imu, body))
            for top, rig, frame in self._kinds
            for body in (None, find_body(top, rig.gravity))
        ]
        if message.data not in right:
            yield Mismatch(name, message.log_time, "frames", "those of the run", "others")

    def _judge_diagnostics(self, name: str, message: Message, place: int) -> Iterator[Mismatch]:
        for status in decode_statuses(message.data):
            owner, _, kind = status.name.rpartition(": ")
            if owner == self._node.lstrip("/") and kind in STATUSES:
                yield from self._judge_status(name, status, kind, place)

    def _judge_status(self, name: str, status: Status, kind: str, place: int) -> Iterator[Mismatch]:
        """Yield the fields of a status that are those of no event that can hold."""
        found: list[list[Mismatch]] = []
        owners = self._list_owners(status.stamp, place)
        if self._course.has_gap[owners].any():
            return
        for number in owners:
            segment, is_own = self._course.segment(number), is_of_this_version(self._events[number])
            if not is_own or not self._budget.reach_stamps(segment, np.array([status.stamp])):
                return
            right = STATUSES[kind](segment, status.stamp)
            found.append(list(compare_fields(name, status.stamp, _texts(right), _texts(status))))
        yield from min(found, key=len, default=[])

    def _list_owners(self, stamp: int, place: int) -> list[int]:
        """Return the events that can hold at a stamp: by their place in the log, and by stamps."""
        stamps, places = np.array([stamp]), np.array([place], dtype=np.intp)
        owner = int(self._course.find_owners(stamps, places)[0])
        # What takes effect at the stamp itself may have come after the diagnostics.
        return [each for each in dict.fromkeys((place - 1, owner, owner - 1)) if each >= 0]


def _kind(event: Event) -> Described:
    segment = event.segment()
    return segment.motion.top, segment.rig, event.values.get("top_frame", "")


def _texts(status: Status) -> dict[str, str]:
    kept = {key: value for key, value in status.values.items() if key not in ROUNDING}
    return {**kept, "message": status.message, "level": str(status.level)}


def _count_events(data: bytes) -> int:
    """Return how many events of a message can be read: the others are not among those of a log."""
    try:
        return len(decode_events(data))
    except ValueError:
        return 0


def find_wrong_texts(log: TopLog, events: Sequence[Event]) -> Iterator[Mismatch]:
    """Yield what is wrong in the texts of a log that has been read."""
    if not events or log.node is None:
        return
    check, place = TextCheck(log.node, events, log.has_readable_events), 0
    own = EVENTS.resolve(log.node)
    for message in chain.from_iterable(log.file.chunks()):
        channel = log.file.channels.get(message.channel_id)
        name = channel.topic if channel else ""
        place += _count_events(message.data) if name == own else 0
        yield from check.judge(name, message, place)
