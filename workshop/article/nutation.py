"""Claims on the nutation: cusps, the spin that falls while the tilt grows, and L above the ground.

The equations are those of the constants of motion, of which the accelerations know nothing.
"""

from collections.abc import Sequence

import numpy as np
from scipy.optimize import brentq
from scipy.signal import find_peaks

from symtop_ros.arrays import Real
from symtop_ros.physics import EffectivePotential, Motion, Top
from workshop.article.claims import Claim, claim
from workshop.article.motions import (
    PSI_DOT,
    RATES,
    accelerations,
    cusps,
    first_turn,
    regular,
    start,
)

SPAN = 10.0  # s
DENSE_TIMES = np.linspace(0.0, SPAN, 20_001)  # two hundred in a nutation
ROUNDING = 1e-9  # of the values; a swing below it counts as zero
VANISHED = 1e-12  # of the largest phi'
CLOSED = 1e-13  # of the horizontal part of L; regular precession after one turn. Measured: 7e-15
SUMMED = 1e-14  # relative; sums of a few products. Measured: 7e-16
LOCATED = 1e-9  # of a nutation; the place of an extremum of theta', by the root of theta''
MIRRORED = 1e-14  # relative; mean rates of a motion and its mirror image. Measured: 0


def claims_on_nutation(top: Top) -> list[Claim]:
    """Return the claims on what changes with the nutation."""
    nutating = [Motion(top, start(rate.phi_dot)) for rate in RATES if rate.direction != "stays"]
    return [
        momentum_swings_with_the_tilt([*nutating, cusps(top)]),
        precession_stops_at_the_cusps(cusps(top)),
        fall_is_fastest_at_zero_acceleration(cusps(top)),
        precession_is_fastest_when_lowest(cusps(top)),
        spin_falls_with_the_axis(cusps(top)),
        spin_decides_the_direction(top),
        momentum_does_not_close(cusps(top), regular(top)),
        momentum_is_smallest_when_highest(top),
    ]


def horizontal_square(motion: Motion, times: Real) -> Real:
    """Return L^2 - L_z'^2 (n,) in (N m s)^2, as a sum of squares, so that nothing cancels."""
    horizontal = motion.top.angular_momentum(motion.at(times))[:, :2]
    return np.asarray((horizontal**2).sum(axis=1))


def count_maxima(values: Real) -> int:
    """Count the maxima that stand out by half of the whole swing, and from rounding."""
    swing, size = float(np.ptp(values)), float(np.abs(values).max())
    return len(find_peaks(values, prominence=max(swing / 2, ROUNDING * size))[0])


@claim
def momentum_swings_with_the_tilt(motions: Sequence[Motion]) -> Claim:
    """Check that the squared horizontal part of L has as many maxima as theta."""
    tilts = [np.asarray(motion.at(DENSE_TIMES).euler_angles.theta) for motion in motions]
    nutations = [count_maxima(theta) for theta in tilts]
    swings = [count_maxima(horizontal_square(motion, DENSE_TIMES)) for motion in motions]
    return Claim(
        "L^2 - L_z'^2 swings as often as the top nutates.",
        f"maxima in {SPAN:g} s of {len(motions)} motions: {', '.join(map(str, swings))}; of theta: "
        f"{', '.join(map(str, nutations))}",
        swings == nutations and min(swings) > 0,
        "L^2 - L_z'^2 = p_psi^2 - p_phi^2 + 2 Ix (E' - Mgl cos(theta))",
        f"none: counts; swings below {ROUNDING:g} of the size count as zero",
    )


@claim
def precession_stops_at_the_cusps(motion: Motion) -> Claim:
    """Check that the precession rate vanishes at the smallest theta, and nowhere else."""
    sentence = "At cusps phi' vanishes exactly where theta is smallest, and nowhere else."
    times = times_of_smallest_tilt(motion)
    if len(times) < 2:
        return Claim(sentence, "theta has no minima", holds=False)
    # Elsewhere: the hundredths of the way from each cusp to the next.
    between = times[:-1, None] + np.diff(times)[:, None] * np.linspace(0.01, 0.99, 99)
    at_cusps, elsewhere = motion.at(times), motion.at(between.ravel())
    largest = np.abs(elsewhere.euler_rates.phi).max()
    stopped = np.abs(at_cusps.euler_rates.phi).max() / largest
    slowest = np.abs(elsewhere.euler_rates.phi).min() / largest
    smallest = np.max(at_cusps.euler_angles.theta) < np.min(elsewhere.euler_angles.theta)
    return Claim(
        sentence,
        f"at {len(times)} minima of theta phi' is at most {stopped:.0e} of its largest, "
        f"{largest:.3g} rad/s; a hundredth of a nutation away and more, it is at least "
        f"{slowest:.0e} of that",
        bool(stopped < VANISHED < slowest and smallest),
        "phi' = p_psi (cos(theta_0) - cos(theta))/(Ix sin^2(theta))",
        f"{VANISHED:g} of the largest phi': rounding of the time of the minimum",
    )


def times_of_smallest_tilt(motion: Motion) -> Real:
    """Return the times (n,) in s within ten seconds at which theta' rises through zero."""
    # The start is left out: cusps start at a minimum, where the sign of theta' is rounding.
    times = DENSE_TIMES[1:]
    rates = np.asarray(motion.at(times).euler_rates.theta)
    rising = np.flatnonzero((rates[:-1] < 0) & (rates[1:] >= 0))

    def rate(t: float) -> float:
        return float(motion.at(t).euler_rates.theta)

    return np.array([brentq(rate, times[k], times[k + 1], xtol=1e-15) for k in rising])


@claim
def fall_is_fastest_at_zero_acceleration(motion: Motion) -> Claim:
    """Check that theta'' vanishes when theta' is largest, off the quarter period."""
    period = motion.nutation_period
    zero, second = times_of_extreme_rate(motion)
    around = zero + LOCATED ** (1 / 2) * period * np.linspace(-1, 1, 5)
    rates = np.asarray(motion.at(around).euler_rates.theta)
    fastest = float(motion.at(zero).euler_rates.theta)
    mirror = abs((zero + second) / period - 1)
    return Claim(
        "From a cusp the axis falls fastest when theta'' = 0, at t1, which is not a quarter of the "
        "nutation period T. At t2 = T - t1, not 3T/4, it rises fastest.",
        f"t1 = {zero:.5f} s = {4 * zero / period:.4f} T/4, theta' = {fastest:.4f} rad/s there; "
        f"t2 = {4 * second / (3 * period):.4f} 3T/4, T - t1 within {mirror:.0e} T; "
        f"theta'' {_theta_acceleration(motion, 0.0):.0f} rad/s^2 at the cusp, "
        f"{_theta_acceleration(motion, period / 2):.0f} at T/2",
        bool(rates.argmax() == 2 and abs(4 * zero / period - 1) > 0.01 and mirror < LOCATED),
        "theta'' = sin(theta)/Ix ((Ix - Iz) phi'^2 cos(theta) - Iz phi' psi' + Mgl) = 0",
        f"{LOCATED**0.5:.0e} T: before and after theta' is smaller; t1 must miss T/4 by 1 %",
    )


def times_of_extreme_rate(motion: Motion) -> tuple[float, float]:
    """Return t1 and t2 in s, where theta'' of cusps vanishes before and after half a nutation."""
    period = motion.nutation_period
    # theta'' > 0 at both cusps, < 0 at half a period
    first, second = (
        float(brentq(lambda t: _theta_acceleration(motion, t), low * period, high * period))
        for low, high in ((0.01, 0.49), (0.51, 0.99))
    )
    return first, second


def _theta_acceleration(motion: Motion, time: float) -> float:
    return float(accelerations(motion.top, motion.at([time]))[0, 1])


@claim
def precession_is_fastest_when_lowest(motion: Motion) -> Claim:
    """Check that phi' and theta are both largest after half a nutation."""
    times = np.linspace(0.0, motion.nutation_period, 2001)
    states = motion.at(times)
    theta, phi_dot = states.euler_angles.theta, states.euler_rates.phi
    return Claim(
        "On cusps phi' and theta are largest together, after half a nutation.",
        f"of {len(times)} samples both are largest at T/2 = {times[1000]:.5f} s: "
        f"theta = {theta[1000]:.4f} rad, phi' = {phi_dot[1000]:.3f} rad/s",
        bool(theta.argmax() == 1000 == phi_dot.argmax()),
        "phi' = (p_phi - p_psi cos(theta))/(Ix sin^2(theta)), p_phi = p_psi cos(theta_0)",
        "none: the same sample is the largest of both",
    )


@claim
def spin_falls_with_the_axis(motion: Motion) -> Claim:
    """Check that psi' falls as theta grows, although L_z is constant."""
    states = motion.at(np.linspace(0.0, motion.nutation_period / 2, 1001))
    theta, psi_dot = states.euler_angles.theta, states.euler_rates.psi
    omega_z = float(motion.start.angular_velocity[2])
    expected = omega_z - states.euler_rates.phi * np.cos(theta)
    off = float(np.abs(psi_dot - expected).max()) / abs(omega_z)
    falls = bool((np.diff(psi_dot) < 0).all() and (np.diff(theta) > 0).all())
    return Claim(
        "As the axis falls, psi' falls too, while omega_z is constant.",
        f"psi' = {psi_dot[0]:.1f} rad/s at the smallest theta and {psi_dot[-1]:.1f} rad/s at the "
        f"largest, falling in each of 1000 steps; off the equation by {off:.0e}",
        falls and off < SUMMED,
        "psi' = p_psi/Iz - phi' cos(theta)",
        f"{SUMMED:g}: rounding of one product and one difference",
    )


@claim
def spin_decides_the_direction(top: Top) -> Claim:
    """Check that a top released with psi' < 0 precesses backwards, as a mirror image."""
    forward, backward = cusps(top), Motion(top, start(0.0, -PSI_DOT))
    rates = forward.mean_precession_rate, backward.mean_precession_rate
    off = abs(sum(rates)) / abs(rates[0])
    return Claim(
        "With psi' < 0 the released top precesses in the other direction.",
        f"mean phi' = {rates[0]:.4f} rad/s for psi' = {PSI_DOT:g} rad/s and {rates[1]:.4f} rad/s "
        f"for psi' = {-PSI_DOT:g} rad/s; the sizes differ by {off:.0e}",
        rates[0] > 0 > rates[1] and off < MIRRORED,
        "phi' -> -phi', psi' -> -psi', theta -> theta leaves the equations unchanged",
        f"{MIRRORED:g}: rounding of the mean rates",
    )


@claim
def momentum_does_not_close(nodding: Motion, steady: Motion) -> Claim:
    """Check that the horizontal part of L returns after a turn only in regular precession."""
    gaps, counts = [], []
    for motion in (nodding, steady):
        turn = first_turn(motion)
        L = motion.top.angular_momentum(motion.at([0.0, turn]))[:, :2]
        gaps.append(float(np.linalg.norm(L[1] - L[0]) / np.linalg.norm(L[0])))
        counts.append(turn / motion.nutation_period)
    return Claim(
        "On cusps the projection of L on the ground does not close after one turn of the "
        "precession; in regular precession it is a circle.",
        f"at phi = 2 pi it misses its start by {gaps[0]:.1%} of its size (cusps: {counts[0]:.3f} "
        f"nutations until then) and by {gaps[1]:.0e} (regular)",
        f"{gaps[0]:.1%}" == "13.2%" and gaps[1] < CLOSED,
        "dL/dt = Mgl sin(theta) (cos(phi), sin(phi), 0)",
        f"{CLOSED:g}: phi of a whole turn to rounding",
    )


@claim
def momentum_is_smallest_when_highest(top: Top) -> Claim:
    """Check that L^2 is smallest where theta is smallest, and largest there for Mgl < 0."""
    offs, extremes = [], []
    for each in (top, Top(top.Ix, top.Iz, -top.Mgl)):
        motion = cusps(each)
        states = motion.at(np.linspace(0.0, motion.nutation_period / 2, 1001))
        square = (each.angular_momentum(states) ** 2).sum(axis=1)
        spin, potential = (
            each.axial_momentum(motion.start),
            EffectivePotential.of(each, motion.start),
        )
        height = states.vertical[:, 2]
        expected = spin**2 + 2 * each.Ix * (potential.energy - each.Mgl * height)
        offs.append(float(np.abs(square / expected - 1).max()))
        extreme = square.argmin() if each.Mgl > 0 else square.argmax()
        extremes.append(height.argmax() == extreme)
    return Claim(
        "L^2 is smallest where theta is smallest (Mgl > 0), and largest there for Mgl < 0.",
        f"of 1001 samples of half a nutation for Mgl = {top.Mgl:g} J and {-top.Mgl:g} J; off the "
        f"equation by at most {max(offs):.0e}",
        all(extremes) and max(offs) < SUMMED,
        "L^2 = p_psi^2 + 2 Ix (E' - Mgl cos(theta))",
        f"{SUMMED:g}: rounding of sums of a few products",
    )
