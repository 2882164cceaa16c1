"""diffrax: Runge-Kutta methods in JAX, compiled, in double precision."""

from __future__ import annotations

from functools import partial
from typing import Any

import diffrax
import jax
import numpy as np

from symtop_ros.report.precision.equations import body_rates
from symtop_ros.report.precision.peers.peer import Peer, Real, Solve, Task, start_of

METHODS = {"Dopri8": diffrax.Dopri8, "Tsit5": diffrax.Tsit5}
SETTINGS = (1e-4, 1e-7, 1e-10, 1e-13)  # a second of compiling each
MOST_STEPS = 2_000_000


def prepare(method: Any, task: Task, rtol: float) -> Solve:
    """Compile, by a first run."""
    jax.config.update("jax_enable_x64", True)
    control = diffrax.PIDController(rtol=rtol, atol=rtol)
    term = diffrax.ODETerm(lambda t, y, _: jax.numpy.stack(body_rates(task, t, tuple(y))))
    start = jax.numpy.array(start_of(task))

    def run(t: Any) -> Any:
        found = diffrax.diffeqsolve(
            *(term, method(), 0.0, t, 1e-4, start),
            stepsize_controller=control,
            max_steps=MOST_STEPS,
            adjoint=diffrax.ForwardMode(),
        )
        return found.ys[0]

    compiled = jax.jit(run)

    def solve(t: float) -> Real:
        q = np.asarray(compiled(t))[:4]
        return np.asarray(q / np.linalg.norm(q))

    solve(1e-3)
    return solve


PEERS = [
    Peer(f"diffrax {name}", SETTINGS, partial(prepare, method), friction="also")
    for name, method in METHODS.items()
]
