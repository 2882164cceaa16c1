"""The thread that calls for ticks, and its real-time scheduling."""

import os
import threading

import pytest
from geometry_msgs.msg import QuaternionStamped
from waiting import TIMEOUT

from symtop_ros.node.host import Pacer


class Ticks:
    """Counts ticks, and answers with what they are to wait for."""

    def __init__(self, *waits):
        self.waits, self.count = list(waits), 0
        self.done, self.failed = threading.Event(), threading.Event()

    def tick(self):
        self.count += 1
        if not self.waits:
            self.done.set()
            return None
        wait = self.waits.pop(0)
        if isinstance(wait, Exception):
            raise wait
        return wait

    def fail(self, error):
        self.error = error
        self.failed.set()


def test_it_ticks_at_once_after_each_wait_and_where_only_the_clock_can_tell_when_it_is_woken():
    ticks = Ticks(0.001, -1.0, 0.0, 0.002, None, None)
    pacer = Pacer(ticks.tick, ticks.fail)
    while not ticks.done.wait(0.001):
        pacer.wake()
    pacer.stop()
    assert ticks.count >= 7


def test_to_wake_it_during_a_tick_is_not_forgotten():
    begun, ticks = threading.Event(), Ticks(None)

    def tick():
        begun.wait(TIMEOUT)
        pacer.wake()
        return ticks.tick()

    pacer = Pacer(tick, ticks.fail)
    begun.set()
    assert ticks.done.wait(TIMEOUT)
    pacer.stop()


def test_an_error_ends_it_and_is_told():
    error = ValueError("no")
    ticks = Ticks(0.0, error)
    pacer = Pacer(ticks.tick, ticks.fail)
    assert ticks.failed.wait(TIMEOUT)
    assert ticks.error is error
    pacer.stop()
    pacer.stop()
    assert ticks.count == 2


@pytest.mark.parametrize("granted", [True, False])
def test_the_node_runs_with_and_without_the_right(monkeypatch, start_top, capfd, granted):
    asked = []

    def set_scheduler(thread, policy, parameters):
        asked.append((thread, policy, parameters.sched_priority))
        if not granted:
            raise PermissionError

    monkeypatch.setattr(os, "sched_setscheduler", set_scheduler)
    top = start_top(scheduling_priority=50)
    top.wait_for(top.collect(QuaternionStamped, "/top/orientation"))
    assert asked == [(0, os.SCHED_FIFO, 50)]
    assert ("scheduling_priority 50 has no effect" in capfd.readouterr().err) == (not granted)
