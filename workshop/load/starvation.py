"""top_node and a client on one core next to busy loops, and every number that is said.

`python -m workshop.load.starvation --seconds 300`. The client makes requests at random. Then the
numbers of warnings, answers and diagnostics are read as a person would read them, and held against
the stamps of all samples, which are those of the logs and those that the client received.
"""

from __future__ import annotations

import argparse
import os
import random
import re
import signal
import subprocess
import sys
import tempfile
import time
from collections import Counter
from collections.abc import Iterator
from contextlib import ExitStack, closing, contextmanager
from itertools import chain, pairwise
from pathlib import Path
from typing import Any, NamedTuple

from diagnostic_msgs.msg import DiagnosticArray
from geometry_msgs.msg import QuaternionStamped, WrenchStamped
from rclpy.serialization import deserialize_message

from symtop_ros.run.log.reader import McapFile
from workshop.load.bare import LATCHED
from workshop.load.follower import DEPTH, Subscriber, read_stamp, to_nanoseconds
from workshop.load.processes import domain, program, run_program, top_node

SAMPLES = "/top/orientation"
RATE = 500.0  # Hz
PERIOD = round(1e9 / RATE)  # ns
LOOPS = 4
LONGEST_PAUSE = 0.5  # s between two requests
REQUESTS: tuple[tuple[str, Any], ...] = (
    ("set_initial_conditions", {"theta": 0.4, "psi_dot": 180.0}),
    ("hurry_precession", None),
    ("kick", {"precession_rate_change": 2.0}),
    ("kick", {"angular_impulse": [0.0, 0.0, 1e-4]}),
    ("kick", {"axle_impulse": 5e-5, "rate": 20.0, "number": 10}),
    ("clamp", True),
    ("clamp", False),
    ("pause", True),
    ("pause", False),
    ("reset", None),
    ("record", False),
    ("record", True),
    ("set_parameters_atomically", {"friction.transverse": 2e-6}),
    ("set_parameters_atomically", {"friction.transverse": 0.0}),
    ("torque", [0.0, 0.0, 1e-4]),
)
MISSED = re.compile(
    r"(?P<samples>\d+) samples? missed in (?P<gaps>a|\d+) gaps?(?: of|, the longest) "
    r"(?P<longest>[\d.e-]+) s.*\((?P<whole>\d+) missed in all\)"
)
LACKS = re.compile(
    r"lacks CPU time: gets (?P<got>[\d.e+-]+) % CPU, needs (?P<needed>[\d.e+-]+) % \(one core\): "
    r"real-time factor (?P<before>[\d.e-]+) -> (?P<after>[\d.e-]+)"
)
# Without a number of the node: a slower motion, and a torque during a clamp.
OTHERS = re.compile("too fast for the compute budget|must come while the precession is free")


class Gap(NamedTuple):
    """Samples of a grid that were not sent: the stamps on both sides in ns, and their number.

    Of a gap that no log spans the client is the only witness, which may have lost the samples.
    """

    last: int
    next: int
    missed: int
    is_certain: bool

    def cut(self, end: int) -> Gap:
        """Return the part of the gap up to a stamp."""
        return self._replace(missed=min(self.missed, max((end - self.last) // PERIOD, 0)))


class Client(Subscriber):
    """Receives samples and diagnostics, and makes requests at random."""

    def __init__(self) -> None:
        super().__init__(domain())
        self.stamps: list[int] = []
        self.events: list[DiagnosticArray] = []
        self.answers: list[str] = []  # those of requests that were granted
        self._random = random.Random(7)
        kinds = QuaternionStamped, f"{self.connection.name}/orientation"
        self.node.create_subscription(*kinds, self._receive, DEPTH, raw=True)
        events = f"{self.connection.name}/events"
        self.node.create_subscription(DiagnosticArray, events, self.events.append, LATCHED)
        hand = f"{self.connection.name}/applied_torque"
        self._hand = self.node.create_publisher(WrenchStamped, hand, 10)

    def _receive(self, data: bytes) -> None:
        self.stamps.append(read_stamp(data))

    def play(self, seconds: float) -> None:
        """Receive for some seconds, and make requests at random moments."""
        self.wait(lambda: bool(self.stamps and self.events), "sample and event")
        end = time.monotonic() + seconds
        while (left := end - time.monotonic()) > 0:
            self.spin(min(left, self._random.uniform(0.0, LONGEST_PAUSE)))
            self._act(*self._random.choice(REQUESTS))

    def _act(self, service: str, argument: Any) -> None:
        if service == "torque":
            message = WrenchStamped()
            message.wrench.torque.x, message.wrench.torque.y, message.wrench.torque.z = argument
            self._hand.publish(message)
            return
        granted, answer = self.connection.request(service, argument)
        if granted and service in ("hurry_precession", "kick", "set_initial_conditions", "reset"):
            self.answers.append(answer)


@contextmanager
def starving(loops: int) -> Iterator[None]:
    """Keep this process, and those that it starts, on one core with some busy loops."""
    before = os.sched_getaffinity(0)
    os.sched_setaffinity(0, {min(before)})
    busy = [subprocess.Popen([sys.executable, "-c", "while True: pass"]) for _ in range(loops)]
    try:
        yield
    finally:
        for each in busy:
            each.kill()
            each.wait()
        os.sched_setaffinity(0, before)


class Trial:
    """Compares the numbers that a node said with the samples that it sent."""

    def __init__(self, client: Client, warnings: list[str], logs: list[Path]) -> None:
        self.read: Counter[str] = Counter()  # numbers, by where they stand
        self.false: list[str] = []
        self._client, self._warnings, self._logs = client, warnings, logs
        self._gaps: list[Gap] = []
        self._texts: set[str] = set()  # of the events

    def judge(self) -> None:
        """Read all that was said."""
        self._read_logs()
        self._read_warnings()
        for answer in self._client.answers:
            is_logged = any(answer.startswith(text) for text in self._texts if text)
            self._note("answers", is_logged, answer)

    def _note(self, place: str, is_true: bool, text: str) -> None:
        self.read[place] += 1
        if not is_true:
            self.false.append(f"{place}: {text}")

    def _read_logs(self) -> None:
        """Read the diagnostics of all logs, whose own check reads what they say of the motion."""
        logs = [_list_messages(path) for path in self._logs]
        messages = [each for log in logs for each in log]
        recorded = [[stamp for name, stamp, _ in log if name == SAMPLES] for log in logs]
        # the first sample of a run has the stamp of its first event
        before_all = to_nanoseconds(self._client.events[0].header.stamp) - PERIOD
        stamps = {before_all, *self._client.stamps, *chain(*recorded)}
        self._gaps = _find_gaps(sorted(stamps), [(min(log), max(log)) for log in recorded if log])
        self._texts = {status.message for each in self._client.events for status in each.status}
        for path in self._logs:
            command = program("top_replay", str(path), "--check")
            done = subprocess.run(command, capture_output=True, text=True, check=False)
            self._note("logs", done.returncode == 0, f"{path.name}: {done.stdout[-300:]}")
        last = 0
        for name, stamp, data in messages:
            last = max(last, stamp) if name == SAMPLES else last
            if name == "/diagnostics":
                self._read_diagnostics(deserialize_message(data, DiagnosticArray), last)

    def _read_diagnostics(self, message: DiagnosticArray, last: int) -> None:
        """Hold the counts against the gaps: those before `last` are known, later ones may be."""
        until = to_nanoseconds(message.header.stamp)
        known = [gap for gap in self._gaps if gap.is_certain and gap.next <= last]
        cut = [gap.cut(until + PERIOD) for gap in self._gaps]
        all_ = [gap for gap in cut if gap.missed]
        (facts,) = (
            {pair.key: pair.value for pair in status.values}
            for status in message.status
            if "longest_gap" in {pair.key for pair in status.values}
        )
        for key, count in (("missed", _count), ("gaps", len), ("longest_gap", _find_longest)):
            value, least, most = float(facts[key]), count(known), count(all_)
            is_true = least - 1e-9 <= value <= most + 1e-9
            self._note("diagnostics", is_true, f"{key} {value} at {until}: {least} to {most}")

    def _read_warnings(self) -> None:
        whole = gaps = 0
        for line in self._warnings:
            if found := MISSED.search(line):
                whole += int(found["samples"])
                gaps += 1 if found["gaps"] == "a" else int(found["gaps"])
                self._note("warnings", whole == int(found["whole"]) <= _count(self._gaps), line)
                # a gap that ends after a warning may be counted before and after it
                self._note("warnings", gaps <= len(self._gaps) + self.read["warnings"], line)
                longest = float(found["longest"])
                self._note("warnings", longest <= 1.005 * _find_longest(self._gaps), line)
            elif found := LACKS.search(line):
                got, needed, before, after = map(float, found.groups())
                # two digits of got and needed, three of the factors
                is_true = abs(after * needed * 2 / (before * got) - 1) < 0.11
                self._note("warnings", got < needed and is_true, line)
            elif not OTHERS.search(line):
                self._note("warnings", False, f"of an unknown form: {line}")


def _list_messages(path: Path) -> list[tuple[str, int, bytes]]:
    file = McapFile(path)
    return [
        (file.channels[each.channel_id].topic, each.log_time, bytes(each.data))
        for chunk in file.chunks()
        for each in chunk
    ]


def _find_gaps(stamps: list[int], spans: list[tuple[int, int]]) -> list[Gap]:
    """Return the gaps between some stamps, of which logs span some."""
    found = []
    for before, after in pairwise(stamps):
        missed = round((after - before) / PERIOD) - 1
        is_certain = any(first <= before and after <= last for first, last in spans)
        if missed > 0:
            found.append(Gap(before, after, missed, is_certain))
    return found


def _count(gaps: list[Gap]) -> int:
    return sum(gap.missed for gap in gaps)


def _find_longest(gaps: list[Gap]) -> float:
    return max((gap.missed / RATE for gap in gaps), default=0.0)


def run_trial(seconds: float, loops: int = LOOPS) -> Trial:
    """Starve a node for some seconds, and read what it said."""
    with tempfile.TemporaryDirectory() as folder, ExitStack() as stack:
        client = stack.enter_context(closing(Client()))
        command = top_node(
            f"publish_rate:={RATE}", "record.enabled:=true", f"record.directory:={folder}"
        )
        environment = {**os.environ, "ROS_DOMAIN_ID": str(domain())}
        with starving(loops):
            node = subprocess.Popen(command, env=environment, stderr=subprocess.PIPE, text=True)
            try:
                client.play(seconds)
            finally:
                node.send_signal(signal.SIGINT)
                _, errors = node.communicate()
        warnings = [line for line in errors.splitlines() if "[WARN]" in line or "[ERROR]" in line]
        trial = Trial(client, warnings, sorted(Path(folder).glob("*.mcap")))
        trial.judge()
        return trial


def _run(options: argparse.Namespace) -> bool:
    trial = run_trial(options.seconds, options.loops)
    print(f"{'numbers in':14}{'read':>8}{'false':>8}")
    for place, count in trial.read.items():
        false = sum(text.startswith(place) for text in trial.false)
        print(f"{place:14}{count:8}{false:8}")
    for text in trial.false:
        print(text, file=sys.stderr)
    return not trial.false


def main(args: list[str] | None = None) -> int:
    """Print how many numbers were read and how many were false; return the exit status."""
    description = "top_node next to busy loops. Exit status 1 if a number that it says is false."
    loops = {"type": int, "default": LOOPS, "help": "busy loops; default: %(default)d"}
    return run_program("starvation.py", description, 300.0, _run, args, loops=loops)


if __name__ == "__main__":
    sys.exit(main())
