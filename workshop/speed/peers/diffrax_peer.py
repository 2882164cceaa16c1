"""diffrax: Runge-Kutta methods in JAX, compiled, in double precision."""

from functools import partial
from typing import Any

import diffrax
import jax
import numpy as np

from symtop_ros.arrays import Real
from workshop.speed.peers.peer import (
    Peer,
    Quick,
    Solution,
    Task,
    body_rates,
    choose_steps,
    initial_values,
    normalize,
)

METHODS: tuple[tuple[str, Quick], ...] = (("Dopri8", "first motion"), ("Tsit5", "no"))
SETTINGS = (1e-7, 1e-11, 1e-14, 1e-15)  # a second of compiling each
MOST_STEPS = 2_000_000
MOST_RECORDED = 65_536  # steps of the untimed run, for which memory is set aside


def prepare(method: str, task: Task, rtol: float) -> Solution:
    """Compile, by a short first run; each solution starts anew."""
    jax.config.update("jax_enable_x64", True)
    control = diffrax.PIDController(rtol=rtol, atol=rtol)
    term = diffrax.ODETerm(lambda t, y, _: jax.numpy.stack(body_rates(task, t, tuple(y))))
    start = jax.numpy.array(initial_values(task))

    def run(saved: Any, most_steps: int, t: Any) -> Any:
        found = diffrax.diffeqsolve(
            *(term, getattr(diffrax, method)(), 0.0, t, 1e-4, start),
            saveat=saved,
            stepsize_controller=control,
            max_steps=most_steps,
            adjoint=diffrax.ForwardMode(),
        )
        return found.ts, found.ys

    compiled = jax.jit(partial(run, diffrax.SaveAt(t1=True), MOST_STEPS))

    def reach(t: float) -> Real:
        return normalize(np.asarray(compiled(t)[1])[0, :4])

    def record(t: float) -> tuple[Real, Real]:
        found = jax.jit(partial(run, diffrax.SaveAt(steps=True), MOST_RECORDED))(t)
        times, states = (np.asarray(each) for each in found)
        steps = np.flatnonzero(np.isfinite(times))[::-1]  # the rest of the memory is filled by inf
        chosen = steps[choose_steps(len(steps))]
        return times[chosen], normalize(states[chosen, :4])

    reach(1e-3)
    return Solution(reach, record)


PEERS = [
    Peer(f"diffrax {name}", SETTINGS, partial(prepare, name), friction="also", quick=quick)
    for name, quick in METHODS
]
