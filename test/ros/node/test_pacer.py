"""The thread that calls for ticks, and its scheduling."""

import os
import platform
import threading
from pathlib import Path

import pytest
from geometry_msgs.msg import QuaternionStamped
from programs import command, running
from ros.node.scheduling import GET_SCHEDULER, read_scheduling
from waiting import TIMEOUT

from symtop_ros.ros.node.host import SLICE, Pacer
from workshop.load.domains import share_domain


class Ticks:
    """Counts ticks, and answers with what they are to wait for."""

    def __init__(self, *waits):
        self.waits = list(waits)
        self.count = 0
        self.done = threading.Event()

    def tick(self):
        self.count += 1
        if not self.waits:
            self.done.set()
            return None
        return self.waits.pop(0)


def start_pacer(tick):
    """A pacer with the usual scheduling."""
    return Pacer(tick, 0, pytest.fail)


def test_it_ticks_at_once_after_each_wait_or_when_the_clock_wakes_it():
    ticks = Ticks(0.001, -1.0, 0.0, 0.002, None, None)
    pacer = start_pacer(ticks.tick)
    while not ticks.done.wait(0.001):
        pacer.wake()
    pacer.stop()
    assert ticks.count >= 7


def test_to_wake_it_during_a_tick_is_not_forgotten():
    begun = threading.Event()
    ticks = Ticks(None)

    def tick():
        begun.wait(TIMEOUT)
        pacer.wake()
        return ticks.tick()

    pacer = start_pacer(tick)
    begun.set()
    assert ticks.done.wait(TIMEOUT)
    pacer.stop()


@pytest.mark.parametrize("granted", [True, False])
def test_the_node_runs_with_and_without_the_right(monkeypatch, start_top, capfd, granted):
    """Its thread alone is to be scheduled in real time: the others are those of the user."""
    asked = []

    def set_scheduler(thread, policy, parameters):
        who = threading.current_thread().name
        asked.append((who, thread, policy, parameters.sched_priority))
        if not granted:
            raise PermissionError

    monkeypatch.setattr(os, "sched_setscheduler", set_scheduler)
    top = start_top(scheduling_priority=50)
    top.wait_for(top.collect(QuaternionStamped, "/top/orientation"))
    assert asked == [("pacer", 0, os.SCHED_FIFO, 50)]
    assert ("scheduling_priority 50 has no effect" in capfd.readouterr().err) == (not granted)


skip_without_slices = pytest.mark.skipif(
    platform.machine() not in GET_SCHEDULER
    or tuple(map(int, platform.release().split(".")[:2])) < (6, 12),
    reason="needs Linux 6.12, on a processor that is known here",
)


@skip_without_slices
def test_the_program_and_its_middleware_have_a_short_slice():
    """A request comes through threads of both."""
    with running(command("top_node"), share_domain()) as node:
        while "states are computed" not in node.stderr.readline():
            assert node.poll() is None
        threads = [*Path(f"/proc/{node.pid}/task").iterdir()]
        own = [each for each in threads if (each / "comm").read_text().startswith("dds.")]
        assert own
        found = {read_scheduling(int(each.name))[1] for each in own}
        assert {*found, read_scheduling(node.pid)[1]} == {SLICE}


@skip_without_slices
def test_it_alone_has_a_short_slice_and_keeps_its_niceness():
    found = []
    ended = threading.Event()

    def tick():
        found.append(read_scheduling())
        ended.set()

    pacer = start_pacer(tick)
    assert ended.wait(TIMEOUT)
    pacer.stop()
    niceness, usual = read_scheduling()
    assert found[0] == (niceness, SLICE)
    assert usual != SLICE
