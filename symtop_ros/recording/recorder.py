"""The recorder: messages go into a bounded queue, and a thread writes them to files.

What the queue cannot hold is counted; the node never waits. Every file begins with the latched
messages that hold, so that it can be understood alone.
"""

from __future__ import annotations

import threading
import time
from collections import deque
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

from symtop_ros.recording.log_file import Channel, LogFile

QUEUE = 60_000  # messages: about ten seconds at 1 kHz
PAUSE = 0.02  # s between two looks at the queue; short, so that the node waits for few messages
FLUSH = 0.4  # s; half a second is promised
Queued = tuple[int, int, bytes]  # channel, stamp in ns, message


@dataclass(frozen=True, slots=True)
class Limits:
    """When a new file begins; 0 for never.

    Attributes
    ----------
    size : float
        Bytes of a file.
    duration : float
        Seconds of a file, by the stamps of its messages.
    """

    size: float = 0.0
    duration: float = 0.0

    def reached(self, file: LogFile) -> bool:
        """Whether a file is long enough."""
        return 0 < self.size <= file.size or 0 < self.duration <= file.duration


def reason(error: Exception) -> str:
    """Why something failed, without numbers and paths."""
    return getattr(error, "strerror", None) or " ".join(str(error).split()) or type(error).__name__


class Recorder:
    """Writes what it is given while it is running.

    Attributes
    ----------
    limits : Limits
        Can be changed at any time.
    dropped : int
        Messages the queue had no room for, since the recording began.
    failure : str
        Why the last recording ended by itself; empty while all is well.
    """

    def __init__(self, directory: Path, limits: Limits) -> None:
        self._directory, self.limits = directory, limits
        self._channels: list[Channel] = []
        self._latched: dict[int, bytes] = {}
        self._queue: deque[Queued] = deque()
        self._held: list[Queued] | None = None
        self._thread: threading.Thread | None = None
        self._ending = threading.Event()
        self.dropped = 0
        self.failure = ""

    def channel(self, topic: str, kind: str, latched: bool = False) -> int:
        """Add a topic, before the first recording, and return its number."""
        self._channels.append(Channel(topic, kind, latched))
        return len(self._channels) - 1

    @property
    def running(self) -> bool:
        """Whether messages are taken."""
        return self._thread is not None and not self.failure

    @property
    def path(self) -> Path | None:
        """File that is being written."""
        return self._file.path if self.running else None

    def start(self, metadata: Mapping[str, str]) -> Path:
        """Begin a file and return its path.

        Raises
        ------
        OSError
            Where it cannot be made.
        """
        self.stop()
        latched = dict(self._latched)
        self._file = LogFile(self._directory, self._channels, metadata, latched)
        self.dropped, self.failure = 0, ""
        self._queue.clear()
        self._ending.clear()
        self._thread = threading.Thread(target=self._work, args=(metadata, latched), daemon=True)
        self._thread.start()
        return self._file.path

    def add(self, channel: int, stamp: int, data: bytes) -> None:
        """Take a message; latched ones are kept for the head of the files to come."""
        if self._channels[channel].latched:
            self._latched[channel] = data
        if not self.running:
            return
        if self._held is None or channel == self._ahead:
            self._put((channel, stamp, data))
        else:
            self._held.append((channel, stamp, data))

    def _put(self, message: Queued) -> None:
        if len(self._queue) < QUEUE:
            self._queue.append(message)
        else:
            self.dropped += 1

    @contextmanager
    def behind(self, channel: int) -> Iterator[None]:
        """Let what is added meanwhile come after what is added on one channel."""
        self._ahead, self._held = channel, []
        try:
            yield
        finally:
            held, self._held = self._held, None
            for message in held:
                self._put(message)

    def stop(self) -> None:
        """Write what is queued, end the file and return when that is done."""
        if self._thread:
            self._ending.set()
            self._thread.join()
            self._thread = None

    # in the thread

    def _work(self, metadata: Mapping[str, str], latched: dict[int, bytes]) -> None:
        try:
            while not self._fill(latched):
                self._file.finish(self._counts())
                self._file = LogFile(self._directory, self._channels, metadata, latched)
            self._file.finish(self._counts())
        except Exception as error:
            self._file.abandon()
            self._queue.clear()
            self.failure = f"{self._file.path}: {reason(error)}"  # last: by then the file is whole

    def _counts(self) -> dict[str, str]:
        return {"dropped": str(self.dropped)}

    def _fill(self, latched: dict[int, bytes]) -> bool:
        """Write into one file; return whether the recording ends, or another file is due."""
        flushed = time.monotonic()
        while not self.limits.reached(self._file):
            ending = self._ending.wait(PAUSE)
            self._drain(latched)
            if ending:
                return True
            if time.monotonic() - flushed > FLUSH - PAUSE:
                flushed = time.monotonic()
                self._file.flush()
        return False

    def _drain(self, latched: dict[int, bytes]) -> None:
        for _ in range(len(self._queue)):
            channel, stamp, data = self._queue.popleft()
            self._file.write(channel, stamp, data)
            if self._channels[channel].latched:
                latched[channel] = data
