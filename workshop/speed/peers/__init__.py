"""The integrators that are measured: the package's own engines here, peers in a file each."""

from importlib import import_module

from symtop_ros.arrays import Real
from symtop_ros.physics import Motion
from workshop.speed.peers.peer import Arrays, Peer, Solution, Task, spread_times

CLOSED_FORM, TAYLOR = "symtop_ros, closed form", "symtop_ros, Taylor series"
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
    """Return a solution that sets the motion up at each call: that is part of its cost."""
    arrays = prepare_arrays(task)

    def reach(t: float) -> Real:
        return _find_motion(task).at(t).orientation

    def record(t: float) -> tuple[Real, Real]:
        times = spread_times(t)
        return times, arrays(times)

    return Solution(reach, record)


def prepare_arrays(task: Task) -> Arrays:
    """Return a function for the orientations at many times."""

    def compute(times: Real) -> Real:
        return _find_motion(task).at(times).orientation

    return compute


def _find_motion(task: Task) -> Motion:
    return Motion(task.top, task.start, task.friction, task.torque)


OWN = [
    Peer(CLOSED_FORM, (0.0,), prepare, prepare_arrays=prepare_arrays, quick="every motion"),
    Peer(TAYLOR, (0.0,), prepare, friction="only", quick="every motion"),
]


def find_peers() -> tuple[list[Peer], list[str]]:
    """Return the package's engines and the peers that can be imported, and the missing packages."""
    modules, missing = [import_module(f"{__name__}.scipy_peer")], []
    for package, file in OPTIONAL.items():
        try:
            modules.append(import_module(f"{__name__}.{file}"))
        except ImportError:
            missing.append(package)
    return OWN + [peer for module in modules for peer in module.PEERS], missing
