"""Pacing: a thread that calls for each tick at its time.

A timer of rclpy would do, but an executor rebuilds its wait set for each of its calls: at 1 kHz
that takes 50 % CPU (one core).

`use_real_time` asks for real-time scheduling, so that ticks and requests come on time on a busy
machine.
"""

import os
import threading
from collections.abc import Callable

# s between two calls, however late they are. Python's locks are not fair: without a pause the
# thread could take the lock again before a waiting request gets it.
MIN_PAUSE = 5e-5


class Pacer:
    """Calls `tick` repeatedly in a thread."""

    def __init__(self, tick: Callable[[], float | None], fail: Callable[[Exception], None]) -> None:
        self._tick, self._fail = tick, fail
        self._awake = threading.Event()
        self._ending = False
        self._thread = threading.Thread(target=self._run, name="pacer", daemon=True)
        self._thread.start()

    def wake(self) -> None:
        """Call `tick` now, because the clock was set or the grid of ticks changed."""
        self._awake.set()

    def stop(self) -> None:
        """End the thread after the current tick."""
        self._ending = True
        self._awake.set()
        if self._thread is not threading.current_thread():
            self._thread.join()

    def _run(self) -> None:
        try:
            while not self._ending:
                wait = self._tick()
                self._awake.wait(None if wait is None else max(wait, MIN_PAUSE))
                self._awake.clear()
        except Exception as error:
            self._fail(error)


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
