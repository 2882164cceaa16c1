"""How Linux schedules a thread."""

import ctypes
import platform

from symtop_ros.ros.node.host import SchedulerAttributes

GET_SCHEDULER = {"x86_64": 315, "aarch64": 275}  # the system call sched_getattr


def read_scheduling(thread=0):
    """Return niceness and slice (ns; 0: the usual one) of a thread; 0 is this one."""
    found = SchedulerAttributes()
    number = GET_SCHEDULER[platform.machine()]
    size = ctypes.sizeof(found)
    assert ctypes.CDLL(None).syscall(number, thread, ctypes.byref(found), size, 0) == 0
    return found.niceness, found.runtime
