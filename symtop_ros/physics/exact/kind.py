"""The kind of a motion, by the sign of phi' at the two turning angles of theta, and its rates."""

import math
from decimal import Decimal
from typing import Literal, NamedTuple

from symtop_ros.physics.exact.elementary import cosine_and_sine
from symtop_ros.physics.exact.nutation import Nutation, Roots
from symtop_ros.physics.exact.quotients import Zeros
from symtop_ros.physics.values import START_ROUNDING

Kind = Literal[
    "regular",
    "unidirectional",
    "cusps",
    "looping",
    "through the pole",
    "asymptotic",
    "sleeping",
    "driven",  # with friction or an applied torque, which have no turning angles
]

ROUNDING = Decimal.from_float(START_ROUNDING)


def classify(nutation: Nutation, roots: Roots, zeros: Zeros) -> Kind:
    """Return the kind of a motion whose axis moves.

    Numbers that differ by rounding of the start alone count as equal: a start that is computed to
    lie on a root of regular precession is regular, although its doubles miss the root.
    """
    above = zeros.B
    if roots.s32 == 0:
        return "asymptotic"
    if _is_regular(nutation):
        return "regular"
    rounding = ROUNDING * largest_precession(nutation, zeros)
    lower_pole, upper_pole = abs(zeros.A.d), abs(above.d)
    if lower_pole <= rounding or (upper_pole <= rounding and above.from_u2 <= above.from_u3):
        return "through the pole"
    lower, upper = nutation.b_minus_au_at(roots.s1), nutation.b_minus_au_at(roots.s2)
    if min(abs(lower), abs(upper)) <= rounding:
        return "cusps"
    return "unidirectional" if (lower > 0) == (upper > 0) else "looping"


def largest_precession(nutation: Nutation, zeros: Zeros) -> Decimal:
    """Return a bound on the terms of b - a u = sin^2(theta) phi' during a nutation, in rad/s.

    A state of the motion is known to rounding of these, not to rounding of the terms at the start:
    they may all be small there, near a cusp.
    """
    sine_squared = zeros.largest_sine_squared
    rate = (nutation.beta * zeros.omega_xy.from_u1).sqrt()  # largest |omega_xy|
    return rate * sine_squared.sqrt() + abs(nutation.a) * sine_squared


def _is_regular(nutation: Nutation) -> bool:
    """Return True if theta' = theta'' = 0 at the start."""
    centrifugal = nutation.omega_xy_squared * abs(nutation.u)
    gravity = nutation.beta * nutation.one_plus_u * nutation.one_minus_u / 2
    spin = nutation.a * nutation.b_minus_au
    sine_squared = nutation.one_plus_u * nutation.one_minus_u
    is_still = nutation.u_dot**2 <= ROUNDING**2 * nutation.omega_xy_squared * sine_squared
    return is_still and abs(nutation.u_dot_dot) <= ROUNDING * (abs(spin) + centrifugal + gravity)


def classify_free(tilt_of_momentum: float, cone: float) -> Kind:
    """Return the kind of a motion without torque, whose axis moves on a circle about L."""
    inside, far = tilt_of_momentum - cone, tilt_of_momentum + cone
    rounding = START_ROUNDING * math.pi
    sines = cosine_and_sine(tilt_of_momentum)[1], cosine_and_sine(cone)[1]
    if min(sines) <= rounding:
        return "regular"
    if abs(inside) <= rounding or abs(far - math.pi) <= rounding:
        return "through the pole"
    return "unidirectional" if (inside < 0) == (far < math.pi) else "looping"


class Rates(NamedTuple):
    """Quantities that are the same in every nutation."""

    nutation_period: float  # s; infinite if theta does not return
    mean_precession_rate: float  # mean phi' in rad/s; nan if the axis meets the vertical
    mean_spin_rate: float  # mean psi' in rad/s; nan there as well
    precession_per_nutation: float  # in turns; nan there, and if theta does not return
    spin_reverses: bool  # True if psi' takes both signs
