"""SciPy's solve_ivp, on the quaternion with Euler's equations and on Euler angles."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import Any, Literal

import numpy as np
from scipy.integrate import solve_ivp

from symtop_ros.physics import State
from symtop_ros.report.precision.equations import body_rates, euler_rates
from symtop_ros.report.precision.peers.peer import TOLERANCES, Peer, Real, Solve, Task, start_of

Method = Literal["DOP853", "LSODA", "Radau"]
METHODS: tuple[Method, ...] = ("DOP853", "LSODA", "Radau")


def on_quaternions(method: Method, task: Task, rtol: float) -> Solve:
    """Integrate w, x, y, z and the body's angular velocity."""

    def solve(t: float) -> Any:
        q = np.array(_end(method, partial(body_rates, task), start_of(task), t, rtol)[:4])
        return q / np.linalg.norm(q)

    return solve


def on_euler_angles(method: Method, task: Task, rtol: float) -> Solve:
    """Integrate phi, theta, psi and their rates."""
    start = [*task.start.euler_angles, *task.start.euler_rates]

    def solve(t: float) -> Any:
        phi, theta, psi = _end(method, partial(euler_rates, task), start, t, rtol)[:3]
        return State.from_euler(phi=phi, theta=theta, psi=psi).orientation

    return solve


def prepare_grid(task: Task) -> Callable[[Real], Real]:
    """Times (n,) to orientations (n, 4), by the dense output of DOP853 at its best tolerance."""

    def solve(times: Real) -> Real:
        rates, start = partial(body_rates, task), start_of(task)
        span, tolerance = (0.0, float(times[-1])), TOLERANCES[-1]
        solution = solve_ivp(
            rates, span, start, method="DOP853", rtol=tolerance, atol=tolerance, t_eval=times
        )
        q = solution.y[:4].T
        return np.asarray(q / np.linalg.norm(q, axis=1, keepdims=True))

    return solve


def _end(
    method: Method, rates: Callable[..., list[float]], start: Any, t: float, rtol: float
) -> list[float]:
    solution = solve_ivp(rates, (0.0, t), start, method=method, rtol=rtol, atol=rtol, t_eval=[t])
    return [float(each) for each in solution.y[:, -1]]


def _peers() -> list[Peer]:
    found = []
    for method in METHODS:
        name, tolerances = f"SciPy {method}", TOLERANCES
        solve = partial(on_quaternions, method)
        found.append(Peer(f"{name}, quaternion", tolerances, solve, friction="also"))
        angles = partial(on_euler_angles, method)
        found.append(Peer(f"{name}, Euler angles", tolerances, angles))
    return found


PEERS = _peers()
