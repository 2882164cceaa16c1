"""Descriptions, fixed frames and diagnostics of a log, compared with what its events give.

Of the diagnostics those of the motion and of balances are computed again. Pace, log and duplicates
describe the machine.
"""

import re
from collections.abc import Iterator, Sequence
from itertools import pairwise
from xml.sax.saxutils import unescape

import numpy as np
from mcap.records import Message

from symtop_ros.check.course import Course
from symtop_ros.check.events import Mismatch, compare_fields, is_of_this_version
from symtop_ros.log.top_log import TopLog
from symtop_ros.models.urdf import robot_description
from symtop_ros.physics import Top
from symtop_ros.session.diagnostics import balance_status, motion_status
from symtop_ros.session.outputs import list_fixed_frames
from symtop_ros.simulation.budget import SPARE_STEPS, StepBudget
from symtop_ros.simulation.events import Event, decode_events
from symtop_ros.simulation.sensor.imu import Rig, find_body
from symtop_ros.simulation.topics import DIAGNOSTICS, EVENTS, TF_STATIC, choose_description
from symtop_ros.wire.diagnostics import Status, decode_statuses
from symtop_ros.wire.layout import DecodeError, Reader
from symtop_ros.wire.messages import encode_transforms

Described = tuple[Top, Rig, str]  # what a description depends on: top, gravity and sensor, frame
FIRST_LINK = re.compile(r'<link name="([^"]*)"/>')  # that of the world
QUOTES = {"&quot;": '"'}
STATUSES = {"motion": motion_status, "balance": balance_status}
# What is left of a balance is rounding, and the order of its sums is that of the linear algebra of
# the machine.
ROUNDING = ("energy.balance", "angular_momentum.balance")


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
        link = FIRST_LINK.search(text)
        world = unescape(link[1], QUOTES) if link else ""
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
            segment = self._course.segment(number)
            stamps = np.array([status.stamp])
            is_own = is_of_this_version(self._events[number])
            if not is_own or not self._budget.reach_stamps(segment, stamps):
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


def find_mismatches(log: TopLog, events: Sequence[Event]) -> Iterator[Mismatch]:
    """Yield what is wrong in the texts of a log that has been read."""
    if not events or log.node is None:
        return
    check, place = TextCheck(log.node, events, log.has_readable_events), 0
    own = EVENTS.resolve(log.node)
    for messages in log.file.chunks():
        for message in messages:
            channel = log.file.channels.get(message.channel_id)
            name = channel.topic if channel else ""
            place += _count_events(message.data) if name == own else 0
            yield from check.judge(name, message, place)
