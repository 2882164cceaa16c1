"""Real-time scheduling of the node's threads: ticks and requests come on time on a busy machine."""

import os


def use_real_time(priority: int) -> str | None:
    """Have this thread, and those that it starts, scheduled with SCHED_FIFO.

    The reason is returned if the machine does not allow it: the node then runs as other programs.
    """
    if not hasattr(os, "sched_setscheduler"):
        return f"scheduling_priority {priority} has no effect: this system has no SCHED_FIFO"
    try:
        os.sched_setscheduler(0, os.SCHED_FIFO, os.sched_param(priority))
    except PermissionError:
        return (
            f"scheduling_priority {priority} has no effect: real-time scheduling needs a right "
            "(`ulimit -r`, or CAP_SYS_NICE; see docs/ros.md)"
        )
    return None
