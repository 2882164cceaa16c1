"""Exact truth for thousands of tops of MuJoCo Warp, each let go with another tilt and spin.

    pip install mujoco-warp

MuJoCo Warp steps all tops together, on a GPU or on the processor. The exact states of all of them
come from one call of `symtop_ros.physics.gpu.Motions` on a GPU, or else of
`symtop_ros.physics.Motions`. The median and the largest error of the attitudes are printed.
"""

import argparse
from typing import Any

import mujoco
import mujoco_warp
import numpy as np
import warp as wp
from numpy.typing import NDArray

from symtop_ros.physics import Body, Motions, State, Top, gpu
from symtop_ros.run.models.engines import format_mjcf

TOP = Top(Ix=0.000228, Iz=0.0000572, Mgl=0.068)


def main() -> None:
    """Step the tops, and compare them with the exact states."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--tops", type=int, default=4096)
    parser.add_argument("--seconds", type=float, default=0.25)
    parser.add_argument("--steps", type=int, default=250)
    options = parser.parse_args()
    wp.config.quiet = True
    rng = np.random.default_rng(1)
    theta = rng.uniform(0.2, 1.2, options.tops)
    start = State.from_euler(theta=theta, psi_dot=rng.uniform(100.0, 300.0, options.tops))
    found = step(start, options.seconds, options.steps)
    exact = find_truth(start, options.seconds)
    half = np.abs(np.sum(found * exact, axis=1)) / np.linalg.norm(found, axis=1)
    error = 2 * np.arccos(np.minimum(half, 1))
    print(f"{options.tops} tops on {wp.get_device()}, {options.steps} steps, {options.seconds:g} s")
    print(
        f"error of the attitude: median {np.median(error):.2g} rad, largest {error.max():.2g} rad"
    )
    worst = int(np.argmax(error))
    print(f"the largest is that of top {worst}, let go at theta = {theta[worst]:.3f} rad")


def step(start: State, seconds: float, steps: int) -> NDArray[np.float64]:
    """Return the orientations (n, 4) that MuJoCo Warp reaches; it computes with 24 bits."""
    body = State.from_euler(theta=0.5)
    model = mujoco.MjModel.from_xml_string(format_mjcf(TOP, body, Body.from_top(TOP)))
    model.opt.timestep = seconds / steps
    worlds = mujoco_warp.put_model(model)
    count = len(start.orientation)
    data = mujoco_warp.put_data(model, mujoco.MjData(model), nworld=count)
    # a ball joint: w, x, y, z, and rates in the body frame
    wp.copy(data.qpos, _to_warp(start.orientation))
    wp.copy(data.qvel, _to_warp(start.angular_velocity))
    for _ in range(steps):
        mujoco_warp.step(worlds, data)
    return np.asarray(data.qpos.numpy(), np.float64)


def _to_warp(values: NDArray[np.float64]) -> Any:
    return wp.array(values.astype(np.float32), dtype=float)


def find_truth(start: State, seconds: float) -> NDArray[np.float64]:
    """Return the exact orientations (n, 4): on the GPU if Warp has found one."""
    if not wp.get_device().is_cuda:
        return np.asarray(Motions(TOP, start).at(seconds).orientation)
    return np.asarray(gpu.Motions(TOP, start).at(seconds).orientation.get())


if __name__ == "__main__":
    main()
