"""What kind of motion it is: what phi' does at the two turning angles of theta."""

from __future__ import annotations

import math
from decimal import Decimal, localcontext
from typing import Literal

from symtop_ros.physics.nutation import Heights, Start
from symtop_ros.physics.precise import PRECISE
from symtop_ros.physics.quotients import Quotient

Kind = Literal[
    "regular",
    "unidirectional",
    "cusps",
    "looping",
    "through the pole",
    "spiralling",
    "sleeping",
]

ROUNDING = Decimal(64 * 2.0**-52)  # what rounding of the start alone does to a sum of its terms


def kind_of(start: Start, heights: Heights, zeros: tuple[Quotient, ...]) -> Kind:
    """Return the kind of a motion whose axis moves; what rounding alone makes differ is equal."""
    with localcontext(PRECISE):
        above = zeros[1]
        if heights.s32 <= ROUNDING * heights.s3 and _no_momentum(start, start.below):
            return "spiralling"
        if _regular(start):
            return "regular"
        if _no_momentum(start, -start.above) or (
            _no_momentum(start, start.below) and above.from_u2 <= above.from_u3
        ):
            return "through the pole"
        if _no_momentum(start, heights.s1) or _no_momentum(start, heights.s2):
            return "cusps"
        lower, upper = start.momentum_about(heights.s1), start.momentum_about(heights.s2)
        return "unidirectional" if (lower > 0) == (upper > 0) else "looping"


def _no_momentum(start: Start, s: Decimal) -> bool:
    """Whether phi' sin^2(theta) vanishes at height u0 + s."""
    terms = abs(start.around) + abs(start.spin * s)
    return abs(start.momentum_about(s)) <= ROUNDING * terms


def _regular(start: Start) -> bool:
    """Whether theta' = theta'' = 0 at the start."""
    across = start.across * abs(start.u)
    gravity = start.pull * start.above * start.below / 2
    spin = start.spin * start.around
    bend = spin - start.u * start.across - gravity
    still = start.fall**2 <= ROUNDING**2 * start.across * start.above * start.below
    return still and abs(bend) <= ROUNDING * (abs(spin) + across + gravity)


def free_kind(tilt_of_momentum: float, cone: float) -> Kind:
    """Return the kind of a motion without torque: a circle of radius `cone` about L."""
    inside, far = tilt_of_momentum - cone, tilt_of_momentum + cone
    rounding = float(ROUNDING) * math.pi
    if min(math.sin(tilt_of_momentum), math.sin(cone)) <= rounding:
        return "regular"
    if abs(inside) <= rounding or abs(far - math.pi) <= rounding:
        return "through the pole"
    return "unidirectional" if (inside < 0) == (far < math.pi) else "looping"
