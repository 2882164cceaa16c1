"""Arrows of the torques in the precessing frame: along the line of nodes, head to tail.

Each of the three begins below the tip of the one before. So the third ends below the pivot if the
precession is steady, and the fourth, their sum, has no length. They lie at different depths below
the pivot, and their sum above it, so that none hides another.
"""

import numpy as np

from symtop_ros.arrays import Real
from symtop_ros.physics import FrameTorques, State, Top, precessing_frame_torques

DEPTHS = {"gravity": 0.08, "Coriolis": 0.15, "centrifugal": 0.22, "sum": -0.08}  # below the pivot
LENGTH, LONGEST = 1.0, 2.5  # in scene units: of the largest at the start, and of any


def torques_of(top: Top, state: State) -> FrameTorques:
    """Return the torques of a state; zero on the vertical, where phi' is undefined."""
    return precessing_frame_torques(
        top, state.euler_angles.theta, state.euler_rates.phi, state.euler_rates.psi
    )


def find_scale(top: Top, state: State) -> float:
    """Return the torque in N m of one scene unit, for the motion that begins with a state."""
    largest = max(abs(top.Mgl), *(float(np.abs(each)) for each in torques_of(top, state)))
    return float(f"{largest / LENGTH:.2g}") or 1.0


def place_arrows(torques: FrameTorques, phi: Real, scale: float) -> dict[str, tuple[Real, Real]]:
    """Return origins and vectors, each (..., 3), of each arrow.

    Near the vertical phi' has no bound: where an arrow is too long, all four have no length.
    """
    nodes = np.stack([np.cos(phi), np.sin(phi), np.zeros_like(phi)], axis=-1)
    ends = np.cumsum([np.zeros_like(torques.gravity), *torques], axis=0) / scale
    lengths = np.array([*np.diff(ends, axis=0), ends[-1]])
    is_drawn = np.abs(lengths).max(axis=0) <= LONGEST  # nan is not
    tails = np.array([*ends[:-1], ends[0]])
    placed = {}
    for (name, depth), tail, length in zip(DEPTHS.items(), tails, lengths, strict=True):
        along, vector = (
            np.where(is_drawn, each, 0.0)[..., None] * nodes for each in (tail, length)
        )
        placed[name] = (along - [0.0, 0.0, depth], vector)
    return placed
