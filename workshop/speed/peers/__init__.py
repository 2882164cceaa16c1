"""The integrators that are measured: the package's own engines here, peers in a file each."""

from importlib import import_module

from symtop_ros.physics import Motion
from workshop.speed.peers.peer import Arrays, Peer, Solution

CLOSED_FORM, TAYLOR = "symtop_ros, closed form", "symtop_ros, Taylor series"
SERIES_TOLERANCES = (*(10.0**-k for k in (6, 8, 9, 10, 11, 12, 13, 14, 15)), 0.0)
OPTIONAL = {  # package, and the file here that needs it
    "heyoka": "heyoka_peer",
    "CyRK": "cyrk_peer",
    "mujoco": "mujoco_peer",
    "pydrake": "drake_peer",
    "pinocchio": "pinocchio_peer",
    "exudyn": "exudyn_peer",
    "diffrax": "diffrax_peer",
}


def prepare(task: Motion, tolerance: float) -> Solution:
    """Return a solution that sets the motion up at each call: that is part of its cost."""
    compute = prepare_arrays(task, tolerance)
    return Solution.of_arrays(compute, compute)


def prepare_arrays(task: Motion, tolerance: float = 0.0) -> Arrays:
    """Return a function for the orientations at one time or many."""
    given = task.top, task.start, task.friction, task.applied_torque
    return lambda times: Motion(*given, tolerance=tolerance).at(times).orientation


OWN = [
    Peer(CLOSED_FORM, (0.0,), prepare, prepare_arrays=prepare_arrays),
    Peer(TAYLOR, SERIES_TOLERANCES, prepare, friction="only"),
]


def find_peers() -> tuple[list[Peer], list[str]]:
    """Return the package's engines and the peers that can be imported, and the missing packages."""
    modules = [import_module(f"{__name__}.{file}") for file in ("elliptic_peer", "scipy_peer")]
    missing = []
    for package, file in OPTIONAL.items():
        try:
            modules.append(import_module(f"{__name__}.{file}"))
        except ImportError:
            missing.append(package)
    return OWN + [peer for module in modules for peer in module.PEERS], missing
