"""Claims on the force of the pivot: when a peg that is only set down would slip, or lift.

The motion does not depend on mass and arm, the force does. `symtop_ros.physics.Body` chooses them.
"""

import numpy as np
from scipy.optimize import brentq

from symtop_ros.arrays import Real
from symtop_ros.physics import Body, Motion, Top
from workshop.article.claims import Claim, claim, differ
from workshop.article.motions import FAST, SLOW, cusps, slope, start

EQUATION = "F = M (a + g z'), a = alpha x r + omega x (omega x r)"
SHORT_ARM = 2.9e-3  # m, with which the same top would hardly slip
SAMPLES = 400  # of a nutation
DIFFERENTIATED = 1e-9  # relative; a difference is good to 1e-11
BALANCED = 1e-13  # relative; a mean of 400 rounded numbers. Measured: 4e-16
PERIODIC = 1e-12  # relative; the mean of a periodic function. Measured: 9e-16
MOST_HURRIED = 4.0  # a factor by which the article's top lifts


def claims_on_pivot(top: Top) -> list[Claim]:
    """Return the claims on the force of the pivot on the top."""
    return [
        force_accelerates_the_mass(cusps(top)),
        pivot_carries_the_weight(cusps(top)),
        peg_slips(top),
        peg_lifts(top),
    ]


def pivot_forces(motion: Motion, times: Real) -> tuple[Real, Real]:
    """Return the vertical and the horizontal force of the pivot on the top, (n,), in N."""
    forces = Body.of(motion.top).pivot_force(motion, motion.at(times))
    return forces[:, 2], np.linalg.norm(forces[:, :2], axis=1)


@claim
def force_accelerates_the_mass(motion: Motion) -> Claim:
    """Check the force against the acceleration of the centre of mass, found by differences."""
    body, times = Body.of(motion.top), _nutation(motion)

    def velocity(t: Real) -> Real:
        states = motion.at(t)
        omega = states.to_world(states.angular_velocity)
        return np.asarray(np.cross(omega, body.centre_of_mass(states)))

    expected = body.mass * (slope(velocity, times).values + np.array([0.0, 0.0, body.gravity]))
    forces = body.pivot_force(motion, motion.at(times))
    off = differ(forces, expected)
    return Claim(
        "The pivot must accelerate the centre of mass and carry the weight: a second force, of "
        "which the equations of motion about the pivot say nothing.",
        f"for M = {body.mass:.4f} kg and an arm of {body.arm * 1e3:.2f} mm, half of the longest "
        f"possible, the force and the differentiated velocity agree within {off:.0e} (cusps)",
        off < DIFFERENTIATED,
        EQUATION,
        f"{DIFFERENTIATED:g}: a derivative by differences is good to 1e-11",
    )


@claim
def pivot_carries_the_weight(motion: Motion) -> Claim:
    """Check that the vertical force is the weight on average over a nutation."""
    body = Body.of(motion.top)
    vertical, _ = pivot_forces(motion, _nutation(motion))
    weight = body.mass * body.gravity
    off = abs(float(vertical.mean()) / weight - 1)
    return Claim(
        "The vertical force of the pivot is the weight on average, less while the axis begins to "
        "fall and more while it is caught.",
        f"{vertical.min():.3f} to {vertical.max():.3f} N for a weight of {weight:.3f} N (cusps); "
        f"the mean of a nutation is off by {off:.0e}",
        bool(off < PERIODIC and vertical.min() < 0.99 * weight < 1.01 * weight < vertical.max()),
        "mean of F_z' = M g, because the height of the centre of mass returns",
        f"{PERIODIC:g}: the mean of a smooth periodic function is exact to rounding",
    )


@claim
def peg_slips(top: Top) -> Claim:
    """Check the friction that a peg needs on both roots of regular precession."""
    needed, offs, body = [], [], Body.of(top)
    for rate in (SLOW, FAST):
        motion = Motion(top, start(rate))
        vertical, horizontal = pivot_forces(motion, _nutation(motion))
        sine = np.sin(motion.start.euler_angles.theta)
        needed.append(float((horizontal / vertical).max()))
        offs.append(abs(needed[-1] / (body.arm * sine * rate**2 / body.gravity) - 1))
    limit, short = 1e3 * body.arm / needed[1], needed[1] * SHORT_ARM / body.arm
    return Claim(
        "A peg that is only set down keeps its place on the slow root. On the fast root it slides "
        'away (the article\'s "otherwise the top slides") if the centre of mass is more than 4.2 '
        "mm from the pivot; the motion does not say how far it is.",
        f"coefficient of friction needed with an arm of {body.arm * 1e3:.1f} mm "
        f"(M = {body.mass:.3f} kg): {needed[0]:.3f} at {SLOW:.2f} rad/s and {needed[1]:.2f} at "
        f"{FAST:.1f} rad/s; there {short:.2f} with {SHORT_ARM * 1e3:g} mm, 1 with {limit:.2f} mm; "
        f"off the equation by {max(offs):.0e}",
        bool(needed[0] < 0.1 and max(offs) < BALANCED and f"{limit:.1f}" == "4.2" and short < 1),
        "F_horizontal/F_z' = |r| sin(theta) phi'^2/g in regular precession",
        f"{BALANCED:g}: rounding of the root, which the rate enters squared; a peg of dry metal or "
        "wood holds up to about 1",
    )


@claim
def peg_lifts(top: Top) -> Claim:
    """Check that a top hurried far enough from the fast root would lift its peg."""
    weight = Body.of(top).mass * Body.of(top).gravity
    hurried, most = _least_force(top, 1.4), _least_force(top, MOST_HURRIED)
    sentence = "Hurried from the fast root, a top that is only set down first stays on the ground; "
    sentence += "hurried further, it falls so fast that the peg lifts off."
    if hurried * most >= 0:
        return Claim(sentence, f"least force {hurried:.3g} and {most:.3g} N", holds=False)
    factor = float(brentq(lambda each: _least_force(top, each), 1.4, MOST_HURRIED, xtol=1e-6))
    return Claim(
        sentence,
        f"least F_z' in a nutation for a weight of {weight:.3f} N: {hurried:.3f} N at "
        f"{1.4 * FAST:.1f} rad/s (factor 1.4), {most:.1f} N at {MOST_HURRIED * FAST:.0f} rad/s; "
        f"it is zero at {factor * FAST:.1f} rad/s (factor {factor:.3f})",
        bool(hurried > 0 > most),
        "F_z' = M (g - r (theta'' sin(theta) + theta'^2 cos(theta))) = 0",
        "none: signs of the least of 400 samples of a nutation",
    )


def _least_force(top: Top, factor: float) -> float:
    """Return the least vertical force in N of a nutation that starts at a multiple of FAST."""
    motion = Motion(top, start(factor * FAST))
    return float(pivot_forces(motion, _nutation(motion))[0].min())


def _nutation(motion: Motion) -> Real:
    """Return times of one nutation, without its end: a mean of these is that of the period."""
    return np.asarray(np.arange(SAMPLES) * (motion.nutation_period / SAMPLES))
