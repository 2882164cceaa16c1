"""Claims on kinds of motion: what the accelerations at the start leave open, and the constants say.

theta'' at the start is one number. The kind of the motion depends on phi' at both turning angles,
and the second of these is known from the constants of motion alone.
"""

import numpy as np

from symtop_ros.physics import (
    EffectivePotential,
    Motion,
    State,
    Top,
    regular_precession_rates,
    theta_acceleration,
)
from workshop.article.claims import Claim, Measured, claim, differ
from workshop.article.motions import (
    FAST,
    HANGING_DISC,
    PSI_DOT,
    RATES,
    SLOW,
    THETA,
    accelerations,
    measure_acceleration,
    start,
)

DISC = Top(HANGING_DISC.Ix, HANGING_DISC.Iz, -HANGING_DISC.Mgl)  # upright
LYING = np.pi - 0.5  # rad, below the horizontal
SAME_RATE = 1e-12  # rad/s; phi' of regular precession at the far turning angle. Measured: 3e-14
EQUAL = 1e-13  # of theta''; two rates that are rounded once. Measured: 4e-15
VIETA = 1e-14  # relative; two rounded roots
TURNED = 1e-14  # of U_eff; rounding of the angle. Measured: 5e-16
STEP_SHARE = 0.002  # of a nutation: its phase changes by 0.013 rad in a step


def claims_on_kinds(top: Top) -> list[Claim]:
    """Return the claims on the six kinds, on equal starts, and on parabolas that open downwards."""
    return [
        six_rates_have_kinds(top),
        accelerations_do_not_decide(top, 0.0),
        accelerations_do_not_decide(top, -3.0),
        constants_decide(top),
        parabola_opens_downward("a disc with Iz > Ix", DISC, THETA),
        parabola_opens_downward("the article's top below the horizontal", top, LYING),
    ]


@claim
def six_rates_have_kinds(top: Top) -> Measured:
    """Check the kind of each of the six motions by phi' at both turning angles."""
    words, agrees = [], []
    for rate in RATES:
        motion = Motion(top, start(rate.phi_dot))
        near, far = rate.phi_dot, float(motion.at(motion.nutation_period / 2).euler_rates.phi)
        expected = "regular" if rate.direction == "stays" else "unidirectional"
        is_regular = abs(far - near) < SAME_RATE
        agrees.append(motion.kind == expected and is_regular == (expected == "regular"))
        agrees.append(near * far > 0)
        words.append(f"{near:.4g} to {far:.4g} {motion.kind}")
    return Measured(all(agrees), listed="; ".join(words))


@claim
def accelerations_do_not_decide(top: Top, phi_dot: float) -> Measured:
    """Check that two starts have the same three accelerations and different kinds.

    The parabola of theta'' takes each value at two rates, which have the sum of its roots.
    """
    partner = SLOW + FAST - phi_dot
    motions = [Motion(top, start(rate)) for rate in (phi_dot, partner)]
    first, second = (accelerations(top, motion.at([0.0]))[0] for motion in motions)
    off = differ(second, first)
    kinds = [motion.kind for motion in motions]
    lowest = [motion.turning_angles[1] for motion in motions]
    holds = off < EQUAL and kinds[0] != kinds[1]
    return Measured(
        holds, phi_dot=phi_dot, partner=partner, first=first, off=off, kinds=kinds, lowest=lowest
    )


@claim
def constants_decide(top: Top) -> Measured:
    """Check that the effective potential alone gives the turning angles that the motion has."""
    offs, words = [], []
    for rate in (0.0, SLOW + FAST):
        motion = Motion(top, start(rate))
        potential = EffectivePotential.of(top, motion.start)
        reached = motion.at([0.0, motion.nutation_period / 2]).euler_angles.theta
        size = np.abs(potential.at(reached)).max()
        offs.append(float(np.abs(potential.at(reached) - potential.energy).max() / size))
        words.append(f"{min(reached):.3f} .. {max(reached):.3f} rad")
    return Measured(max(offs) < TURNED, listed=" and of ".join(words), off=max(offs))


@claim
def parabola_opens_downward(name: str, top: Top, theta: float) -> Measured:
    """Check the sign rule of the roots, and rising and falling, for (Ix - Iz) cos(theta) < 0."""
    a, b = (top.Ix - top.Iz) * float(np.cos(theta)), top.Iz * PSI_DOT
    low, high = sorted(regular_precession_rates(top, theta, PSI_DOT))
    rates = [low - 5.0, (low + high) / 2, high + 5.0]
    starts = [State.from_euler(theta=theta, phi_dot=rate, psi_dot=PSI_DOT) for rate in rates]
    found = [measure_acceleration(Motion(top, each), STEP_SHARE) for each in starts]
    off = max(abs((low + high) * a / b - 1), abs(low * high * a / top.Mgl - 1))
    expected = theta_acceleration(top, theta, np.array(rates), PSI_DOT)
    good = np.array_equal(np.sign(found), [-1, 1, -1]) and np.allclose(found, expected, rtol=1e-9)
    holds = good and low < 0 < high and a < 0 and off < VIETA
    return Measured(holds, name=name, low=low, high=high, found=found, off=off)
