"""The news of a running node for the pages: its events, its attitude, and its silence.

Knows no ROS: `bridge` tells what comes from the node, and each page follows.
"""

import threading
import time
from collections import deque
from collections.abc import Callable, Iterator, Sequence
from functools import partial
from typing import Any

from symtop_ros.run.simulation.events import Event
from symtop_ros.run.simulation.run_file import RunRecorder

SILENCE = 2.0  # s without samples after which the page says so
PERIOD = 1 / 60  # s between two messages to a page
ALIVE = 2.0  # s after which a page without news is sent an empty message: a closed one is noticed
KEPT = 200  # events of a run that a page is sent when it is opened

Message = dict[str, Any]
Sample = tuple[int, Sequence[float]]  # stamp in ns, and the orientation x, y, z, w
Place = tuple[int, int, Message]  # what a page was sent: run, number of its events, and state


class News:
    """The news of a node (full name) for its pages. Methods may be called from any thread."""

    def __init__(self, name: str, clock: Callable[[], float] = time.monotonic) -> None:
        self.name, self._clock = name, clock
        self._ending = threading.Event()
        self._changed = threading.Condition()  # guards all that follows
        self.pages = 0  # that follow
        self.last: Event | None = None  # the newest event of the node
        self._recorder = RunRecorder()
        self._events: deque[Message] = deque(maxlen=KEPT)  # of this run, each as a message
        self._count = 0  # events of this run
        self._runs = 0  # runs that have begun; a page with another number has an old one
        self._sample: Message = {}
        self._heard = clock()
        self._lost = False

    def follow(self) -> Iterator[Message]:
        """Yield what is new for one page, as soon as the page has taken what was before.

        A page that does not keep up gets fewer samples, and all events.
        """
        place: Place = (-1, 0, {})
        with self._changed:
            self.pages += 1
        try:
            while not self._ending.is_set():
                with self._changed:
                    message = self._changed.wait_for(partial(self._list_news, place), ALIVE)
                    place = self._place
                yield message
                self._ending.wait(PERIOD)
        finally:
            with self._changed:
                self.pages -= 1

    def expect(self) -> None:
        """Count the silence from now on: samples were asked for."""
        with self._changed:
            self._heard = self._clock()

    def tell(self, events: Sequence[Event], sample: Sample | None, is_expected: bool) -> None:
        """Let the pages know what has come; `is_expected` if samples were asked for."""
        with self._changed:
            for event in events:
                self._add_event(event)
            if sample:
                self._add_sample(*sample)
            # with publish_clock a pause has no samples
            if sample or (self.last and not self.last.segment().running):
                self._heard = self._clock()
            self._lost = is_expected and self._clock() > self._heard + SILENCE
            self._changed.notify_all()

    def close(self) -> None:
        """End what the pages follow."""
        self._ending.set()

    def _list_news(self, place: Place) -> Message:
        """Return what a page has not been sent; nothing if it has all."""
        if place == self._place:
            return {}
        run, count, _ = place
        message = self._state
        is_new = run != self._runs
        missed = self._count if is_new else self._count - count
        return message | {"new": is_new, "events": [*self._events][-missed:]} if missed else message

    @property
    def _place(self) -> Place:
        return self._runs, self._count, self._state

    @property
    def _state(self) -> Message:
        lost = (
            f"no samples from {self.name} for {SILENCE:g} s: is top_node running, with the same "
            "ROS_DOMAIN_ID and --node?"
        )
        return {**self._sample, "lost": lost if self._lost else None}

    def _add_event(self, event: Event) -> None:
        if event.number == 1 or self.last is None:  # another node, or the first event that is seen
            self._recorder, self._runs, self._count = RunRecorder(), self._runs + 1, 0
            self._events.clear()
            self._sample = {}
        found = self._recorder.add(event)
        self.last = event
        segment = event.segment()
        told: Message = {"running": segment.running, "factor": segment.factor}
        if event.name == "record":
            told["recording"] = event.values.get("outcome.kind") == "begun"
        if found:
            told["record"] = found.to_json()
        # A stamp has more digits than a number of JavaScript.
        told |= {"name": event.name, "said": event.verdict, "stamp": str(event.stamp)}
        self._events.append(told)
        self._count += 1

    def _add_sample(self, stamp: int, orientation: Sequence[float]) -> None:
        if self.last is None or stamp < self.last.stamp:
            return  # of the motion before
        x, y, z, w = orientation
        self._sample = {"time": self._recorder.time_at(stamp), "orientation": [w, x, y, z]}
