"""The view: batches of a run are sent to a Rerun recording in columns."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
import rerun as rr

from symtop_ros.base.arrays import Real, axis_of, rotate
from symtop_ros.physics import Motion, State, Top
from symtop_ros.replay.view import entities, quantities, surroundings, torques
from symtop_ros.replay.view.blueprint import Framing, create_blueprint
from symtop_ros.replay.view.ghost import GhostView
from symtop_ros.replay.view.plots import Plots, describe_motion, describe_nothing
from symtop_ros.replay.view.seen import send_points
from symtop_ros.run.log.batch import Batch, Columns, choose
from symtop_ros.run.log.intervals import Interval, Unknown
from symtop_ros.run.simulation.events import RESTARTS, Event
from symtop_ros.run.simulation.points import Points
from symtop_ros.run.simulation.segment import Segment
from symtop_ros.run.simulation.topics import SAMPLE_TOPICS


@dataclass(frozen=True, slots=True)
class Arrow:
    """An arrow of the scene."""

    entity: str  # path of the entity
    label: str
    unit: str
    color: tuple[int, int, int]
    length: float  # length of the first vector in scene units
    quantity: str  # name of the vector in the format of its topic


ARROWS = {
    "angular_momentum": Arrow(entities.MOMENTUM, "L", "N m s", entities.BLUE, 1.45, "vector"),
    "angular_velocity": Arrow(entities.VELOCITY, "omega", "rad/s", entities.GREEN, 1.2, "angular"),
    "torque": Arrow(entities.TORQUE, "torque", "N m", entities.RED, 0.6, "torque"),
    "imu": Arrow(
        entities.SPECIFIC_FORCE, "a + g z'", "m/s^2", entities.VIOLET, 0.8, "linear_acceleration"
    ),
}


@dataclass(frozen=True, slots=True)
class ViewOptions:
    """Parts of the scene that can be left out. One that is off costs nothing."""

    ghost: bool = True  # the top without the last kick or clamp
    angles: bool = False  # both frames, the line of nodes, and the arcs of phi, theta and psi
    torques: bool = False  # arrows of dL/dt and of the inertial torque in two frames
    fictitious: bool = False  # arrows of the torques that an observer sees who precesses along


DEFAULT_OPTIONS = ViewOptions()


class View:
    """A Rerun recording of one top."""

    def __init__(
        self,
        recording: rr.RecordingStream,
        live: bool = False,
        options: ViewOptions = DEFAULT_OPTIONS,
        unknown: Sequence[Interval] = (),  # in which the motion is not known, of a log
    ) -> None:
        self._stream = entities.Stream(recording)
        self._live = live
        self._options = options
        self._plots = Plots(self._stream)
        self._ghost = GhostView(self._stream) if options.ghost else None
        self._fictitious = torques.FictitiousView(self._stream) if options.fictitious else None
        self._has_cones = False
        self._unknown = Unknown(unknown)
        self._event: Event | None = None  # the last one
        self._segment: Segment | None = None  # None: the motion is not known
        self._framing: Framing | None = None
        self._top: Top | None = None
        self._scales: dict[str, float] = {}  # of each arrow: value of one scene unit
        self._trace = surroundings.Trace()
        if options.angles:
            surroundings.log_frames(self._stream)
        if options.torques:
            torques.log_styles(self._stream)
        self._stream.style_lines(entities.TRACE, entities.GOLD, 0.007)
        self._stream.style_lines(entities.NODES, entities.ORANGE, 0.005)

    @np.errstate(all="ignore")
    def send(self, batch: Batch) -> None:
        """Send a batch; numbers that cannot be drawn (nan) are not visible."""
        for event, columns in batch.intervals():
            if self._stream.origin is None:
                self._stream.origin = _first_stamp(event, columns)
            if columns:
                self._choose_scales(columns)
            if event:
                self._send_event(event)
            if columns and self._stream.origin is not None:
                self._send_columns(columns)

    @np.errstate(all="ignore")
    def send_points(self, points: Points, intervals: Sequence[Interval]) -> None:
        """Send measured points over the motions of some intervals."""
        send_points(self._stream, points, intervals)

    def log_text(self, sentence: str, level: str = "WARN") -> None:
        """Add a sentence to the list of events at the current time."""
        self._stream.log(entities.EVENTS, rr.TextLog(sentence, level=level))

    def close(self) -> None:
        """Send what is left, and end the recording."""
        self._stream.recording.disconnect()

    def _send_event(self, event: Event) -> None:
        previous = self._segment if _follows(event, self._event) else None
        is_new = event.name in RESTARTS or not (previous and event.has_motion_of(self._event))
        self._event, self._segment = event, event.segment()
        motion = self._segment.final_motion
        framing = Framing.of(self._segment).after(self._framing)
        before, self._framing = self._framing, framing
        if before is None or before.ranges != framing.ranges:
            self._send_layout(framing)
        self._stream.set_time(event.stamp)
        if self._top != motion.top:
            self._log_body(motion.top)
        if before is None or before.below_pivot != framing.below_pivot:
            surroundings.log_surroundings(self._stream, framing.below_pivot)
        if self._ghost:
            self._ghost.follow(event.name, previous, self._segment)
        self._send_cones(motion, event.state())
        self._plots.follow(event, previous, self._segment, is_new=is_new)
        self._stream.log(entities.CIRCLES, surroundings.turning_circles(motion.turning_angles))
        asked = "; ".join(f"{name}={text}" for name, text in event.request.items())
        self.log_text(f"{event.name}{f' ({asked})' if asked else ''}: {event.verdict}", "INFO")
        equations = dict(torques.EQUATIONS) if self._options.torques else {}
        if self._fictitious:
            equations |= self._fictitious.follow(motion.top, event.state())
        scales = self._name_scales()
        self._log_panel(describe_motion(self._segment, event.state(), scales, equations))
        if is_new:  # otherwise the previous sentence still holds
            self._log_sentence(event.verdict)

    def _log_panel(self, text: str) -> None:
        self._stream.log(entities.PANEL, rr.TextDocument(text, media_type="text/markdown"))

    def _log_sentence(self, text: str) -> None:
        self._stream.log(entities.SENTENCE, rr.TextDocument(text))

    def _name_scales(self) -> dict[str, str]:
        """Return what one scene unit is, by the labels of the arrows."""
        return {
            arrow.label: f"{self._scales[name]:g} {arrow.unit}"
            for name, arrow in ARROWS.items()
            if name in self._scales
        }

    def _send_cones(self, motion: Motion, state: State) -> None:
        """Draw the cones of a free motion; remove them when it ceases to be free."""
        scale = self._scales.get("angular_velocity")
        if surroundings.has_cones(motion) and scale:
            surroundings.log_cones(self._stream, motion, state, scale)
            self._has_cones = True
        else:
            self._remove_cones()

    def _remove_cones(self) -> None:
        if self._has_cones:
            for entity in (entities.POLHODE, entities.HERPOLHODE):
                self._stream.log(entity, rr.Clear(recursive=True))
            self._has_cones = False

    def _send_columns(self, columns: Mapping[str, Columns]) -> None:
        """Send the samples after an event: first those of which the motion is known."""
        end = min(map(self._find_end, columns.values()))
        if known := choose(columns, {n: each.stamps < end for n, each in columns.items()}):
            self._send_samples(known)
        if others := choose(columns, {n: each.stamps >= end for n, each in columns.items()}):
            self._remove_motion(others)
            self._send_samples(others)

    def _find_end(self, columns: Columns) -> float:
        """Return the first stamp of some samples at which the motion is not known."""
        unknown = self._unknown.find(columns.stamps, columns.places)
        return min(columns.stamps[unknown].tolist(), default=math.inf)

    def _remove_motion(self, columns: Mapping[str, Columns]) -> None:
        """Remove what is drawn of the motion: from these samples on it is not known."""
        if self._segment is None:
            return
        self._segment = None
        stamp, place = min((int(each.stamps[0]), int(each.places[0])) for each in columns.values())
        reason = self._unknown.explain(stamp, place)
        self._stream.set_time(stamp)
        self._plots.remove()
        if self._ghost:
            self._ghost.remove()
        if self._fictitious:
            self._fictitious.remove()
        self._remove_cones()
        self._stream.log(entities.CIRCLES, rr.Clear(recursive=False))
        self._log_panel(describe_nothing(reason, self._name_scales()))
        sentence = f"From here on the motion is not known: {reason}"
        self._log_sentence(sentence)
        self.log_text(sentence)

    def _send_samples(self, columns: Mapping[str, Columns]) -> None:
        if self._framing is None:  # there was no event: the top is unknown
            self._framing = Framing()
            self._send_layout(self._framing)
            self._log_body(None)
        if found := quantities.attitudes(columns):
            stamps, quaternions = found
            self._stream.send_turns(entities.BODY, stamps, quaternions)
            self._stream.send_lines(
                entities.TRACE, *self._trace.strips(stamps, axis_of(quaternions))
            )
            if self._ghost:
                self._ghost.send(stamps, self._trace.length)
        for name, arrow in ARROWS.items():
            if name in columns:
                vectors = _find_vectors(name, columns[name]) / self._scales[name]
                self._stream.send_arrows(arrow.entity, columns[name].stamps, vectors, vectors)
        if "euler_angles" in columns:
            euler = columns["euler_angles"]
            self._stream.send_lines(
                entities.NODES, euler.stamps, surroundings.line_of_nodes(euler.numbers[:, 0])
            )
            if self._options.angles:
                surroundings.send_angles(self._stream, euler)
            if self._fictitious:
                self._fictitious.send(euler)
        if self._options.torques and (parts := torques.Torques.of(columns)):
            torques.send_arrows(self._stream, *parts, self._scales["torque"])
        self._plots.send(columns, self._segment)

    def _choose_scales(self, columns: Mapping[str, Columns]) -> None:
        """Choose the scale of each arrow by its first vectors, and log its style."""
        for name, arrow in ARROWS.items():
            if name in columns and name not in self._scales:
                lengths = np.linalg.norm(_find_vectors(name, columns[name]), axis=1)
                self._scales[name] = float(f"{lengths.max() / arrow.length:.2g}") or 1.0
                self._stream.style_arrows(arrow.entity, arrow.color, 0.012, arrow.label)
                if name == "torque" and self._options.torques:
                    # One scale for all torques, so that their sum can be seen.
                    parts = torques.Torques.of(columns)
                    self._scales[name] = parts[1].find_scale() if parts else self._scales[name]

    def _send_layout(self, framing: Framing) -> None:
        self._trace.length = framing.trace
        self._stream.recording.send_blueprint(create_blueprint(framing, self._live))

    def _log_body(self, top: Top | None) -> None:
        self._top = top
        self._stream.log_mesh(entities.BODY, entities.create_body(top))


def _follows(event: Event, before: Event | None) -> bool:
    """Return True if no event is missing between two; those of old logs have no numbers."""
    return before is not None and (not event.number or event.number == before.number + 1)


def _find_vectors(topic: str, columns: Columns) -> Real:
    """Return the vectors of the arrow of a topic in the world frame, (n, 3)."""
    places = SAMPLE_TOPICS[topic].format.quantities
    vectors = columns.numbers[:, places[ARROWS[topic].quantity]]
    if topic == "imu":  # in the frame of the sensor
        x, y, z, w = columns.numbers[:, places["orientation"]].T
        return rotate(w, x, y, z, vectors)
    return vectors


def _first_stamp(event: Event | None, columns: Mapping[str, Columns]) -> int | None:
    """Return the stamp of the first sample, or of the event if there is no sample."""
    return min(
        (int(each.stamps[0]) for each in columns.values()), default=event.stamp if event else None
    )
