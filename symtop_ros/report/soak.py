"""Hours at full rate: a node under friction that records, splits its logs and is kicked at random.

Every finished log is computed again from its events, as `top_replay --check` does, and deleted.
"""

from __future__ import annotations

import random
import struct
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import rclpy
from diagnostic_msgs.msg import DiagnosticArray
from geometry_msgs.msg import QuaternionStamped

from symtop_ros.client.connection import Connection
from symtop_ros.report.processes import descriptors, domain, memory, node_command, running

RATE = 1000.0  # Hz
PART = 20.0  # s of a log
LINE = 10.0  # s between two lines
LONGEST_PAUSE = 1.0  # s between two requests
WARM = 10.0  # s until all that is kept is filled: pools of the middleware and the allocator
STARTING = 30.0  # s
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
    user.spin(STARTING, until_sample=True)
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


class User:
    """Somebody who listens to a node and makes requests at random."""

    def __init__(self) -> None:
        self._context = rclpy.Context()
        rclpy.init(context=self._context, domain_id=domain())
        node = rclpy.create_node("soak", context=self._context)
        self._connection = Connection(node, timeout=STARTING)
        node.create_subscription(QuaternionStamped, "/top/orientation", self._take, 5000, raw=True)
        node.create_subscription(DiagnosticArray, "/diagnostics", self._note, 10)
        self._random = random.Random(1)
        self._facts: dict[str, str] = {}
        self.begin()

    def close(self) -> None:
        """Leave the domain."""
        rclpy.shutdown(context=self._context)

    def begin(self) -> None:
        """Count from here."""
        self._samples, self._gaps, self._requests, self._balance = 0, 0, 0, 0.0
        self._stamp, self._missed_before = 0, int(self._facts.get("missed", 0))

    def spin(self, seconds: float, until_sample: bool = False) -> None:
        """Listen."""
        self._connection.spin_until(lambda: until_sample and self._samples > 0, seconds)

    def play(self, seconds: float) -> None:
        """Listen, and make requests at random moments."""
        end = time.monotonic() + seconds
        while (left := end - time.monotonic()) > 0:
            self.spin(min(left, self._random.uniform(0.0, LONGEST_PAUSE)))
            self._request(*self._random.choice(REQUESTS))

    def counted(self, seconds: float) -> Reading:
        """Return what was counted since the beginning."""
        missed = int(self._facts.get("missed", 0)) - self._missed_before
        return Reading(
            seconds=seconds,
            samples=self._samples,
            lost=max(0, self._gaps - missed),
            requests=self._requests,
            late=int(self._facts.get("late", 0)),
            missed=missed,
            dropped=int(self._facts.get("dropped", 0)),
            balance=self._balance,
        )

    def _request(self, service: str, values: Mapping[str, Any] | bool | None) -> None:
        if values is None:
            self._connection.trigger(service)
        elif isinstance(values, bool):
            self._connection.switch(service, values)
        else:
            self._connection.set(service, values)
        self._requests += 1

    def _take(self, data: bytes) -> None:
        seconds, nanoseconds = struct.unpack_from("<iI", data, 4)
        stamp = seconds * 1_000_000_000 + nanoseconds
        if self._stamp:
            self._gaps += round((stamp - self._stamp) * 1e-9 * RATE) - 1
        self._stamp = stamp
        self._samples += 1

    def _note(self, message: DiagnosticArray) -> None:
        self._facts.update((pair.key, pair.value) for s in message.status for pair in s.values)
        self._balance = max(self._balance, abs(float(self._facts["energy.balance"])))


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
