"""The package's engines: the closed form, and under friction the splitting."""

from __future__ import annotations

from symtop_ros.physics import motion
from symtop_ros.report.precision.peers.peer import Peer, Solve, Task

CLOSED_FORM, SPLITTING = "symtop_ros, closed form", "symtop_ros, splitting"


def prepare(task: Task, _: float) -> Solve:
    """Return a solution that sets the motion up at each call: that is part of its cost."""
    return lambda t: motion(task.top, task.start, task.friction).at(t).orientation


PEERS = [
    Peer(CLOSED_FORM, (0.0,), prepare),
    Peer(SPLITTING, (0.0,), prepare, friction="only"),
]
