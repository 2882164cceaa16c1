"""diffrax: Runge-Kutta methods in JAX, compiled, in double precision."""

from collections.abc import Callable
from functools import partial
from typing import Any

import diffrax
import jax
import numpy as np

from symtop_ros.base.arrays import Real
from symtop_ros.physics import Motion
from workshop.speed.peers.peer import Equations, Peer, Solution, on_quaternion
from workshop.speed.peers.turning_frame import on_turning_frame

SETTINGS = (1e-7, 1e-11, 1e-14, 1e-15)  # a second of compiling each
MOST_STEPS = 2_000_000
MOST_RECORDED = 65_536  # steps of the untimed run, for which memory is set aside


def prepare(
    method: str, form: Callable[[Motion], Equations], task: Motion, rtol: float
) -> Solution:
    """Compile, by a short first run; each solution starts anew."""
    jax.config.update("jax_enable_x64", True)
    control = diffrax.PIDController(rtol=rtol, atol=rtol)
    equations = form(task)
    term = diffrax.ODETerm(lambda t, y, _: jax.numpy.stack(equations.rates(t, tuple(y))))
    start = jax.numpy.array(equations.start)

    def run(saved: Any, most_steps: int, t: Any) -> Any:
        found = diffrax.diffeqsolve(
            term,
            getattr(diffrax, method)(),
            0.0,
            t,
            1e-4,
            start,
            saveat=saved,
            stepsize_controller=control,
            max_steps=most_steps,
            adjoint=diffrax.ForwardMode(),
        )
        return found.ts, found.ys

    compiled = jax.jit(partial(run, diffrax.SaveAt(t1=True), MOST_STEPS))

    def record(t: float) -> tuple[Real, Real]:
        found = jax.jit(partial(run, diffrax.SaveAt(t0=True, steps=True), MOST_RECORDED))(t)
        times, states = (np.asarray(each) for each in found)
        made = np.isfinite(times)  # the rest of the memory is filled by inf
        return times[made], states[made]

    compiled(1e-3)
    return Solution.of_steps(lambda t: np.asarray(compiled(t)[1]), record, equations.read)


FORMS = {"quaternion": on_quaternion, "turning frame": on_turning_frame}
PEERS = [
    Peer(f"diffrax {method}, {name}", SETTINGS, partial(prepare, method, form), friction="also")
    for method in ("Dopri8", "Tsit5")
    for name, form in FORMS.items()
]
