"""Motions next to the unstable vertical and the separatrix, and the error of their derivatives."""

import math
from typing import NamedTuple

from drawn import Numbers
from physics.differences import differentiate, find_errors

from symtop_ros.physics import Motion, State, Top

PROMISED = 1e-8  # docs/filters.md
LEAST_TILT, LEAST_GAP = 1e-6, 1e-8  # below them a refusal is promised to be possible
DIGITS = 60  # those of a derivative are a third, less what the motion magnifies
TURNS = ((1.0, 0.0), (0.6, 0.8), (-5 / 13, 12 / 13), (8 / 17, -15 / 17), (-0.8, -0.6))
RATIOS = (0.25, 0.5, 1.0, 1.5, 1.9375)  # Iz/Ix: rods, spheres, discs
DISCS = 0.05  # share of flat ones


class Case(NamedTuple):
    """A motion and a time, and how near to the vertical (rad) or the separatrix it starts."""

    family: str
    motion: Motion
    t: float
    nearness: float

    @property
    def may_be_refused(self) -> bool:
        return self.nearness < (LEAST_TILT if self.family == "vertical" else LEAST_GAP)


def make_case(number: int) -> Case:
    """The motion of a number: from the vertical if it is even, from the separatrix if odd."""
    rng = Numbers(f"unstable {number}")
    ratio = 2.0 if rng.uniform(0, 1) < DISCS else rng.choice(RATIOS)
    family, make = (("separatrix", _pass_by), ("vertical", _stand))[number % 2 == 0]
    motion, nearness = make(rng, ratio)
    period = motion.nutation_period
    unit = period if math.isfinite(period) else 10.0
    late = rng.uniform(0, 1) < 0.25
    t = rng.power(0, 4) * unit if late else rng.uniform(0, 3) * unit
    return Case(family, motion, t, nearness)


def _stand(rng: Numbers, ratio: float) -> tuple[Motion, float]:
    """A top next to the vertical, mostly too slow to stay there."""
    Mgl, tilt = rng.uniform(1, 4), rng.power(-6.5, -1.3)
    critical = 2 * math.sqrt(Mgl) / ratio
    spin = critical * rng.uniform(-1.2, 1.2)
    w, z = rng.choice(TURNS)
    x, y = rng.uniform(-1, 1), rng.uniform(-1, 1)
    half = tilt / 2 / math.sqrt(x * x + y * y)
    moving = rng.choice((0.0, tilt))
    across = moving * rng.uniform(-1, 1), moving * rng.uniform(-1, 1)
    # The norm is 1 + tilt^2/8.
    start = State((w, half * x, half * y, z), (*across, spin))
    return Motion(Top(1.0, ratio, Mgl), start), tilt


def _pass_by(rng: Numbers, ratio: float) -> tuple[Motion, float]:
    """A motion from the horizontal that just reaches the upper vertical, or just does not."""
    x, y, gap = rng.uniform(-2, 2), rng.uniform(-2, 2), rng.power(-8.3, -0.5)
    # On the separatrix omega_y is Iz omega_z/Ix, and omega_xy^2 is 2 Mgl/Ix.
    Mgl = (x * x + y * y) / 2 * (1 + rng.choice((gap, -gap)))
    start = State((0.5, 0.5, 0.5, 0.5), (x, y, y / ratio))
    return Motion(Top(1.0, ratio, Mgl), start), gap


def find_error(case: Case, exact: Motion | None = None) -> float | None:
    """The largest error of the derivatives, as a part of what is promised; None if refused.

    `exact` is the motion with which they are compared, if another one.
    """
    try:
        found = case.motion.jacobian([case.t])
    except ValueError as refusal:
        if "at which double precision resolves the derivatives" not in str(refusal):
            raise
        return None
    right = differentiate(exact or case.motion, [case.t], digits=DIGITS)
    return float(find_errors(case.motion, found, right).max()) / PROMISED
