"""SciPy's solve_ivp, on quaternions of the body and of the turning frame, and on Euler angles."""

from collections.abc import Callable
from functools import partial
from typing import Literal

import numpy as np
from scipy.integrate import solve_ivp

from symtop_ros.base.arrays import Real
from symtop_ros.physics import Motion
from workshop.speed.peers.peer import (
    TOLERANCES,
    Arrays,
    Equations,
    Peer,
    Solution,
    on_euler_angles,
    on_quaternion,
)
from workshop.speed.peers.turning_frame import on_turning_frame

Method = Literal["DOP853", "LSODA", "Radau"]


def integrate(
    method: Method,
    equations: Equations,
    tolerance: float,
    t: float,
    times: Real | list[float] | None = None,
) -> tuple[Real, Real]:
    """Return the times (n,) asked for, or those of all steps, and the variables (n, k)."""
    solution = solve_ivp(
        equations.rates,
        (0.0, t),
        equations.start,
        method=method,
        rtol=tolerance,
        atol=tolerance,
        t_eval=times,
    )
    return np.asarray(solution.t), np.asarray(solution.y.T)


def prepare(
    method: Method, make: Callable[[Motion], Equations], task: Motion, tolerance: float
) -> Solution:
    """Return a solution by a method at a tolerance; `make` returns the equations of a task."""
    equations = make(task)
    run = partial(integrate, method, equations, tolerance)
    return Solution.of_steps(lambda t: run(t, [t])[1], run, equations.read)


def prepare_arrays(task: Motion) -> Arrays:
    """Return states at many times, from the dense output of DOP853 at its best tolerance."""
    equations = on_turning_frame(task)
    run = partial(integrate, "DOP853", equations, TOLERANCES[-1])
    return lambda times: equations.read(times, run(float(times[-1]), times)[1])


def _make_peers(method: Method) -> list[Peer]:
    """Return a method as three peers, by the forms of the equations."""
    arrays = prepare_arrays if method == "DOP853" else None
    forms = on_quaternion, on_turning_frame, on_euler_angles
    quaternion, frame, angles = (partial(prepare, method, form) for form in forms)
    return [
        Peer(f"SciPy {method}, quaternion", TOLERANCES, quaternion, "also"),
        Peer(f"SciPy {method}, turning frame", TOLERANCES, frame, "also", arrays),
        Peer(f"SciPy {method}, Euler angles", TOLERANCES, angles),
    ]


# Radau is for stiff equations, which these are not.
PEERS = [*_make_peers("DOP853"), *_make_peers("LSODA"), *_make_peers("Radau")]
