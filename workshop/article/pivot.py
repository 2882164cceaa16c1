"""Claims on the force of the pivot: when a peg that is only set down would slip, or lift.

The motion does not depend on mass and arm, the force does. `symtop_ros.physics.Body` chooses them.
"""

import numpy as np
from scipy.optimize import brentq

from symtop_ros.base.arrays import Real
from symtop_ros.physics import Body, Motion, Top
from workshop.article.claims import Measured, claim, differ
from workshop.article.motions import FAST, SLOW, cusps, slope, start
from workshop.article.nutation import nutation_times

SHORT_ARM = 2.9e-3  # m, with which the same top would hardly slip
SAMPLES = 400  # of a nutation
DIFFERENTIATED = 1e-9  # relative; a difference is good to 1e-11
BALANCED = 1e-13  # relative; a mean of 400 rounded numbers. Measured: 4e-16
PERIODIC = 1e-12  # relative; the mean of a periodic function. Measured: 9e-16
MOST_HURRIED = 4.0  # a factor by which the article's top lifts


def pivot_forces(motion: Motion, times: Real) -> tuple[Real, Real]:
    """Return the vertical and the horizontal force of the pivot on the top, (n,), in N."""
    forces = Body.from_top(motion.top).pivot_force(motion, motion.at(times))
    return forces[:, 2], np.linalg.norm(forces[:, :2], axis=1)


@claim()
def force_accelerates_the_mass(top: Top) -> Measured:
    """Check the force against the acceleration of the centre of mass, found by differences."""
    body = Body.from_top(top)
    motion = cusps(top)
    times = nutation_times(motion, SAMPLES)

    def velocity(t: Real) -> Real:
        states = motion.at(t)
        omega = states.to_world(states.angular_velocity)
        return np.asarray(np.cross(omega, body.centre_of_mass(states)))

    expected = body.mass * (slope(velocity, times) + np.array([0.0, 0.0, body.gravity]))
    forces = body.pivot_force(motion, motion.at(times))
    off = differ(forces, expected)
    return Measured(off < DIFFERENTIATED, body=body, arm=1e3 * body.arm, off=off)


@claim()
def pivot_carries_the_weight(top: Top) -> Measured:
    """Check that the vertical force is the weight on average over a nutation."""
    body = Body.from_top(top)
    motion = cusps(top)
    vertical, _ = pivot_forces(motion, nutation_times(motion, SAMPLES))
    weight = body.mass * body.gravity
    off = abs(float(vertical.mean()) / weight - 1)
    holds = off < PERIODIC and vertical.min() < 0.99 * weight < 1.01 * weight < vertical.max()
    return Measured(holds, least=vertical.min(), most=vertical.max(), weight=weight, off=off)


@claim()
def peg_slips(top: Top) -> Measured:
    """Check the friction that a peg needs on both roots of regular precession."""
    needed = []
    offs = []
    body = Body.from_top(top)
    for rate in (SLOW, FAST):
        motion = Motion(top, start(rate))
        vertical, horizontal = pivot_forces(motion, nutation_times(motion, SAMPLES))
        sine = np.sin(motion.start.euler_angles.theta)
        needed.append(float((horizontal / vertical).max()))
        offs.append(abs(needed[-1] / (body.arm * sine * rate**2 / body.gravity) - 1))
    limit = 1e3 * body.arm / needed[1]
    short = needed[1] * SHORT_ARM / body.arm
    holds = needed[0] < 0.1 and max(offs) < BALANCED and f"{limit:.1f}" == "4.2" and short < 1
    return Measured(
        holds,
        arm=1e3 * body.arm,
        body=body,
        needed=needed,
        short=short,
        short_arm=1e3 * SHORT_ARM,
        limit=limit,
        off=max(offs),
    )


@claim()
def peg_lifts(top: Top) -> Measured:
    """Check that a top hurried far enough from the fast root would lift its peg."""
    weight = Body.from_top(top).mass * Body.from_top(top).gravity
    hurried = _least_force(top, 1.4)
    most = _least_force(top, MOST_HURRIED)
    factor = float(brentq(lambda each: _least_force(top, each), 1.4, MOST_HURRIED, xtol=1e-6))
    holds = hurried > 0 > most
    return Measured(
        holds,
        weight=weight,
        hurried=hurried,
        rate=1.4 * FAST,
        most=most,
        fastest=MOST_HURRIED * FAST,
        lifted=factor * FAST,
        factor=factor,
    )


def _least_force(top: Top, factor: float) -> float:
    """Return the least vertical force in N of a nutation that starts at a multiple of FAST."""
    motion = Motion(top, start(factor * FAST))
    return float(pivot_forces(motion, nutation_times(motion, SAMPLES))[0].min())
