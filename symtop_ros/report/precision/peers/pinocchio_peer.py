"""Pinocchio: a spherical joint, its forward dynamics in RK4 steps on the group (in Python)."""

from __future__ import annotations

import numpy as np
import pinocchio

from symtop_ros.report.precision.peers.peer import Peer, Real, Solve, Task, start_of, steps

SETTINGS = (1e-2, 3.125e-3, 1e-3, 3.125e-4, 1e-4)  # s
GRAVITY = 10.0  # m/s^2


def prepare(task: Task, step: float) -> Solve:
    """Build the model."""
    model = _model(task)
    data = model.createData()
    w, x, y, z, *omega = start_of(task)
    still = np.zeros(3)

    def acceleration(q: Real, v: Real) -> Real:
        return np.array(pinocchio.aba(model, data, q, v, still))

    def advance(q: Real, v: Real) -> tuple[Real, Real]:
        """Munthe-Kaas's RK4: each slope is carried back to where the step begins."""
        u1, a1 = v * step, acceleration(q, v) * step
        u2, a2 = _slope(q, v, u1 / 2, a1 / 2)
        u3, a3 = _slope(q, v, u2 / 2, a2 / 2)
        u4, a4 = _slope(q, v, u3, a3)
        turn = (u1 + 2 * u2 + 2 * u3 + u4) / 6
        return pinocchio.integrate(model, q, turn), v + (a1 + 2 * a2 + 2 * a3 + a4) / 6

    def _slope(q: Real, v: Real, u: Real, a: Real) -> tuple[Real, Real]:
        turned, faster = pinocchio.integrate(model, q, u), v + a
        w = faster * step
        bent = w + np.cross(u, w) / 2 + np.cross(u, np.cross(u, w)) / 12
        return bent, acceleration(turned, faster) * step

    def solve(t: float) -> Real:
        q, v = np.array([x, y, z, w]), np.array(omega)
        for _ in range(steps(t, step)):
            q, v = advance(q, v)
        return q[[3, 0, 1, 2]]

    return solve


def _model(task: Task) -> pinocchio.Model:
    Ix, Iz, Mgl = task.top.moments
    arm = Ix / 2 * GRAVITY / Mgl if Mgl else 0.0
    mass = Mgl / (GRAVITY * arm) if Mgl else 1.0
    across = Ix - mass * arm**2
    model = pinocchio.Model()
    model.gravity.linear = np.array([0.0, 0.0, -GRAVITY])
    fixed = pinocchio.SE3.Identity()
    joint = model.addJoint(0, pinocchio.JointModelSpherical(), fixed, "pivot")
    inertia = pinocchio.Inertia(mass, np.array([0.0, 0.0, arm]), np.diag([across, across, Iz]))
    model.appendBodyToJoint(joint, inertia, fixed)
    return model


PEERS = [Peer("Pinocchio, RK4 in Python", SETTINGS, prepare)]
