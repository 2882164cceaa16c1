"""Pinocchio: forward dynamics of a spherical joint, in RK4 steps on the group in Python."""

import numpy as np
import pinocchio

from symtop_ros.base.arrays import Real
from symtop_ros.physics import Body, Motion
from symtop_ros.run.models.urdf import format_urdf
from workshop.speed.peers.peer import Peer, Solution, initial_values

SETTINGS = tuple(2.0**-k for k in range(7, 19))  # s


def prepare(task: Motion, step: float) -> Solution:
    """Build the model; each solution starts anew."""
    model = _build_model(task)
    data = model.createData()
    w, x, y, z, *omega = initial_values(task)
    place, rate, still = np.zeros(4), np.zeros(3), np.zeros(3)

    def acceleration(q: Real, v: Real) -> Real:
        return np.array(pinocchio.aba(model, data, q, v, still))

    def make_step(q: Real, v: Real) -> tuple[Real, Real]:
        """Make one Runge-Kutta-Munthe-Kaas step of order 4.

        Each slope is carried back to the start of the step by the series of dexp^-1.
        """
        u1 = v * step
        a1 = acceleration(q, v) * step
        u2, a2 = _slope(q, v, u1 / 2, a1 / 2)
        u3, a3 = _slope(q, v, u2 / 2, a2 / 2)
        u4, a4 = _slope(q, v, u3, a3)
        turn = (u1 + 2 * u2 + 2 * u3 + u4) / 6
        return pinocchio.integrate(model, q, turn), v + (a1 + 2 * a2 + 2 * a3 + a4) / 6

    def _slope(q: Real, v: Real, u: Real, a: Real) -> tuple[Real, Real]:
        turned = pinocchio.integrate(model, q, u)
        faster = v + a
        w = faster * step
        bent = w + np.cross(u, w) / 2 + np.cross(u, np.cross(u, w)) / 12
        return bent, acceleration(turned, faster) * step

    def begin() -> None:
        nonlocal place, rate
        place = np.array([x, y, z, w])
        rate = np.array(omega)

    def advance(steps: int) -> None:
        nonlocal place, rate
        for _ in range(steps):
            place, rate = make_step(place, rate)

    return Solution.of_fixed_steps(step, begin, advance, read=lambda: place[[3, 0, 1, 2]])


def _build_model(task: Motion) -> pinocchio.Model:
    """Return the body of the URDF of `top_model`, on a spherical joint for its three joints."""
    chain = pinocchio.buildModelFromXML(format_urdf(task.top, task.start, Body.from_top(task.top)))
    model = pinocchio.Model()
    model.gravity.linear = chain.gravity.linear
    fixed = pinocchio.SE3.Identity()
    joint = model.addJoint(0, pinocchio.JointModelSpherical(), fixed, "pivot")
    model.appendBodyToJoint(joint, chain.inertias[chain.njoints - 1], fixed)
    return model


PEERS = [Peer("Pinocchio, RK4 in Python", SETTINGS, prepare)]
