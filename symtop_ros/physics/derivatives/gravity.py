"""Derivatives of the motion under gravity alone, at any time, by one nutation.

In the frame of the axis without spin, which turns about the axis by -omega_z t against the body,
the motion depends on two numbers only: with r = Iz omega_z/Ix and m = Mgl/Ix,

    u' = r z' x u - m z' x g,    g' = -u x g,

where u is omega_xy and g the vertical. No rate of it is fast if the body is slender and spins fast.
Small rotations delta (of the attitude, in this frame) and changes of u obey

    delta' = -u x delta + du,    du' = r z' x du - m z' x (g x delta) + dr z' x u - dm z' x g.

After a nutation the axis has turned about the vertical, and u and g about z'. All that has changed
is the angles by which they turn, in proportion to the changes of the constants of motion. So one
nutation multiplies derivatives by 1 + N with N^2 = 0, and n of them by 1 + n N.
"""

import math
from decimal import Context, Decimal, DivisionByZero, InvalidOperation, localcontext
from functools import cached_property
from typing import Any

import numpy as np

from symtop_ros.arrays import Real
from symtop_ros.physics.derivatives.collocation import LinearFlow
from symtop_ros.physics.values import Complex, refuse

# Phases are reduced to one turn with these digits.
PRECISE = Context(prec=50, traps=[InvalidOperation, DivisionByZero])
TWO_PI = Decimal("6.28318530717958647692528676655900576839433879875021")
# A step in units of the fastest rate. Half or twice of it changes no derivative by more than 4e-14
# of the largest one of its kind, which is rounding.
WIDTH = 1.0
SIZE, COUNT = 5, 2  # delta and u; r and m
SLOWEST = 1e-290  # rad/s
SMALL_PHASE, LARGEST_EXPONENT = 1e-9, 700.0
MOST_STEPS = 2**18  # to a time, or in a nutation; some ten seconds


class GravityDerivatives:
    """Derivatives of the attitude and of omega by Ix, Iz, Mgl and the start."""

    def __init__(self, motion: Any, nutation_rate: tuple[float, float]) -> None:
        with localcontext(PRECISE):
            self._rate = sum(map(Decimal, nutation_rate), Decimal(0))
            self._period = float(TWO_PI / self._rate) if self._rate else math.inf
        self._motion = motion
        self._Ix, self._Iz, Mgl = motion.top.moments
        wx, wy, self._spin = motion.start.angular_velocity.tolist()
        self._r, self._m = self._Iz / self._Ix * self._spin, Mgl / self._Ix
        # |u|^2/2 changes by m times the change of height, at most 2.
        fastest = math.hypot(math.hypot(wx, wy), 2 * math.sqrt(abs(self._m))) + abs(self._r)
        self._fastest = max(fastest, SLOWEST)

    def at(self, times: Real) -> Real:
        """Return the derivatives at times (n,) in s, (n, 6, 9)."""
        turns, rests = self._reduce(times)
        self._limit(times, bool(turns.any()))
        inner = self._flow.at(rests)
        if turns.any():
            inner = inner @ self._repeat(turns)
        state = self._motion.at(times)
        vectors = self._see(state)
        turn = self._match(vectors, self._see_without_spin(rests))
        return self._assemble(times, inner, turn, vectors[1])

    def _reduce(self, times: Real) -> tuple[Real, Real]:
        """Return the numbers of whole nutations (n,), and the rests in s."""
        if math.isinf(self._period):
            return np.zeros(len(times)), times
        with localcontext(PRECISE):
            phases = [Decimal(t) * self._rate / TWO_PI for t in times.tolist()]
            whole = [phase.to_integral_value() for phase in phases]
            pairs = zip(phases, whole, strict=True)
            rests = [float((phase - n) * TWO_PI / self._rate) for phase, n in pairs]
        return np.array(whole, np.float64), np.array(rests)

    def _limit(self, times: Real, repeats: bool) -> None:
        """Refuse times with too many steps: close to a motion that never returns."""
        farthest = np.abs(times).max(initial=0.0)
        longest = MOST_STEPS * WIDTH / self._fastest
        if (self._period if repeats else farthest) > longest:
            condition = f"at most {longest:.3g} s for derivatives of a motion that hardly returns"
            raise refuse("t", condition, float(farthest))

    @cached_property
    def _flow(self) -> LinearFlow:
        width = WIDTH / self._fastest
        if math.isfinite(self._period):
            width = self._period / math.ceil(self._period / width)
        return LinearFlow(self._list_coefficients, SIZE, COUNT, width)

    def _repeat(self, turns: Real) -> Real:
        """Return 1 + n N for numbers of nutations (n,), (n, 7, 7)."""
        once = np.eye(SIZE + COUNT)
        (once[:SIZE],) = self._flow.at(np.array([self._period]))
        begin, end = (self._see_without_spin(np.array([t])) for t in (0.0, self._period))
        (turn,) = self._match(end, begin)
        once[:2] = _rotate(turn.conjugate(), once[:2])
        once[3:5] = _rotate(turn.conjugate(), once[3:5])
        change = once - np.eye(SIZE + COUNT)
        return np.asarray(np.eye(SIZE + COUNT) + turns[:, None, None] * change)

    def _list_coefficients(self, times: Real) -> tuple[Real, Real]:
        """Return the matrices of the equations above at times (n,) in s."""
        g, u, height = self._see_without_spin(times)
        r, m = self._r, self._m
        slopes, forces = np.zeros((len(times), 5, 5)), np.zeros((len(times), 5, 2))
        slopes[:, 0, 2], slopes[:, 1, 2] = -u.imag, u.real
        slopes[:, 2, 0], slopes[:, 2, 1] = u.imag, -u.real
        slopes[:, 0, 3] = slopes[:, 1, 4] = 1.0
        slopes[:, 3, 0] = slopes[:, 4, 1] = m * height
        slopes[:, 3, 2], slopes[:, 4, 2] = -m * g.real, -m * g.imag
        slopes[:, 3, 4], slopes[:, 4, 3] = -r, r
        forces[:, 3, 0], forces[:, 4, 0] = -u.imag, u.real
        forces[:, 3, 1], forces[:, 4, 1] = g.imag, -g.real
        return slopes, forces

    def _see_without_spin(self, times: Real) -> tuple[Complex, Complex, Real]:
        """Return g and u across the axis, and g along it, in the frame without spin."""
        g, u, height = self._see(self._motion.at(times))
        turn = _turn_by_product(self._spin, times)
        return g * turn, u * turn, height

    def _see(self, state: Any) -> tuple[Complex, Complex, Real]:
        """Return g and u across the axis, and g along it, in the body frame."""
        w, x, y, z = np.moveaxis(state.orientation, -1, 0)
        # x + i y of the vertical in the body; a product, so that a small tilt keeps its digits
        g = 2j * (w - 1j * z) * (x + 1j * y)
        u = state.angular_velocity[..., 0] + 1j * state.angular_velocity[..., 1]
        return g, u, (w * w + z * z) - (x * x + y * y)

    def _match(
        self, now: tuple[Complex, Complex, Real], before: tuple[Complex, Complex, Real]
    ) -> Complex:
        """Return e^(i angle) of the turns about the axis that take g and u to where they are."""
        u, u_before = now[1] / self._fastest, before[1] / self._fastest
        both = now[0] * before[0].conjugate() + u * u_before.conjugate()
        return np.asarray(both / np.abs(both))

    def _assemble(self, times: Real, inner: Real, turn: Complex, u: Complex) -> Real:
        """Return the derivatives by the parameters of a top, from those by r and m."""
        Ix, spin, n = self._Ix, self._spin, len(times)
        chain = np.zeros((SIZE + COUNT, 9))
        chain[:3, 3:6] = np.eye(3)
        chain[3:5, 6:8] = np.eye(2)
        chain[5, [0, 1, 8]] = -self._r / Ix, spin / Ix, self._Iz / Ix
        chain[6, [0, 2]] = -self._m / Ix, 1 / Ix
        found, reduced = np.zeros((n, 6, 9)), inner @ chain
        found[:, :2] = _rotate(turn[:, None], reduced[:, :2])
        found[:, 2] = reduced[:, 2]
        found[:, 3:5] = _rotate(turn[:, None], reduced[:, 3:5])
        # A faster spin turns the body, and so omega_xy in it backwards.
        found[:, 2, 8] += times
        found[:, 3, 8] += times * u.imag
        found[:, 4, 8] -= times * u.real
        found[:, 5, 8] = 1.0
        return found


class SleepingDerivatives:
    """Derivatives of an axis that rests on the vertical.

    Across the axis, z = delta_x + i delta_y in the frame without spin obeys z'' = i r z' + m g z
    with g = 1 upright and -1 hanging, which has the frequencies r/2 +- sqrt(r^2/4 - m g): the
    swing of a sleeping top, or its fall if the root is imaginary.
    """

    def __init__(self, motion: Any) -> None:
        Ix, Iz, Mgl = map(Decimal, motion.top.moments)
        w, x, y, z = motion.start.orientation.tolist()
        height = 1 if w * w + z * z > x * x + y * y else -1
        self._spin = Decimal(motion.start.angular_velocity.tolist()[2])
        with localcontext(PRECISE):
            self._half_r = Iz * self._spin / Ix / 2
            self._weight = Mgl / Ix * height
            self._square = self._weight - self._half_r * self._half_r  # of the rate of a fall
            self._rate = abs(self._square).sqrt()

    def at(self, times: Real) -> Real:
        """Return the derivatives at times (n,) in s, (n, 6, 9)."""
        found = np.zeros((len(times), 6, 9))
        found[:, 2, 5] = found[:, 5, 8] = 1.0
        found[:, 2, 8] = times
        for k, t in enumerate(map(Decimal, times.tolist())):
            with localcontext(PRECISE):
                turn = _unit((self._half_r - self._spin) * t)  # into the body frame, as well
                even, odd = self._solve(t)
            half_r = float(self._half_r)
            by_z = even - 1j * half_r * odd, float(self._weight) * odd
            by_slope = odd, even + 1j * half_r * odd
            for column, values in ((3, by_z), (6, by_slope)):
                for row, value in zip((0, 3), values, strict=True):
                    z = turn * value
                    found[k, row : row + 2, column] = z.real, z.imag
                    found[k, row : row + 2, column + 1] = -z.imag, z.real
        return found

    def _solve(self, t: Decimal) -> tuple[float, float]:
        """Return cosh(s t) and sinh(s t)/s for s^2 of either sign."""
        rate, phase = float(self._rate), float(self._rate * t)
        if abs(phase) < SMALL_PHASE:
            return 1.0, float(t)
        if self._square > 0:
            if abs(phase) > LARGEST_EXPONENT:
                raise refuse("t", "before the derivatives of the fall overflow", float(t))
            return math.cosh(phase), math.sinh(phase) / rate
        turn = _unit(self._rate * t)
        return turn.real, turn.imag / rate


def _unit(phase: Decimal) -> complex:
    """Return e^(i phase), the phase reduced to one turn with all digits."""
    rest = float(phase - (phase / TWO_PI).to_integral_value() * TWO_PI)
    return complex(math.cos(rest), math.sin(rest))


def _rotate(turn: Complex, pairs: Real) -> Real:
    """Return rows x and y, (..., 2, k), turned about the axis."""
    turned = turn * (pairs[..., 0, :] + 1j * pairs[..., 1, :])
    return np.stack((turned.real, turned.imag), axis=-2)


def _turn_by_product(rate: float, times: Real) -> Complex:
    """Return e^(i rate t), with all digits of the product."""
    product = rate * times
    with localcontext(PRECISE):
        pairs = zip(times.tolist(), product.tolist(), strict=True)
        lost = [float(Decimal(rate) * Decimal(t) - Decimal(p)) for t, p in pairs]
    return np.asarray(np.exp(1j * product) * np.exp(1j * np.array(lost)))
