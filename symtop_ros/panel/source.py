"""The top of the page: a local one, or a running node behind the same methods.

Both take the same requests and send the same events, so that the page need not know which it has.
"""

import threading
import time
from collections import deque
from collections.abc import Mapping
from itertools import count
from pathlib import Path
from typing import Any, Protocol

import numpy as np

from symtop_ros.arrays import Vector
from symtop_ros.log.batch import Batch, Columns
from symtop_ros.session.session import Answer, Session
from symtop_ros.simulation.block import Block
from symtop_ros.simulation.events import Event
from symtop_ros.simulation.settings import Settings
from symtop_ros.simulation.simulation import AT_ONCE
from symtop_ros.simulation.topics import Topic
from symtop_ros.web.run import DRAWN
from symtop_ros.wire.diagnostics import Status
from symtop_ros.wire.layout import NANOSECONDS

Argument = Mapping[str, Any] | bool | None
LONGEST_STEP = 0.05  # s of the clock in one batch; a browser that is slow makes the motion slow
TORQUE_TIMEOUT = 0.3  # s; a held button repeats its torque 20 times a second, but not exactly
SAMPLES = 2000  # that are kept for the next batch: 10 s at 200 Hz


class Source(Protocol):
    """A top that can be asked and watched. Methods may be called from any thread."""

    is_own: bool  # True if the top belongs to its pages, and waits while none is open

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


class LocalTop:
    """A top in this process, which is the host of its session; see `Source` for the methods."""

    name, is_own = "local top", True

    def __init__(self, scene: str, factor: float) -> None:
        settings = Settings.from_scene(
            scene, real_time_factor=factor, applied_torque_timeout=TORQUE_TIMEOUT
        )
        self.is_open = True
        self.log: Path | None = None
        self._is_watched = True
        # Samples and events with their places in the order of both.
        self._samples: deque[tuple[int, int, list[float]]] = deque(maxlen=SAMPLES)
        self._events: deque[tuple[int, Event]] = deque()
        self._places = count()
        self._reports: deque[str] = deque(maxlen=20)
        self._clock = PageClock()
        self._session = Session(settings, self._clock, self, scene, {"program": "top_panel"})
        self._upkept = 0.0
        self._lock = threading.Lock()  # the page's thread and that of a request may end a batch

    # As a host

    def resolve(self, topic: Topic) -> str:
        """Return the name that the topic of a node /top has."""
        return topic.resolve("/top")

    def create_publisher_of(self, topic: Topic) -> None:
        """Return None: topics are only logged."""

    def watch_sample(self, stamp: int, block: Block) -> None:
        """Keep what is drawn."""
        if self._is_watched:
            self._samples.append((next(self._places), stamp, block.numbers(DRAWN, stamp)))

    def watch_event(self, event: Event) -> None:
        """Keep an event."""
        self._events.append((next(self._places), event))

    def update_statuses(self) -> list[Status]:
        """Return nothing: a page adds no diagnostics."""
        return []

    def inform(self, text: str) -> None:
        """Do nothing: answers and events say it too."""

    def warn(self, text: str) -> None:
        """Keep a warning or an error for the user."""
        self._reports.append(text)

    report_error = warn

    # As a source

    def request(self, name: str, argument: Argument = None) -> Answer:
        """Carry out a request."""
        recorded = self._session.recording.path
        granted, answer = self._session.answer(name, lambda: argument)
        if name == "record" and not argument and granted:
            self.log = recorded
        return granted, answer

    def set_parameters(self, values: Mapping[str, Any]) -> Answer:
        """Set parameters."""

        def act() -> str:
            self._session.apply_settings(values)
            return ""

        return self._session.simulation.answer("set_parameters", act)

    def hold_torque(self, torque: Vector) -> None:
        """Apply a torque."""
        reason = self._session.hold_torque(torque)
        if reason:
            self.warn(reason)

    def watch(self, watched: bool) -> None:
        """Let the clock run, or rest."""
        self._is_watched = watched
        self._clock.rest()

    def batch(self) -> Batch:
        """Advance the clock and return what happened."""
        with self._lock:
            if self._is_watched:
                self._clock.advance()
                self._tick()
                self._keep_up()
            # Between turns: a kick sends its first sample some time before its event.
            with self._session.simulation.turn("batch"):
                return self._collect()

    def _collect(self) -> Batch:
        samples = [self._samples.popleft() for _ in range(len(self._samples))]
        events = [self._events.popleft() for _ in range(len(self._events))]
        columns = {}
        if samples:
            places, stamps, rows = zip(*samples, strict=True)
            columns[DRAWN] = Columns(np.array(stamps, np.int64), np.array(rows), np.array(places))
        return Batch(columns, events)

    def _tick(self) -> None:
        """Publish what is due: a tick publishes one block, or integrates for a bounded time."""
        deadline = time.perf_counter() + LONGEST_STEP
        while (wait := self._session.simulation.tick()) is not None and wait <= AT_ONCE:
            if time.perf_counter() > deadline:
                return

    def _keep_up(self) -> None:
        """Do once a second what a timer of the node does."""
        now = time.monotonic()
        if now - self._upkept > 1.0:
            self._upkept = now
            self._session.keep_up()

    def reports(self) -> list[str]:
        """Return warnings and failures."""
        return [self._reports.popleft() for _ in range(len(self._reports))]

    def close(self) -> None:
        """End a recording."""
        self.is_open = False
        self._session.close()
