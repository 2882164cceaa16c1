"""Motions with friction and torque as balls: Taylor polynomials, and a proof by their defect.

The polynomials p, of `series`, need no trust. Their defect d = p' - F(p), F being the field of the
equations, is a polynomial, too, and bounded by its coefficients. F is of second degree, so that
e = x - p, x being the exact motion, obeys e' = J((x + p)/2) e - d with the Jacobian J of F. Of the
quaternion's part of e and that of the rates

    |e_q|' <= Q/2 |e_w| + |d_q|,    |e_w|' <= 2 Q P |e_q| + K |e_w| + |d_w|

with Q = |x_q + p_q|/2 <= 1 + |e_q|/2, because exact quaternions have norm 1; a rotation, however
fast, loses nothing. P is the sum of the torques, each divided by its least moment of inertia: a
vector of the world, seen from the body, changes by 2 Q |e_q| of its length. K is half of
|omega_xy (Ix - Iz)/Ix|; friction takes away, or back in time adds its decay. |omega_xy| grows by P
at most, as Euler's terms turn it. So the norm E = |(e_q, e_w/s)| obeys E' <= m E + |d| with
m = (s/2 + 2 P/s) Q/2 + K, and s = 2 sqrt(P) is best.

A time is in units of 1/second, the power of two above the fastest rate, and so are rates.
"""

from __future__ import annotations

import math
from bisect import bisect_right
from collections.abc import Sequence
from fractions import Fraction
from typing import Any

from flint import arb, arb_poly, ctx

from symtop_ros.physics.reference.balls import Ball, ProvedState, TooFewBitsError, norm, to_ball
from symtop_ros.physics.reference.series import Inputs, Series, Way

MARGIN = 60  # bits in which the defect is computed, besides those of the polynomials
ROUGH = 64  # bits in which bounds are
WIDEST = Fraction(1, 2**20)  # error beyond which nothing is proved
LEAST_SCALE = Fraction(1, 2**30)  # of rates, if there is no torque
HALF = arb(0.5)  # a polynomial is not divided
NO_DRIVE = (0.0, 0.0), (0.0, 0.0, 0.0)


class Enclosure:
    """A motion that is integrated and proved up to the times of `at`, and kept.

    The friction is (axial, transverse), the torque is applied in the world frame.
    """

    def __init__(
        self,
        inputs: Inputs,
        bits: int,
        friction: Sequence[float] = NO_DRIVE[0],
        torque: Sequence[float] = NO_DRIVE[1],
    ) -> None:
        self._series = Series(inputs, int(bits * math.log10(2)), friction, torque)
        self._bits = self._series.bits + MARGIN
        with ctx.workprec(self._bits):
            self._field = Field(inputs, self._series.second, friction, torque)
            start = self._field.start
        self._tracks = {sign: Track(start) for sign in (1, -1)}

    def at(self, t: Fraction) -> ProvedState:
        """Return the state at t in s."""
        with ctx.workprec(self._bits):
            time = abs(t) * self._series.second * 2**self._series.bits
            way = self._series.reach(-1 if t < 0 else 1, math.ceil(time))
            step = min(bisect_right(way.begins, math.floor(time)), len(way.steps)) - 1
            track = self._tracks[way.sign]
            while len(track.steps) <= step:
                self._prove(way, track)
            begin, end = map(int, way.begins[step : step + 2])
            part = to_ball((time - begin) / (end - begin))
            values = [each(part) for each in track.steps[step]]
            return self._field.widen(values, track.errors[step])

    def _prove(self, way: Way, track: Track) -> None:
        """Add the polynomials of a step and the bound of their error in it."""
        step = len(track.steps)
        h = to_ball(Fraction(int(way.begins[step + 1] - way.begins[step]), 2**self._series.bits))
        p = [self._scale(each, h * way.sign) for each in way.steps[step]]
        slopes = zip(p, self._field.slopes(p), strict=True)
        defect = [each.derivative() - h * way.sign * slope for each, slope in slopes]
        gaps = [a - each(arb(0)) for a, each in zip(track.end, p, strict=True)]
        with ctx.workprec(ROUGH):
            before = track.errors[-1] if step else arb(0)
            apart = before + self._field.measure(gaps) + self._field.measure(map(largest, defect))
            error = (apart * (self._field.find_growth(p, h, way.sign) * h).exp()).upper()
            if not error < to_ball(WIDEST):
                raise TooFewBitsError
        track.add(p, error)

    def _scale(self, coefficients: Sequence[Any], h: Ball) -> arb_poly:
        """Return the polynomial of a step in time over its length, with numbers that are exact."""
        unit = arb(2) ** -self._series.bits
        found = []
        for each in coefficients:
            found.append((arb(int(each)) * unit).mid())
            unit = (unit * h).mid()
        return arb_poly(found)


class Track:
    """The proved steps forward or back in time: polynomials of the part of a step that is over."""

    def __init__(self, start: list[Ball]) -> None:
        self.end = start  # of the last step
        self.steps: list[list[arb_poly]] = []
        self.errors: list[Ball] = []  # largest one in each step

    def add(self, p: list[arb_poly], error: Ball) -> None:
        """Add a step."""
        self.steps.append(p)
        self.errors.append(error)
        self.end = [each(arb(1)) for each in p]


class Field:
    """The equations of motion in units of the fastest rate, and how fast an error may grow."""

    def __init__(
        self,
        inputs: Inputs,
        second: Fraction,
        friction: Sequence[float],
        torque: Sequence[float],
    ) -> None:
        Ix, Iz, Mgl, q, omega = inputs
        axial, transverse = map(Fraction, friction)
        pulls = tuple(map(Fraction, torque))
        moments = (Ix, Ix, Iz)
        self._second = to_ball(second)
        self._kappa = to_ball((Ix - Iz) / Ix)
        self._weight = to_ball(Mgl / Ix / second**2)
        decays = transverse / Ix, transverse / Ix, axial / Iz
        self._decays = [to_ball(each / second) for each in decays]
        self._pulls = [[to_ball(each / moment / second**2) for each in pulls] for moment in moments]
        self._has_torque = any(pulls)
        length = to_ball(sum((each * each for each in q), Fraction(0))).sqrt()
        self.start = [to_ball(each) / length for each in q]
        self.start += [to_ball(each / second) for each in omega]
        self._find_scale(abs(Mgl) / Ix / second**2, norm(list(map(to_ball, pulls))), min(Ix, Iz))

    def _find_scale(self, weight: Fraction, torque: Ball, inertia: Fraction) -> None:
        self._pull = (to_ball(weight) + torque / to_ball(inertia) / self._second**2).upper()
        self._scale = (2 * self._pull.sqrt()).max(to_ball(LEAST_SCALE)).mid()

    def slopes(self, state: Sequence[Any]) -> list[Any]:
        """Return the derivatives of numbers or polynomials [derivation, 1]."""
        w, x, y, z, a, b, c = state
        gx = 2 * (x * z - w * y)
        gy = 2 * (y * z + w * x)
        slopes = [
            -(x * a + y * b + z * c) * HALF,
            (w * a + y * c - z * b) * HALF,
            (w * b + z * a - x * c) * HALF,
            (w * c + x * b - y * a) * HALF,
            b * c * self._kappa + gy * self._weight - a * self._decays[0],
            -(a * c * self._kappa) - gx * self._weight - b * self._decays[1],
            -(c * self._decays[2]),
        ]
        if self._has_torque:
            turned = self._turn(w, x, y, z, gx, gy)
            slopes[4:] = [a + b for a, b in zip(slopes[4:], turned, strict=True)]
        return slopes

    def _turn(self, w: Any, x: Any, y: Any, z: Any, gx: Any, gy: Any) -> list[Any]:
        """Return the applied torque over the moments of inertia, seen from the body."""
        ww, xx, yy, zz, xy, wz = w * w, x * x, y * y, z * z, x * y, w * z
        xz, wy, yz, wx = x * z, w * y, y * z, w * x
        rows = (
            (ww + xx - yy - zz, 2 * (xy + wz), gx),
            (2 * (xy - wz), ww - xx + yy - zz, gy),
            (2 * (xz + wy), 2 * (yz - wx), ww - xx - yy + zz),
        )
        return [
            row[0] * pulls[0] + row[1] * pulls[1] + row[2] * pulls[2]
            for row, pulls in zip(rows, self._pulls, strict=True)
        ]

    def measure(self, parts: Any) -> Ball:
        """Return a bound of the norm |(e_q, e_w/s)|."""
        *q, a, b, c = parts
        return norm([*q, *(each / self._scale for each in (a, b, c))]).upper()

    def find_growth(self, p: Sequence[arb_poly], h: Ball, sign: int) -> Ball:
        """Return a bound of m in a step of length h."""
        s = self._scale
        room = to_ball(WIDEST)
        decay = self._decays[0].max(self._decays[2]) if sign < 0 else arb(0)
        start = norm([each(arb(0)) for each in p[4:6]]) + room * s
        across = (start + self._pull * h) * (decay * h).exp() + room * s
        pulled = (1 + room) * (s / 2 + 2 * self._pull / s) / 2
        return (pulled + abs(self._kappa) * across / 2 + decay).upper()

    def widen(self, values: Sequence[Ball], error: Ball) -> ProvedState:
        """Return numbers of polynomials with the bound of their error as a state in rad/s."""
        wide = arb(0, error), arb(0, (error * self._scale).upper())
        q = tuple(each + wide[0] for each in values[:4])
        omega = tuple((each + wide[1]) * self._second for each in values[4:])
        return ProvedState(q, omega, self._second)


def largest(p: arb_poly) -> Ball:
    """Return a bound of a polynomial on [0, 1]."""
    return sum((each.abs_upper() for each in p.coeffs()), arb(0)).upper()
