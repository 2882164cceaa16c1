"""Claims on single statements of the article that nothing else answers."""

import numpy as np

from symtop_ros.arrays import Real
from symtop_ros.physics import Motion, State, Top
from workshop.article.claims import Claim, claim, differ
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
def axis_moves_too(motion: Motion) -> Claim:
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
    return Claim(
        "That the torque has no component along the axis is not enough for a constant L_z, because "
        "the axis moves: the second term of dL_z/dt vanishes because Ix = Iy.",
        f"torque along the axis {along:.0e} of its size; L . (omega x z) at most {rates[0]:.0e} N "
        f"m for Iy = Ix, and {rates[1]:.2e} N m at the same rates for Iy = {ACROSS_Y:g} kg m^2",
        along < SAME and rates[0] < SAME * rates[1] and rates[1] > 1e-3 * np.abs(torque).max(),
        "dL_z/dt = torque . z + L . (omega x z), L . (omega x z) = (Ix - Iy) omega_x omega_y",
        f"{SAME:g} of the torque, and of the term with Iy: rounding of sums of products",
    )


@claim
def lagrangian_gives_the_same(top: Top) -> Claim:
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
    return Claim(
        "Lagrange's equations give the same accelerations.",
        f"on {rates.shape[1]} random states d/dt of the momenta and the generalized forces differ "
        f"by {off:.0e} of the largest force, {np.abs(forces).max():.3g} N m",
        off < AGREED,
        "d/dt dL/dq' = dL/dq for L = Ix (theta'^2 + phi'^2 sin^2(theta))/2 + "
        "Iz (psi' + phi' cos(theta))^2/2 - Mgl cos(theta)",
        f"{AGREED:g}: a derivative by differences",
    )


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
def masses_feel_the_euler_force(motion: Motion) -> Claim:
    """Check that in the body frame gravity, centrifugal and Euler force are in balance."""
    top, times = motion.top, np.linspace(0.0, motion.nutation_period, 41)
    states, moments = motion.at(times), np.array([top.Ix, top.Ix, top.Iz])
    change = slope(lambda t: motion.at(t).angular_velocity, times).values
    gravity = states.to_body(top.gravity_torque(states))
    centrifugal = -np.cross(states.angular_velocity, moments * states.angular_velocity)
    euler = -moments * change
    sizes = [float(np.linalg.norm(each, axis=1).max()) for each in (gravity, centrifugal, euler)]
    off = float(np.abs(gravity + centrifugal + euler).max() / max(sizes))
    return Claim(
        "In the body frame there is no Coriolis force, and one more than the centrifugal force: "
        "the Euler force, because the frame turns with a changing angular velocity. Nothing moves "
        "there, so that the torques balance.",
        f"largest torques of gravity {sizes[0]:.4f}, centrifugal {sizes[1]:.4f} and Euler force "
        f"{sizes[2]:.4f} N m; their sum is off by {off:.0e} ({motion.kind})",
        off < DIFFERENTIATED and min(sizes) > 0.1 * max(sizes),
        "torque - omega x L - I domega/dt = 0; dF = -dm (domega/dt) x r",
        f"{DIFFERENTIATED:g}: a derivative by differences is good to 1e-11",
    )


@claim
def torque_tilts_only(top: Top) -> Claim:
    """Check that gravity's torque enters theta'' only, and a torque along the vertical does not."""
    states = draw_states()
    added = _add_torque(top, states, top.gravity_torque(states))
    expected = top.Mgl * np.sin(states.euler_angles.theta) / top.Ix
    off = float(np.abs(added[1] - expected).max() / np.abs(expected).max())
    others = float(np.abs(added[[0, 2]]).max() / np.abs(expected).max())
    upward = _add_torque(top, states, np.array([0.0, 0.0, top.Mgl]))
    least = float(np.abs(upward[0]).min())
    return Claim(
        "A torque can cause angular accelerations in all directions (introduction), but gravity's "
        "enters theta'' only (section 3.1): phi'' and psi'' come from the rates alone.",
        f"on {len(states)} random states gravity adds to theta'' what the equation says within "
        f"{off:.0e}, and to phi'' and psi'' {others:.0e} of it; a torque Mgl along the vertical "
        f"adds at least {least:.0f} rad/s^2 to phi''",
        off < ROUNDED and others < ROUNDED and least > 1.0,
        "theta'' = ... + Mgl sin(theta)/Ix",
        f"{ROUNDED:g}: rounding of sums of products, over sin(theta) >= 0.1",
    )


def _add_torque(top: Top, states: State, torque: Real) -> Real:
    """Return what a torque in the world frame adds to phi'', theta'' and psi'', (3, n)."""
    body = states.to_body(torque)
    x, y, z = np.moveaxis(body / np.array([top.Ix, top.Ix, top.Iz]), -1, 0)
    _, theta, psi = states.euler_angles
    phi = (x * np.sin(psi) + y * np.cos(psi)) / np.sin(theta)
    return np.array([phi, x * np.cos(psi) - y * np.sin(psi), z - phi * np.cos(theta)])


@claim
def one_torque_has_one_change(top: Top) -> Claim:
    """Check that dL/dt is the same vector on both roots, while L is not."""
    motions = [Motion(top, start(rate)) for rate in (SLOW, FAST)]
    changes = [_change_of_momentum(motion) for motion in motions]
    momenta = [top.angular_momentum(motion.start) for motion in motions]
    torque = float(np.linalg.norm(top.gravity_torque(motions[0].start)))
    off = float(np.linalg.norm(changes[0] - changes[1])) / torque
    apart = float(np.linalg.norm(momenta[0] - momenta[1]) / np.linalg.norm(momenta[0]))
    return Claim(
        'One torque is one rate of change of L: the conclusion\'s "more than one rate of change" '
        "is to be read as section 3.1 has it, one rate of change at more than one L.",
        f"on both roots dL/dt = {np.linalg.norm(changes[0]):.4f} N m along the line of nodes; the "
        f"vectors differ by {off:.0e} of it, and L by {apart:.0%}",
        off < DIFFERENTIATED and apart > 0.1,
        "dL/dt = torque(theta, phi)",
        f"{DIFFERENTIATED:g}: a derivative by differences is good to 1e-11",
    )


def _change_of_momentum(motion: Motion) -> Real:
    """Return dL/dt (3,) in N m at the start, by differences."""
    found = slope(lambda t: motion.top.angular_momentum(motion.at(t)), np.zeros(1))
    return np.asarray(found.values[0])


@claim
def release_tilts_first(motion: Motion) -> Claim:
    """Check the first powers of time in theta and phi after a release."""
    top, states = motion.top, motion.at(EARLY)
    tilt = (states.euler_angles.theta - THETA) / EARLY**2
    turn = states.euler_angles.phi / EARLY**3
    # The next terms are t^2 smaller: Richardson's extrapolation takes them out
    found = [float((4 * each[1] - each[0]) / 3) for each in (tilt, turn)]
    p_psi = float(top.axial_momentum(motion.start))
    expected = top.Mgl * np.sin(THETA) / (2 * top.Ix), top.Mgl * p_psi / (6 * top.Ix**2)
    off = max(abs(a / b - 1) for a, b in zip(found, expected, strict=True))
    return Claim(
        '"Just after t = 0" both theta and phi change, theta as the square and phi as the cube of '
        "time: 71.5 t^2 and 2494 t^3.",
        f"theta - theta_0 = {found[0]:.4f} t^2, phi = {found[1]:.2f} t^3 (rad, s) from 0.5 and 1 "
        f"ms; off the equation by {off:.0e}",
        off < EARLY_OFF and (f"{found[0]:.1f}", f"{found[1]:.0f}") == ("71.5", "2494"),
        "theta - theta_0 = Mgl sin(theta_0)/(2 Ix) t^2, phi = Mgl p_psi/(6 Ix^2) t^3",
        f"{EARLY_OFF:g}: the third terms, of which the extrapolation takes out the second",
    )


@claim
def momentum_is_nearly_a_sine(motion: Motion) -> Claim:
    """Check the second harmonic of L^2 - L_z'^2 and of theta over a nutation."""
    times = np.asarray(np.arange(SAMPLES) * (motion.nutation_period / SAMPLES))
    shares = []
    for values in (horizontal_square(motion, times), motion.at(times).euler_angles.theta):
        size = np.abs(np.fft.rfft(values))
        shares.append(float(size[2] / size[1]))
    return Claim(
        "L^2 - L_z'^2 is nearly sinusoidal, more so than theta: its second harmonic is 0.43 % of "
        "the first, that of theta 2.7 %.",
        f"second over first harmonic of a nutation: {shares[0]:.4%} and {shares[1]:.3%}",
        f"{shares[0]:.2%}" == "0.43%" and f"{shares[1]:.1%}" == "2.7%",
        "L^2 - L_z'^2 = p_psi^2 - p_phi^2 + 2 Ix (E' - Mgl cos(theta)): cos(theta) = u_1 + "
        "(u_2 - u_1) sn^2",
        f"none: digits of a sum over {SAMPLES} samples of a period",
    )
