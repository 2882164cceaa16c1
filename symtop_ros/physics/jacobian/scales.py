"""Sizes in which a motion, its steps and the errors of its derivatives are measured."""

import math

import numpy as np

from symtop_ros.base.arrays import Real
from symtop_ros.physics.jacobian.differentiable import Differentiable
from symtop_ros.physics.jacobian.nodes import TINY
from symtop_ros.physics.state import State

PROMISED = 1e-8  # error of a derivative, in units of the largest of its block
# Smaller effects are measured by this one, in rad or in units of the spin, of a change by all of a
# moment, by 1 rad, or by the fastest rate.
SMALLEST = 1e-3
# Columns of a block are measured by its largest element: each moment, attitude, and omega.
FIRSTS, COUNTS = (0, 1, 2, 3, 6), (1, 1, 1, 3, 3)


class Scales:
    """Sizes of the parameters (columns) of a motion, and of its states at times."""

    def __init__(self, motion: Differentiable, states: State, longest: float) -> None:
        """Measure a motion and its states (n,) up to the longest time in s."""
        nutation, fastest = find_rates(motion)
        rate = fastest or (1 / longest if longest else 1.0)
        Ix, Iz, Mgl = motion.top.moments
        # A top without weight has the size of the weight that would move it at its rate.
        weight = max(abs(Mgl), Ix * (nutation or rate) ** 2)
        self.rate = rate  # rad/s
        self.of_steps = np.array([Ix, Iz, weight, 1, 1, 1, rate, rate, rate])
        self.of_parameters = np.array([Ix, Iz, Mgl or weight, 1, 1, 1, rate, rate, rate])
        self.of_blocks = np.array([1.0, rate])  # of attitude and omega
        # The sizes of which errors are parts, 1 rad and the spin, (n, 2, 1); one at rest, too.
        spins = np.maximum(np.abs(states.angular_velocity).max(axis=-1), rate * 1e-3)
        self.of_states = np.stack((np.ones(len(spins)), spins), axis=-1)[..., None]

    def find_allowed(self, derivatives: Real, of_states: Real) -> Real:
        """Return the promised errors (m, 2, 1, 9) of derivatives (m, 2, 3, 9)."""
        blocks = np.maximum.reduceat(np.abs(derivatives).max(axis=2), FIRSTS, axis=-1)
        largest = np.repeat(blocks, COUNTS, axis=-1)
        # An absolute error is left of parameters that hardly count, such as those of the start in
        # the first instants.
        least = SMALLEST * of_states / np.abs(self.of_parameters)
        return np.asarray(PROMISED * np.maximum(largest, least)[:, :, None] + TINY)


def find_rates(motion: Differentiable) -> tuple[float, float]:
    """Return rates in rad/s that the axis and the body hardly exceed; 0 for a body at rest."""
    Ix, Iz, Mgl = motion.top.moments
    wx, wy, wz = motion.start.angular_velocity.tolist()
    swing = math.sqrt((abs(Mgl) + math.hypot(*motion.applied_torque)) / Ix)
    nutation = math.hypot(wx, wy, 2 * swing, Iz / Ix * wz)
    return nutation, math.hypot(nutation, wz)


def find_widths(motion: Differentiable) -> tuple[float, float]:
    """Return the largest sine of the tilt and the largest omega across the axis, without a drive.

    Near the vertical they are small, and have the relative precision of all numbers.
    """
    Ix, _, Mgl = motion.top.moments
    wx, wy, _ = motion.start.angular_velocity.tolist()
    least, most = motion.turning_angles
    sine = 1.0 if least < math.pi / 2 < most else max(math.sin(least), math.sin(most))
    height = 2 * math.sin((most + least) / 2) * math.sin((most - least) / 2)
    return sine, math.sqrt(wx * wx + wy * wy + 2 * abs(Mgl) / Ix * height)
