"""Real-time scheduling of the node, where the machine grants it and where it does not."""

import os

import pytest
from geometry_msgs.msg import QuaternionStamped

from symtop_ros.node.pacer import use_real_time
from symtop_ros.physics import kernel_version


def test_the_thread_gets_the_priority(monkeypatch):
    asked = []
    monkeypatch.setattr(os, "sched_setscheduler", lambda *arguments: asked.append(arguments))
    assert use_real_time(50) is None
    ((thread, policy, parameters),) = asked
    assert (thread, policy, parameters.sched_priority) == (0, os.SCHED_FIFO, 50)


def test_a_machine_that_refuses_is_named_in_a_sentence(monkeypatch):
    def refuse(*_):
        raise PermissionError

    monkeypatch.setattr(os, "sched_setscheduler", refuse)
    assert "real-time scheduling needs a right" in use_real_time(50)


def test_a_system_without_it_is_named_in_a_sentence(monkeypatch):
    monkeypatch.delattr(os, "sched_setscheduler")
    assert "this system has no SCHED_FIFO" in use_real_time(50)


@pytest.mark.parametrize("granted", [True, False])
def test_the_node_runs_with_and_without_the_right(monkeypatch, start_top, capfd, granted):
    def set_scheduler(*_):
        if not granted:
            raise PermissionError

    monkeypatch.setattr(os, "sched_setscheduler", set_scheduler)
    top = start_top(scheduling_priority=50)
    top.wait_for(top.collect(QuaternionStamped, "/top/orientation"))
    assert ("scheduling_priority 50 has no effect" in capfd.readouterr().err) == (not granted)


def test_the_node_says_what_computes_its_states(start_top, capfd):
    top = start_top()
    line = f"states are computed by the kernel, version {kernel_version()}"
    top.spin_until(lambda: True)
    assert line in capfd.readouterr().err
