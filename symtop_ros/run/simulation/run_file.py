"""Runs as the page keeps them (`run.json`): events, each with the motion that follows it.

The time of such a run is that of its motion, in whole nanoseconds: pauses and the speed at which a
top is watched leave no trace in it.
"""

import json
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import astuple, dataclass, replace
from fractions import Fraction
from pathlib import Path
from typing import Any

from symtop_ros.base.refusals import RefusedError, one_line, refuse, show, validate_names
from symtop_ros.physics import Body, ExactTimes, Friction, Motion, State, Top
from symtop_ros.run.simulation.changes.requests import (
    KICK_FIELDS,
    find_hold,
    name_pushes,
    read_kick,
    read_pushes,
)
from symtop_ros.run.simulation.events import BODY, KICKS, MOTION, RELEASE, RESTARTS, Event
from symtop_ros.run.simulation.fields import TABLE, read_field
from symtop_ros.run.simulation.points import Points, read_points
from symtop_ros.run.simulation.segment import Segment
from symtop_ros.run.simulation.settings import PARAMETERS
from symtop_ros.run.wire.layout import NANOSECONDS

# A time is at most 4e6 s: up to there a double in s has its own ns.
FORMATS: list[int] = TABLE["formats"]  # that are read
# Formats, by the content that readers of the previous format do not know. A run without this
# content keeps the previous format, which more versions read.
PLAIN, CLAMPED, WEIGHED, MEASURED = FORMATS[1:]
# Mass and gravity of a body in events that do not state them.
ASSUMED = {name: TABLE["event"][name]["absent"] for name in BODY}
KINDS: list[str] = TABLE["event"]["kind"]["words"]
ACTS = ("start", *KICKS, "clamp", "unclamp")
MAX_BYTES = 100_000_000
RATE: float = PARAMETERS["publish_rate"].default  # Hz, of the log that is written of a run


@dataclass(frozen=True, slots=True)
class RunEvent:
    """An event of a run, and the motion that follows it."""

    kind: str  # one of `KINDS`, or `RELEASE`
    time: int  # ns of the run
    motion: Motion
    act: Mapping[str, Any]  # of a kick or a push, the fields of ~/kick; else empty
    mass: float = ASSUMED["mass"]  # kg; 0: a body is chosen
    gravity: float = ASSUMED["gravity"]  # m/s^2

    def end_pushes(self, time: int) -> "RunEvent":
        """Return the event with the pushes that were given up to a time in ns of the run."""
        if not self.motion.pushes:
            return self
        given = self.motion.piece_at(ExactTimes(time - self.time)).number
        motion = self.motion.end_pushes(given)
        return replace(self, motion=motion, act={**self.act, "number": given})

    @property
    def body(self) -> dict[str, float]:
        """Mass and gravity that are not those of a body that is chosen."""
        given = {name: getattr(self, name) for name in BODY}
        return {name: value for name, value in given.items() if value != ASSUMED[name]}

    def to_json(self) -> dict[str, Any]:
        """Return the event as it stands in run.json."""
        motion = self.motion
        start = self.motion.start
        return {
            "kind": self.kind,
            "time": self.time / NANOSECONDS,
            "top": motion.top.moments,
            "orientation": start.given_orientation.tolist(),
            "angular_velocity": start.angular_velocity.tolist(),
            "friction": astuple(motion.friction),
            "torque": motion.applied_torque,
            **({"clamped": True} if motion.clamped else {}),
            **self.body,
            **({"act": self.act} if self.act else {}),
            **({"hold": find_hold(self.act)} if self.kind == "kick" else {}),
        }


class RunRecorder:
    """Follows the events of a node or of a log, and gives those that belong into run.json."""

    def __init__(self) -> None:
        self._segment: Segment | None = None
        self._values: Mapping[str, str] = {}
        self._begin = Fraction(0)  # time of the run (ns) at which the present motion began

    def add(self, event: Event) -> RunEvent | None:
        """Follow an event; None if it changes no motion, such as a pause.

        An end of pushes is no event of a run, but a number of that before it (`end_pushes`).
        """
        if event.name == RELEASE and self._segment:
            self._segment = event.segment()
            self._values = event.values
            return RunEvent(RELEASE, self.time_at(event.stamp), self._segment.motion, {})
        segment = event.segment()
        previous = self._segment
        values = event.values
        is_new = event.name in RESTARTS or any(
            values.get(k) != self._values.get(k) for k in (*MOTION, *BODY)
        )
        if previous and is_new:
            # Within one motion its own time counts, in pauses, steps and jumps of the clock too.
            self._begin += previous.elapsed_at(event.previous_end) - segment.elapsed
        self._segment, self._values = segment, values
        if not is_new:
            return None
        kind = "start" if previous is None or event.name in RESTARTS else event.name
        act = _read_act(event, segment.motion) if kind in KICKS else {}
        if kind not in KINDS or (kind in KICKS and not act):
            kind = "change"
        time, rig = max(0, round(self._begin)), segment.rig
        return RunEvent(kind, time, segment.motion, act, rig.mass, rig.gravity)

    def time_at(self, stamp: int) -> int:
        """Return the time of the run (ns) at a stamp (ns) after the last event."""
        return round(self._begin + (self._segment.elapsed_at(stamp) if self._segment else 0))


def _read_act(event: Event, motion: Motion) -> dict[str, Any]:
    """Return the fields of a kick; none if a log has some that cannot be read."""
    if motion.pushes:
        return name_pushes(motion.pushes)
    given = event.request.items()
    try:
        act = read_kick({name: text for name, text in given if name in KICK_FIELDS and text})
        find_hold(act)
    except ValueError:
        return {}
    return act


def record_run(events: Iterable[Event], stamp: int) -> tuple[list[RunEvent], int]:
    """Return the run of the events of a log, and the time in ns that it has at a stamp (ns)."""
    recorder = RunRecorder()
    found = list[RunEvent]()
    for event in filter(None, map(recorder.add, events)):
        kind = event.kind
        found[-1:] = [each.end_pushes(event.time) for each in found[-1:]]
        if kind == RELEASE:
            continue
        # A change of several parameters at once is a sequence of events; the last one holds.
        if len(found) > 1 and found[-1].time == event.time and found[-1].kind not in ACTS:
            kind = kind if found.pop().kind == kind or kind in ACTS else "change"
        found.append(replace(event, kind=kind))
    return found, max(recorder.time_at(stamp), *(event.time for event in found[-1:]), 0)


def write_run(events: Iterable[RunEvent], end: int, points: Points | None = None) -> dict[str, Any]:
    """Return the content of run.json, of a run that has reached a time in ns."""
    listed = [*events]
    return {
        "format": MEASURED if points else _find_format(listed),
        "events": [event.to_json() for event in listed],
        "end": end / NANOSECONDS,
        **({"points": points.to_json()} if points else {}),
    }


def _find_format(events: Sequence[RunEvent]) -> int:
    if any(event.body for event in events):
        return WEIGHED
    return CLAMPED if any(event.motion.clamped for event in events) else PLAIN


def read_run(path: Path) -> tuple[list[RunEvent], int, Points | None]:
    """Return the events of run.json, the time in ns that it has reached, and its measured points.

    Raises
    ------
    RefusedError
        If the file is no run; the text names what is wrong.
    OSError
        If it cannot be read.
    """
    with path.open("rb") as file:
        data = file.read(MAX_BYTES)
    try:
        content = json.loads(data)
    except (ValueError, RecursionError):
        content = None
    if not isinstance(content, dict) or content.get("format") not in FORMATS:
        known = f"run.json, format {' or '.join(map(str, FORMATS))}"
        found = f", got format {show(content['format'])}" if _has_format(content) else ""
        raise RefusedError(f"{path} must be a run of the page ({known}){found}")
    given = content.get("events")
    if not isinstance(given, list) or not given:
        raise refuse("events", "a list with a start at its beginning", given)
    if len(given) > TABLE["most"]:
        raise refuse("events", f"a list of at most {TABLE['most']}", len(given))
    events = _read_events(given)
    end = read_field("end", {**TABLE["end"], "absent": 0.0}, content)
    points = read_points(content["points"]) if "points" in content else None
    seen = int(points.stamps[-1]) if points else 0
    return events, max(events[-1].time, round(end * NANOSECONDS), seen), points


def _has_format(content: Any) -> bool:
    return isinstance(content, dict) and isinstance(content.get("format"), int)


def _read_events(given: list[Any]) -> list[RunEvent]:
    events: list[RunEvent] = []
    for place, each in enumerate(given):
        try:
            events.append(_read_event(each if isinstance(each, dict) else {}, events))
        except ValueError as error:  # those of a top and a state too
            raise RefusedError(f"events[{place}]: {one_line(error)}") from None
    return events


def _read_event(given: Mapping[str, Any], before: Sequence[RunEvent]) -> RunEvent:
    values = {name: read_field(name, field, given) for name, field in TABLE["event"].items()}
    kind = values["kind"]
    time = round(values["time"] * NANOSECONDS)
    if not before and kind != "start":
        raise refuse("kind", '"start" for the first event', kind)
    if before and time < before[-1].time:
        raise refuse("time", "at least that of the previous event", values["time"])
    act = _read_kick(given.get("act")) if kind in KICKS else {}
    top = Top(*values["top"])
    start = State(values["orientation"], values["angular_velocity"])
    pushes = read_pushes(act) if kind == "push" else None
    acting = Friction(*values["friction"]), values["torque"], pushes, values["clamped"]
    motion = Motion(top, start, *acting)
    mass, gravity = values["mass"], values["gravity"]
    if mass:
        Body.from_top(top, gravity, mass)  # refuses one that is too small
    return RunEvent(kind, time, motion, name_pushes(pushes) if pushes else act, mass, gravity)


def _read_kick(given: Any) -> Mapping[str, Any]:
    if not isinstance(given, dict):
        raise refuse("act", "the fields of a kick", given)
    validate_names(given, TABLE["act"])
    return {name: read_field(name, TABLE["act"][name], given) for name in given}
