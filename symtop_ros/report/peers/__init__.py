"""The integrators that are measured: the package's own engines here, peers in a file each."""

from __future__ import annotations

from importlib import import_module

from symtop_ros.physics import Motion
from symtop_ros.report.peers.peer import Arrays, Peer, Real, Solution, Task, spread_times

CLOSED_FORM, SPLITTING = "symtop_ros, closed form", "symtop_ros, splitting"
OPTIONAL = {  # package, and the file here that needs it
    "heyoka": "heyoka_peer",
    "CyRK": "cyrk_peer",
    "mujoco": "mujoco_peer",
    "pydrake": "drake_peer",
    "pinocchio": "pinocchio_peer",
    "exudyn": "exudyn_peer",
    "diffrax": "diffrax_peer",
}


def prepare(task: Task, _: float) -> Solution:
    """Return a solution that sets the motion up at each call: that is part of its cost.

    Examples
    --------
    >>> from symtop_ros.report.reference import Reference
    >>> problem = Reference.read().article[0]
    >>> problem.error(10.0, prepare(problem.task, 0.0).reach(10.0)) < 1e-15
    True
    """
    arrays = prepare_arrays(task)

    def reach(t: float) -> Real:
        return Motion(task.top, task.start, task.friction, task.torque).at(t).orientation

    def record(t: float) -> tuple[Real, Real]:
        times = spread_times(t)
        return times, arrays(times)

    return Solution(reach, record)


def prepare_arrays(task: Task) -> Arrays:
    """Return the same for many times.

    Examples
    --------
    >>> from symtop_ros.report.reference import Reference
    >>> import numpy as np
    >>> prepare_arrays(Reference.read().article[0].task)(np.array([0.0, 1.0])).shape
    (2, 4)
    """
    given = task.top, task.start, task.friction, task.torque
    return lambda times: Motion(*given).at(times).orientation


OWN = [
    Peer(CLOSED_FORM, (0.0,), prepare, prepare_arrays=prepare_arrays, quick="every motion"),
    Peer(SPLITTING, (0.0,), prepare, friction="only", quick="every motion"),
]


def installed() -> tuple[list[Peer], list[str]]:
    """Return the package's engines and the peers that can be imported, and the missing packages.

    Examples
    --------
    >>> peers, missing = installed()
    >>> peers[0].name
    'symtop_ros, closed form'
    """
    modules, missing = [import_module(f"{__name__}.scipy_peer")], []
    for package, file in OPTIONAL.items():
        try:
            modules.append(import_module(f"{__name__}.{file}"))
        except ImportError:
            missing.append(package)
    return OWN + [peer for module in modules for peer in module.PEERS], missing
