"""Real-time scheduling of the node, where the machine grants it and where it does not."""

import os

import pytest
from geometry_msgs.msg import QuaternionStamped

from symtop_ros.physics import kernel_version


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


def test_the_node_says_what_computes_its_states(start_top, capfd):
    top = start_top()
    line = f"states are computed by the kernel, version {kernel_version()}"
    top.spin_until(lambda: True)
    assert line in capfd.readouterr().err
