"""Claims on the nutation: cusps, the spin that falls while the tilt grows, and L above the ground.

The equations are those of the constants of motion, of which the accelerations know nothing.
"""

import numpy as np
from scipy.optimize import brentq
from scipy.signal import find_peaks

from symtop_ros.base.arrays import Real
from symtop_ros.physics import EffectivePotential, Motion, Top
from workshop.article.claims import Measured, claim
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


def nutation_times(motion: Motion, count: int) -> Real:
    """Return times (n,) of one nutation, without its end: a mean over these is that of it."""
    return np.asarray(np.arange(count) * (motion.nutation_period / count))


def horizontal_square(motion: Motion, times: Real) -> Real:
    """Return L^2 - L_z'^2 (n,) in (N m s)^2, as a sum of squares, so that nothing cancels."""
    horizontal = motion.top.angular_momentum(motion.at(times))[:, :2]
    return np.asarray((horizontal**2).sum(axis=1))


def count_maxima(values: Real) -> int:
    """Count the maxima that stand out by half of the whole swing, and from rounding."""
    swing = float(np.ptp(values))
    size = float(np.abs(values).max())
    return len(find_peaks(values, prominence=max(swing / 2, ROUNDING * size))[0])


@claim()
def momentum_swings_with_the_tilt(top: Top) -> Measured:
    """Check that the squared horizontal part of L has as many maxima as theta."""
    nutating = [*(rate.phi_dot for rate in RATES if rate.direction != "stays"), 0.0]
    motions = [Motion(top, start(phi_dot)) for phi_dot in nutating]
    tilts = [np.asarray(motion.at(DENSE_TIMES).euler_angles.theta) for motion in motions]
    nutations = [count_maxima(theta) for theta in tilts]
    swings = [count_maxima(horizontal_square(motion, DENSE_TIMES)) for motion in motions]
    holds = swings == nutations and min(swings) > 0
    return Measured(
        holds,
        count=len(motions),
        swings=", ".join(map(str, swings)),
        nutations=", ".join(map(str, nutations)),
    )


@claim()
def precession_stops_at_the_cusps(top: Top) -> Measured:
    """Check that the precession rate vanishes at the smallest theta, and nowhere else."""
    motion = cusps(top)
    times = times_of_smallest_tilt(motion)
    if len(times) < 2:
        raise ValueError("theta has no minima")
    # Elsewhere: the hundredths of the way from each cusp to the next.
    between = times[:-1, None] + np.diff(times)[:, None] * np.linspace(0.01, 0.99, 99)
    at_cusps = motion.at(times)
    elsewhere = motion.at(between.ravel())
    largest = np.abs(elsewhere.euler_rates.phi_dot).max()
    stopped = np.abs(at_cusps.euler_rates.phi_dot).max() / largest
    slowest = np.abs(elsewhere.euler_rates.phi_dot).min() / largest
    smallest = np.max(at_cusps.euler_angles.theta) < np.min(elsewhere.euler_angles.theta)
    holds = stopped < VANISHED < slowest and smallest
    return Measured(holds, count=len(times), stopped=stopped, largest=largest, slowest=slowest)


def times_of_smallest_tilt(motion: Motion) -> Real:
    """Return the times (n,) in s within ten seconds at which theta' rises through zero."""
    # The start is left out: cusps start at a minimum, where the sign of theta' is rounding.
    times = DENSE_TIMES[1:]
    rates = np.asarray(motion.at(times).euler_rates.theta_dot)
    rising = np.flatnonzero((rates[:-1] < 0) & (rates[1:] >= 0))

    def rate(t: float) -> float:
        return float(motion.at(t).euler_rates.theta_dot)

    return np.array([brentq(rate, times[k], times[k + 1], xtol=1e-15) for k in rising])


@claim()
def fall_is_fastest_at_zero_acceleration(top: Top) -> Measured:
    """Check that theta'' vanishes when theta' is largest, off the quarter period."""
    motion = cusps(top)
    period = motion.nutation_period
    zero, second = times_of_extreme_rate(motion)
    around = zero + LOCATED ** (1 / 2) * period * np.linspace(-1, 1, 5)
    rates = np.asarray(motion.at(around).euler_rates.theta_dot)
    fastest = float(motion.at(zero).euler_rates.theta_dot)
    mirror = abs((zero + second) / period - 1)
    holds = rates.argmax() == 2 and abs(4 * zero / period - 1) > 0.01 and mirror < LOCATED
    return Measured(
        holds,
        zero=zero,
        early=4 * zero / period,
        fastest=fastest,
        late=4 * second / (3 * period),
        mirror=mirror,
        at_cusp=_theta_acceleration(motion, 0.0),
        at_half=_theta_acceleration(motion, period / 2),
        near=LOCATED**0.5,
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


@claim()
def precession_is_fastest_when_lowest(top: Top) -> Measured:
    """Check that phi' and theta are both largest after half a nutation."""
    motion = cusps(top)
    times = np.linspace(0.0, motion.nutation_period, 2001)
    states = motion.at(times)
    theta, phi_dot = states.euler_angles.theta, states.euler_rates.phi_dot
    holds = theta.argmax() == 1000 == phi_dot.argmax()
    return Measured(holds, count=len(times), times=times, theta=theta, phi_dot=phi_dot)


@claim()
def spin_falls_with_the_axis(top: Top) -> Measured:
    """Check that psi' falls as theta grows, although L_z is constant."""
    motion = cusps(top)
    states = motion.at(np.linspace(0.0, motion.nutation_period / 2, 1001))
    theta, psi_dot = states.euler_angles.theta, states.euler_rates.psi_dot
    omega_z = float(motion.start.angular_velocity[2])
    expected = omega_z - states.euler_rates.phi_dot * np.cos(theta)
    off = float(np.abs(psi_dot - expected).max()) / abs(omega_z)
    falls = bool((np.diff(psi_dot) < 0).all() and (np.diff(theta) > 0).all())
    return Measured(falls and off < SUMMED, psi_dot=psi_dot, last=psi_dot[-1], off=off)


@claim()
def spin_decides_the_direction(top: Top) -> Measured:
    """Check that a top released with psi' < 0 precesses backwards, as a mirror image."""
    forward = cusps(top)
    backward = Motion(top, start(0.0, -PSI_DOT))
    rates = forward.mean_precession_rate, backward.mean_precession_rate
    off = abs(sum(rates)) / abs(rates[0])
    return Measured(
        rates[0] > 0 > rates[1] and off < MIRRORED, rates=rates, backward=-PSI_DOT, off=off
    )


@claim()
def momentum_does_not_close(top: Top) -> Measured:
    """Check that the horizontal part of L returns after a turn only in regular precession."""
    gaps, counts = [], []
    for motion in (cusps(top), regular(top)):
        turn = first_turn(motion)
        L = top.angular_momentum(motion.at([0.0, turn]))[:, :2]
        gaps.append(float(np.linalg.norm(L[1] - L[0]) / np.linalg.norm(L[0])))
        counts.append(turn / motion.nutation_period)
    return Measured(f"{gaps[0]:.1%}" == "13.2%" and gaps[1] < CLOSED, gaps=gaps, counts=counts)


@claim()
def momentum_is_smallest_when_highest(top: Top) -> Measured:
    """Check that L^2 is smallest where theta is smallest, and largest there for Mgl < 0."""
    offs, extremes = [], []
    for each in (top, Top(top.Ix, top.Iz, -top.Mgl)):
        motion = cusps(each)
        states = motion.at(np.linspace(0.0, motion.nutation_period / 2, 1001))
        square = (each.angular_momentum(states) ** 2).sum(axis=1)
        spin = each.axial_momentum(motion.start)
        height = states.vertical[:, 2]
        energy = EffectivePotential.from_state(each, motion.start).energy
        expected = spin**2 + 2 * each.Ix * (energy - each.Mgl * height)
        offs.append(float(np.abs(square / expected - 1).max()))
        extreme = square.argmin() if each.Mgl > 0 else square.argmax()
        extremes.append(height.argmax() == extreme)
    return Measured(all(extremes) and max(offs) < SUMMED, below=-top.Mgl, off=max(offs))
