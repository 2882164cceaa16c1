"""heyoka: Taylor series of the equations of motion, compiled, in five forms.

Besides the quaternion with Euler's equations these are the article's equations in Euler angles,
and Euler angles whose precession and spin rates follow from the two constants of motion: four
variables instead of six or seven. Both have a pole on the vertical. The other two are in the frame
that leaves the spin out, with the spin as a variable, and with a formula for it, in doubles and in
80 bits.
"""

from collections.abc import Callable
from functools import partial
from typing import Any, NamedTuple

import heyoka as hy
import numpy as np

from symtop_ros.base.arrays import Real
from symtop_ros.physics import Motion
from workshop.speed.peers.peer import (
    Arrays,
    Equations,
    Friction,
    Peer,
    Solution,
    from_euler_angles,
    normalize,
    on_euler_angles,
    on_quaternion,
)
from workshop.speed.peers.turning_frame import (
    on_turning_frame,
    on_turning_frame_with_known_spin,
    turn_about_axis,
)

DEFAULT = 2.0**-52
SETTINGS = (1e-4, 1e-6, 1e-8, 1e-9, 1e-10, 1e-11, 1e-12, 1e-13, 1e-14, DEFAULT, 1e-17, 1e-18)
LONG_SETTINGS = (1e-14, 1e-16, 1e-18, 1e-19, 1e-20)  # of 80 bits

on_angles = partial(on_euler_angles, sin=hy.sin, cos=hy.cos)
on_known_spin = partial(on_turning_frame_with_known_spin, exp=hy.exp)
on_known_spin_in_80_bits = partial(on_known_spin, number=np.longdouble)


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
    return Equations(start, rates, lambda _, y: from_euler_angles(y[:, :3]))


def find_rates(variables: Any, weight: Any, momentum: Any, a: Any, wz: Any) -> list[Any]:
    """Return the rates for the constants Mgl/Ix, p_phi/Ix, p_psi/Ix and omega_z."""
    _, theta, _, theta_dot = variables
    c, s = hy.cos(theta), hy.sin(theta)
    phi_dot = (momentum - a * c) / (s * s)
    theta_ddot = s * (phi_dot * (phi_dot * c - a) + weight)
    return [phi_dot, theta_dot, wz - phi_dot * c, theta_ddot]


def integrator(equations: Equations, tolerance: float) -> Any:
    """Return the compiled integrator at the start, with the numbers that the start has."""
    number = type(equations.start[0])
    variables = hy.make_vars(*(f"y{k}" for k in range(len(equations.start))))
    rates = [
        rate if isinstance(rate, hy.expression) else hy.expression(rate)
        for rate in equations.rates(hy.time, variables)
    ]
    system = list(zip(variables, rates, strict=True))
    return hy.taylor_adaptive(system, equations.start, tol=number(tolerance), fp_type=number)


def prepare(make: Callable[[Motion], Equations], task: Motion, tolerance: float) -> Solution:
    """Compile; each solution starts anew."""
    equations = make(task)
    taylor = integrator(equations, tolerance)
    start = np.array(equations.start)
    number = start.dtype.type

    def reach(t: float) -> Real:
        taylor.time = number(0.0)
        taylor.state[:] = start
        taylor.propagate_until(number(t))
        return np.asarray(equations.read(np.array([t]), taylor.state[np.newaxis])[0])

    return Solution.of_arrays(reach, partial(_run_over, taylor, equations))


def prepare_arrays(make: Callable[[Motion], Equations], task: Motion) -> Arrays:
    """Compile at the default tolerance; states at many times come from dense output."""
    equations = make(task)
    return partial(_run_over, integrator(equations, DEFAULT), equations)


def _run_over(taylor: Any, equations: Equations, times: Real) -> Real:
    """Return the orientations (n, 4) at times (n,) from the Taylor series of the steps."""
    taylor.time = type(equations.start[0])(0.0)
    taylor.state[:] = equations.start
    # heyoka wants its own time first
    grid = np.concatenate([[0.0], times]).astype(taylor.state.dtype)
    return equations.read(times, taylor.propagate_grid(grid)[-1][1:])


class Batches(NamedTuple):
    """A form for many motions: what differs between them are parameters."""

    names: str  # of the variables
    parameters: int  # how many
    rates: Callable[[Any], list[Any]]  # of the variables, with hy.par[k] for the parameters
    # the variables (v, n) and parameters (p, n) of many motions, and orientations (n, 4) at t in s
    begin: Callable[[Any], tuple[Real, Real]]
    read: Callable[[Any, Real, float], Real]


def _begin_with_constants(motions: Any) -> tuple[Real, Real]:
    top, start = motions.top, motions.start
    wz = start.angular_velocity[:, 2]
    momentum = top.angular_momentum(start)[:, 2] / top.Ix
    pars = [top.Mgl / top.Ix, momentum, top.Iz * wz / top.Ix, wz]
    return np.array([*start.euler_angles, start.euler_rates.theta_dot]), np.array(pars)


def _begin_in_frame(motions: Any) -> tuple[Real, Real]:
    top, start = motions.top, motions.start
    wx, wy, wz = start.angular_velocity.T
    return np.array([*start.orientation.T, wx, wy]), np.array(
        [top.Mgl / top.Ix, top.Iz / top.Ix * wz]
    )


def _find_rates_in_frame(variables: Any) -> list[Any]:
    w, x, y, z, wx, wy = variables
    weight, turn = hy.par[0], hy.par[1]
    return [
        (-x * wx - y * wy - z * turn) / 2,
        (w * wx + y * turn - z * wy) / 2,
        (w * wy - x * turn + z * wx) / 2,
        (w * turn + x * wy - y * wx) / 2,
        2 * weight * (y * z + w * x),
        -2 * weight * (x * z - w * y),
    ]


def _read_in_frame(motions: Any, found: Real, t: float) -> Real:
    half = (1 - motions.top.Iz / motions.top.Ix) / 2 * motions.start.angular_velocity[:, 2] * t
    return turn_about_axis(normalize(found[:4].T), half)


BATCHES = {
    "two constants": Batches(
        "phi theta psi theta_dot",
        4,
        lambda variables: find_rates(variables, *(hy.par[k] for k in range(4))),
        _begin_with_constants,
        lambda _, found, __: from_euler_angles(found[:3].T),
    ),
    "turning frame": Batches(
        "w x y z wx wy", 2, _find_rates_in_frame, _begin_in_frame, _read_in_frame
    ),
}


def prepare_batches(name: str, tolerance: float) -> Callable[[Any, float], Real]:
    """Return a function for many motions: one compilation, and several motions at a time."""
    form = BATCHES[name]
    variables = hy.make_vars(*form.names.split())
    size = hy.recommended_simd_size()
    taylor = hy.taylor_adaptive_batch(
        list(zip(variables, form.rates(variables), strict=True)),
        np.zeros((len(variables), size)),
        pars=np.zeros((form.parameters, size)),
        tol=tolerance,
    )

    def compute(motions: Any, t: float) -> Real:
        start, pars = form.begin(motions)
        found = np.empty_like(start)
        count = start.shape[1]
        for first in range(0, count, size):
            places = np.arange(first, first + size) % count
            taylor.set_time(0.0)
            taylor.state[:] = start[:, places]
            taylor.pars[:] = pars[:, places]
            taylor.propagate_until(t)
            found[:, places] = taylor.state
        return form.read(motions, found, t)

    return compute


QUATERNION, TURNING = "heyoka, quaternion", "heyoka, turning frame"
KNOWN_SPIN, LONG = "heyoka, turning frame, known spin", "heyoka, turning frame, 80 bits"
FORMS: dict[
    str, tuple[Callable[[Motion], Equations], Friction]
] = {  # and whether friction has a place in it
    QUATERNION: (on_quaternion, "also"),
    "heyoka, Euler angles": (on_angles, "no"),
    "heyoka, Euler angles, two constants": (on_constants_of_motion, "no"),
    TURNING: (on_turning_frame, "also"),
    KNOWN_SPIN: (on_known_spin, "also"),
    LONG: (on_known_spin_in_80_bits, "also"),
}
WITHOUT_ARRAYS = "heyoka, Euler angles", TURNING, LONG  # slower than another one of its forms
PEERS = [
    Peer(
        name,
        LONG_SETTINGS if name == LONG else SETTINGS,
        partial(prepare, form),
        friction,
        None if name in WITHOUT_ARRAYS else partial(prepare_arrays, form),
    )
    for name, (form, friction) in FORMS.items()
]
