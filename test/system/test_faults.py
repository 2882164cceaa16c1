"""Faults of processes: one that is stopped again and again, and two of one name."""

import os
import random
import signal
import time

import numpy as np
import pytest
from diagnostic_msgs.msg import DiagnosticArray
from exact_log import assert_exact, stamps_of
from node.listener import Listener
from node.running_top import facts
from programs import running_node
from sensor_msgs.msg import JointState

from symtop_ros.log.reader import McapFile
from symtop_ros.log.top_log import TopLog
from workshop.load.domains import claim_domain

pytestmark = [pytest.mark.untraced, pytest.mark.realtime]

DOMAIN = claim_domain()
MS = 1_000_000


def test_stopped_again_and_again_at_1000_hz_it_counts_what_is_missed_and_the_log_is_exact(tmp_path):
    chance = random.Random(1)
    stops = [1.0, *(chance.uniform(0.02, 0.3) for _ in range(8))]
    parameters = ("publish_rate:=1000", "record.enabled:=true", f"record.directory:={tmp_path}")
    with running_node(DOMAIN, *parameters) as node, Listener(DOMAIN) as listener:
        angles = listener.collect(JointState, "/top/euler_angles", raw=True)
        diagnostics = listener.collect(DiagnosticArray, "/diagnostics")
        listener.spin_until(lambda: len(angles) > 100)
        for seconds in stops:
            os.kill(node.pid, signal.SIGSTOP)
            time.sleep(seconds)
            os.kill(node.pid, signal.SIGCONT)
            listener.spin(chance.uniform(0.0, 0.1))
        listener.wait_for(diagnostics, 2)
        missed = int(facts(diagnostics[-1], "top: pace")["missed"])
        stamp = diagnostics[-1].header.stamp
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
    begin = next(TopLog(McapFile(path)).events()).stamp
    until = stamp.sec * 1000 * MS + stamp.nanosec
    assert missed == (until - begin) // MS - sum(each < until for each in stamps) > 800
    assert abs(stamps[-1] - asked) < 5_000 * MS  # where the clock is
    assert_exact(path)
