"""Faults of processes: signals at random moments, and a node that is stopped again and again.

The first moment is that in which a program imports NumPy: before its first line Ctrl-C may show a
traceback of Python's own start.
"""

import os
import random
import signal
import time
from itertools import pairwise
from pathlib import Path

import numpy as np
import psutil
import pytest
from diagnostic_msgs.msg import DiagnosticArray
from exact_log import assert_exact, assert_no_deviation, stamps_of
from log_files import Run
from machine_time import measuring
from programs import command, running, running_node, set_parameters
from ros.node.listener import Listener
from ros.node.running_top import facts, stamp_of
from sensor_msgs.msg import JointState
from trials import trials
from waiting import TIMEOUT, until

from symtop_ros.replay import viewer
from symtop_ros.run.log.reader import McapFile
from symtop_ros.run.log.top_log import TopLog
from workshop.load.domains import claim_domain

pytestmark = pytest.mark.untraced

DOMAIN = claim_domain()
SILENT = {-signal.SIGINT, -signal.SIGTERM}  # ended before there was anything to put in order
RECORDING = ("publish_rate:=1000", "record.enabled:=true")
SECONDS, ATTEMPTS = 1.0, 2


def _wait_for_imports(process):
    """Wait until a program imports NumPy, which it does after its first line."""
    maps = Path(f"/proc/{process.pid}/maps")
    until(lambda: process.poll() is not None or "numpy" in maps.read_text(), lambda: None)


def ended_at_random(chance, *words):
    """End a program at a moment of chance; return its exit status and what it wrote to stderr."""
    with running(command(*words), DOMAIN) as process:
        _wait_for_imports(process)
        time.sleep(chance.uniform(0.0, SECONDS))
        process.send_signal(chance.choice([signal.SIGINT, signal.SIGTERM]))
        _, told = process.communicate(timeout=TIMEOUT)
    return process.returncode, told


@pytest.mark.slow
def test_top_node_ends_in_silence_and_its_log_is_whole_or_absent(tmp_path):
    chance = random.Random(1)
    statuses = set()
    for attempt in range(2 * ATTEMPTS):
        folder = tmp_path / str(attempt)
        options = set_parameters(*RECORDING, f"record.directory:={folder}")
        status, told = ended_at_random(chance, "top_node", *options)
        # A machine that is overloaded adds its own warning, which is not the matter here, nor what
        # rcl says of it if ROS ends between the check of the node and the warning.
        of_load = " missed in ", "Failed to publish log message to rosout"
        lines = [line for line in told.splitlines() if not any(each in line for each in of_load)]
        assert lines == []
        statuses.add(status)
        for path in folder.glob("*"):
            assert status in {0, *SILENT}
            assert "symtop_ros.end" in assert_no_deviation(path).file.metadata
    assert statuses <= {0, *SILENT}


@pytest.mark.slow
@pytest.mark.parametrize("words", [("watch",), ("hurry",)], ids=lambda words: words[0])
def test_top_ctl_says_at_most_that_there_was_no_answer(words):
    chance = random.Random(2)
    for _ in range(ATTEMPTS // 2):
        status, told = ended_at_random(chance, "top_ctl", *words)
        if status in SILENT or words == ("watch",):
            assert (status in {0, *SILENT}, told) == (True, "")
        else:
            assert (status, told) == (1, "top_ctl: interrupted before the answer arrived\n")


@pytest.mark.slow
def test_top_live_leaves_no_viewer_behind():
    chance = random.Random(3)
    for _ in range(ATTEMPTS):
        port = viewer.free_port()
        status, told = ended_at_random(chance, "top_live", "--web", "--port", str(port))
        assert status in {0, *SILENT}
        assert "Traceback" not in told
        assert not [each for each in psutil.process_iter(["cmdline"]) if is_viewer(each, port)]


def is_viewer(process, port):
    """Return True for a viewer of Rerun on a port, which is no child of its program after the end.

    The test has this port, so that it is no other program's.
    """
    program, *words = process.info["cmdline"] or [""]
    return Path(program).name == "rerun" and ("--port", str(port)) in pairwise(words)


@pytest.mark.slow
def test_top_replay_ends_in_silence_and_never_says_that_a_log_is_good(tmp_path):
    chance = random.Random(4)
    log = Run(seconds=8.0, rate=1000.0).write(tmp_path)
    for _ in range(ATTEMPTS):
        status, told = ended_at_random(chance, "top_replay", str(log), "--check")
        assert (status in {0, 130, *SILENT}, told) == (True, "")


MS = 1_000_000


@pytest.mark.realtime
@pytest.mark.parametrize("count", trials(4, 8))
def test_stopped_again_and_again_it_counts_what_is_missed_and_the_log_is_exact(tmp_path, count):
    chance = random.Random(1)
    stops = [3.0, *(chance.uniform(0.02, 0.3) for _ in range(count))]
    folder = f"record.directory:={tmp_path}"
    with (
        running_node(DOMAIN, *RECORDING, folder) as node,
        Listener(DOMAIN) as listener,
        measuring() as machine,
    ):
        angles = listener.collect(JointState, "/top/euler_angles", raw=True)
        diagnostics = listener.collect(DiagnosticArray, "/diagnostics")
        listener.spin_until(lambda: len(angles) > 100)
        for seconds in stops:
            os.kill(node.pid, signal.SIGSTOP)
            time.sleep(seconds)
            os.kill(node.pid, signal.SIGCONT)
            listener.spin(chance.uniform(0.0, 0.1))
        resumed = time.time_ns()
        listener.spin_until(lambda: diagnostics and stamp_of(diagnostics[-1]) > resumed)
        missed = int(facts(diagnostics[-1], "top: pace")["missed"])
        end = stamp_of(diagnostics[-1])
        asked = time.time_ns()
        angles.clear()
        listener.spin_until(lambda: angles)
    (path,) = tmp_path.iterdir()
    stamps = stamps_of(path)
    gaps = np.diff(stamps)
    assert not (gaps % MS).any()
    assert gaps.min() == MS
    # The stamp of the diagnostics is that of the next tick: all before it were published or missed.
    # The start's own stamp: that of the first tick, which a slow start may have missed.
    begin = TopLog(McapFile(path)).catalog.events[0].stamp
    # Of the first stop, of 3 s, 100 samples are sent late.
    assert missed == (end - begin) // MS - sum(each < end for each in stamps) > 2800
    assert_exact(path)
    machine.demand(1.0)
    assert abs(stamps[-1] - asked) < 5_000 * MS  # where the clock is
