"""Events, each compared with what follows from its act on the segment of the event before it.

Descriptions, fixed frames, diagnostics and the clock are compared with what the events give. Of the
diagnostics those of the motion and of balances are computed again. Pace, log and duplicates
describe the machine.
"""

import html
import re
from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from mcap.records import Message

from symtop_ros import __version__
from symtop_ros.base.refusals import one_line
from symtop_ros.physics import Top
from symtop_ros.run.log.account import Account
from symtop_ros.run.log.chronicle import Chronicle
from symtop_ros.run.log.contents import LATEST
from symtop_ros.run.log.stretches import NO_BEGINNING, NOT_RECORDED, Unknown
from symtop_ros.run.models.urdf import robot_description
from symtop_ros.run.session.diagnostics import balance_status, motion_status
from symtop_ros.run.session.outputs import list_fixed_frames
from symtop_ros.run.simulation.budget import FREE_STEPS, SPARE_STEPS, StepBudget
from symtop_ros.run.simulation.changes.follow import RULES, Act, Change, follow
from symtop_ros.run.simulation.changes.outcomes import Start
from symtop_ros.run.simulation.changes.requests import read_kick
from symtop_ros.run.simulation.events import KICKS, RESTARTS, Event
from symtop_ros.run.simulation.segment import Segment
from symtop_ros.run.simulation.sensor.imu import Rig, find_body
from symtop_ros.run.simulation.topics import (
    APPLIED_TORQUE,
    CLOCK,
    DESCRIPTION,
    DIAGNOSTICS,
    EVENTS,
    MARKERS,
    TF_STATIC,
)
from symtop_ros.run.wire.diagnostics import Status, decode_statuses
from symtop_ros.run.wire.layout import DecodeError, Reader
from symtop_ros.run.wire.messages import encode_transforms

NOTHING = "nothing"
BEFORE = ("before.orientation", "before.angular_velocity", "before.pushes")
Described = tuple[Top, Rig, str]  # what a description depends on: top, gravity and sensor, frame
Found = list["Mismatch"] | None  # in a message; None: it was not compared
STATUSES: dict[str, Callable[[Segment, int, int], Status]] = {
    "motion": motion_status,
    "balance": lambda segment, stamp, _: balance_status(segment, stamp),
}
OTHER_VERSION = "it is of another version"
REASONS = {
    CLOCK.name: "a recorder gets it at other times than those that it names",
    MARKERS.name: "markers are drawings of the samples before them",
    APPLIED_TORQUE.name: "it was received, and not computed",
}
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
    act = read_act(event)
    is_known = event.number == 1
    if previous and _is_near(previous, act, budget):
        change = follow(previous, act)
        is_known = True
    else:
        following = event.segment()
        before = following.state_at(event.stamp) if is_known else event.state_before()
        outcome = Start.of(following.motion) if event.name in RESTARTS else act.told
        change = Change(act, before, following, outcome)
    right = Event.of(change, event.number, event.values.get("top_frame", ""))
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
        start=given.motion.start,
        factor=given.factor,
        told=event.outcome(),
        left=given if event.name == "failure" else None,
        clamped=given.motion.clamped,
    )


def _is_near(previous: Segment, act: Act, budget: StepBudget) -> bool:
    """Return False if the state before an act takes too long to compute."""
    if "reached" in act.request:
        return budget.reach(previous.motion, float(act.request["reached"]), FREE_STEPS)
    stamp = act.request["from"] if act.name == "clock" else act.stamp
    return budget.reach_stamps(previous, np.array([stamp]))


class TextCheck:
    """The messages of one node that are neither events nor samples."""

    def __init__(self, account: Account) -> None:
        self.mismatches: list[Mismatch] = []
        self.compared: Counter[str] = Counter()  # messages by our names of topics
        self.reasons = dict(REASONS)  # why others were not compared
        self._account = account
        self._budget = StepBudget(SPARE_STEPS)
        self._unknown = Unknown(account.unknown)
        self._chronicle = Chronicle(account.events, account.ordered.places)
        self._judges: dict[str, Callable[[str, Message, int], Found]] = {
            DESCRIPTION.name: self._judge_description,
            TF_STATIC.name: self._judge_frames,
            DIAGNOSTICS.name: self._judge_diagnostics,
            **({} if account.guess else {CLOCK.name: self._judge_clock}),
        }
        self._kinds = list(dict.fromkeys(map(_kind, account.events)))
        # Of a run with an event that is missing, the top of a description may not be known.
        harmless = NOT_RECORDED, NO_BEGINNING
        self._is_whole = all(each.reason in harmless for each in account.unknown)
        if not account.events:
            self._judges.clear()
        if not all(map(is_of_this_version, account.events)):
            for name in (DESCRIPTION.name, TF_STATIC.name):
                self._judges.pop(name, None)
                self.reasons[name] = OTHER_VERSION

    def add(self, place: int, name: str, message: Message) -> None:
        """Compare a message, given with its place in the log and our name of its topic."""
        if name in self._judges:
            topic = self._account.topics[name].name
            try:
                found = self._judges[name](topic, message, place)
                self.compared[name] += found is not None
                self.mismatches += found or []
            except DecodeError as error:
                self.mismatches.append(
                    Mismatch(topic, message.log_time, "message", "readable", str(error))
                )

    def _leave(self, name: str) -> Found:
        """Note that a message of a topic is not compared, as an event may be missing."""
        self.reasons.setdefault(name, "events may be missing")
        return None

    def _judge_description(self, name: str, message: Message, _: int) -> Found:
        if not self._is_whole:
            return self._leave(DESCRIPTION.name)
        text = Reader(message.data).string()
        link = re.search(r'<link name="([^"]*)"/>', text)  # the first is that of the world
        world = html.unescape(link[1]) if link else ""
        right = [
            robot_description(
                top, world, frame, tf_moves_it=moves, body=find_body(top, rig.gravity)
            )
            for top, rig, frame in self._kinds
            for moves in (True, False)
        ]
        wrong = Mismatch(name, message.log_time, "text", "that of a top of the run", "another")
        return [] if text in right else [wrong]

    def _judge_frames(self, name: str, message: Message, _: int) -> Found:
        reader = Reader(message.data)
        reader.count()
        stamp = reader.stamp()
        if not self._is_whole:
            return self._leave(TF_STATIC.name)
        if self._kinds[0][2].encode() not in message.data:
            return None  # of another node
        right = [
            encode_transforms(stamp, list_fixed_frames(frame, rig.imu, body))
            for top, rig, frame in self._kinds
            for body in (None, find_body(top, rig.gravity))
        ]
        wrong = Mismatch(name, message.log_time, "frames", "those of the run", "others")
        return [] if message.data in right else [wrong]

    def _judge_clock(self, name: str, message: Message, _: int) -> Found:
        """Compare a time with that at which the node logged it."""
        stamp = Reader(message.data).stamp()
        wrong = Mismatch(name, message.log_time, "clock", str(message.log_time), str(stamp))
        return [] if stamp == message.log_time else [wrong]

    def _judge_diagnostics(self, name: str, message: Message, place: int) -> Found:
        found: list[Found] = []
        for status in decode_statuses(message.data):
            owner, _, kind = status.name.rpartition(": ")
            if owner == (self._account.node or "").lstrip("/") and kind in STATUSES:
                found.append(self._judge_status(name, status, kind, place))
        judged = [each for each in found if each is not None]
        return [one for each in judged for one in each] if judged else None

    def _judge_status(self, name: str, status: Status, kind: str, place: int) -> Found:
        """Return the fields of a status that are those of no event that can hold."""
        found: list[list[Mismatch]] = []
        for number in self._list_owners(status.stamp, place):
            event = self._account.events[number]
            segment = self._chronicle.segment(number)
            if not is_of_this_version(event):
                self.reasons.setdefault(DIAGNOSTICS.name, OTHER_VERSION)
                return None
            if not self._budget.reach_stamps(segment, np.array([status.stamp])):
                return None
            right = _texts(STATUSES[kind](segment, status.stamp, event.number))
            if LATEST not in status.values:  # a log of before
                right.pop(LATEST, None)
            found.append(list(compare_fields(name, status.stamp, right, _texts(status))))
        wrong = min(found, key=len, default=[])
        where = np.array([status.stamp]), np.array([place])
        if wrong and self._unknown.find(*where).any():
            return self._leave(DIAGNOSTICS.name)
        return wrong

    def _list_owners(self, stamp: int, place: int) -> list[int]:
        """Return the events that can hold at a stamp: by their place in the log, and by stamps."""
        stamps = np.array([stamp])
        places = np.array([place], dtype=np.intp)
        owner = int(self._chronicle.find_owners(stamps, places)[0])
        latest = int(self._chronicle.find_latest(places)[0])
        # What takes effect at the stamp itself may have come after the diagnostics, and an event
        # may come late.
        found = dict.fromkeys((latest, owner, owner - 1, latest + 1))
        return [each for each in found if self._may_hold(each, stamp)]

    def _may_hold(self, number: int, stamp: int) -> bool:
        events = self._account.events
        return 0 <= number < len(events) and stamp >= min(
            events[number].stamp, events[number].previous_end
        )


def _kind(event: Event) -> Described:
    segment = event.segment()
    return segment.motion.top, segment.rig, event.values.get("top_frame", "")


def _texts(status: Status) -> dict[str, str]:
    kept = {key: value for key, value in status.values.items() if key not in ROUNDING}
    return {**kept, "message": status.message, "level": str(status.level)}
