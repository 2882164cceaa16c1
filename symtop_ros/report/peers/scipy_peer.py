"""SciPy's solve_ivp, on the quaternion with Euler's equations and on Euler angles."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import Any, Literal

import numpy as np
from scipy.integrate import solve_ivp

from symtop_ros.arrays import Real
from symtop_ros.report.peers.peer import (
    TOLERANCES,
    Arrays,
    Peer,
    Solution,
    Task,
    body_rates,
    choose_steps,
    euler_rates,
    from_euler_angles,
    initial_values,
    normalize,
)

Method = Literal["DOP853", "LSODA", "Radau"]
Quick = Literal["every motion", "first motion", "no"]
METHODS: tuple[Method, ...] = ("DOP853", "LSODA", "Radau")


def prepare_quaternion(method: Method, task: Task, rtol: float) -> Solution:
    """Return a solution that integrates the quaternion and the body's angular velocity."""
    run = partial(_run, method, partial(body_rates, task), initial_values(task), rtol)
    return _make_solution(run, lambda states: normalize(states[:, :4]))


def prepare_euler_angles(method: Method, task: Task, rtol: float) -> Solution:
    """Return a solution that integrates phi, theta, psi and their rates."""
    start = [*task.start.euler_angles, *task.start.euler_rates]
    run = partial(_run, method, partial(euler_rates, task), start, rtol)
    return _make_solution(run, lambda states: from_euler_angles(states[:, :3]))


def _make_solution(run: Callable[..., tuple[Real, Real]], read: Callable[[Real], Real]) -> Solution:
    """Return a solution from the integrator's own steps, without its interpolation."""

    def reach(t: float) -> Real:
        return np.asarray(read(run(t, [t])[1])[0])

    def record(t: float) -> tuple[Real, Real]:
        times, states = run(t, None)
        # From the end back: the time t itself is always among them.
        chosen = choose_steps(len(times) - 1)
        return times[:0:-1][chosen], read(states[:0:-1][chosen])

    return Solution(reach, record)


def _run(
    method: Method,
    rates: Callable[..., list[float]],
    start: Any,
    rtol: float,
    t: float,
    times: list[float] | None,
) -> tuple[Real, Real]:
    """Return the times (n,) asked for, or those of all steps, and the variables (n, k)."""
    solution = solve_ivp(rates, (0.0, t), start, method=method, rtol=rtol, atol=rtol, t_eval=times)
    return np.asarray(solution.t), np.asarray(solution.y.T)


def prepare_arrays(task: Task) -> Arrays:
    """Return states at many times, from the dense output of DOP853 at its best tolerance."""

    def solve(times: Real) -> Real:
        rates, start = partial(body_rates, task), initial_values(task)
        span, tolerance = (0.0, float(times[-1])), TOLERANCES[-1]
        solution = solve_ivp(
            rates, span, start, method="DOP853", rtol=tolerance, atol=tolerance, t_eval=times
        )
        return normalize(solution.y[:4].T)

    return solve


def _make_peers() -> list[Peer]:
    peers = []
    for method in METHODS:
        name, arrays = f"SciPy {method}", prepare_arrays if method == "DOP853" else None
        on_quaternion = partial(prepare_quaternion, method)
        on_angles = partial(prepare_euler_angles, method)
        dop853: Quick = "first motion" if method == "DOP853" else "no"
        # LSODA is better in Euler angles. Radau is for stiff equations, which these are not.
        quick: Quick = "no" if method == "Radau" else "first motion"
        peers += [
            Peer(f"{name}, quaternion", TOLERANCES, on_quaternion, "also", arrays, dop853),
            Peer(f"{name}, Euler angles", TOLERANCES, on_angles, quick=quick),
        ]
    return peers


PEERS = _make_peers()
