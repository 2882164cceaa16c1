"""MuJoCo: a body on a ball joint, from the MJCF of `top_model`."""

from functools import partial

import mujoco
import numpy as np

from symtop_ros.arrays import Real
from symtop_ros.models.engines import format_mjcf
from symtop_ros.physics import Body
from workshop.speed.peers.peer import (
    Peer,
    Quick,
    Solution,
    Task,
    count_steps,
    list_strides,
    time_strides,
)

FOURTH_ORDER = tuple(2.0**-k for k in (9, 11, 13, 15, 16, 17, 18, 19, 20, 21))  # s
FIRST_ORDER = tuple(2.0**-k for k in range(13, 22))  # s; coarser steps are not stable
METHODS: tuple[tuple[str, tuple[float, ...], Quick], ...] = (
    ("RK4", FOURTH_ORDER, "first motion"),
    ("implicitfast", FIRST_ORDER, "no"),
    ("Euler", FIRST_ORDER, "no"),
)
# Unstable steps are visible in their errors; without a handler MuJoCo writes a log file for each.
mujoco.set_mju_user_warning(lambda _: None)


def prepare(method: str, task: Task, step: float) -> Solution:
    """Compile the model; each solution starts anew."""
    model = mujoco.MjModel.from_xml_string(format_mjcf(task.top, task.start, Body.of(task.top)))
    model.opt.integrator = getattr(mujoco.mjtIntegrator, f"mjINT_{method.upper()}")
    model.opt.timestep = step
    data = mujoco.MjData(model)
    start = model.key("start").id

    def begin() -> None:
        mujoco.mj_resetDataKeyframe(model, data, start)

    def reach(t: float) -> Real:
        begin()
        mujoco.mj_step(model, data, nstep=count_steps(t, step))
        return np.array(data.qpos)

    def record(t: float) -> tuple[Real, Real]:
        begin()
        orientations = []
        for stride in list_strides(t, step):
            mujoco.mj_step(model, data, nstep=stride)
            orientations.append(data.qpos.copy())
        return time_strides(t, step), np.array(orientations)

    return Solution(reach, record)


PEERS = [
    Peer(f"MuJoCo {method}", settings, partial(prepare, method), quick=quick)
    for method, settings, quick in METHODS
]
