"""The top of the page: a local one, or a running node behind the same methods.

Both take the same requests and send the same events, so that the page need not know which it has.
"""

from __future__ import annotations

import threading
import time
from collections import deque
from collections.abc import Callable, Mapping, Sequence
from contextlib import AbstractContextManager
from pathlib import Path
from typing import Any, Protocol

import numpy as np

from symtop_ros.arrays import Vector
from symtop_ros.log.batch import Batch, Columns
from symtop_ros.log.recorder import Recorder
from symtop_ros.log.recording import Recording, limits_of
from symtop_ros.simulation.block import Block
from symtop_ros.simulation.events import Event
from symtop_ros.simulation.initial import initial_state
from symtop_ros.simulation.requests import Requests
from symtop_ros.simulation.settings import Settings
from symtop_ros.simulation.simulation import Simulation
from symtop_ros.simulation.topics import DESCRIPTION, EVENTS, STATE_TOPICS
from symtop_ros.simulation.validation import RefusedError
from symtop_ros.wire.cdr import encode_string
from symtop_ros.wire.layout import NANOSECONDS
from symtop_ros.wire.messages import Transform

Answer = tuple[bool, str]
Argument = Mapping[str, Any] | bool | None
# The topic of the samples: with the motion of the last event it gives all others.
DRAWN = "orientation"
LONGEST_STEP = 0.05  # s of the clock in one batch; a browser that is slow makes the motion slow
TORQUE_TIMEOUT = 0.3  # s; a held button repeats its torque 20 times a second, but not exactly
SAMPLES = 2000  # that are kept for the next batch: 10 s at 200 Hz


class Source(Protocol):
    """A top that can be asked and watched. Methods may be called from any thread."""

    @property
    def name(self) -> str:
        """Name of the top for people."""

    def request(self, name: str, argument: Argument = None) -> Answer:
        """Send a request of the interface; return success and the answer."""

    def set_parameters(self, values: Mapping[str, Any]) -> Answer:
        """Set parameters by their full names, all or none; return success and the answer."""

    def hold_torque(self, torque: Vector) -> None:
        """Apply a torque (N m, world frame) until its time-out."""

    def watch(self, watched: bool) -> None:
        """Begin or cease to take samples. An unwatched top costs nothing."""

    def batch(self) -> Batch:
        """Return the events and samples (topic `DRAWN`) since the last call."""

    def reports(self) -> list[str]:
        """Return the sentences for the user since the last call: warnings and failures."""

    @property
    def log(self) -> Path | None:
        """Path of the log that was finished last, if it is on this machine."""

    def close(self) -> None:
        """End a recording and all threads."""


class PageClock:
    """A clock that advances only while the page asks: the top waits while no page is open.

    It never advances by more than `LONGEST_STEP` at once, so that a machine under load shows a
    slower motion and not one with gaps.
    """

    def __init__(self) -> None:
        self.now, self.is_simulated = time.time_ns(), True
        self._last: float | None = None

    def advance(self) -> None:
        """Advance by the time since the last call."""
        last, self._last = self._last, time.monotonic()
        if last is not None:
            self.now += round(min(self._last - last, LONGEST_STEP) * NANOSECONDS)

    def rest(self) -> None:
        """Do not count the time until the next call of `advance`."""
        self._last = None


class Collector:
    """The sink of a simulation in this process: keeps what is drawn, and logs if asked to."""

    def __init__(self, recorder: Recorder, settings: Settings) -> None:
        self.is_open, self.publishes_tf, self.is_watched = True, False, True
        self._frame = settings.world_frame
        frames = settings.world_frame, settings.top_frame
        self._recorder = recorder
        self._channels = {
            topic.name: recorder.add_channel(topic.resolve("/top"), topic)
            for topic in (EVENTS, DESCRIPTION, *STATE_TOPICS.values())
        }
        self._layouts = {name: topic.layout(*frames) for name, topic in STATE_TOPICS.items()}
        self._samples: deque[tuple[int, int, list[float]]] = deque(maxlen=SAMPLES)
        self._events: deque[tuple[int, Event]] = deque()
        self._count = 0
        self.reports: deque[str] = deque(maxlen=20)  # sentences for the user

    def send_sample(self, stamp: int, block: Block) -> None:
        """Keep the sample of a stamp (ns), and log it."""
        self._count += 1
        if self.is_watched:
            self._samples.append((self._count, stamp, block.numbers(DRAWN, stamp)))
        if self._recorder.running:
            for name, layout in self._layouts.items():
                data = layout.encode(stamp, block.numbers(name, stamp))
                self._recorder.add(self._channels[name], stamp, data)

    def send_event(self, event: Event) -> None:
        """Keep an event, and log it."""
        self._count += 1
        self._events.append((self._count, event))
        self._recorder.add(self._channels[EVENTS.name], event.stamp, event.encode(self._frame))

    def send_description(self, stamp: int, urdf: str) -> None:
        """Log the URDF of the top."""
        self._recorder.add(self._channels[DESCRIPTION.name], stamp, encode_string(urdf))

    def send_fixed_frames(self, stamp: int, transforms: Sequence[Transform]) -> None:
        """Leave out frames on the body: the top of a page has no sensor."""

    def put_events_first(self) -> AbstractContextManager[None]:
        """In the log, put the events sent in this context before its samples."""
        return self._recorder.put_first(self._channels[EVENTS.name])

    def warn(self, text: str) -> None:
        """Keep a warning for the user."""
        self.reports.append(text)

    def report_error(self, text: str) -> None:
        """Keep an error for the user."""
        self.reports.append(text)

    def batch(self) -> Batch:
        """Return what was collected since the last call."""
        samples = [self._samples.popleft() for _ in range(len(self._samples))]
        events = [self._events.popleft() for _ in range(len(self._events))]
        columns = {}
        if samples:
            places, stamps, rows = zip(*samples, strict=True)
            columns[DRAWN] = Columns(np.array(stamps, np.int64), np.array(rows), np.array(places))
        return Batch(columns, events)


class LocalTop:
    """A top in this process. Needs no ROS."""

    name = "local top"

    def __init__(self, scene: str, factor: float) -> None:
        settings = Settings.from_scene(
            scene, real_time_factor=factor, applied_torque_timeout=TORQUE_TIMEOUT
        )
        self._clock = PageClock()
        self._recorder = Recorder(Path(settings.record.directory), limits_of(settings.record))
        self._sink = Collector(self._recorder, settings)
        self._simulation = Simulation(settings, self._clock, self._sink)
        start, verdict = self._simulation.start, self._simulation.verdict
        self._simulation.announce("start", verdict, {"scene": scene}, start)
        environment = {"scene": scene, "program": "top_panel"}
        self.recording = Recording(
            self._recorder, self._simulation, environment, lambda text, _: self._sink.warn(text)
        )
        requests = Requests(self._simulation)
        self._acts: dict[str, Callable[[Any], str]] = {
            "set_initial_conditions": requests.set_initial_conditions,
            "kick": requests.kick,
            "step": requests.step,
            "pause": requests.pause,
            "reset": lambda _: requests.reset(),
            "record": self.recording.switch,
        }
        self.log: Path | None = None
        self._upkept = 0.0
        self._lock = threading.Lock()  # the page's thread and that of a request may end a batch

    def request(self, name: str, argument: Argument = None) -> Answer:
        """Carry out a request; see `Source`."""
        act, recorded = self._acts[name], self._recorder.path
        granted, answer = self._simulation.answer(name, lambda: act(argument))
        if name == "record" and not argument and granted:
            self.log = recorded
        return granted, answer

    def set_parameters(self, values: Mapping[str, Any]) -> Answer:
        """Set parameters; see `Source`."""

        def act() -> str:
            simulation = self._simulation
            settings = Settings.from_values({**simulation.settings.values, **values})
            initial_state(settings.top, settings.initial, {})  # may have no such root
            simulation.apply_settings(settings)
            return ""

        return self._simulation.answer("set_parameters", act)

    def hold_torque(self, torque: Vector) -> None:
        """Apply a torque; see `Source`."""
        with self._simulation.turn("~/applied_torque"):
            try:
                self._simulation.hold_torque(torque)
            except RefusedError as refusal:
                self._sink.warn(str(refusal))

    def watch(self, watched: bool) -> None:
        """Let the clock run, or rest; see `Source`."""
        self._sink.is_watched = watched
        self._clock.rest()

    def batch(self) -> Batch:
        """Advance the clock and return what happened; see `Source`."""
        with self._lock:
            if self._sink.is_watched:
                self._clock.advance()
                self._tick()
                self._keep_up()
            return self._sink.batch()

    def _tick(self) -> None:
        """Publish what is due: a tick publishes one block, or integrates for a bounded time."""
        deadline = time.perf_counter() + LONGEST_STEP
        while (wait := self._simulation.tick()) is not None and wait <= 0.0:
            if time.perf_counter() > deadline:
                return

    def _keep_up(self) -> None:
        """Do once a second what a timer of the node does."""
        now = time.monotonic()
        if now - self._upkept > 1.0:
            self._upkept = now
            with self._simulation.turn("upkeep"):
                self._simulation.speed_up()
                self.recording.report_failure()

    def reports(self) -> list[str]:
        """Return warnings and failures; see `Source`."""
        return [self._sink.reports.popleft() for _ in range(len(self._sink.reports))]

    def close(self) -> None:
        """End a recording; see `Source`."""
        self._sink.is_open = False
        self._recorder.stop()
