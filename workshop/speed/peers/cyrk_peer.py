"""CyRK: the Runge-Kutta methods of SciPy in C++, with compiled equations of motion."""

from collections.abc import Callable
from functools import partial
from math import cos, sin
from typing import Any

import numpy as np
from CyRK import nb_diffeq_addr, nbsolve2_ivp

from symtop_ros.base.arrays import Real
from symtop_ros.physics import Motion
from workshop.speed.peers.peer import (
    Equations,
    Peer,
    Solution,
    on_euler_angles,
    on_quaternion,
)
from workshop.speed.peers.turning_frame import on_turning_frame

METHOD = "DOP853"  # the most exact of its methods here; Vern7 and Vern8 were tried as well
SETTINGS = (1e-5, 1e-7, 1e-9, 1e-11, 1e-13, 1e-14, 1e-15, 2.0**-52)
Rates = Callable[..., None]


def compile_quaternion(task: Motion) -> tuple[Rates, Equations]:
    """Return rates for quaternion and angular velocity that CyRK compiles, and the equations."""
    Ix, Iz, Mgl = task.top.moments
    axial, transverse = task.friction.axial, task.friction.transverse

    # CyRK compiles this function. A subset of Python, it cannot call `body_rates`.
    def rates(slopes: Any, _t: float, y: Any, _arguments: Any) -> None:
        gx = 2 * (y[1] * y[3] - y[0] * y[2])
        gy = 2 * (y[2] * y[3] + y[0] * y[1])
        slopes[0] = (-y[1] * y[4] - y[2] * y[5] - y[3] * y[6]) / 2
        slopes[1] = (y[0] * y[4] + y[2] * y[6] - y[3] * y[5]) / 2
        slopes[2] = (y[0] * y[5] - y[1] * y[6] + y[3] * y[4]) / 2
        slopes[3] = (y[0] * y[6] + y[1] * y[5] - y[2] * y[4]) / 2
        slopes[4] = ((Ix - Iz) * y[5] * y[6] + Mgl * gy - transverse * y[4]) / Ix
        slopes[5] = ((Iz - Ix) * y[6] * y[4] - Mgl * gx - transverse * y[5]) / Ix
        slopes[6] = -axial * y[6] / Iz

    return rates, on_quaternion(task)


def compile_turning_frame(task: Motion) -> tuple[Rates, Equations]:
    """Return rates in the frame without the spin that CyRK compiles, and the equations."""
    Ix, Iz, Mgl = task.top.moments
    axial, transverse = task.friction.axial, task.friction.transverse

    def rates(slopes: Any, _t: float, y: Any, _arguments: Any) -> None:
        turn = Iz / Ix * y[6]
        slopes[0] = (-y[1] * y[4] - y[2] * y[5] - y[3] * turn) / 2
        slopes[1] = (y[0] * y[4] + y[2] * turn - y[3] * y[5]) / 2
        slopes[2] = (y[0] * y[5] - y[1] * turn + y[3] * y[4]) / 2
        slopes[3] = (y[0] * turn + y[1] * y[5] - y[2] * y[4]) / 2
        slopes[4] = (2 * Mgl * (y[2] * y[3] + y[0] * y[1]) - transverse * y[4]) / Ix
        slopes[5] = (-2 * Mgl * (y[1] * y[3] - y[0] * y[2]) - transverse * y[5]) / Ix
        slopes[6] = -axial * y[6] / Iz
        slopes[7] = y[6]

    return rates, on_turning_frame(task)


def compile_euler_angles(task: Motion) -> tuple[Rates, Equations]:
    """Return rates for Euler angles and their rates that CyRK compiles, and the equations."""
    Ix, Iz, Mgl = task.top.moments

    def rates(slopes: Any, _t: float, y: Any, _arguments: Any) -> None:
        c, s = cos(y[1]), sin(y[1])
        gyration = Iz * y[5] + (Iz - 2 * Ix) * y[3] * c
        slopes[0], slopes[1], slopes[2] = y[3], y[4], y[5]
        slopes[3] = y[4] / (Ix * s) * gyration
        slopes[4] = s / Ix * ((Ix - Iz) * y[3] * y[3] * c - Iz * y[3] * y[5] + Mgl)
        slopes[5] = y[4] * y[3] * s - slopes[3] * c

    return rates, on_euler_angles(task)


def prepare(
    form: Callable[[Motion], tuple[Rates, Equations]], task: Motion, tolerance: float
) -> Solution:
    """Compile; each solution starts anew."""
    rates, equations = form(task)
    address = nb_diffeq_addr(rates)
    start = np.array(equations.start)

    def run(t: float) -> tuple[Real, Real]:
        """Return the times (n,) and the variables (n, k) of all steps."""
        found = nbsolve2_ivp(
            address, (0.0, t), start, method=METHOD, rtol=tolerance, atol=tolerance
        )
        times = np.array(found.t)
        states = np.array(found.y).T
        found.free()  # the result is not freed with its Python object
        return times, states

    run(1e-3)  # compiles the solver itself, once
    return Solution.of_steps(lambda t: run(t)[1][-1:], run, equations.read)


PEERS = [
    Peer(f"CyRK {METHOD}, quaternion", SETTINGS, partial(prepare, compile_quaternion), "also"),
    Peer(
        f"CyRK {METHOD}, turning frame", SETTINGS, partial(prepare, compile_turning_frame), "also"
    ),
    Peer(f"CyRK {METHOD}, Euler angles", SETTINGS, partial(prepare, compile_euler_angles)),
]
