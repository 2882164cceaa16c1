"""Memory over time. SYMTOP_SOAK_SECONDS=1800 makes it half an hour."""

import os
from pathlib import Path

import pytest
from geometry_msgs.msg import QuaternionStamped
from node.listener import Listener
from programs import running_node

SECONDS = float(os.environ.get("SYMTOP_SOAK_SECONDS", "12"))
WARM = 5.0  # s until all that is kept is filled: points of the engine, pools of the middleware
LARGEST_GROWTH = 1.0  # MB; what the allocator may keep, however long it takes
DOMAINS = {"cusps": 97, "friction": 98}


def memory(pid):
    """Resident memory of a process in MB."""
    status = Path(f"/proc/{pid}/status").read_text()
    (line,) = (line for line in status.splitlines() if line.startswith("VmRSS"))
    return int(line.split()[1]) / 1024


@pytest.mark.parametrize("scene", DOMAINS)
def test_memory_is_flat(scene):
    domain = DOMAINS[scene]
    with running_node(domain, f"scene:={scene}") as node, Listener(domain) as listener:
        got = listener.collect(QuaternionStamped, "/top/orientation", raw=True)
        listener.spin_until(lambda: got)
        listener.spin(WARM)
        warm = memory(node.pid)
        for _ in range(10):
            got.clear()
            listener.spin(SECONDS / 10)
            assert len(got) > 0.9 * 200 * SECONDS / 10
        assert memory(node.pid) - warm < LARGEST_GROWTH
