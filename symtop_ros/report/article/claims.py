"""Every claim of the article that can be checked."""

from __future__ import annotations

from symtop_ros.physics import Top, motion
from symtop_ros.report.article import on_momentum, on_nutation, on_rates
from symtop_ros.report.article.claim import Claim
from symtop_ros.report.article.motions import (
    FROM_FAST,
    FROM_SLOW,
    HANGING_DISC,
    OF_THE_DISC,
    RATES,
    TOP,
    cusps,
    regular,
    seven,
    start,
)


def claims(top: Top = TOP) -> list[Claim]:
    """Return the claims with what they were measured to be, of the article's top or another."""
    return [*claims_on_rates(top), *claims_on_momentum(top), *claims_on_nutation(top)]


def claims_on_rates(top: Top) -> list[Claim]:
    """Regular precession, rising and falling, and Perry's rule."""
    return [
        on_rates.roots_are_as_printed(top),
        on_rates.printed_roots_keep_the_tilt(top),
        *(on_rates.rate_decides(top, rate) for rate in RATES),
        on_rates.acceleration_is_a_parabola(top),
        on_rates.hurrying(top, FROM_SLOW),
        on_rates.hurrying(top, FROM_FAST),
        on_rates.hurrying(HANGING_DISC, OF_THE_DISC),
    ]


def claims_on_momentum(top: Top) -> list[Claim]:
    """Constants of motion, torque, and the equations of motion."""
    paths = seven(top)
    return [
        *(on_momentum.is_constant(name, paths) for name in on_momentum.CONSTANTS),
        on_momentum.torque_is_along_the_line_of_nodes(cusps(top)),
        *(on_momentum.momentum_changes_by_gravity(path) for path in (regular(top), cusps(top))),
        on_momentum.attitude_turns_with_the_angular_velocity(cusps(top)),
        on_momentum.equations_hold(cusps(top)),
    ]


def claims_on_nutation(top: Top) -> list[Claim]:
    """What nutates together."""
    nutating = [motion(top, start(rate.phi_dot)) for rate in RATES if rate.follows != "stays"]
    return [
        on_nutation.momentum_swings_with_the_tilt([*nutating, cusps(top)]),
        on_nutation.precession_stops_at_the_cusps(cusps(top)),
    ]
