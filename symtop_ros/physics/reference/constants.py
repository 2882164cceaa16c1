"""Constants of a motion under gravity in balls: kind, period, turning angles, mean rates.

The kind is that of exactly the doubles given, decided in fractions: where the kernel takes numbers
that differ by rounding as equal, this does not.
"""

from __future__ import annotations

import math
from fractions import Fraction
from typing import NamedTuple

from flint import acb, arb

from symtop_ros.physics.reference.balls import Ball, norm, refine, show, to_ball
from symtop_ros.physics.reference.fall import Fall, Nutation, turn_world
from symtop_ros.physics.reference.series import Inputs

ENDLESS = ("sleeping", "asymptotic")  # kinds without a period
WITHOUT_MEANS = (*ENDLESS, "through the pole")  # phi jumps at a pole


class ProvedConstants(NamedTuple):
    """Constants of a motion under gravity; balls contain the exact numbers.

    Attributes
    ----------
    kind : str
        As `Motion.kind`, for exactly the doubles given.
    period : flint.arb
        Period of theta in s; for a regular precession, that of a small nutation. Infinite if the
        axis rests on the vertical or approaches it for ever, and for a body at rest without weight.
    turning_angles : (flint.arb, flint.arb)
        Smallest and largest theta in rad.
    mean_rates : (flint.arb, flint.arb)
        Mean phi' and psi' over a nutation in rad/s; nan if the axis rests on the vertical, passes
        through it or approaches it for ever. For a clamped motion 0 and omega_z.
    """

    kind: str
    period: Ball
    turning_angles: tuple[Ball, Ball]
    mean_rates: tuple[Ball, Ball]

    def __str__(self) -> str:
        """Return the digits that are known."""
        parts = {"period": (self.period,), "turning_angles": self.turning_angles}
        parts["mean_rates"] = self.mean_rates
        lines = (f"{name}: {' '.join(map(show, balls))}" for name, balls in parts.items())
        return "\n".join((f"kind: {self.kind}", *lines))


def prove_constants(inputs: Inputs, digits: int) -> ProvedConstants:
    """Return the constants of a motion under gravity alone: see `exact_constants`."""

    def is_small(found: ProvedConstants) -> bool:
        return _is_small(found, arb(10) ** -digits)

    return refine(lambda _: find_constants(inputs), is_small, int(digits * math.log2(10)) + 60)


def prove_held_constants(inputs: Inputs, digits: int) -> ProvedConstants:
    """Return those of the pendulum that is left while a hand holds phi."""
    found = prove_constants(inputs.clamp(), digits)
    rates = arb(0), to_ball(inputs.angular_velocity[2])
    return found._replace(kind="clamped", mean_rates=rates)


def find_constants(inputs: Inputs) -> ProvedConstants:
    """Return the constants at the precision of FLINT's context."""
    fall = Fall(turn_world(inputs))
    if fall.rests:
        found = _find_resting(fall)
    else:
        found = _find_nutation(fall) if fall.beta else _find_circle(fall)
    if inputs.Mgl >= 0:
        return found
    least, most = found.turning_angles
    phi_dot, psi_dot = found.mean_rates
    angles = arb.pi() - most, arb.pi() - least
    return found._replace(turning_angles=angles, mean_rates=(-phi_dot, psi_dot))


def _is_small(found: ProvedConstants, least: Ball) -> bool:
    """Return True if radii are small, of balls that are finite: others are too wide."""
    limits = [(each, arb(1)) for each in found.turning_angles]
    if found.period != arb.pos_inf():
        limits.append((found.period, found.period))
    if found.kind not in WITHOUT_MEANS:
        limits += [(each, norm(found.mean_rates)) for each in found.mean_rates]
    return all(x.is_finite() and bool(x.rad() <= least * size) for x, size in limits)


def _find_resting(fall: Fall) -> ProvedConstants:
    """Return what regular precession has, and an axis on the vertical."""
    u = to_ball(fall.u)
    nan = arb.nan()
    if fall.u**2 == 1:
        angle = arb(0) if fall.u > 0 else arb.pi()
        return ProvedConstants("sleeping", arb.pos_inf(), (angle, angle), (nan, nan))
    phi_dot = (fall.b - fall.a * fall.u) / (1 - fall.u**2)
    rates = to_ball(phi_dot), to_ball(fall.wz - phi_dot * fall.u)
    # u'' = f'(u)/2 next to the double root
    square = fall.alpha + fall.a**2 - 3 * fall.beta * fall.u
    period = 2 * arb.pi() / to_ball(square).sqrt() if square else arb.pos_inf()
    return ProvedConstants("regular", period, (u.acos(), u.acos()), rates)


def _find_nutation(fall: Fall) -> ProvedConstants:
    nutation = Nutation(fall)
    kind = _decide_kind(fall, nutation)
    heights = [_find_height(fall, nutation, k) for k in (1, 2)]
    angles = heights[0].acos(), heights[1].acos()
    nan = arb.nan()
    if kind == "asymptotic":
        return ProvedConstants(kind, arb.pos_inf(), angles, (nan, nan))
    if kind == "through the pole":
        return ProvedConstants(kind, nutation.unit, angles, (nan, nan))
    of_A, of_B = (acb(nutation.find_rate(k)).imag for k in (0, 1))
    return ProvedConstants(kind, nutation.unit, angles, (of_A + of_B, of_A - of_B))


def _find_circle(fall: Fall) -> ProvedConstants:
    """Return the constants of an axis that turns about L, as there is no weight.

    Its height is u = (a b + |omega_xy| sqrt(|R|^2 - b^2) cos(|R| t))/|R|^2 with |R| = |L|/Ix, from
    the highest place on. In a turn the arguments of A and B make half a turn each, with the signs
    of b + a and of b - a.
    """
    square, (above, below) = fall.alpha + fall.a**2, (_turns_at(fall, pole) for pole in (1, -1))
    rate, middle = to_ball(square).sqrt(), to_ball(fall.a * fall.b / square)
    half = to_ball(fall.alpha * (square - fall.b**2)).sqrt() / to_ball(square)
    highest, lowest = arb(1) if above else middle + half, arb(-1) if below else middle - half
    angles, period = (highest.acos(), lowest.acos()), 2 * arb.pi() / rate
    if above or below:
        return ProvedConstants("through the pole", period, angles, (arb.nan(), arb.nan()))
    of_A, of_B = (1 if part > 0 else -1 for part in (fall.b + fall.a, fall.b - fall.a))
    rates = rate * (of_A + of_B) / 2, rate * (of_A - of_B) / 2 + to_ball(fall.c)
    kind = "unidirectional" if of_A == of_B else "looping"
    return ProvedConstants(kind, period, angles, rates)


def _find_height(fall: Fall, nutation: Nutation, k: int) -> Ball:
    """Return u at a turning angle: the root e_(k + 1), or a pole if that is decided."""
    if k == 1 and (_turns_at(fall, 1) or not nutation.simple):
        return arb(1)
    if k == 2 and _turns_at(fall, -1):
        return arb(-1)
    return 4 * (nutation.e[k] + to_ball(nutation.shift)) / to_ball(fall.beta)


def _turns_at(fall: Fall, pole: int) -> bool:
    """Return True if the motion turns at a pole: a root of f, but not the one beyond all motion."""
    return fall.b == pole * fall.a and pole * fall.f1(Fraction(pole)) < 0


def _decide_kind(fall: Fall, nutation: Nutation) -> str:
    if not nutation.simple:
        return "asymptotic"
    if _turns_at(fall, 1) or _turns_at(fall, -1):
        return "through the pole"
    # b - a u vanishes at b/a, and f there; beyond the poles there is no motion
    if abs(fall.b) < abs(fall.a) and fall.alpha * fall.a == fall.beta * fall.b:
        return "cusps"
    signs = [to_ball(fall.b) - to_ball(fall.a) * _find_height(fall, nutation, k) for k in (1, 2)]
    if any(sign.contains(0) for sign in signs):
        raise ValueError("a sign must be decided")
    return "looping" if (signs[0] > 0) != (signs[1] > 0) else "unidirectional"
