"""top_node for hours: it records, splits its logs and is kicked at random.

Every finished log is computed again from its events, as `top_replay --check` does, and deleted.
`make -C workshop soak` runs an hour with friction at 1000 Hz; several can run side by side, for
example `python -m workshop.load.soak --scene cusps --rate 200`.
"""

import argparse
import random
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from concurrent.futures import Future, ThreadPoolExecutor, wait
from contextlib import closing
from dataclasses import asdict, dataclass, replace
from pathlib import Path
from typing import Any

from workshop.load.follower import Follower
from workshop.load.processes import (
    descriptors,
    memory,
    program,
    run_program,
    running,
    top_node,
)

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


ROW = (
    "{seconds:7.0f}{samples:10}{lost:6}{requests:10}{late:6}{missed:8}{dropped:9}{memory:7.1f}"
    "{growth:8.2f}{descriptors:7}{balance:12.1e}{logs:6}{wrong:7}{megabytes:8.1f}"
)


def soak(seconds: float, scene: str, rate: float) -> Iterator[Reading]:
    """Yield the counts every ten seconds, and at the end, after the check of the last log."""
    with tempfile.TemporaryDirectory() as folder, closing(Logs(Path(folder))) as logs:
        command = top_node(
            f"scene:={scene}",
            f"publish_rate:={rate}",
            "record.enabled:=true",
            f"record.directory:={folder}",
            f"record.max_duration:={LOG_DURATION}",
        )
        with running(command) as node, closing(User(rate)) as user:
            for reading in _readings(user, node.pid, seconds):
                logs.check()
                last = logs.add_to(reading)
                yield last
        node.wait()
        logs.check(newest=True)
        logs.wait()
        yield logs.add_to(last)


def _readings(user: "User", pid: int, seconds: float) -> Iterator[Reading]:
    user.begin()
    began = time.monotonic()
    first = 0.0
    while (passed := time.monotonic() - began) < seconds:
        user.play(min(LINE_INTERVAL, seconds - passed))
        now = memory(pid)
        first = first or now
        yield Reading(
            seconds=time.monotonic() - began,
            samples=user.samples,
            lost=user.lost,
            requests=user.requests,
            late=user.fact("late"),
            missed=user.missed,
            dropped=user.fact("dropped"),
            memory=now,
            growth=now - first,
            descriptors=descriptors(pid),
            balance=user.balance,
        )


class User(Follower):
    """A follower that also makes requests at random."""

    def __init__(self, rate: float) -> None:
        super().__init__(rate)
        self._random = random.Random(1)
        self.requests = 0

    def play(self, seconds: float) -> None:
        """Receive for some seconds, and make requests at random moments."""
        end = time.monotonic() + seconds
        while (left := end - time.monotonic()) > 0:
            self.spin(min(left, self._random.uniform(0.0, LONGEST_PAUSE)))
            self.connection.request(*self._random.choice(REQUESTS))
            self.requests += 1


class Logs:
    """The finished logs, checked one after the other while the node runs."""

    def __init__(self, folder: Path) -> None:
        self._folder = folder
        self._pool = ThreadPoolExecutor(1)
        self._checks: dict[Path, Future[tuple[bool, int]]] = {}

    def close(self) -> None:
        """Leave out the checks that have not begun."""
        self._pool.shutdown(cancel_futures=True)

    def add_to(self, reading: Reading) -> Reading:
        """Return a reading with the results of the checks."""
        done = [check.result() for check in self._checks.values() if check.done()]
        wrong = sum(not good for good, _ in done)
        sizes = sum(size for _, size in done)
        return replace(reading, logs=len(done), wrong=wrong, megabytes=sizes / 1e6)

    def check(self, newest: bool = False) -> None:
        """Check further logs, without waiting; of a node that runs the newest is still written."""
        logs = sorted(self._folder.glob("*.mcap"))
        for log in logs if newest else logs[:-1]:
            self._checks[log] = self._checks.get(log) or self._pool.submit(_check, log)

    def wait(self) -> None:
        """Wait until all checks have ended."""
        wait(self._checks.values())


def _check(log: Path) -> tuple[bool, int]:
    """Return whether a log is right, and its size in bytes; delete it."""
    command = program("top_replay", str(log), "--check")
    status = subprocess.run(command, stdout=subprocess.DEVNULL, check=False).returncode
    size = log.stat().st_size
    log.unlink()
    return status == 0, size


def _run(options: argparse.Namespace) -> bool:
    print(HEAD)
    for reading in soak(options.seconds, options.scene, options.rate):
        print(ROW.format(**asdict(reading)), flush=True)
    return reading.good


def main(args: list[str] | None = None) -> int:
    """Print the counts every ten seconds; return the exit status."""
    description = (
        "top_node, recording, kicked at random. "
        "Exit status 1 if a sample was lost or a log was wrong."
    )
    scene = {"default": "friction", "help": "default: %(default)s"}
    rate = {"type": float, "default": 1000.0, "help": "in Hz; default: %(default)g"}
    return run_program("soak.py", description, 3600.0, _run, args, scene=scene, rate=rate)


if __name__ == "__main__":
    sys.exit(main())
