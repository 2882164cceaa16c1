"""heyoka: Taylor series of the equations of motion, compiled."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import heyoka as hy
import numpy as np

from symtop_ros.report.precision.equations import body_rates
from symtop_ros.report.precision.peers.peer import Peer, Real, Solve, Task, start_of

NAMES = ("w", "x", "y", "z", "wx", "wy", "wz")
SETTINGS = (1e-4, 1e-7, 1e-10, 1e-13, 2.0**-52)  # the last is its default


def integrator(task: Task, tolerance: float) -> Any:
    """Return the compiled integrator at the start."""
    variables = hy.make_vars(*NAMES)
    rates = body_rates(task, 0.0, variables)
    rates = [rate if isinstance(rate, hy.expression) else hy.expression(rate) for rate in rates]
    equations = list(zip(variables, rates, strict=True))
    return hy.taylor_adaptive(equations, start_of(task), tol=tolerance)


def prepare(task: Task, tolerance: float) -> Solve:
    """Compile; a solution goes back to the start first."""
    taylor, start = integrator(task, tolerance), np.array(start_of(task))

    def solve(t: float) -> Real:
        taylor.time = 0.0
        taylor.state[:] = start
        taylor.propagate_until(t)
        return np.array(taylor.state[:4])

    return solve


def prepare_grid(task: Task) -> Callable[[Real], Real]:
    """Compile, at the best tolerance; times (n,) to orientations (n, 4), by dense output."""
    taylor, start = integrator(task, SETTINGS[-1]), np.array(start_of(task))

    def solve(times: Real) -> Real:
        taylor.time = 0.0
        taylor.state[:] = start
        grid = np.concatenate([[0.0], times])  # it must begin where the integrator is
        return np.asarray(taylor.propagate_grid(grid)[-1][1:, :4])

    return solve


PEERS = [Peer("heyoka", SETTINGS, prepare, friction="also")]
