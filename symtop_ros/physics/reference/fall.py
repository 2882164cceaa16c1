"""States under gravity alone as balls: theta functions of whole numbers of the input.

All constants but |q| are rational in the doubles. So equal roots, a start at a turning point and an
axis on the vertical are decided in fractions, and no tolerance is needed. Each of the numbers A, B
and conj(omega) of docs/derivation.md is C theta_k(X + xi)/theta_4(X) exp(rate t), k = 4, 3, 3:
for one of these P, with its zero at p(v) of Weierstrass's p,
P'/P = (p'(s) - p'(v))/(2 (p(s) - p(v))) = zeta(s + v) - zeta(s) - zeta(v), and a constant.

Assumed: these formulas, which are proved on paper. Tests compare them with `enclosure`, which
shares none.
"""

from __future__ import annotations

from fractions import Fraction

from flint import acb, arb

from symtop_ros.physics.reference.balls import (
    Ball,
    ProvedState,
    TooFewBitsError,
    carlson_rf,
    to_ball,
)
from symtop_ros.physics.reference.series import Inputs

I = acb(0, 1)  # noqa: E741, as in the derivation


def find_fall(inputs: Inputs, t: Fraction) -> ProvedState:
    """Return the state at the precision of FLINT's context, however wide the balls are."""
    found = Fall(turn_world(inputs)).at(t)
    if inputs.Mgl >= 0:
        return found
    w, x, y, z = found.orientation
    return found._replace(orientation=(x, -w, z, -y))


def turn_world(inputs: Inputs) -> Inputs:
    """Return a motion with Mgl >= 0: if Mgl < 0, in a world that is turned by pi about x'."""
    if inputs.Mgl >= 0:
        return inputs
    w, x, y, z = inputs.orientation
    return inputs._replace(Mgl=-inputs.Mgl, orientation=(-x, w, -z, y))


class Fall:
    """The constants of a motion with Mgl >= 0 [derivation, 1]."""

    def __init__(self, inputs: Inputs) -> None:
        Ix, Iz, Mgl, (w, x, y, z), (wx, wy, self.wz) = inputs
        square = w * w + x * x + y * y + z * z
        self.u = (w * w + z * z - x * x - y * y) / square
        gx = 2 * (x * z - w * y) / square
        gy = 2 * (w * x + y * z) / square
        self.a = self.wz * Iz / Ix
        self.c = self.wz * (Ix - Iz) / Ix
        self.beta = 2 * Mgl / Ix
        self.energy = wx * wx + wy * wy
        self.slope = wy * gx - wx * gy  # of u
        self.b = wx * gx + wy * gy + self.a * self.u
        self.alpha = self.energy + self.beta * self.u
        norm = to_ball(square).sqrt()
        self.A, self.B = acb(to_ball(w), to_ball(z)) / norm, acb(to_ball(x), to_ball(y)) / norm
        self.W = acb(to_ball(wx), to_ball(-wy))

    def at(self, t: Fraction) -> ProvedState:
        """Return the state at a time, by the kind of motion that the fractions decide."""
        T = to_ball(t)
        if not self.beta:
            return self._turn_freely(T)
        if self.rests:  # regular precession, sleeping, hanging
            found = [self._turn(*part, T) for part in self.parts()]
            return self._pack(found, to_ball(self.energy).sqrt())
        nutation = Nutation(self)
        return self._pack([nutation.value(k, T) for k in range(3)], nutation.largest)

    @property
    def rests(self) -> bool:
        """True if the height of the axis is constant."""
        return not self.slope and not self.f1(self.u)

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
            (
                W,
                to_ball(self.beta) * A * B.conjugate(),
                self.alpha / self.beta,
                self.c + self.a / 2,
            ),
        ]

    def _turn(self, P: Ball, _: Ball, v: Fraction, share: Fraction, T: Ball) -> Ball:
        if self.u == v:
            return acb(0)
        rate = share + (self.b - self.a * v) / (2 * abs(self.u - v))
        return P * (I * to_ball(rate) * T).exp()

    def _turn_freely(self, T: Ball) -> ProvedState:
        """Turn about the axis by c t, and about L by |L| t/Ix."""
        half = to_ball(self.energy + self.a * self.a).sqrt() * T / 2
        along = acb(half.cos(), to_ball(self.a) * T / 2 * half.sinc())
        over = self.W.conjugate() * T / 2 * half.sinc()
        turn = (I * to_ball(self.c) * T / 2).exp()
        A = (self.A * along - self.B * over.conjugate()) * turn
        B = (self.A * over + self.B * along.conjugate()) / turn
        return self._pack([A, B, self.W * turn * turn], to_ball(self.energy).sqrt())

    def _pack(self, found: list[Ball], size: Ball) -> ProvedState:
        A, B, W = found
        omega = (W.real, -W.imag, to_ball(self.wz))
        return ProvedState((A.real, B.real, B.imag, A.imag), omega, size)


class Nutation:
    """Weierstrass's p = beta u/4 - (alpha + a^2)/12, and quotients of theta functions."""

    def __init__(self, fall: Fall) -> None:
        self.fall = fall
        self.parts = fall.parts()
        self._find_roots()
        d1, d2, d3 = self.gaps(fall.u)
        x = (-d3).sqrt() * carlson_rf(self.e13 * d2, self.e23 * d1, self.e13 * self.e23)
        self.largest = (to_ball(fall.energy) - 4 * d3).sqrt()
        root = self.e13.sqrt()
        if self.simple:
            w1, w3 = (arb.pi() / 2 / root.agm(e.sqrt()) for e in (self.e12, self.e23))
            self.unit = 2 * w1
            self.tau = acb(0, w3 / w1)
        else:  # the separatrix: the real period is infinite
            self.unit = 1 / root
        self.X0 = x * (-1 if fall.slope < 0 else 1) / self.unit

    def _find_roots(self) -> None:
        a, b, alpha, beta = self.fall.a, self.fall.b, self.fall.alpha, self.fall.beta
        self.shift = (alpha + a * a) / 12
        slope = 2 * a * b - beta
        g2 = 12 * self.shift**2 - beta * slope / 4
        g3 = 8 * self.shift**3 - beta * slope * self.shift / 4 - beta**2 * (alpha - b * b) / 16
        square = g2**3 - 27 * g3**2
        pi = arb.pi()
        size = (to_ball(g2) / 3).sqrt()
        self.simple = bool(square)
        phi = arb.atan2(to_ball(square).sqrt(), arb(27).sqrt() * to_ball(g3)) / 3
        self.e = [size * (phi + turn * pi / 3).cos() for turn in (0, -2, 2)]
        scale = arb(3).sqrt() * size
        self.e12 = scale * (pi / 3 - phi).sin() if self.simple else arb(0)
        self.e13 = scale * (pi / 3 + phi).sin()
        self.e23 = scale * phi.sin()

    def gaps(self, v: Fraction) -> list[Ball]:
        """Return e1 - p, e2 - p, e3 - p at a height: exactly zero where it is a root."""
        p = self.fall.beta * v / 4 - self.shift
        found = [each - to_ball(p) for each in self.e]
        if not self.fall.f(v):
            found[1 if self.fall.f1(v) < 0 else 0 if p > 0 else 2] = arb(0)
        return found

    def theta(self, k: int, z: Ball, slopes: int = 0) -> Ball:
        """Return theta_k, k = 1, 2, 3, 4, or its derivative."""
        if self.simple:
            return acb(z).modular_theta(self.tau, slopes)[k - 1]
        sinh = acb(z).sinh()
        cosh = acb(z).cosh()
        one = acb(1)
        zero = acb(0)
        return ((sinh, one, one, cosh), (cosh, zero, zero, sinh))[slopes][k - 1]

    def value(self, k: int, T: Ball) -> Ball:
        """Return A, B or conj(omega) at a time."""
        P, slope, v, _ = self.parts[k]
        xi = self._find_xi(k, v)
        X = self._reduce(self.X0 + T / self.unit)
        above = 3 if k else 4
        if self.fall.u != v:
            start = P / self.theta(above, self.X0 + xi)
        else:  # of a zero at the start the slopes
            start = slope * self.unit / self.theta(above, self.X0 + xi, 1)
        quotient = self.theta(above, X + xi) / self.theta(4, X)
        return start * self.theta(4, self.X0) * quotient * (self.find_rate(k) * T).exp()

    def find_rate(self, k: int) -> Ball:
        """Return the rate of the exponential, i times the mean rate of the argument."""
        _, _, v, share = self.parts[k]
        xi = self._find_xi(k, v)
        beside = 2 if k else 1
        return I * to_ball(share) - self.theta(beside, xi, 1) / self.theta(beside, xi) / self.unit

    def _find_xi(self, k: int, v: Fraction) -> Ball:
        d1, d2, d3 = self.gaps(v)
        if k == 0:
            y = carlson_rf(d1, d2, d3)
        elif self.simple:
            y = d1.sqrt() * carlson_rf(self.e12 * self.e13, -self.e12 * d3, -self.e13 * d2)
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
