"""top_node for hours: it records, splits its logs and is kicked at random.

Every finished log is computed again from its events, as `top_replay --check` does, and deleted.
`make -C workshop soak` runs an hour with friction at 1000 Hz; several can run side by side, for
example `python -m workshop.load.soak --scene cusps --rate 200`.
"""

from __future__ import annotations

import argparse
import random
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from contextlib import closing
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from workshop.load.follower import Follower
from workshop.load.processes import program, run_program, running, top_node
from workshop.load.usage import descriptors, memory

LOG_DURATION = 20.0  # s
LINE_INTERVAL = 10.0  # s; the pools of the middleware and the allocator are filled after one
LONGEST_PAUSE = 1.0  # s between two requests
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
    """The counts since the first sample.

    Attributes
    ----------
    seconds : float
        Since the first sample.
    samples, lost : int
        Orientations that were received, and those that were published and not received.
    requests : int
        Requests that were answered, granted or refused.
    late, missed, dropped : int
        Late and missed ticks, and messages that the log dropped, as the node counts them.
    memory, growth : float
        Resident memory in MB, and its growth since the first line.
    descriptors : int
        Number of open files and sockets.
    balance : float
        Largest imbalance of energy in J, as the node reports it.
    logs, wrong : int
        Logs that were checked, and those that differ from their recomputation.
    megabytes : float
        Size of the checked logs in MB.
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
        """True if nothing was lost and no log was wrong."""
        return not (self.lost or self.dropped or self.wrong)


HEAD = (
    f"{'s':>7}{'samples':>10}{'lost':>6}{'requests':>10}{'late':>6}{'missed':>8}{'dropped':>9}"
    f"{'MB':>7}{'growth':>8}{'files':>7}{'balance, J':>12}{'logs':>6}{'wrong':>7}{'MB':>8}"
)


def format_row(reading: Reading) -> str:
    """Return a reading as a line below `HEAD`."""
    r = reading
    return (
        f"{r.seconds:7.0f}{r.samples:10}{r.lost:6}{r.requests:10}{r.late:6}{r.missed:8}"
        f"{r.dropped:9}{r.memory:7.1f}{r.growth:8.2f}{r.descriptors:7}{r.balance:12.1e}{r.logs:6}"
        f"{r.wrong:7}{r.megabytes:8.1f}"
    )


def soak(seconds: float, scene: str, rate: float) -> Iterator[Reading]:
    """Yield the counts every ten seconds, and at the end, after the check of the last log."""
    with tempfile.TemporaryDirectory() as folder:
        logs = Logs(Path(folder))
        command = top_node(
            *(f"scene:={scene}", f"publish_rate:={rate}", "record.enabled:=true"),
            *(f"record.directory:={folder}", f"record.max_duration:={LOG_DURATION}"),
        )
        with running(command) as node, closing(User(rate)) as user:
            for reading in _readings(user, node.pid, seconds):
                logs.check_finished()
                last = logs.add_to(reading)
                yield last
        node.wait()
        logs.check_all()
        yield logs.add_to(last)


def _readings(user: User, pid: int, seconds: float) -> Iterator[Reading]:
    user.begin()
    began, first = time.monotonic(), 0.0
    while (passed := time.monotonic() - began) < seconds:
        user.play(min(LINE_INTERVAL, seconds - passed))
        now = memory(pid)
        first = first or now
        yield replace(
            user.read(time.monotonic() - began),
            memory=now,
            growth=now - first,
            descriptors=descriptors(pid),
        )


class User(Follower):
    """A follower that also makes requests at random."""

    def __init__(self, rate: float) -> None:
        super().__init__(rate)
        self._random = random.Random(1)
        self._requests = 0

    def play(self, seconds: float) -> None:
        """Receive for some seconds, and make requests at random moments."""
        end = time.monotonic() + seconds
        while (left := end - time.monotonic()) > 0:
            self.spin(min(left, self._random.uniform(0.0, LONGEST_PAUSE)))
            self.connection.request(*self._random.choice(REQUESTS))
            self._requests += 1

    def read(self, seconds: float) -> Reading:
        """Return the counts since the first sample."""
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
    """The finished logs, checked one after the other while the node runs."""

    def __init__(self, folder: Path) -> None:
        self._folder = folder
        self._checking: tuple[Path, subprocess.Popen[bytes]] | None = None
        self._count, self._wrong, self._bytes = 0, 0, 0

    def add_to(self, reading: Reading) -> Reading:
        """Return a reading with the results of the checks."""
        megabytes = self._bytes / 1e6
        return replace(reading, logs=self._count, wrong=self._wrong, megabytes=megabytes)

    def check_finished(self) -> None:
        """Continue with the checks without waiting; the newest log is still being written."""
        if self._checking and self._checking[1].poll() is not None:
            self._take_result()
        waiting = sorted(self._folder.glob("*.mcap"))[:-1]
        if waiting and not self._checking:
            self._begin(waiting[0])

    def check_all(self) -> None:
        """Check the remaining logs, the newest included."""
        if self._checking:
            self._take_result()
        for log in sorted(self._folder.glob("*.mcap")):
            self._begin(log)
            self._take_result()

    def _begin(self, log: Path) -> None:
        command = program("top_replay", str(log), "--check")
        self._checking = log, subprocess.Popen(command, stdout=subprocess.DEVNULL)

    def _take_result(self) -> None:
        assert self._checking
        log, process = self._checking
        self._wrong += process.wait() != 0
        self._count += 1
        self._bytes += log.stat().st_size
        log.unlink()
        self._checking = None


def main(args: list[str] | None = None) -> int:
    """Print the counts every ten seconds; return the exit status."""

    def run(options: argparse.Namespace) -> bool:
        print(HEAD)
        for reading in soak(options.seconds, options.scene, options.rate):
            print(format_row(reading), flush=True)
        return reading.good

    description = (
        "top_node, recording, kicked at random. "
        "Exit status 1 if a sample was lost or a log was wrong."
    )
    return run_program("soak.py", description, 3600.0, run, args, _add_options)


def _add_options(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--scene", default="friction", help="default: %(default)s")
    parser.add_argument("--rate", type=float, default=1000.0, help="in Hz; default: %(default)g")


if __name__ == "__main__":
    sys.exit(main())
