"""A simulation with a clock and a sink of the test: no ROS."""

import contextlib
from collections.abc import Iterator
from typing import Any

from symtop_ros.base.arrays import Real, Stamps
from symtop_ros.run.session.session import Requests
from symtop_ros.run.simulation.block import Block
from symtop_ros.run.simulation.budget import ComputeBudget
from symtop_ros.run.simulation.changes.outcomes import Failure
from symtop_ros.run.simulation.events import Event
from symtop_ros.run.simulation.own_time import simulate
from symtop_ros.run.simulation.settings import Settings

SECOND = 1_000_000_000


class HandClock:
    """A clock that is set by hand."""

    def __init__(self) -> None:
        self.now, self.is_simulated = 0, True
        self.set_forward = 0  # ns by which it was set

    @property
    def steady(self) -> int:
        return self.now - self.set_forward


class ListSink:
    """Keeps everything that it is sent."""

    def __init__(self) -> None:
        self.is_open = True
        self.samples: list[tuple[int, list[float]]] = []  # stamp and orientation x, y, z, w
        self.events: list[Event] = []
        self.order: list[str] = []  # of events and samples, as a log would have it
        self.descriptions: list[Settings] = []
        self.warnings: list[str] = []
        self.errors: list[str] = []

    def encode(self, topic: str, stamps: Stamps, numbers: Real) -> list[bytes]:
        return [b""] * len(stamps)

    def send_sample(self, stamp: int, block: Block) -> None:
        self.samples.append((stamp, block.numbers("orientation", stamp)))
        self.order.append("sample")

    def send_event(self, event: Event) -> None:
        self.events.append(event)
        self.order.append(event.name)

    def send_description(self, stamp: int, settings: Settings) -> None:
        self.descriptions.append(settings)

    @contextlib.contextmanager
    def put_events_first(self) -> Iterator[None]:
        begin = len(self.order)
        yield
        self.order[begin:] = sorted(self.order[begin:], key=lambda name: name == "sample")

    def inform(self, text: str) -> None:
        raise AssertionError

    def warn(self, text: str) -> None:
        self.warnings.append(text)

    def report_error(self, text: str) -> None:
        self.errors.append(text)

    def fail(self, failure: Failure) -> None:
        raise AssertionError(str(failure))


class Run:
    """A simulation of a scene with its requests, after some seconds."""

    def __init__(
        self,
        scene: str = "cusps",
        seconds: float = 0.0,
        sink: ListSink | None = None,
        **changes: Any,
    ) -> None:
        self.clock, self.sink = HandClock(), sink or ListSink()
        settings = Settings.from_scene(scene, **changes)
        self.simulation = simulate(settings, self.clock, self.sink, self.sink)
        self.simulation.budget = ComputeBudget(lambda: 0.0)  # a machine that is fast enough
        self.simulation.apply(self.simulation.timeline.announce("test"))
        self.requests = Requests(self.simulation, lambda on: "not recording")
        self.advance(seconds)

    def advance(self, seconds: float, step: float = 0.005) -> None:
        """Advance the clock in steps and tick after each."""
        for _ in range(round(seconds / step)):
            self.clock.now += round(step * SECOND)
            self.tick()

    def jump(self, now: int) -> None:
        """Set the clock (ns), as the node does it."""
        self.simulation.begin_jump()
        self.clock.now = now
        self.simulation.end_jump(True)

    def tick(self) -> None:
        """Publish everything that is due, as the pacing of the node does."""
        while (wait := self.simulation.tick()) is not None and wait <= 0.0:
            pass

    def change(self, changes: dict[str, Any]) -> None:
        """Set some parameters."""
        settings = Settings.from_values({**self.simulation.settings.values, **changes})
        self.simulation.take_turn("parameters", lambda: self.simulation.apply_settings(settings))

    def push(self, torque: tuple[float, float, float]) -> None:
        """Hold a torque (N m), as the node does it."""
        self.simulation.take_turn("torque", lambda: self.simulation.hold_torque(torque))

    @property
    def stamps(self) -> list[int]:
        """The stamps of the samples."""
        return [stamp for stamp, _ in self.sink.samples]

    def assert_recomputed(self) -> None:
        """Each sample is the one of the last event before it, bit for bit."""
        assert self.sink.samples
        segments = [event.segment() for event in self.sink.events]
        for stamp, numbers in self.sink.samples:
            segment = [each for each in segments if each.stamp <= stamp][-1]
            w, x, y, z = segment.state_at(stamp).orientation.tolist()
            assert numbers == [x, y, z, w]

    def ask(self, name: str, argument: Any = None) -> tuple[bool, str]:
        """Carry out a request by its name; return success and the answer."""
        return self.simulation.answer(name, self.requests.find(name, lambda: argument))
