"""The recorder: messages go into a bounded queue, and a thread writes them to files.

The caller never waits: messages that do not fit into the queue are dropped and counted. Every file
begins with the current latched messages, so that it can be read alone.
"""

import json
import threading
import time
from collections import deque
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

from symtop_ros.run.simulation.settings import RecordSettings
from symtop_ros.run.simulation.topics import Topic

if TYPE_CHECKING:
    from symtop_ros.run.log.writer import LogFile

QUEUE_LENGTH = 60_000  # messages: about ten seconds at 1 kHz
# s between two writes. Short, so that each takes little time: ticks wait for the interpreter.
WRITE_PERIOD = 0.005
# s: age at which a message is written to the disk. Half a second is promised if the thread gets the
# processor within 0.1 s when that is due.
LONGEST_AGE = 0.4
Queued = tuple[int, int, bytes]  # channel, stamp in ns, message


def describe_error(error: Exception) -> str:
    """Return the text of an error without its number and path."""
    return getattr(error, "strerror", None) or " ".join(str(error).split()) or type(error).__name__


class Recorder:
    """Writes messages to files in a thread."""

    def __init__(
        self, settings: RecordSettings, clock: Callable[[], float] = time.monotonic
    ) -> None:
        self.settings = settings  # its limits may be changed while a recording runs
        self._clock = clock  # s
        self._oldest: float | None = None  # when the oldest message came that is not on the disk
        self._channels: list[Topic] = []  # with their full names
        self._names: dict[str, str] = {}  # the full names of topics, by ours
        self.latched: dict[int, bytes] = {}  # last messages of latched topics, for later files
        self._queue: deque[Queued] = deque()
        # While one channel is put first: its index, and the messages of all others.
        self._ahead: int | None = None
        self._held: list[Queued] = []
        self._file: LogFile | None = None  # the last file that was opened
        self._number = 0  # of that file in its recording
        self._thread: threading.Thread | None = None
        self._ending = threading.Event()
        # returns the samples that were missed, which no message shows
        self.count_missed: Callable[[], int] = lambda: 0
        self.running = False  # True while a recording runs
        self.dropped = 0  # messages that did not fit into the queue since the recording began
        self.failure = ""  # reason why the last recording ended by itself; empty if it did not

    def add_channel(self, name: str, topic: Topic) -> int:
        """Add a topic before the first recording; return the index of its channel."""
        self._channels.append(replace(topic, ros_name=name))
        self._names[topic.name] = name
        return len(self._channels) - 1

    @property
    def path(self) -> Path | None:
        """Path of the current file, None if not recording."""
        return self._file.path if self._file and self.running else None

    def start(self, metadata: Mapping[str, str]) -> Path:
        """Begin a recording and return the path of its first file."""
        self.stop()
        latched = dict(self.latched)
        self._number = 0
        self._file = file = self._open(metadata, latched)
        self.dropped, self.failure = 0, ""
        self._queue.clear()
        self._oldest = None
        self._ending.clear()
        self._thread = threading.Thread(
            target=self._work, args=(file, metadata, latched), daemon=True
        )
        self._thread.start()
        self.running = True
        return file.path

    def _open(self, metadata: Mapping[str, str], latched: Mapping[int, bytes]) -> "LogFile":
        # It needs mcap, without which a top moves and is published, but not recorded.
        from symtop_ros.run.log.writer import FILE_ENTRY, TOPICS_ENTRY, LogFile

        self._number += 1
        own = {TOPICS_ENTRY: json.dumps(self._names), FILE_ENTRY: str(self._number)}
        return LogFile(Path(self.settings.directory), self._channels, {**metadata, **own}, latched)

    def add(self, channel: int, stamp: int, data: bytes) -> None:
        """Queue a message with its stamp (ns), while a recording runs."""
        if not self.running:
            return
        if self._ahead in (None, channel):
            self._put((channel, stamp, data))
        else:
            self._held.append((channel, stamp, data))

    def _put(self, message: Queued) -> None:
        if len(self._queue) < QUEUE_LENGTH:
            self._queue.append(message)
            if self._oldest is None:
                self._oldest = self._clock()
        else:
            self.dropped += 1

    def await_room(self) -> None:
        """Wait until half of the queue is free, for a caller that would rather wait than drop."""
        while self.running and len(self._queue) > QUEUE_LENGTH // 2:
            time.sleep(WRITE_PERIOD)

    @contextmanager
    def put_first(self, channel: int) -> Iterator[None]:
        """Write messages of one channel before all others that are added in this context."""
        self._ahead = channel
        try:
            yield
        finally:
            held, self._held, self._ahead = self._held, [], None
            for message in held:
                self._put(message)

    def stop(self) -> None:
        """Write the queue, finish the file and return when both are done."""
        if self._thread:
            self._ending.set()
            self._thread.join()
            self._thread, self.running = None, False

    # The following methods run in the thread.

    def _work(
        self, file: "LogFile", metadata: Mapping[str, str], latched: dict[int, bytes]
    ) -> None:
        try:
            while True:
                is_last = self._fill(file, latched)
                file.finish({"dropped": str(self.dropped), "missed": str(self.count_missed())})
                if is_last or not self._await_message():
                    return  # a file without any message would be no log of a run
                self._file = file = self._open(metadata, latched)
        except Exception as error:
            file.abandon()
            self.running = False
            # Set last: a reader of the path may open the file, so it must be complete by then.
            self.failure = f"{file.path}: {describe_error(error)}"

    def _await_message(self) -> bool:
        """Wait for the first message of the next file; return False if the recording ends first."""
        while not self._queue:
            if self._ending.wait(WRITE_PERIOD):
                return bool(self._queue)
        return True

    def _fill(self, file: "LogFile", latched: dict[int, bytes]) -> bool:
        """Write one file; return True if the recording ends, False if a new file is due."""
        while True:
            ending = self._ending.wait(WRITE_PERIOD)
            self._drain(file, latched)
            if ending:
                return True
            # This is tested last: an empty file may be larger than a small limit, so an earlier
            # test would create empty files for ever.
            size, duration = self.settings.max_size, self.settings.max_duration  # 0: no limit
            if 0 < size <= file.size or 0 < duration <= file.duration:
                return False
            if self._oldest is not None and self._clock() - self._oldest > LONGEST_AGE:
                self._oldest = None  # messages that are added from now on are timed anew
                self._drain(file, latched)
                file.flush()

    def _drain(self, file: "LogFile", latched: dict[int, bytes]) -> None:
        for _ in range(len(self._queue)):
            channel, stamp, data = self._queue.popleft()
            file.write(channel, stamp, data)
            if self._channels[channel].latched:
                latched[channel] = data
