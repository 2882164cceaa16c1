"""heyoka: Taylor series of the equations of motion, compiled, in three forms.

Besides the quaternion with Euler's equations these are the article's equations in Euler angles,
and Euler angles whose precession and spin rates follow from the two constants of motion: four
variables instead of six or seven. The last two forms have a pole on the vertical.
"""

from collections.abc import Callable
from functools import partial
from typing import Any

import heyoka as hy
import numpy as np

from symtop_ros.base.arrays import Real
from symtop_ros.physics import Motion
from workshop.speed.peers.peer import (
    Arrays,
    Equations,
    Peer,
    Solution,
    from_euler_angles,
    on_euler_angles,
    on_quaternion,
)

DEFAULT = 2.0**-52
SETTINGS = (1e-4, 1e-6, 1e-8, 1e-10, 1e-12, 1e-14, DEFAULT, 1e-17, 1e-18)


on_angles = partial(on_euler_angles, sin=hy.sin, cos=hy.cos)


def on_constants_of_motion(task: Motion) -> Equations:
    """Return phi, theta, psi and theta' as variables, with p_phi and p_psi as constants."""
    Ix, Iz, Mgl = task.top.moments
    phi, theta, psi = task.start.euler_angles
    wz = float(task.start.angular_velocity[2])
    momentum = task.top.angular_momentum(task.start)[2] / Ix
    a = Iz * wz / Ix

    def rates(_: float, variables: Any) -> list[Any]:
        return find_rates(variables, Mgl / Ix, momentum, a, wz)

    start = [phi, theta, psi, task.start.euler_rates[1]]
    return Equations(start, rates, lambda y: from_euler_angles(y[:, :3]))


def find_rates(variables: Any, weight: Any, momentum: Any, a: Any, wz: Any) -> list[Any]:
    """Return the rates for the constants Mgl/Ix, p_phi/Ix, p_psi/Ix and omega_z."""
    _, theta, _, theta_dot = variables
    c, s = hy.cos(theta), hy.sin(theta)
    phi_dot = (momentum - a * c) / (s * s)
    theta_ddot = s * (phi_dot * (phi_dot * c - a) + weight)
    return [phi_dot, theta_dot, wz - phi_dot * c, theta_ddot]


def integrator(equations: Equations, tolerance: float) -> Any:
    """Return the compiled integrator at the start."""
    variables = hy.make_vars(*(f"y{k}" for k in range(len(equations.start))))
    rates = [
        rate if isinstance(rate, hy.expression) else hy.expression(rate)
        for rate in equations.rates(0.0, variables)
    ]
    return hy.taylor_adaptive(
        list(zip(variables, rates, strict=True)), equations.start, tol=tolerance
    )


def prepare(make: Callable[[Motion], Equations], task: Motion, tolerance: float) -> Solution:
    """Compile; each solution starts anew."""
    equations = make(task)
    taylor = integrator(equations, tolerance)
    start = np.array(equations.start)

    def reach(t: float) -> Real:
        taylor.time = 0.0
        taylor.state[:] = start
        taylor.propagate_until(t)
        return np.asarray(equations.read(taylor.state[np.newaxis])[0])

    return Solution.of_arrays(reach, partial(_run_over, taylor, equations))


def prepare_arrays(make: Callable[[Motion], Equations], task: Motion) -> Arrays:
    """Compile at the default tolerance; states at many times come from dense output."""
    equations = make(task)
    return partial(_run_over, integrator(equations, DEFAULT), equations)


def _run_over(taylor: Any, equations: Equations, times: Real) -> Real:
    """Return the orientations (n, 4) at times (n,) from the Taylor series of the steps."""
    taylor.time = 0.0
    taylor.state[:] = equations.start
    grid = np.concatenate([[0.0], times])  # heyoka wants its own time first
    return equations.read(taylor.propagate_grid(grid)[-1][1:])


def prepare_batches(tolerance: float) -> Callable[[Any, float], Real]:
    """Return a function for many motions: one compilation, and several motions at a time.

    The form is that with two constants of motion. What differs between the motions are parameters.
    """
    variables = hy.make_vars("phi", "theta", "psi", "theta_dot")
    rates = find_rates(variables, *(hy.par[k] for k in range(4)))
    size = hy.recommended_simd_size()
    system = list(zip(variables, rates, strict=True))
    taylor = hy.taylor_adaptive_batch(
        system, np.zeros((4, size)), pars=np.zeros((4, size)), tol=tolerance
    )

    def compute(motions: Any, t: float) -> Real:
        top, start = motions.top, motions.start
        angles = start.euler_angles
        wz = start.angular_velocity[:, 2]
        pars = [
            top.Mgl / top.Ix,
            top.angular_momentum(start)[:, 2] / top.Ix,
            top.Iz * wz / top.Ix,
            wz,
        ]
        variables = np.array([*angles, start.euler_rates.theta_dot])
        found = np.empty((3, len(wz)))
        for first in range(0, len(wz), size):
            places = np.arange(first, first + size) % len(wz)
            taylor.set_time(0.0)
            taylor.state[:] = variables[:, places]
            taylor.pars[:] = np.array(pars)[:, places]
            taylor.propagate_until(t)
            found[:, places] = taylor.state[:3]
        return from_euler_angles(found.T)

    return compute


PEERS = [
    Peer(
        f"heyoka, {name}",
        SETTINGS,
        partial(prepare, form),
        "also" if form is on_quaternion else "no",
        None if form is on_angles else partial(prepare_arrays, form),
    )
    for name, form in (
        ("quaternion", on_quaternion),
        ("Euler angles", on_angles),
        ("Euler angles, two constants", on_constants_of_motion),
    )
]
