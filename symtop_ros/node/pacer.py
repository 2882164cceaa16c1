"""A thread that calls for ticks at their time; requests wait on the executor meanwhile.

An executor of rclpy builds its set of everything it waits for anew for every timer: at 1 kHz that
is half of a core. Here the node's clock alone is waited for.
"""

from __future__ import annotations

import threading
from collections.abc import Callable

REST = 5e-5  # s between two ticks however late they are: a lock is not fair, others need a turn


class Pacer:
    """Calls `tick` again and again.

    Parameters
    ----------
    tick : callable
        Returns how many seconds there are to the next tick; None where only `wake` can tell.
    failed : callable
        Is given the error that `tick` ended with; nothing is called any more after it.
    """

    def __init__(
        self, tick: Callable[[], float | None], failed: Callable[[Exception], None]
    ) -> None:
        self._tick, self._failed = tick, failed
        self._awake = threading.Event()
        self._ending = False
        self._thread = threading.Thread(target=self._run, name="pacer", daemon=True)
        self._thread.start()

    def wake(self) -> None:
        """Look at the clock now: it has been set, or the grid of ticks is another one."""
        self._awake.set()

    def stop(self) -> None:
        """End, after the tick that is under way."""
        self._ending = True
        self._awake.set()
        if self._thread is not threading.current_thread():
            self._thread.join()

    def _run(self) -> None:
        try:
            while not self._ending:
                wait = self._tick()
                self._awake.wait(None if wait is None else max(wait, REST))
                self._awake.clear()
        except Exception as error:
            self._failed(error)
