"""Kicks of a session without a middleware: how long the first sample and the whole request take.

Code that has not run for a while is no longer in the caches of the processor. So there are two
series: kicks that follow each other at once, and kicks after a pause with samples in it.
"""

import time
from statistics import median

from symtop_ros.run.session.run_log import SetClock, Silent
from symtop_ros.run.session.session import Session
from symtop_ros.run.simulation.settings import Settings
from symtop_ros.run.simulation.topics import SAMPLE_TOPICS, Topic

KICKS = 300
RATE = 1000.0  # Hz
PERIOD = 1_000_000  # ns
PAUSE = 14  # periods


class Clock(SetClock):
    """The time of the session, which advances period by period."""

    is_simulated = False


class Subscriber:
    """Receives a topic, and notes when its first message came."""

    has_subscriber = True

    def __init__(self) -> None:
        self.first: float | None = None  # s

    def publish(self, _: bytes) -> None:
        """Note the time if this is the first message."""
        if self.first is None:
            self.first = time.perf_counter()


class Listening(Silent):
    """The host of a session whose topics have a subscriber each."""

    def __init__(self) -> None:
        super().__init__()
        self.orientation = Subscriber()

    def create_publisher_of(self, topic: Topic) -> Subscriber:
        """Return a publisher that has a subscriber."""
        return self.orientation if topic is SAMPLE_TOPICS["orientation"] else Subscriber()


def measure() -> dict[str, float]:
    """Return the medians in ms by their rows."""
    settings = Settings.from_scene("cusps", publish_rate=RATE, hurry_factor=1.0)
    clock, host = Clock(), Listening()
    session = Session(settings, clock, host, "cusps", {})
    rows = {}
    for when, pause in (("at once", 0), (f"after {PAUSE} ms", PAUSE)):
        kicks = [_kick(session, clock, host.orientation, pause) for _ in range(KICKS)]
        for what, times in zip(("first sample", "answer"), zip(*kicks, strict=True), strict=True):
            rows[f"without a middleware, kick {when}: to {what}, ms"] = 1e3 * median(times)
    session.close()
    return rows


def _kick(
    session: Session, clock: Clock, orientation: Subscriber, pause: int
) -> tuple[float, float]:
    """Return the times in s from a request to its first sample, and to its answer."""
    for _ in range(pause):
        time.sleep(1e-9 * PERIOD)
        clock.now = clock.steady = clock.now + PERIOD
        session.simulation.tick()
    clock.now = clock.steady = clock.now + PERIOD  # a sample is due
    orientation.first = None
    began = time.perf_counter()
    session.answer("hurry_precession", dict)
    end = time.perf_counter()
    assert orientation.first is not None
    return orientation.first - began, end - began
