"""MuJoCo: a body on a ball joint, from the MJCF of `top_model`."""

from functools import partial

import mujoco
import numpy as np

from symtop_ros.physics import Body, Motion
from symtop_ros.run.models.engines import format_mjcf
from workshop.speed.peers.peer import Peer, Solution

FOURTH_ORDER = tuple(2.0**-k for k in (9, 11, 13, 15, 16, 17, 18, 19, 20, 21))  # s
FIRST_ORDER = tuple(2.0**-k for k in range(13, 22))  # s; coarser steps are not stable
METHODS = {"RK4": FOURTH_ORDER, "implicitfast": FIRST_ORDER, "Euler": FIRST_ORDER}
# Unstable steps are visible in their errors; without a handler MuJoCo writes a log file for each.
mujoco.set_mju_user_warning(lambda _: None)


def prepare(method: str, task: Motion, step: float) -> Solution:
    """Compile the model; each solution starts anew."""
    model = mujoco.MjModel.from_xml_string(
        format_mjcf(task.top, task.start, Body.from_top(task.top))
    )
    model.opt.integrator = getattr(mujoco.mjtIntegrator, f"mjINT_{method.upper()}")
    model.opt.timestep = step
    data = mujoco.MjData(model)
    return Solution.of_fixed_steps(
        step,
        begin=partial(mujoco.mj_resetDataKeyframe, model, data, model.key("start").id),
        advance=lambda steps: mujoco.mj_step(model, data, nstep=steps),
        read=lambda: np.array(data.qpos),
    )


PEERS = [
    Peer(f"MuJoCo {method}", settings, partial(prepare, method))
    for method, settings in METHODS.items()
]
