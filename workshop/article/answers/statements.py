"""Claims on single statements of the article that nothing else answers."""

import numpy as np

from symtop_ros.arrays import Real
from symtop_ros.physics import Motion, State, Top
from workshop.article.claims import Claim, Measured, claim, differ
from workshop.article.motions import FAST, SLOW, THETA, accelerations, cusps, slope, start
from workshop.article.nutation import horizontal_square
from workshop.article.torque import draw_states

COMPLEX_STEP = 1e-30  # of a derivative without a difference
SHORT = 1e-5  # s, of a difference along a parabola in the angles
AGREED = 1e-10  # of the largest term; a difference of order 8. Measured: 1e-13
SAMPLES = 256  # of a nutation
EARLY = np.array([1e-3, 5e-4])  # s after the release
EARLY_OFF = 1e-6  # relative. Measured: 2e-8
DIFFERENTIATED = 1e-9  # relative; a difference is good to 1e-11
SAME = 1e-14  # relative; rounding of sums of products. Measured: 9e-16
ROUNDED = 1e-13  # the same, divided by sin(theta) >= 0.1
ACROSS_Y = 1.9e-4  # kg m^2, of a body that is not symmetric


def claims_on_statements(top: Top) -> list[Claim]:
    """Return the claims, in the order of the article."""
    return [
        axis_moves_too(cusps(top)),
        lagrangian_gives_the_same(top),
        masses_feel_the_euler_force(cusps(top)),
        torque_tilts_only(top),
        one_torque_has_one_change(top),
        release_tilts_first(cusps(top)),
        momentum_is_nearly_a_sine(cusps(top)),
    ]


@claim
def axis_moves_too(motion: Motion) -> Measured:
    """Check that L_z is constant because Ix = Iy, and not for the torque alone."""
    top, states = motion.top, motion.at(np.linspace(0.0, 0.5, 501))
    torque, z = top.gravity_torque(states), states.to_world([0.0, 0.0, 1.0])
    along = float(np.abs((torque * z).sum(axis=1)).max() / np.abs(torque).max())
    turning = np.cross(states.angular_velocity, [0.0, 0.0, 1.0])
    body, other = np.array([top.Ix, top.Ix, top.Iz]), np.array([top.Ix, ACROSS_Y, top.Iz])
    rates = [
        float(np.abs((moments * states.angular_velocity * turning).sum(axis=1)).max())
        for moments in (body, other)
    ]
    holds = along < SAME and rates[0] < SAME * rates[1] and rates[1] > 1e-3 * np.abs(torque).max()
    return Measured(holds, along=along, rates=rates)


@claim
def lagrangian_gives_the_same(top: Top) -> Measured:
    """Check that the article's accelerations obey Lagrange's equations, on random states."""
    states = draw_states()
    angles = np.stack(states.euler_angles)
    rates = np.stack(states.euler_rates)
    changes = accelerations(top, states).T

    def momenta(t: Real) -> Real:
        moved = angles + rates * t + changes * t**2 / 2
        return _slopes(top, moved, rates + changes * t, by_rate=True)

    moments = slope(momenta, np.zeros(1), SHORT).values
    forces = _slopes(top, angles, rates, by_rate=False)
    off = differ(moments, forces)
    return Measured(off < AGREED, rates=rates, off=off, largest=np.abs(forces).max())


def _slopes(top: Top, angles: Real, rates: Real, *, by_rate: bool) -> Real:
    """Return the derivatives (3, n) of the Lagrangian by the rates or by phi, theta and psi."""
    found = []
    for k in range(3):
        step = np.zeros((3, 1), complex)
        step[k] = 1j * COMPLEX_STEP
        turned, moving = (angles, rates + step) if by_rate else (angles + step, rates + 0j)
        phi_dot, theta_dot, psi_dot = moving
        sine, cosine = np.sin(turned[1]), np.cos(turned[1])
        kinetic = top.Ix * (theta_dot**2 + (phi_dot * sine) ** 2) / 2
        kinetic = kinetic + top.Iz * (psi_dot + phi_dot * cosine) ** 2 / 2
        found.append((kinetic - top.Mgl * cosine).imag / COMPLEX_STEP)
    return np.array(found)


@claim
def masses_feel_the_euler_force(motion: Motion) -> Measured:
    """Check that in the body frame gravity, centrifugal and Euler force are in balance."""
    top, times = motion.top, np.linspace(0.0, motion.nutation_period, 41)
    states, moments = motion.at(times), np.array([top.Ix, top.Ix, top.Iz])
    change = slope(lambda t: motion.at(t).angular_velocity, times).values
    gravity = states.to_body(top.gravity_torque(states))
    centrifugal = -np.cross(states.angular_velocity, moments * states.angular_velocity)
    euler = -moments * change
    sizes = [float(np.linalg.norm(each, axis=1).max()) for each in (gravity, centrifugal, euler)]
    off = float(np.abs(gravity + centrifugal + euler).max() / max(sizes))
    return Measured(
        off < DIFFERENTIATED and min(sizes) > 0.1 * max(sizes), sizes=sizes, off=off, motion=motion
    )


@claim
def torque_tilts_only(top: Top) -> Measured:
    """Check that gravity's torque enters theta'' only, and a torque along the vertical does not."""
    states = draw_states()
    added = _add_torque(top, states, top.gravity_torque(states))
    expected = top.Mgl * np.sin(states.euler_angles.theta) / top.Ix
    off = float(np.abs(added[1] - expected).max() / np.abs(expected).max())
    others = float(np.abs(added[[0, 2]]).max() / np.abs(expected).max())
    upward = _add_torque(top, states, np.array([0.0, 0.0, top.Mgl]))
    least = float(np.abs(upward[0]).min())
    holds = off < ROUNDED and others < ROUNDED and least > 1.0
    return Measured(holds, count=len(states), off=off, others=others, least=least)


def _add_torque(top: Top, states: State, torque: Real) -> Real:
    """Return what a torque in the world frame adds to phi'', theta'' and psi'', (3, n)."""
    body = states.to_body(torque)
    x, y, z = np.moveaxis(body / np.array([top.Ix, top.Ix, top.Iz]), -1, 0)
    _, theta, psi = states.euler_angles
    phi = (x * np.sin(psi) + y * np.cos(psi)) / np.sin(theta)
    return np.array([phi, x * np.cos(psi) - y * np.sin(psi), z - phi * np.cos(theta)])


@claim
def one_torque_has_one_change(top: Top) -> Measured:
    """Check that dL/dt is the same vector on both roots, while L is not."""
    motions = [Motion(top, start(rate)) for rate in (SLOW, FAST)]
    changes = [_change_of_momentum(motion) for motion in motions]
    momenta = [top.angular_momentum(motion.start) for motion in motions]
    torque = float(np.linalg.norm(top.gravity_torque(motions[0].start)))
    off = float(np.linalg.norm(changes[0] - changes[1])) / torque
    apart = float(np.linalg.norm(momenta[0] - momenta[1]) / np.linalg.norm(momenta[0]))
    return Measured(
        off < DIFFERENTIATED and apart > 0.1, size=np.linalg.norm(changes[0]), off=off, apart=apart
    )


def _change_of_momentum(motion: Motion) -> Real:
    """Return dL/dt (3,) in N m at the start, by differences."""
    found = slope(lambda t: motion.top.angular_momentum(motion.at(t)), np.zeros(1))
    return np.asarray(found.values[0])


@claim
def release_tilts_first(motion: Motion) -> Measured:
    """Check the first powers of time in theta and phi after a release."""
    top, states = motion.top, motion.at(EARLY)
    tilt = (states.euler_angles.theta - THETA) / EARLY**2
    turn = states.euler_angles.phi / EARLY**3
    # The next terms are t^2 smaller: Richardson's extrapolation takes them out
    found = [float((4 * each[1] - each[0]) / 3) for each in (tilt, turn)]
    p_psi = float(top.axial_momentum(motion.start))
    expected = top.Mgl * np.sin(THETA) / (2 * top.Ix), top.Mgl * p_psi / (6 * top.Ix**2)
    off = max(abs(a / b - 1) for a, b in zip(found, expected, strict=True))
    holds = off < EARLY_OFF and (f"{found[0]:.1f}", f"{found[1]:.0f}") == ("71.5", "2494")
    return Measured(holds, found=found, off=off)


@claim
def momentum_is_nearly_a_sine(motion: Motion) -> Measured:
    """Check the second harmonic of L^2 - L_z'^2 and of theta over a nutation."""
    times = np.asarray(np.arange(SAMPLES) * (motion.nutation_period / SAMPLES))
    shares = []
    for values in (horizontal_square(motion, times), motion.at(times).euler_angles.theta):
        size = np.abs(np.fft.rfft(values))
        shares.append(float(size[2] / size[1]))
    return Measured(f"{shares[0]:.2%}" == "0.43%" and f"{shares[1]:.1%}" == "2.7%", shares=shares)
