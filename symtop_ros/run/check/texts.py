"""Messages that are neither events nor samples, compared with what the events give.

These are descriptions, fixed frames, the clock and diagnostics. In diagnostics the statuses of the
motion and of the balances are computed again. Pace, log and duplicates describe the machine.
"""

import html
import re
from collections import Counter
from collections.abc import Callable

import numpy as np
from mcap.records import Message

from symtop_ros.physics import Top
from symtop_ros.run.check.mismatch import Mismatch, compare_fields, is_of_this_version
from symtop_ros.run.log.catalog import Catalog
from symtop_ros.run.log.contents import LATEST
from symtop_ros.run.log.event_order import EventOrder
from symtop_ros.run.log.intervals import NO_BEGINNING, NOT_RECORDED, Unknown
from symtop_ros.run.models.urdf import robot_description
from symtop_ros.run.session.diagnostics import balance_status, motion_status
from symtop_ros.run.session.outputs import list_fixed_frames
from symtop_ros.run.simulation.budget import SPARE_STEPS, StepBudget
from symtop_ros.run.simulation.events import Event
from symtop_ros.run.simulation.segment import Segment
from symtop_ros.run.simulation.sensor.imu import Rig
from symtop_ros.run.simulation.topics import (
    APPLIED_TORQUE,
    CLOCK,
    DESCRIPTION,
    DIAGNOSTICS,
    MARKERS,
    POINTS,
    TF_STATIC,
)
from symtop_ros.run.wire.diagnostics import Status, decode_statuses
from symtop_ros.run.wire.layout import DecodeError, Reader
from symtop_ros.run.wire.messages import encode_transforms

Described = tuple[Top, Rig, str]  # what a description depends on: top, gravity and sensor, frame
Found = list[Mismatch] | None  # mismatches in a message; None: it was not compared
STATUSES: dict[str, Callable[[Segment, int, int], Status]] = {
    "motion": motion_status,
    "balance": lambda segment, stamp, _: balance_status(segment, stamp),
}
OTHER_VERSION = "it is of another version"
REASONS = {
    CLOCK.name: "a recorder receives these messages at times other than those in them",
    MARKERS.name: "markers are drawings of the samples before them",
    APPLIED_TORQUE.name: "it was received, and not computed",
    POINTS.name: "the points were measured, not computed",
}
# The residual of a balance is a rounding error, and the order of its sums depends on the linear
# algebra library of the machine.
ROUNDING = ("energy.balance", "angular_momentum.balance")


class TextCheck:
    """The messages of one node that are neither events nor samples."""

    def __init__(self, catalog: Catalog) -> None:
        self.mismatches: list[Mismatch] = []
        self.compared: Counter[str] = Counter()  # messages by our names of topics
        self.reasons = dict(REASONS)  # why others were not compared
        self._catalog = catalog
        self._budget = StepBudget(SPARE_STEPS)
        self._unknown = Unknown(catalog.unknown)
        self._event_order = EventOrder(catalog.events, catalog.ordered.places)
        self._judges: dict[str, Callable[[str, Message, int], Found]] = {
            DESCRIPTION.name: self._judge_description,
            TF_STATIC.name: self._judge_frames,
            DIAGNOSTICS.name: self._judge_diagnostics,
            **({} if catalog.guess else {CLOCK.name: self._judge_clock}),
        }
        self._kinds = list(dict.fromkeys(map(_kind, catalog.events)))
        # Of a run with an event that is missing, the top of a description may not be known.
        harmless = NOT_RECORDED, NO_BEGINNING
        self._is_whole = all(each.reason in harmless for each in catalog.unknown)
        if not catalog.events:
            self._judges.clear()
        if not all(map(is_of_this_version, catalog.events)):
            for name in (DESCRIPTION.name, TF_STATIC.name):
                self._judges.pop(name, None)
                self.reasons[name] = OTHER_VERSION

    def add(self, place: int, name: str, message: Message) -> None:
        """Compare a message, given with its place in the log and our name of its topic."""
        if name in self._judges:
            topic = self._catalog.topics[name].name
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
            robot_description(top, world, frame, tf_moves_it=moves, body=rig.find_body(top))
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
            for body in (None, rig.find_body(top))
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
            if owner == (self._catalog.node or "").lstrip("/") and kind in STATUSES:
                found.append(self._judge_status(name, status, kind, place))
        judged = [each for each in found if each is not None]
        return [one for each in judged for one in each] if judged else None

    def _judge_status(self, name: str, status: Status, kind: str, place: int) -> Found:
        """Return the fields of a status that agree with no event that can hold."""
        found: list[list[Mismatch]] = []
        for number in self._list_owners(status.stamp, place):
            event = self._catalog.events[number]
            segment = self._event_order.segment(number)
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
        owner = int(self._event_order.find_owners(stamps, places)[0])
        latest = int(self._event_order.find_latest(places)[0])
        # What takes effect at the stamp itself may have come after the diagnostics, and an event
        # may come late.
        found = dict.fromkeys((latest, owner, owner - 1, latest + 1))
        return [each for each in found if self._may_hold(each, stamp)]

    def _may_hold(self, number: int, stamp: int) -> bool:
        events = self._catalog.events
        return 0 <= number < len(events) and stamp >= min(
            events[number].stamp, events[number].previous_end
        )


def _kind(event: Event) -> Described:
    segment = event.segment()
    return segment.motion.top, segment.rig, event.values.get("top_frame", "")


def _texts(status: Status) -> dict[str, str]:
    kept = {key: value for key, value in status.values.items() if key not in ROUNDING}
    return {**kept, "message": status.message, "level": str(status.level)}
