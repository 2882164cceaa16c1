"""Memory over time. SYMTOP_SOAK_SECONDS=1800 makes it half an hour."""

import contextlib
import os
import time
from pathlib import Path

from geometry_msgs.msg import QuaternionStamped
from node.listener import Listener
from programs import running_node

SECONDS = float(os.environ.get("SYMTOP_SOAK_SECONDS", "4"))
WARM = 3.0  # s until all that is kept is filled: points of the engine, pools of the middleware
LARGEST_GROWTH = 1.0  # MB; what the allocator may keep, however long it takes
RATE = 200.0  # Hz, the default
DOMAINS = {"cusps": 93, "friction": 94}


class Watched:
    """A node in another process, and what it takes."""

    def __init__(self, stack, scene, domain):
        self.node = stack.enter_context(running_node(domain, f"scene:={scene}"))
        self.listener = stack.enter_context(Listener(domain))
        self.got = self.listener.collect(QuaternionStamped, "/top/orientation", raw=True)

    def begin(self):
        self.listener.spin_until(lambda: self.got)

    @property
    def memory(self):
        """Resident memory in MB."""
        status = Path(f"/proc/{self.node.pid}/status").read_text()
        (line,) = (line for line in status.splitlines() if line.startswith("VmRSS"))
        return int(line.split()[1]) / 1024


def spin(watched, seconds):
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        for each in watched:
            each.listener.spin(0.02)


def test_memory_is_flat_and_no_sample_is_lost():
    with contextlib.ExitStack() as stack:
        watched = [Watched(stack, *each) for each in DOMAINS.items()]
        for each in watched:
            each.begin()
        spin(watched, WARM)
        warm = [each.memory for each in watched]
        for _ in range(4):
            for each in watched:
                each.got.clear()
            spin(watched, SECONDS / 4)
            assert all(len(each.got) > 0.9 * RATE * SECONDS / 4 for each in watched)
        for each, before in zip(watched, warm, strict=True):
            assert each.memory - before < LARGEST_GROWTH
