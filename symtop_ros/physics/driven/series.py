"""The top with friction and an applied torque: Taylor series in time, step after step.

The derivatives are polynomials of degree 2 of the variables (`equations`).
So coefficient k + 1 of all variables follows from the products of coefficients 0 to k with those
from k to 0. One product of two matrices has them all, and a second one combines them. The length of
a step follows from the last two coefficients (A. Jorba and M. Zou, A software package for the
numerical integration of ODEs, Experimental Mathematics 14 (2005) 99).

An error of the angular velocity grows with time, therefore rounding must not accumulate in it. The
state between two steps, the largest terms of the series and the constants have extended precision:
64 bits or more where NumPy has them (Linux), 53 elsewhere.
"""

import math
from typing import Any, NamedTuple

import numpy as np

from symtop_ros.arrays import Real
from symtop_ros.physics.driven.equations import (
    FACTORS,
    OMEGA_X,
    OMEGA_Y,
    OMEGA_Z,
    QUATERNION,
    RATES,
    SPIN,
    DrivenEquations,
    Extended,
    W,
    X,
    Y,
    Z,
)
from symtop_ros.physics.values import LARGEST_ANGULAR_VELOCITY

TERMS = 30  # more of them make the steps longer, and the terms of a sum larger than the sum
EXTENDED_TERMS = 6  # the largest ones, in extended precision
# Size of the last terms of a step, for variables of size 1. It is far below EPS, because what is
# left out has the same sign in many steps, while rounding has not.
LAST = 5e-19
# The terms of an axis near the vertical may be larger than this by a factor, compared with its
# tilt: so that steps do not become shorter at ordinary tilts.
CLOSER = 8.0
LONGEST = 16.0  # in units of about 1/rate; so the powers of a step stay in range
# rad by which the frame turns in a step. Further on the terms of a sine would exceed their sum, and
# rounding with them.
LARGEST_TURN = 3.5
LARGEST_SPIN = 1e15  # rad of half the spin angle; far beyond, no digit of it is left
LENGTH_BITS = 10  # a length has so few bits that the sum of lengths, the time, is exact

ORDERS = np.arange(1.0, TERMS + 1)[:, np.newaxis]
# Powers of the time in `Piece.high` and `Piece.low`.
HIGH_POWERS = np.arange(TERMS, EXTENDED_TERMS, -1.0)
LOW_POWERS = np.arange(EXTENDED_TERMS, 0.0, -1.0, dtype=np.longdouble)


class Knot(NamedTuple):
    """The state between two steps."""

    t: float  # time in s
    values: Extended  # the variables, in rad and s


class Piece(NamedTuple):
    """The Taylor series of the motion between two knots of the grid."""

    start: Knot
    end: float  # time in s up to which the series hold
    unit: float  # unit of time of the coefficients in s, a power of two
    # coefficients of the lowest powers of the time, from the highest of them to the first
    low: Extended
    high: Real  # coefficients of the higher powers, from the highest on
    following: Knot  # at the end

    def at(self, times: Extended) -> Extended:
        """Return the variables at times (n,) in s of the piece, (n, 9).

        A state has the same bits alone as among others: terms are formed and added one by one, the
        smallest first, while a product of matrices would depend on their shapes.
        """
        u = (times - self.start.t) / self.unit
        powers = np.empty((TERMS, len(u)), np.longdouble)
        powers[:] = u
        np.multiply.accumulate(powers, axis=0, out=powers)
        high, low = (
            powers[: EXTENDED_TERMS - 1 : -1].astype(np.float64),
            powers[EXTENDED_TERMS - 1 :: -1],
        )
        gain = np.add.reduce(low[:, :, np.newaxis] * self.low[:, np.newaxis, :], axis=0)
        gain += np.add.reduce(high[:, :, np.newaxis] * self.high[:, np.newaxis, :], axis=0)
        gain[:, RATES] /= self.unit
        return np.asarray(gain + self.start.values)


class Coefficients:
    """The coefficients of a series in one precision, and the places in which they are made."""

    def __init__(self, first: int, terms: int, precision: type[np.floating[Any]]) -> None:
        self.forward = np.zeros((terms + 1, FACTORS), precision)  # from the first coefficient on
        self.backward = np.zeros((terms + 1, FACTORS), precision)
        self.matrices = np.zeros((terms, FACTORS, FACTORS * FACTORS), precision)
        self._products = np.zeros((FACTORS, FACTORS), precision)
        # Coefficient k + 1 needs the products of coefficient n with k - n for all n. With one array
        # in ascending and one in descending order they are a single product of two matrices, and
        # its two factors are views: making these views takes longer than the product.
        self._orders = [
            (
                self.forward[: k + 1].T,
                self.backward[terms - k :],
                self.matrices[k],
                self.forward[k + 1],
                self.backward[terms - k - 1],
            )
            for k in range(first, terms)
        ]

    def compute(self) -> None:
        """Compute one coefficient of all variables after the other."""
        # Three calls for each order take most of the time of a motion, hence the prepared views.
        dot, products, flat = np.dot, self._products, self._products.reshape(-1)
        for forward, backward, matrix, row, reverse in self._orders:
            dot(forward, backward, products)
            dot(matrix, flat, row)
            reverse[:] = row


class Stepper:
    """The Taylor series of a driven top about any knot.

    Not thread-safe: the arrays in which series are made are used again for the next ones.
    """

    def __init__(self, equations: DrivenEquations) -> None:
        self._equations = equations
        self._unit = 0.0
        # The first terms of a series are its largest. Their rounding would be that of the state.
        self._low = Coefficients(0, EXTENDED_TERMS, np.longdouble)
        self._high = Coefficients(EXTENDED_TERMS, TERMS, np.float64)
        # Of 512 possible terms of the derivatives some 60 are not zero. Only they are written when
        # the unit of time changes.
        row, i, j = np.nonzero(equations.parts.any(axis=0))
        self._constants = equations.parts[:, row, i, j]
        all_orders = slice(None)
        self._places = all_orders, row, i * FACTORS + j
        self._mirrored = all_orders, row, j * FACTORS + i

    def step(self, knot: Knot, direction: int) -> Piece:
        """Return the series about a knot, for times after it (1) or before it (-1).

        If the motion has become too fast for doubles, or for a digit of the spin angle, the
        piece ends at its start.
        """
        rate = self._equations.estimate_rate(knot.values)
        if not rate < LARGEST_ANGULAR_VELOCITY:
            return _stop(knot, knot.t)
        self._set_unit(math.ldexp(1.0, math.frexp(1 / rate)[1]) if rate else 1.0)
        scaled = knot.values[:FACTORS].copy()
        scaled[RATES] *= self._unit
        low, high = self._low, self._high
        low.forward[0] = low.backward[-1] = scaled
        low.compute()
        if not low.forward[1].any():
            return _stop(knot, direction * math.inf)  # it is at rest, for ever
        high.forward[: EXTENDED_TERMS + 1] = low.forward
        high.backward[TERMS - EXTENDED_TERMS :] = low.backward
        high.compute()
        length = direction * self._find_length() * self._unit
        piece = self._join(knot, length, *self._copy_series())
        while abs(piece.following.values[SPIN] * self._equations.half_rest) > LARGEST_SPIN:
            length /= 2  # until the piece has no length
            piece = self._join(knot, length, piece.low, piece.high)
        return piece

    def _join(self, knot: Knot, length: float, low: Extended, high: Real) -> Piece:
        """Return the piece of a length in s from a knot on, and the knot at its end."""
        end = knot.t + length
        u = (end - knot.t) / self._unit
        gain = np.dot(u**LOW_POWERS, low)
        gain += np.dot(u**HIGH_POWERS, high)
        gain[RATES] /= self._unit
        gain += knot.values
        q = gain[QUATERNION]
        # One Newton step towards norm 1: rounding leaves so little that its square is nothing.
        q *= 1.5 - 0.5 * np.dot(q, q)
        return Piece(knot, end, self._unit, low, high, Knot(end, gain))

    def _set_unit(self, unit: float) -> None:
        if unit == self._unit:
            return
        self._unit = unit
        constants = self._constants[0] + unit * (self._constants[1] + unit * self._constants[2])
        by_order = constants / ORDERS
        self._low.matrices[self._places] = by_order[:EXTENDED_TERMS]
        nearest = by_order.astype(np.float64)
        # The products (i, j) and (j, i) are the same. One takes the nearest double of a constant,
        # the other one what is left: an error of the constants would be the same in each step.
        self._high.matrices[self._mirrored] = by_order - nearest
        self._high.matrices[self._places] = nearest

    def _copy_series(self) -> tuple[Extended, Real]:
        """Return the coefficients of the powers of the time, `Piece.low` and `Piece.high`."""
        low = np.empty((EXTENDED_TERMS, SPIN + 1), np.longdouble)
        low[:, :FACTORS] = self._low.forward[:0:-1]
        low[:, SPIN] = self._low.forward[-2::-1, OMEGA_Z] / LOW_POWERS
        high = np.empty((len(HIGH_POWERS), SPIN + 1))
        high[:, :FACTORS] = self._high.forward[:EXTENDED_TERMS:-1]
        high[:, SPIN] = self._high.forward[-2 : EXTENDED_TERMS - 1 : -1, OMEGA_Z] / HIGH_POWERS
        return low, high

    def _find_length(self) -> float:
        """Return the length of the step in the unit of time, by the root test."""
        w, x, y, z, omega_x, omega_y, omega_z, _ = self._high.forward[0].tolist()
        turn = math.hypot(omega_x, omega_y, self._equations.ratio * omega_z)
        length = LARGEST_TURN / max(turn, LARGEST_TURN / LONGEST)
        axial = max(1.0, abs(omega_z))  # the spin of a rod exceeds the rate
        upper, lower = w * w + z * z, x * x + y * y
        swing: tuple[int, ...] = ()
        if CLOSER * CLOSER * min(upper, lower) < 1:
            swing = (OMEGA_X, OMEGA_Y, *((X, Y) if upper > lower else (W, Z)))
            size = self._measure_swing(swing)
        # Of the last two terms one may be small by chance.
        for order in (TERMS - 1, TERMS):
            row = self._high.forward[order].tolist()
            *others, along, _ = row
            largest = max(*map(abs, others), abs(along) / axial)
            if swing:
                largest = max(largest, max([abs(row[k]) for k in swing]) / size)
            if largest:
                length = min(length, (LAST / largest) ** (1 / order))
        fraction, exponent = math.frexp(length)
        return math.ldexp(math.floor(math.ldexp(fraction, LENGTH_BITS)), exponent - LENGTH_BITS)

    def _measure_swing(self, swing: tuple[int, ...]) -> float:
        """Return the size in a step of the variables that are small near the vertical.

        An axis near the vertical swings in proportion to its tilt. Its motion is right to rounding
        of itself only if the terms left out are compared with it, not with 1.
        """
        size = CLOSER * max([abs(row[k]) for row in self._high.forward[:4].tolist() for k in swing])
        return min(1.0, size) or 1.0


def _stop(knot: Knot, end: float) -> Piece:
    """Return the piece of a constant state."""
    low = np.zeros((EXTENDED_TERMS, SPIN + 1), np.longdouble)
    return Piece(knot, end, math.inf, low, np.zeros((len(HIGH_POWERS), SPIN + 1)), knot)
