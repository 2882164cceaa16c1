"""SIGINT and SIGTERM at random moments, from the first line of a program on.

A moment before that is Python's own: there Ctrl-C may show a traceback of its start.
"""

import contextlib
import random
import signal
import subprocess
import time
from pathlib import Path

import pytest
from log_files import Run
from programs import command, environment

from symtop_ros.playback import viewer
from symtop_ros.playback.check import check
from symtop_ros.playback.mcap_file import McapFile
from symtop_ros.playback.top_log import TopLog

pytestmark = pytest.mark.untraced

DOMAIN = 94
TIMEOUT = 20.0
SILENT = {-signal.SIGINT, -signal.SIGTERM}  # ended before there was anything to put in order
RECORDING = ("publish_rate:=1000", "record.enabled:=true")
SECONDS, ATTEMPTS = 1.0, 6


@contextlib.contextmanager
def begun(*words):
    """Run a program; it is there when it has begun to run its own lines."""
    process = subprocess.Popen(
        command(*words),
        env=environment(DOMAIN),
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )
    try:
        deadline = time.monotonic() + TIMEOUT
        while process.poll() is None and not _left_to_the_system(process.pid):
            assert time.monotonic() < deadline, "the program did not begin in time"
            time.sleep(0.001)
        yield process
    finally:
        process.kill()
        process.communicate()


def _left_to_the_system(pid):
    """Whether Python has begun, which ignores SIGPIPE, and no longer handles SIGINT itself."""
    lines = Path(f"/proc/{pid}/status").read_text().splitlines()
    masks = {name: int(mask, 16) for name, _, mask in (each.partition(":") for each in lines)
             if name in ("SigIgn", "SigCgt")}  # fmt: skip
    return bool(
        masks["SigIgn"] >> signal.SIGPIPE - 1 & 1 > masks["SigCgt"] >> signal.SIGINT - 1 & 1
    )


def ended_at_random(chance, *words):
    """End a program at a moment of chance; return its exit status and what it wrote to stderr."""
    with begun(*words) as process:
        time.sleep(chance.uniform(0.0, SECONDS))
        process.send_signal(chance.choice([signal.SIGINT, signal.SIGTERM]))
        _, told = process.communicate(timeout=TIMEOUT)
    return process.returncode, told


def test_top_node_ends_in_silence_and_its_log_is_whole_or_absent(tmp_path):
    chance, statuses = random.Random(1), set()
    for attempt in range(2 * ATTEMPTS):
        folder = tmp_path / str(attempt)
        parameters = (*RECORDING, f"record.directory:={folder}")
        words = [word for parameter in parameters for word in ("-p", parameter)]
        status, told = ended_at_random(
            chance, "top_node", "--ros-args", *words, "--log-level", "warn"
        )
        assert told == ""
        statuses.add(status)
        for path in folder.glob("*"):
            assert status in {0, *SILENT}
            log = TopLog(McapFile(path))
            assert all(each.largest == 0.0 and not each.unchecked for each in check(log).values())
            assert log.problems == []
            assert "symtop_ros.end" in log.file.metadata
    assert statuses <= {0, *SILENT}


@pytest.mark.parametrize("words", [("watch",), ("hurry",)], ids=lambda words: words[0])
def test_top_ctl_says_at_most_that_there_was_no_answer(words):
    chance = random.Random(2)
    for _ in range(ATTEMPTS // 2):
        status, told = ended_at_random(chance, "top_ctl", *words)
        if status in SILENT or words == ("watch",):
            assert (status in {0, *SILENT}, told) == (True, "")
        else:
            assert (status, told) == (1, "top_ctl: ended before the answer came\n")


def test_top_live_leaves_no_viewer_behind():
    chance = random.Random(3)
    for _ in range(ATTEMPTS):
        port = viewer.free_port()
        status, told = ended_at_random(chance, "top_live", "--web", "--port", str(port))
        assert status in {0, *SILENT}
        assert "Traceback" not in told
        assert not [path for path in Path("/proc").glob("[0-9]*") if str(port) in _words(path)]


def _words(process):
    with contextlib.suppress(OSError):
        return (process / "cmdline").read_text().split("\0")
    return []


def test_top_replay_ends_in_silence_and_never_says_that_a_log_is_good(tmp_path):
    chance, log = random.Random(4), Run(seconds=20.0, rate=1000.0).write(tmp_path)
    for _ in range(ATTEMPTS):
        status, told = ended_at_random(chance, "top_replay", str(log), "--check")
        assert (status in {0, 130, *SILENT}, told) == (True, "")
