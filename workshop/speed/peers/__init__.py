"""The integrators that are measured: the package's own engines here, peers in a file each."""

from functools import partial
from importlib import import_module

from symtop_ros.arrays import Real
from symtop_ros.physics import Motion, accelerated
from workshop.speed.peers.peer import Arrays, Peer, Solution, Task, spread_times

CLOSED_FORM, TAYLOR = "symtop_ros, closed form", "symtop_ros, Taylor series"
ALONE = ", Python alone"  # follows these names where there is a kernel to do without
OPTIONAL = {  # package, and the file here that needs it
    "heyoka": "heyoka_peer",
    "CyRK": "cyrk_peer",
    "mujoco": "mujoco_peer",
    "pydrake": "drake_peer",
    "pinocchio": "pinocchio_peer",
    "exudyn": "exudyn_peer",
    "diffrax": "diffrax_peer",
}


def prepare(task: Task, _: float, pure: bool = False) -> Solution:
    """Return a solution that sets the motion up at each call: that is part of its cost."""
    arrays = prepare_arrays(task, pure)

    def reach(t: float) -> Real:
        return _find_motion(task, pure).at(t).orientation

    def record(t: float) -> tuple[Real, Real]:
        times = spread_times(t)
        return times, arrays(times)

    return Solution(reach, record)


def prepare_arrays(task: Task, pure: bool = False) -> Arrays:
    """Return a function for the orientations at many times."""

    def compute(times: Real) -> Real:
        return _find_motion(task, pure).at(times).orientation

    return compute


def _find_motion(task: Task, pure: bool) -> Motion:
    return Motion(task.top, task.start, task.friction, task.torque, pure=pure)


def _list_own(ending: str, pure: bool) -> list[Peer]:
    solve, arrays = partial(prepare, pure=pure), partial(prepare_arrays, pure=pure)
    return [
        Peer(CLOSED_FORM + ending, (0.0,), solve, prepare_arrays=arrays, quick="every motion"),
        Peer(TAYLOR + ending, (0.0,), solve, friction="only", quick="every motion"),
    ]


OWN = _list_own("", pure=False) + (_list_own(ALONE, pure=True) if accelerated else [])


def find_peers() -> tuple[list[Peer], list[str]]:
    """Return the package's engines and the peers that can be imported, and the missing packages."""
    modules, missing = [import_module(f"{__name__}.scipy_peer")], []
    for package, file in OPTIONAL.items():
        try:
            modules.append(import_module(f"{__name__}.{file}"))
        except ImportError:
            missing.append(package)
    return OWN + [peer for module in modules for peer in module.PEERS], missing
