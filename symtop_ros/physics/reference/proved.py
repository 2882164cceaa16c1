"""States under gravity alone as balls whose radius is a proof, in ball arithmetic (FLINT).

All constants but |q| are rational in the doubles. So equal roots, a start at a turning point and an
axis on the vertical are decided in fractions, and no tolerance is needed. The rest is computed with
more bits until the balls are small. Each of the numbers A, B and conj(omega)
of docs/derivation.md is C theta_k(X + xi)/theta_4(X) exp(rate t), k = 4, 3, 3.

Assumed: FLINT, Python's fractions, and the formulas, which are proved on paper.
"""

from __future__ import annotations

import math
from fractions import Fraction
from typing import Any, NamedTuple

from flint import acb, arb, ctx, fmpq

from symtop_ros.physics.reference.series import Inputs

Ball = Any  # of FLINT: arb or acb
MOST_BITS = 200_000
I = acb(0, 1)  # noqa: E741, as in the derivation


class TooFewBitsError(ArithmeticError):
    """A ball is too wide at this precision, or at the largest."""


class ProvedState(NamedTuple):
    """A state in balls: each contains the exact number.

    Attributes
    ----------
    orientation : tuple of flint.arb
        Unit quaternion (w, x, y, z), body to world.
    angular_velocity : tuple of flint.arb
        Angular velocity in the body frame, in rad/s.
    size : flint.arb
        The largest abs(omega_xy) of the motion, in rad/s.
    """

    orientation: tuple[Ball, ...]
    angular_velocity: tuple[Ball, ...]
    size: Ball


def prove_state(inputs: Inputs, t: float | Fraction, digits: int = 30) -> ProvedState:
    """Return balls of radius 10^-digits at most, that of rates relative to `size`."""
    if not math.isfinite(t):
        raise ValueError(f"t must be a finite number, got {t} s")
    t = Fraction(t)
    turned = abs(t) * max(map(abs, (*inputs.angular_velocity, inputs.Mgl / inputs.Ix, Fraction(1))))
    bits = int(3.33 * digits) + 40 + int(turned + 1).bit_length()
    while bits <= MOST_BITS:
        try:
            with ctx.workprec(bits):
                found = find_state(inputs, t)
                if _is_small(found, arb(10) ** -digits):
                    return found
        except (TooFewBitsError, ValueError, ZeroDivisionError):
            pass  # a wide ball contains a zero or a pole
        bits += bits // 2
    raise TooFewBitsError(f"the state needs more than {MOST_BITS} bits")


def _is_small(found: ProvedState, least: Ball) -> bool:
    limits = [least] * 4 + [least * found.size] * 3
    balls = (*found.orientation, *found.angular_velocity)
    # a comparison with nan is False, so a ball that is not finite must be looked for
    return all(
        b.is_finite() and bool(b.is_exact() or b.rad() <= limit)
        for b, limit in zip(balls, limits, strict=True)
    )


def _real(x: Fraction) -> Ball:
    return arb(fmpq(x.numerator, x.denominator))


def _rf(*arguments: Ball) -> Ball:
    return acb.elliptic_rf(*map(acb, arguments)).real


def find_state(inputs: Inputs, t: Fraction) -> ProvedState:
    """Return the state at the precision of FLINT's context, however wide the balls are."""
    if inputs.Mgl >= 0:
        return _Fall(inputs).at(t)
    w, x, y, z = inputs.orientation  # turn the world by pi about x'
    turned = inputs._replace(Mgl=-inputs.Mgl, orientation=(-x, w, -z, y))
    (w, x, y, z), omega, size = _Fall(turned).at(t)
    return ProvedState((x, -w, z, -y), omega, size)


class _Fall:
    """The constants of a motion with Mgl >= 0 [derivation, 1]."""

    def __init__(self, inputs: Inputs) -> None:
        Ix, Iz, Mgl, (w, x, y, z), (wx, wy, self.wz) = inputs
        square = w * w + x * x + y * y + z * z
        self.u = (w * w + z * z - x * x - y * y) / square
        gx, gy = 2 * (x * z - w * y) / square, 2 * (w * x + y * z) / square
        self.a, self.c = self.wz * Iz / Ix, self.wz * (Ix - Iz) / Ix
        self.beta, self.energy = 2 * Mgl / Ix, wx * wx + wy * wy
        self.slope = wy * gx - wx * gy  # of u
        self.b, self.alpha = wx * gx + wy * gy + self.a * self.u, self.energy + self.beta * self.u
        norm = _real(square).sqrt()
        self.A, self.B = acb(_real(w), _real(z)) / norm, acb(_real(x), _real(y)) / norm
        self.W = acb(_real(wx), _real(-wy))

    def at(self, t: Fraction) -> ProvedState:
        """Return the state at a time, by the kind of motion that the fractions decide."""
        T = _real(t)
        if not self.beta:
            return self._turn_freely(T)
        if not self.slope and not self.f1(self.u):  # u rests: regular precession, sleeping, hanging
            found = [self._turn(*part, T) for part in self.parts()]
            return self._pack(found, _real(self.energy).sqrt())
        nutation = _Nutation(self)
        return self._pack([nutation.value(k, T) for k in range(3)], nutation.largest)

    def f(self, v: Fraction) -> Fraction:
        """Return u'^2 at a height."""
        return (self.alpha - self.beta * v) * (1 - v * v) - (self.b - self.a * v) ** 2

    def f1(self, v: Fraction) -> Fraction:
        """Return the derivative of `f`."""
        pull = -self.beta * (1 - v * v) - 2 * v * (self.alpha - self.beta * v)
        return pull + 2 * self.a * (self.b - self.a * v)

    def parts(self) -> list[tuple[Ball, Ball, Fraction, Fraction]]:
        """Return A, B, conj(omega): value and slope, the u of its zero, a constant rotation."""
        A, B, W = self.A, self.B, self.W
        return [
            (A, -W * B / 2, Fraction(-1), self.c / 2),
            (B, W.conjugate() * A / 2, Fraction(1), -self.c / 2),
            (W, _real(self.beta) * A * B.conjugate(), self.alpha / self.beta, self.c + self.a / 2),
        ]

    def _turn(self, P: Ball, _: Ball, v: Fraction, share: Fraction, T: Ball) -> Ball:
        if self.u == v:
            return acb(0)
        rate = share + (self.b - self.a * v) / (2 * abs(self.u - v))
        return P * (I * _real(rate) * T).exp()

    def _turn_freely(self, T: Ball) -> ProvedState:
        """Turn about the axis by c t, and about L by |L| t/Ix."""
        half = _real(self.energy + self.a * self.a).sqrt() * T / 2
        along = acb(half.cos(), _real(self.a) * T / 2 * half.sinc())
        over, turn = self.W.conjugate() * T / 2 * half.sinc(), (I * _real(self.c) * T / 2).exp()
        A = (self.A * along - self.B * over.conjugate()) * turn
        B = (self.A * over + self.B * along.conjugate()) / turn
        return self._pack([A, B, self.W * turn * turn], _real(self.energy).sqrt())

    def _pack(self, found: list[Ball], size: Ball) -> ProvedState:
        A, B, W = found
        omega = (W.real, -W.imag, _real(self.wz))
        return ProvedState((A.real, B.real, B.imag, A.imag), omega, size)


class _Nutation:
    """Weierstrass's p = beta u/4 - (alpha + a^2)/12, and quotients of theta functions."""

    def __init__(self, fall: _Fall) -> None:
        self.fall, self.parts = fall, fall.parts()
        self._find_roots()
        d1, d2, d3 = self.gaps(fall.u)
        x = (-d3).sqrt() * _rf(self.e13 * d2, self.e23 * d1, self.e13 * self.e23)
        self.largest, root = (_real(fall.energy) - 4 * d3).sqrt(), self.e13.sqrt()
        if self.simple:
            w1, w3 = (arb.pi() / 2 / root.agm(e.sqrt()) for e in (self.e12, self.e23))
            self.unit, self.tau = 2 * w1, acb(0, w3 / w1)
        else:  # the separatrix: the real period is infinite
            self.unit = 1 / root
        self.X0 = x * (-1 if fall.slope < 0 else 1) / self.unit

    def _find_roots(self) -> None:
        a, b, alpha, beta = self.fall.a, self.fall.b, self.fall.alpha, self.fall.beta
        self.shift, slope = (alpha + a * a) / 12, 2 * a * b - beta
        g2 = 12 * self.shift**2 - beta * slope / 4
        g3 = 8 * self.shift**3 - beta * slope * self.shift / 4 - beta**2 * (alpha - b * b) / 16
        square, pi = g2**3 - 27 * g3**2, arb.pi()
        size, self.simple = (_real(g2) / 3).sqrt(), bool(square)
        phi = arb.atan2(_real(square).sqrt(), arb(27).sqrt() * _real(g3)) / 3
        self.e = [size * (phi + turn * pi / 3).cos() for turn in (0, -2, 2)]
        scale = arb(3).sqrt() * size
        self.e12 = scale * (pi / 3 - phi).sin() if self.simple else arb(0)
        self.e13, self.e23 = scale * (pi / 3 + phi).sin(), scale * phi.sin()

    def gaps(self, v: Fraction) -> list[Ball]:
        """Return e1 - p, e2 - p, e3 - p at a height: exactly zero where it is a root."""
        p = self.fall.beta * v / 4 - self.shift
        found = [each - _real(p) for each in self.e]
        if not self.fall.f(v):
            found[1 if self.fall.f1(v) < 0 else 0 if p > 0 else 2] = arb(0)
        return found

    def theta(self, k: int, z: Ball, slopes: int = 0) -> Ball:
        """Return theta_k, k = 1, 2, 3, 4, or its derivative."""
        if self.simple:
            return acb(z).modular_theta(self.tau, slopes)[k - 1]
        sinh, cosh, one, zero = acb(z).sinh(), acb(z).cosh(), acb(1), acb(0)
        return ((sinh, one, one, cosh), (cosh, zero, zero, sinh))[slopes][k - 1]

    def value(self, k: int, T: Ball) -> Ball:
        """Return A, B or conj(omega) at a time."""
        P, slope, v, share = self.parts[k]
        above, beside = (3, 2) if k else (4, 1)
        xi, X = self._find_xi(k, v), self._reduce(self.X0 + T / self.unit)
        rate = I * _real(share) - self.theta(beside, xi, 1) / self.theta(beside, xi) / self.unit
        start = (
            P / self.theta(above, self.X0 + xi)
            if self.fall.u != v
            else (
                slope * self.unit / self.theta(above, self.X0 + xi, 1)  # of the zero at the start
            )
        )
        quotient = self.theta(above, X + xi) / self.theta(4, X)
        return start * self.theta(4, self.X0) * quotient * (rate * T).exp()

    def _find_xi(self, k: int, v: Fraction) -> Ball:
        d1, d2, d3 = self.gaps(v)
        if k == 0:
            y = _rf(d1, d2, d3)
        elif self.simple:
            y = d1.sqrt() * _rf(self.e12 * self.e13, -self.e12 * d3, -self.e13 * d2)
        else:
            y = arb(0)
        return acb(0, y / self.unit * (-1 if self.fall.b < self.fall.a * v else 1))

    def _reduce(self, X: Ball) -> Ball:
        if not self.simple:
            return X
        turns = X.mid().floor().unique_fmpz()  # the quotients have the period 1
        if turns is None:
            raise TooFewBitsError
        return X - turns
