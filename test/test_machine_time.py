"""The bare loop that tells what the machine gives."""

import os
import signal
import time

import psutil
import pytest
from machine_time import MachineTime, measuring


def test_a_test_is_skipped_with_a_figure_if_the_machine_stood_still():
    others = {*psutil.Process().children()}  # of other tests
    with measuring() as machine:
        (loop,) = {*psutil.Process().children()} - others
        os.kill(loop.pid, signal.SIGSTOP)
        time.sleep(0.2)
        os.kill(loop.pid, signal.SIGCONT)
    assert machine.longest >= 0.2
    machine.demand(machine.longest)
    with pytest.raises(pytest.skip.Exception, match=r"for 0\.300 s, needed 0\.1 s"):
        demand_of(0.3)


def demand_of(longest):
    machine = MachineTime()
    machine.longest = longest
    machine.demand(0.1)
