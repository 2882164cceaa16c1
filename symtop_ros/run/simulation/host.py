"""The surroundings of a simulation: its clock, its program, and where samples go."""

from contextlib import AbstractContextManager
from typing import Protocol

from symtop_ros.base.arrays import Real, Stamps
from symtop_ros.run.simulation.block import Block
from symtop_ros.run.simulation.changes.outcomes import Failure
from symtop_ros.run.simulation.events import Event
from symtop_ros.run.simulation.settings import Settings


class Clock(Protocol):
    """Source of the stamps."""

    @property
    def now(self) -> int:
        """Current time in ns."""

    @property
    def is_simulated(self) -> bool:
        """True if the time is set from outside (use_sim_time)."""

    @property
    def steady(self) -> int:
        """Time in ns of a clock that cannot be set: it shows when this clock was set."""


class Host(Protocol):
    """The program around a run: the node, or what writes the log of a run of the page."""

    @property
    def is_open(self) -> bool:
        """False when the program is shutting down and nothing can be sent."""

    def inform(self, text: str) -> None:
        """Inform the user."""

    def warn(self, text: str) -> None:
        """Warn the user."""

    def report_error(self, text: str) -> None:
        """Report an error to the user."""

    def fail(self, failure: Failure) -> None:
        """Report that an unexpected exception has ended the run."""


class Sink(Protocol):
    """Destination of samples and events."""

    def encode(self, topic: str, stamps: Stamps, numbers: Real) -> list[bytes]:
        """Encode samples of a topic from their stamps (n,) in ns and their doubles (n, width)."""

    def send_sample(self, stamp: int, block: Block) -> None:
        """Send the sample of a stamp (ns) on all topics that somebody needs."""

    def send_event(self, event: Event) -> None:
        """Send an event."""

    def send_description(self, stamp: int, settings: Settings) -> None:
        """Send the description of the top and its fixed frames."""

    def put_events_first(self) -> AbstractContextManager[None]:
        """In the log, put the events sent in this context before its samples."""
