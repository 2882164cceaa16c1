"""Hours at full rate: a node under friction that records, splits its logs and is kicked at random.

Every finished log is computed again from its events, as `top_replay --check` does, and deleted.
"""

from __future__ import annotations

import random
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from symtop_ros.report.follower import Follower, request
from symtop_ros.report.processes import descriptors, memory, node_command, running

RATE = 1000.0  # Hz
PART = 20.0  # s of a log
LINE = 10.0  # s between two lines
LONGEST_PAUSE = 1.0  # s between two requests
WARM = 10.0  # s until all that is kept is filled: pools of the middleware and the allocator
REQUESTS: tuple[tuple[str, Any], ...] = (
    ("hurry_precession", None),
    ("kick", {"precession_rate_change": 2.0}),
    ("kick", {"precession_rate_factor": 0.8, "hold": "spin_momentum"}),
    ("kick", {"angular_impulse": [0.0, 0.0, 1e-4]}),
    ("pause", True),
    ("pause", False),
    ("reset", None),
)


@dataclass(frozen=True)
class Reading:
    """What was counted so far.

    Attributes
    ----------
    seconds : float
        Since the first sample.
    samples, lost : int
        Orientations that came, and those that were published and did not.
    requests : int
        Answered ones, granted or refused.
    late, missed, dropped : int
        Ticks, and messages that the log had no room for, as the node counts them.
    memory, growth : float
        Resident memory in MB, and how much more that is than after the first seconds.
    descriptors : int
        Open files and sockets.
    balance : float
        Largest part of the energy, in J, that neither friction nor a kick explains.
    logs, wrong : int
        Logs that were checked, and those that are not what their events say.
    megabytes : float
        Of these logs.
    """

    seconds: float = 0.0
    samples: int = 0
    lost: int = 0
    requests: int = 0
    late: int = 0
    missed: int = 0
    dropped: int = 0
    memory: float = 0.0
    growth: float = 0.0
    descriptors: int = 0
    balance: float = 0.0
    logs: int = 0
    wrong: int = 0
    megabytes: float = 0.0

    @property
    def good(self) -> bool:
        """Whether nothing was lost and no state was wrong."""
        return not (self.lost or self.dropped or self.wrong)


HEAD = (
    f"{'s':>7}{'samples':>10}{'lost':>6}{'requests':>10}{'late':>6}{'missed':>8}{'dropped':>9}"
    f"{'MB':>7}{'growth':>8}{'files':>7}{'balance, J':>12}{'logs':>6}{'wrong':>7}{'MB':>8}"
)


def row(reading: Reading) -> str:
    """Return a reading as a line below the head."""
    r = reading
    return (
        f"{r.seconds:7.0f}{r.samples:10}{r.lost:6}{r.requests:10}{r.late:6}{r.missed:8}"
        f"{r.dropped:9}{r.memory:7.1f}{r.growth:8.2f}{r.descriptors:7}{r.balance:12.1e}{r.logs:6}"
        f"{r.wrong:7}{r.megabytes:8.1f}"
    )


def soak(seconds: float) -> Iterator[Reading]:
    """Yield what was counted, every ten seconds and at the end, when the last log is checked."""
    with tempfile.TemporaryDirectory() as folder:
        logs = Logs(Path(folder))
        command = node_command(
            *("scene:=friction", f"publish_rate:={RATE}", "record.enabled:=true"),
            *(f"record.directory:={folder}", f"record.max_duration:={PART}"),
        )
        with running(command) as node:
            user = User()
            try:
                for reading in _readings(user, node.pid, seconds):
                    logs.check_finished()
                    last = logs.added_to(reading)
                    yield last
            finally:
                user.close()
        node.wait()
        logs.check_all()
        yield logs.added_to(last)


def _readings(user: User, pid: int, seconds: float) -> Iterator[Reading]:
    user.begin()
    began, warm = time.monotonic(), 0.0
    while (passed := time.monotonic() - began) < seconds:
        user.play(min(LINE, WARM, seconds - passed))
        warm = warm or memory(pid)
        now = memory(pid)
        yield replace(
            user.counted(time.monotonic() - began),
            memory=now,
            growth=now - warm,
            descriptors=descriptors(pid),
        )


class User(Follower):
    """Somebody who listens to a node and makes requests at random."""

    def __init__(self) -> None:
        super().__init__(RATE)
        self._random = random.Random(1)
        self._requests = 0

    def play(self, seconds: float) -> None:
        """Listen, and make requests at random moments."""
        end = time.monotonic() + seconds
        while (left := end - time.monotonic()) > 0:
            self.spin(min(left, self._random.uniform(0.0, LONGEST_PAUSE)))
            request(self.connection, *self._random.choice(REQUESTS))
            self._requests += 1

    def counted(self, seconds: float) -> Reading:
        """Return what was counted since the beginning."""
        return Reading(
            seconds=seconds,
            samples=self.samples,
            lost=self.lost,
            requests=self._requests,
            late=self.fact("late"),
            missed=self.missed,
            dropped=self.fact("dropped"),
            balance=self.balance,
        )


class Logs:
    """Finished logs, checked one after the other beside the run."""

    def __init__(self, folder: Path) -> None:
        self._folder = folder
        self._checking: tuple[Path, subprocess.Popen[bytes]] | None = None
        self._count, self._wrong, self._bytes = 0, 0, 0

    def added_to(self, reading: Reading) -> Reading:
        """Return a reading with what is known of the logs."""
        megabytes = self._bytes / 1e6
        return replace(reading, logs=self._count, wrong=self._wrong, megabytes=megabytes)

    def check_finished(self) -> None:
        """Go on with the checks, without waiting; the newest log is still being written."""
        if self._checking and self._checking[1].poll() is not None:
            self._take_result()
        waiting = sorted(self._folder.glob("*.mcap"))[:-1]
        if waiting and not self._checking:
            self._begin(waiting[0])

    def check_all(self) -> None:
        """Check what is left, the newest log too."""
        if self._checking:
            self._take_result()
        for path in sorted(self._folder.glob("*.mcap")):
            self._begin(path)
            self._take_result()

    def _begin(self, path: Path) -> None:
        command = [sys.executable, "-m", "symtop_ros.playback.main", str(path), "--check"]
        self._checking = path, subprocess.Popen(command, stdout=subprocess.DEVNULL)

    def _take_result(self) -> None:
        assert self._checking
        path, process = self._checking
        self._wrong += process.wait() != 0
        self._count += 1
        self._bytes += path.stat().st_size
        path.unlink()
        self._checking = None
