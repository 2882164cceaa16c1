"""Effect on each motion of the least inertia that MuJoCo gives to the links of a URDF.

The two links of the chain z-x-z turn about the pivot. With the moment of inertia J in all
directions the first one has the kinetic energy J phi'^2/2 and the second one
J (phi'^2 + theta'^2)/2. What is left is a motion in theta, as without them.
"""

import math

import numpy as np
from scipy.integrate import solve_ivp

from symtop_ros.base.arrays import Real
from symtop_ros.physics import Motion, State, Top
from symtop_ros.run.models.urdf import MUJOCO_BOUND
from workshop.speed.peers.peer import from_euler_angles
from workshop.testset.problems import Setting

SPAN = 20.0  # s; beyond it the effect grows with the time
# J/Ix of a trial, far above the errors of an integration; its effect is in proportion to J.
TRIED = 1e-8
LARGEST = 1e-3  # of 2 J/(Ix sin^2 theta), which would be a larger part of the effect
NEAR = 5e-4  # sin(theta): nearer to the vertical the angles of the chain turn by themselves
SAMPLES = 201


def find_link_effect(setting: Setting, J: float = MUJOCO_BOUND) -> float | None:
    """Return the largest angle in rad by which links with J in kg m^2 change the attitude.

    None if the axis comes so close to the vertical that the chain is of no use.
    """
    top, start = setting.top, setting.start
    times = np.linspace(0.0, min(setting.duration, SPAN), SAMPLES)
    lowest = find_lowest_sine(top, start)
    if lowest < NEAR:
        return None
    tried = max(J, min(TRIED, LARGEST / 2 * lowest**2) * top.Ix)
    without, with_links = (follow(top, start, each, times) for each in (0.0, tried))
    apart = [np.linalg.norm(without - sign * with_links, axis=1) for sign in (1, -1)]
    effect = 2 * np.minimum(*apart).max() * J / tried * setting.duration / times[-1]
    return float(f"{min(effect, math.pi):.2g}")


def find_lowest_sine(top: Top, start: State) -> float:
    """Return the smallest sin(theta) of the motion; 1 if the axis stays in a plane."""
    if not (start.euler_rates.phi_dot or start.euler_rates.psi_dot):
        return 1.0
    return min(map(math.sin, Motion(top, start).turning_angles))


def follow(top: Top, start: State, J: float, times: Real) -> Real:
    """Return the quaternions (n, 4) of the chain with links of J."""
    Ix, Iz, Mgl = top.moments
    angles, rates = start.euler_angles, start.euler_rates
    u = math.cos(angles.theta)
    p_psi = Iz * (rates.psi_dot + rates.phi_dot * u)
    p_phi = (Ix * math.sin(angles.theta) ** 2 + 2 * J) * rates.phi_dot + p_psi * u

    def slope(_: float, y: Real) -> tuple[float, ...]:
        _, theta, _, theta_dot = y
        u, s = math.cos(theta), math.sin(theta)
        phi_dot = (p_phi - p_psi * u) / (Ix * s * s + 2 * J) if p_phi or p_psi else 0.0
        torque = Mgl * s + (Ix * phi_dot * u - p_psi) * phi_dot * s
        return phi_dot, theta_dot, p_psi / Iz - phi_dot * u, torque / (Ix + J)

    begin = (*angles, rates.theta_dot)
    found = solve_ivp(slope, (0.0, times[-1]), begin, "DOP853", times, rtol=1e-13, atol=1e-13)
    return from_euler_angles(found.y[:3].T)
