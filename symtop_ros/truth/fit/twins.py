"""Motions that give the same record: exact twins, as tops and starts.

Each function returns a motion that has the same record of some kind. The report compares both
records before it names a twin; the tests compare them, too, to rounding.
"""

import numpy as np

from symtop_ros.base.arrays import Real, compose
from symtop_ros.physics import Friction, Motion, State, Top

OVER_X = np.array([0.0, 1.0, 0.0, 0.0])  # half a turn about x


def scale_friction(friction: Friction, axial: float, transverse: float) -> Friction:
    """Return friction that is larger by factors."""
    return Friction(float(friction.axial) * axial, float(friction.transverse) * transverse)


def scale_moments(motion: Motion, factor: float) -> Motion:
    """Return the motion of a top whose moments and weight are larger by a factor: the same one."""
    top = motion.top
    new = Top(top.Ix * factor, top.Iz * factor, top.Mgl * factor)
    return Motion(new, motion.start, scale_friction(motion.friction, factor, factor))


def change_axial_moment(motion: Motion, Iz: float) -> Motion:
    """Return a motion with the same axis: of another Iz, and the spin that keeps p_psi."""
    top, (wx, wy, wz) = motion.top, motion.start.angular_velocity
    omega = [wx, wy, wz * top.Iz / Iz]
    friction = scale_friction(motion.friction, Iz / top.Iz, 1.0)
    return Motion(Top(top.Ix, Iz, top.Mgl), State(motion.start.orientation, omega), friction)


def exchange_momenta(motion: Motion) -> Motion:
    """Return a motion with the same theta: p_psi and p_phi exchanged.

    The effective potential (p_phi - p_psi cos)^2/(2 Ix sin^2) + p_psi^2/(2 Iz) + Mgl cos changes by
    a constant. Iz stays the same, and the spin follows from it.
    """
    top, angles, rates = motion.top, motion.start.euler_angles, motion.start.euler_rates
    cos, square = np.cos(angles.theta), np.sin(angles.theta) ** 2
    p_psi = top.Iz * float(motion.start.angular_velocity[2])
    p_phi = top.Ix * square * rates.phi_dot + p_psi * cos
    return _start(motion, float((p_psi - p_phi * cos) / (top.Ix * square)), p_phi / top.Iz)


def reverse_momenta(motion: Motion) -> Motion:
    """Return a motion with the same theta: p_psi and p_phi with the other sign."""
    rates = motion.start.euler_rates
    return _start(motion, float(-rates.phi_dot), float(-motion.start.angular_velocity[2]))


def _start(motion: Motion, phi_dot: float, spin: float) -> Motion:
    """Return the motion with the same theta and theta', and a given phi' and omega_z."""
    top, start, friction = motion.top, motion.start, motion.friction
    angles, rates = start.euler_angles, start.euler_rates
    psi_dot = float(spin - phi_dot * np.cos(angles.theta))
    given = {"theta": float(angles.theta), "theta_dot": float(rates.theta_dot)}
    new = State.from_euler(**given, phi=float(angles.phi), phi_dot=phi_dot, psi_dot=psi_dot)
    return Motion(top, new, friction)


def turn_over(motion: Motion) -> Motion:
    """Return a motion with the same rates: Mgl and the vertical change sign together."""
    top, start = motion.top, motion.start
    turned = State(compose(OVER_X, start.orientation), start.angular_velocity)
    return Motion(Top(top.Ix, top.Iz, -top.Mgl), turned, motion.friction)


def turn_azimuth(motion: Motion, angle: float) -> Motion:
    """Return the motion turned about the vertical: with the same rates and the same theta."""
    turn = np.array([np.cos(angle / 2), 0.0, 0.0, np.sin(angle / 2)])
    turned = State(compose(turn, motion.start.orientation), motion.start.angular_velocity)
    return Motion(motion.top, turned, motion.friction)


def take_other_end(motion: Motion) -> Motion:
    """Return the motion of the other end of the axis: Mgl and p_psi change sign, e becomes -e.

    A camera that is turned upside down shows it as it shows the first motion upright.
    """
    top, (wx, wy, wz) = motion.top, motion.start.angular_velocity
    q = compose(motion.start.orientation, OVER_X)
    return Motion(Top(top.Ix, top.Iz, -top.Mgl), State(q, [wx, -wy, -wz]), motion.friction)


def mirror_view(motion: Motion, camera: dict[str, float]) -> tuple[Motion, dict[str, float]]:
    """Return the motion mirrored in the plane of the picture, and the camera that shows it so.

    Without perspective a picture does not show which points are near. The mirrored vertical is that
    of a camera with the other elevation; p_psi changes sign, as all spins do in a mirror.
    """
    turned = {**camera, "elevation": -camera["elevation"]}
    axis, velocity = _find_axis_motion(motion)
    mirrored, moved = (_mirror(each, camera["elevation"]) for each in (axis, velocity))
    return start_axis(motion, mirrored, moved, -1.0), turned


def turn_camera(motion: Motion, camera: dict[str, float]) -> tuple[Motion, dict[str, float]]:
    """Return the motion with the vertical turned over, and the camera that shows it so.

    Everything is turned about the line of sight, so that a pinhole shows the same as well.
    """
    mirrored, low = mirror_view(motion, camera)
    roll = camera["roll"] + np.pi
    return take_other_end(mirrored), {
        **low,
        "roll": float(roll - 2 * np.pi * np.round(roll / (2 * np.pi))),
    }


def mirror_picture(motion: Motion, camera: dict[str, float]) -> tuple[Motion, dict[str, float]]:
    """Return the motion mirrored left and right, and the camera that shows its picture mirrored."""
    axis, velocity = _find_axis_motion(motion)
    over = np.array([-1.0, 1.0, 1.0])
    turned = {**camera, "roll": -camera["roll"]}
    if "centre_u" in camera:
        turned["centre_u"] = 2 * camera["u"] - camera["centre_u"]
    return start_axis(motion, axis * over, velocity * over, -1.0), turned


def _mirror(vector: Real, elevation: float) -> Real:
    """Return what a camera of the other elevation sees at the same place, mirrored in depth."""
    x, y, z = vector
    sin, cos = np.sin(elevation), np.cos(elevation)
    high, near = y * sin + z * cos, y * cos - z * sin
    # from the other elevation: up is (0, -sin, cos), and the line of sight (0, cos, sin)
    return np.array([x, -high * sin - near * cos, high * cos - near * sin])


def _find_axis_motion(motion: Motion) -> tuple[Real, Real]:
    start = motion.start
    axis = start.to_world([0.0, 0.0, 1.0])
    return axis, np.cross(start.to_world(start.angular_velocity), axis)


def start_axis(motion: Motion, axis: Real, velocity: Real, sign: float) -> Motion:
    """Return the motion that begins at an axis with a velocity, and the spin times a sign."""
    theta = float(np.arctan2(np.hypot(axis[0], axis[1]), axis[2]))
    attitude = State.from_euler(theta=theta, phi=float(np.arctan2(axis[0], -axis[1])))
    wx, wy, _ = attitude.to_body(np.cross(axis, velocity))
    omega = [wx, wy, sign * motion.start.angular_velocity[2]]
    return Motion(motion.top, State(attitude.orientation, omega), motion.friction)


def see_from_above(motion: Motion) -> Motion:
    """Return the motion (pi - theta, -Mgl, -p_psi), which has the same x and y of the axis."""
    axis, velocity = _find_axis_motion(motion)
    over = np.array([1.0, 1.0, -1.0])
    found = start_axis(motion, axis * over, velocity * over, -1.0)
    top = motion.top
    return Motion(Top(top.Ix, top.Iz, -top.Mgl), found.start, motion.friction)


def bias_spin(motion: Motion, bias: float) -> Motion:
    """Return a motion whose rates are those of the first, with a bias about z.

    In units of Ix, W = wx + i wy and the vertical G = gx + i gy, gz of the body follow
    W' = -i (wz - p) W - i a G, G' = -i wz G + i gz W and gz' = Im(conj(G) W). They are the same for
    wz + b, p + 2 b and the vector a G + b W, a gz + b (p + b).
    """
    top, (wx, wy, wz) = motion.top, motion.start.angular_velocity
    a, p = top.Mgl / top.Ix, top.Iz * float(wz) / top.Ix
    vertical = np.asarray(motion.start.to_body([0.0, 0.0, 1.0]))
    pull = a * vertical + bias * np.array([wx, wy, p + bias])
    weight = float(np.linalg.norm(pull))
    spin = float(wz) + bias
    new = Top(top.Ix, top.Ix * (p + 2 * bias) / spin, weight * top.Ix)
    up = pull / weight
    theta = float(np.arctan2(np.hypot(up[0], up[1]), up[2]))
    attitude = State.from_euler(theta=theta, psi=float(np.arctan2(up[0], up[1])))
    return Motion(new, State(attitude.orientation, [wx, wy, spin]))


def add_turns(motion: Motion, step: float, turns: int = 1) -> Motion:
    """Return a motion with the same attitudes at equal steps: whole turns more from row to row."""
    top, (wx, wy, wz) = motion.top, motion.start.angular_velocity
    spin = float(wz) + turns * 2 * np.pi / step
    ratio = top.Iz * float(wz) / spin
    return Motion(Top(top.Ix, ratio, top.Mgl), State(motion.start.orientation, [wx, wy, spin]))
