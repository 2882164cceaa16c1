"""The motion under gravity, by quotients of theta functions: docs/derivation.md line by line.

For clarity and digits, not speed. Numbers in brackets are the sections of the derivation.
"""

from __future__ import annotations

from fractions import Fraction
from typing import NamedTuple

from mpmath import (
    agm,
    conj,
    cos,
    ellipe,
    ellipk,
    elliprf,
    exp,
    expj,
    inf,
    mp,
    mpc,
    mpf,
    nan,
    nint,
    pi,
    sin,
    sqrt,
)

from symtop_ros.physics.reference.series import Inputs
from workshop.digits.state import ExactState, Number


class ClosedForm:
    """A motion without friction and torque, at any time.

    `digits` are those of the computation: they cover the answer, and the decimal logarithm of the
    number of turns.
    """

    def __init__(self, inputs: Inputs, digits: int = 50) -> None:
        self.digits = digits
        self._is_turned = inputs.Mgl < 0
        if self._is_turned:  # [1] a world turned by pi about x' has the opposite gravity
            w, x, y, z = inputs.orientation
            inputs = inputs._replace(Mgl=-inputs.Mgl, orientation=(-x, w, -z, y))
        with mp.workdps(digits):
            self._wz = mpf(inputs.angular_velocity[2])
            self._start = KleinStart.of(inputs)
            moves = self._start.omega != 0 or 0 not in (self._start.A, self._start.B)
            self._nutation = Nutation(inputs) if inputs.Mgl and moves else None
            self._factors = self._nutation.find_factors(self._start) if self._nutation else ()

    def at(self, t: Number) -> ExactState:
        """Return the state at t in s."""
        with mp.workdps(self.digits):
            t = mpf(t)
            if self._factors:
                A, B, omega = (each.at(t) for each in self._factors)
                omega = conj(omega)
            else:
                A, B, omega = self._start.turn_freely(t)
            rates = omega.real, omega.imag, self._wz
            if self._is_turned:
                return ExactState((B.real, -A.real, A.imag, -B.imag), rates)
            return ExactState((A.real, B.real, B.imag, A.imag), rates)

    @property
    def period(self) -> Number:
        """Period of theta in s; inf on the separatrix, nan without nutation."""
        with mp.workdps(self.digits):
            return 2 * self._nutation.K / self._nutation.rate if self._nutation else nan

    @property
    def mean_rates(self) -> tuple[Number, Number]:
        """Mean phi' and psi' of a nutation in rad/s [7]; nan without nutation."""
        if not self._factors:
            return nan, nan
        with mp.workdps(self.digits):
            (of_A, share), (of_B, _) = ((each.mean, each.share) for each in self._factors[:2])
            precession = of_A + of_B
            return -precession if self._is_turned else precession, of_A - of_B + 2 * share

    @property
    def mean_cosine(self) -> Number:
        """Mean of cos(theta) in time [7]; nan without nutation, or if theta does not return."""
        if not self._nutation or not self._nutation.k:
            return nan
        with mp.workdps(self.digits):
            n = self._nutation
            mean = n.u + n.s[2] - n.s31 * ellipe(n.m) / ellipk(n.m)
            return -mean if self._is_turned else mean


class KleinStart(NamedTuple):
    """The start in Cayley-Klein parameters, and the constants [1]."""

    A: Number
    B: Number
    omega: Number
    a: Number
    c: Number
    beta: Number

    @classmethod
    def of(cls, inputs: Inputs) -> KleinStart:
        """Return the start of a top with Mgl >= 0."""
        Ix, Iz, Mgl, q, (wx, wy, wz) = inputs
        norm = sqrt(mpf(sum(each * each for each in q)))
        w, x, y, z = (mpf(each) / norm for each in q)
        constants = wz * Iz / Ix, wz * (Ix - Iz) / Ix, 2 * Mgl / Ix
        return cls(mpc(w, z), mpc(x, y), mpc(mpf(wx), mpf(wy)), *map(mpf, constants))

    @property
    def slopes(self) -> tuple[Number, Number, Number]:
        """Derivatives of A, B, conj(omega) without the constant rotations [6]."""
        A, B, omega, a, _, beta = self
        A_dot = 0.5j * a * A - conj(omega) * B / 2
        B_dot = omega * A / 2 - 0.5j * a * B
        omega_dot = 0.5j * a * omega + beta * conj(A) * B
        return A_dot, B_dot, conj(omega_dot)

    def turn_freely(self, t: Number) -> tuple[Number, Number, Number]:
        """Return A, B, omega turned about the axis by c t and about L by |L| t/Ix [8]."""
        A, B, omega, a, c, _ = self
        rate = sqrt(abs(omega) ** 2 + a**2)
        cosine, sine = cos(rate * t / 2), (sin(rate * t / 2) / rate if rate else mpf(0))
        along = mpc(cosine, a * sine)
        over = omega * sine
        turn = expj(c * t / 2)
        return (
            (A * along - B * conj(over)) * turn,
            (A * over + B * conj(along)) / turn,
            omega * expj(-c * t),
        )


class Nutation:
    """The height of the axis [2]: u - u0 = s1 + s21 sn^2(v0 + rate t)."""

    def __init__(self, inputs: Inputs) -> None:
        Ix, Iz, Mgl, (w, x, y, z), (wx, wy, wz) = inputs
        square = w * w + x * x + y * y + z * z
        g = 2 * (x * z - w * y) / square, 2 * (w * x + y * z) / square
        below, above = 2 * (w * w + z * z) / square, 2 * (x * x + y * y) / square  # 1 + u, 1 - u
        u = below - 1
        self.u = mpf(u)
        a = wz * Iz / Ix
        beta = 2 * Mgl / Ix
        lift = wx * g[0] + wy * g[1]  # b - a u
        u_dot = wy * g[0] - wx * g[1]
        energy = wx * wx + wy * wy  # alpha - beta u
        a2 = 2 * u - (energy + a * a) / beta
        a1 = 2 * (a * lift - u * energy) / beta - below * above
        self.s, self.s21, self.s32 = find_roots(a2, a1, u_dot * u_dot / beta)
        # [3] heights at which A, B and omega vanish, and d there
        self.zeros = -below, above, energy / beta
        self.d = [mpf(lift - a * zero) for zero in self.zeros]
        self.beta = mpf(beta)
        self.s31 = self.s[2] - self.s[0]
        self.m = self.s21 / self.s31
        self.k = sqrt(self.s32 / self.s31)  # k is k'
        self.rate = sqrt(self.beta * self.s31) / 2
        self.K = pi / 2 / agm(1, self.k) if self.k else inf
        self.Kc = pi / 2 / agm(1, sqrt(self.m)) if self.m else inf
        self.v0 = self._find_phase(falls=u_dot < 0)

    def _find_phase(self, falls: bool) -> Number:
        """Return the phase at the start [4]: 1 - sn^2 is s2/s21, and 1 - m sn^2 is s3/s31."""
        if not self.m:
            return mpf(0)
        s1, s2, s3 = self.s
        sn = sqrt(-s1 / self.s21) * (-1 if falls else 1)
        return sn * elliprf(s2 / self.s21, s3 / self.s31, 1)

    def find_factors(self, start: KleinStart) -> tuple[Factor, ...]:
        """Return A, B and conj(omega) as functions of time."""
        values = start.A, start.B, conj(start.omega)
        shares = start.c / 2, -start.c / 2, start.c + start.a / 2  # [3] what does not depend on u
        pairs = zip(values, start.slopes, shares, strict=True)
        return tuple(Factor(self, k, *each) for k, each in enumerate(pairs))

    def distances(self, k: int) -> list[Number]:
        """Return g1, g2, g3, the one that may be small from the product of all three [3]."""
        g = [abs(mpf(self.zeros[k]) - root) for root in self.s]
        near = 0 if k == 0 else 1 if g[1] < g[2] else 2
        one, other = (g[j] for j in range(3) if j != near)
        if one and other:
            g[near] = self.d[k] ** 2 / (self.beta * one * other)
        return g


class Factor:
    """A, B or conj(omega): C th(v + i gamma)/th4(v) exp(i lambda t) [4]."""

    def __init__(self, nutation: Nutation, k: int, P: Number, slope: Number, share: Number) -> None:
        self.share = share
        self._nutation = nutation
        self._is_A = k == 0
        g = nutation.distances(k)
        self._sign = -1 if nutation.d[k] < 0 else 1
        if not nutation.m:  # [8] regular precession: the quotient is constant
            self.mean = nutation.d[k] / (2 * g[0]) if g[0] else mpf(0)
            self._constant = P
            return
        self._gamma = self._sign * (nutation.Kc - self._find_y(*g))
        self.mean = self._find_mean(*g)
        value, by_v = self._quotient(nutation.v0)
        # [6] value and slope never vanish together
        self._constant = (
            P / value
            if abs(value) > abs(by_v)
            else (slope - 1j * self.mean * P) / (nutation.rate * by_v)
        )

    def at(self, t: Number) -> Number:
        """Return the value at t in s."""
        n = self._nutation
        value = mpf(1)
        if n.m:
            v = n.v0 + n.rate * t
            value, _ = self._quotient(v - 2 * n.K * nint(v / (2 * n.K)) if n.k else v)
        return self._constant * value * expj((self.mean + self.share) * t)

    def _find_y(self, g1: Number, g2: Number, g3: Number) -> Number:
        """Return K' - |gamma| [4]."""
        n = self._nutation
        if self._is_A:
            return sqrt(g1 / g2) * elliprf(n.s21 / g2, n.s21 * g3 / (g2 * n.s31), 1)
        if not n.k:
            return mpf(0)
        across = g1 * n.s32
        return sqrt(g2 * n.s31 / across) * elliprf(n.s21 * g3 / across, n.s21 / g1, 1)

    def _find_mean(self, g1: Number, g2: Number, g3: Number) -> Number:
        """Return the mean of d/(2 |u - u_P|) over a nutation, by Bulirsch's iteration [7]."""
        k, beta = self._nutation.k, self._nutation.beta
        if not k:
            return self._sign * sqrt(beta * g1 * g3 / g2) / 2 if self._is_A else mpf(0)
        near = g1 / g2 if self._is_A else g2 / g1
        x = 1 + near
        y = 2 * (1 + k)
        p = 1 + k * near if self._is_A else k + near
        a = (1 + k) / 2
        b = sqrt(k)
        power = mpf(4)
        while a - b > mp.eps * a:
            e = power * a * b / p
            x, y, p = near * y / p + x, 2 * (x * e + y), near * e + p
            a, b, power = (a + b) / 2, sqrt(a * b), 4 * power
        root = sqrt(near)
        h = sqrt(power) * a
        return self._sign * a / 2 * sqrt(beta * g3) * (x * h + root * y) / (h * (root * h + p))

    def _quotient(self, v: Number) -> tuple[Number, Number]:
        """Return th_k(v + i gamma)/th4(v) up to a factor, and its derivative, |v| <= K [5]."""
        n = self._nutation
        at = mpc(v, self._gamma)
        if n.Kc >= n.K:
            q = exp(-pi * n.Kc / n.K)
            scale = pi / (2 * n.K)
            turn = mpf(0)
            above = theta(0, scale * at + (pi / 2 if self._is_A else 0), q)
            below = theta(0, scale * v + pi / 2, q)
        else:  # Jacobi's imaginary transformation
            q = exp(-pi * n.K / n.Kc)
            scale = 0.5j * pi / n.Kc
            turn = -self._gamma * pi / 2 / n.Kc
            above = theta(int(self._is_A), scale * at, q)
            below = theta(1, scale * v, q)
            turn /= n.K
        value = above[0] / below[0]
        outer = expj(turn * v)
        slope = scale * (above[1] - value * below[1]) / below[0]
        return outer * value, outer * (slope + 1j * turn * value)


def find_roots(a2: Fraction, a1: Fraction, a0: Fraction) -> tuple[list[Number], Number, Number]:
    """Return s1 <= s2 <= s3 of s^3 + a2 s^2 + a1 s + a0, and s2 - s1 and s3 - s2 [2].

    The distance of the two that may be close is the root of the discriminant divided by the slope
    at the third. The discriminant is a fraction: whether it is zero is no question of digits.
    """
    square = (a1 * a2) ** 2 - 4 * (a1**3 + a2**3 * a0) + (18 * a2 * a1 - 27 * a0) * a0
    mean = -a2 / 3
    if ((mean + a2) * mean + a1) * mean + a0 > 0:  # the lowest root is apart: reflect
        near, far, r, gap = _split(-a2, a1, -a0, square)
        s1, s2, s3 = -r, *sorted((-near, -far))
        return [s1, s2, s3], s2 - s1, gap
    near, far, r, gap = _split(a2, a1, a0, square)
    s1, s2 = sorted((near, far))
    return [s1, s2, r], gap, r - s2


def _split(b2: Fraction, b1: Fraction, b0: Fraction, square: Fraction) -> tuple[Number, ...]:
    """Return two roots, the largest one, which is apart, and the distance of the other two."""
    a2, a1, a0 = map(mpf, (b2, b1, b0))
    r = 2 * max(abs(a2), sqrt(abs(a1)), mp.cbrt(abs(a0)))  # no root is larger
    if not b0 and b1 >= 0 and b2 >= 0:
        r = mpf(0)
    while r:  # Newton's method from above
        following = r - (((r + a2) * r + a1) * r + a0) / ((3 * r + 2 * a2) * r + a1)
        if not following < r:
            break
        r = following
    gap = sqrt(mpf(square)) / ((3 * r + 2 * a2) * r + a1)
    # Vieta, of the other two
    product = -a0 / r if r else a1
    total = -(a2 + r)
    if r > abs(total):  # both are small, and their sum would cancel
        total = (a1 - product) / r
    far = (total + (-gap if total < 0 else gap)) / 2
    return (product / far if far else far), far, r, gap


def theta(k: int, z: Number, q: Number) -> tuple[Number, Number]:
    """Return theta_3 (k = 0) or theta_2/q^(1/4) (k = 1), and its derivative [5].

    theta_4(z) is theta_3(z + pi/2).
    """
    up = expj(k * z)
    turn = expj(2 * z)
    down = 1 / up
    weight = mpf(1)
    step = q ** (k + 1)
    value = up + down if k else mpc(1)
    slope = 1j * k * (up - down)
    least = mp.eps * max(abs(up), abs(down))
    while True:
        k, up, down, weight, step = k + 2, up * turn, down / turn, weight * step, step * q * q
        value += weight * (up + down)
        slope += 1j * k * weight * (up - down)
        if k * weight * max(abs(up), abs(down)) <= least:
            return value, slope
