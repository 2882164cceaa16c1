"""MuJoCo: a body on a ball joint."""

from __future__ import annotations

from functools import partial

import mujoco
import numpy as np

from symtop_ros.report.precision.peers.peer import Peer, Real, Solve, Task, start_of, steps

FOURTH_ORDER = (3.125e-3, 1e-3, 3.125e-4, 1e-4, 3.125e-5, 1e-5)  # s
FIRST_ORDER = (1e-4, 3.125e-5, 1e-5, 1e-6)  # s; coarser steps are not stable
METHODS = {"RK4": FOURTH_ORDER, "implicitfast": FIRST_ORDER, "Euler": FIRST_ORDER}
GRAVITY = 10.0  # m/s^2
MODEL = """
<mujoco>
  <option integrator="{method}" timestep="{step!r}" gravity="0 0 -{gravity!r}">
    <flag contact="disable" constraint="disable"/>
  </option>
  <worldbody>
    <body>
      <joint type="ball" damping="0" armature="0"/>
      <inertial pos="0 0 {arm!r}" mass="{mass!r}" diaginertia="{across!r} {across!r} {along!r}"/>
    </body>
  </worldbody>
</mujoco>
"""

# Steps that are not stable show in their errors; MuJoCo would write a file where one happens to be.
mujoco.set_mju_user_warning(lambda _: None)


def prepare(method: str, task: Task, step: float) -> Solve:
    """Compile the model; a solution goes back to the start first."""
    model = mujoco.MjModel.from_xml_string(_model(method, task, step))
    data = mujoco.MjData(model)
    start = start_of(task)

    def solve(t: float) -> Real:
        mujoco.mj_resetData(model, data)
        data.qpos[:], data.qvel[:] = start[:4], start[4:]
        mujoco.mj_step(model, data, nstep=steps(t, step))
        return np.array(data.qpos)

    return solve


def _model(method: str, task: Task, step: float) -> str:
    """Weight on a short arm, and heavy: about its centre there is half of Ix."""
    Ix, Iz, Mgl = task.top.moments
    arm = Ix / 2 * GRAVITY / Mgl if Mgl else 0.0  # M arm^2 = Ix/2
    mass = Mgl / (GRAVITY * arm) if Mgl else 1.0
    across = Ix - mass * arm**2
    numbers = {"arm": arm, "mass": mass, "across": across, "along": Iz}
    return MODEL.format(method=method, step=step, gravity=GRAVITY, **numbers)


PEERS = [
    Peer(f"MuJoCo {method}", settings, partial(prepare, method))
    for method, settings in METHODS.items()
]
