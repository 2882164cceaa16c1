"""The motion of the heavy symmetric top in mpmath, written from derivation.md alone.

For clarity and digits, not speed. Numbers in brackets are the sections of the derivation.

    python docs/closed_form.py
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

from mpmath import agm, conj, cos, elliprf, exp, expj, inf, mp, mpc, mpf, nint, pi, sign, sin, sqrt

mp.dps = 120
Real = Complex = Any  # numbers of mpmath
State = tuple[tuple[Real, ...], tuple[Real, ...]]  # (w, x, y, z), (omega_x, omega_y, omega_z)


def motion(
    Ix: float,
    Iz: float,
    Mgl: float,
    orientation: Sequence[float],
    angular_velocity: Sequence[float],
) -> Callable[[float], tuple[tuple[Real, ...], tuple[Real, ...]]]:
    """Return a function of t that gives (w, x, y, z) and (omega_x, omega_y, omega_z)."""
    Ix, Iz, Mgl, wx, wy, wz = map(mpf, (Ix, Iz, Mgl, *angular_velocity))
    size = sqrt(sum(mpf(each) ** 2 for each in orientation))
    w, x, y, z = (mpf(each) / size for each in orientation)
    A, B, omega = mpc(w, z), mpc(x, y), mpc(wx, wy)
    if Mgl < 0:  # [1] a world turned by pi about x' has the opposite gravity
        turned = motion(Ix, Iz, -Mgl, (-x, w, -z, y), angular_velocity)
        return lambda t: turn_over(*turned(t))
    a, c = wz * Iz / Ix, wz * (Ix - Iz) / Ix
    if Mgl == 0 or (omega == 0 and 0 in (A, B)):  # [8]
        return lambda t: state(*free(A, B, omega, a, c, mpf(t)), wz)
    beta = 2 * Mgl / Ix
    start, rates = derivatives(A, B, omega, a, beta)
    quotients = solve(A, B, omega, a, beta)
    shares = c / 2, -c / 2, c + a / 2  # [3] parts of the rates that do not depend on u
    factors = []
    for P, P_dot, (quotient, mean) in zip(start, rates, quotients, strict=True):
        value, slope = quotient(0), mp.diff(quotient, 0)
        near = abs(value) < abs(slope) * mpf(10) ** (-mp.dps // 4)
        factors.append((P_dot - 1j * mean * P) / slope if near else P / value)  # [6]

    def at(t: float) -> State:
        A, B, conjugate = (
            factor * quotient(mpf(t)) * expj((mean + share) * mpf(t))
            for factor, (quotient, mean), share in zip(factors, quotients, shares, strict=True)
        )
        return state(A, B, conj(conjugate), wz)

    return at


def turn_over(q: tuple[Real, ...], rates: tuple[Real, ...]) -> State:
    """Return a state in the world turned by pi about x' [1]."""
    return (q[1], -q[0], q[3], -q[2]), rates


def state(A: Complex, B: Complex, omega: Complex, wz: Real) -> State:
    """Return (w, x, y, z) and (omega_x, omega_y, omega_z)."""
    return (A.real, B.real, B.imag, A.imag), (omega.real, omega.imag, wz)


def derivatives(
    A: Complex, B: Complex, omega: Complex, a: Real, beta: Real
) -> tuple[tuple[Complex, ...], tuple[Complex, ...]]:
    """Return A, B, conj(omega) and their derivatives without the constant rotations [1, 6]."""
    A_dot = 0.5j * a * A - conj(omega) * B / 2
    B_dot = omega * A / 2 - 0.5j * a * B
    omega_dot = 0.5j * a * omega + beta * conj(A) * B
    return (A, B, conj(omega)), (A_dot, B_dot, conj(omega_dot))


def free(
    A: Complex, B: Complex, omega: Complex, a: Real, c: Real, t: Real
) -> tuple[Complex, Complex, Complex]:
    """Return A, B and omega after a rotation about the axis by c t and about L by |L| t/Ix [8]."""
    rate = sqrt(abs(omega) ** 2 + a**2)
    cosine, sine = cos(rate * t / 2), (sin(rate * t / 2) / rate if rate else mpf(0))
    along, over = mpc(cosine, a * sine), omega * sine
    turn = expj(c * t / 2)
    return (
        (A * along - B * conj(over)) * turn,
        (A * over + B * conj(along)) / turn,
        omega * expj(-c * t),
    )


def solve(
    A: Complex, B: Complex, omega: Complex, a: Real, beta: Real
) -> list[tuple[Callable[[Real], Complex], Real]]:
    """Return the quotient of theta functions and the mean rate for A, B and conj(omega)."""
    u, g = abs(A) ** 2 - abs(B) ** 2, 2j * conj(A) * B
    b_minus_au, u_dot = (omega * conj(g)).real, (omega * conj(g)).imag
    energy = abs(omega) ** 2  # alpha - beta u
    # [2] f(u + s)/beta = s^3 + a2 s^2 + a1 s + a0
    a2 = 2 * u - (energy + a**2) / beta
    a1 = 2 * (a * b_minus_au - u * energy) / beta - 4 * abs(A * B) ** 2
    s1, s2, s3 = roots(a2, a1, u_dot**2 / beta)
    s21, s31, s32 = s2 - s1, s3 - s1, s3 - s2
    m, k, half_rate = s21 / s31, sqrt(s32 / s31), sqrt(beta * s31) / 2
    K = pi / 2 / agm(1, k) if k else inf
    Kc = pi / 2 / agm(1, sqrt(m)) if m else inf
    sn = sqrt(-s1 / s21) if m else mpf(0)
    v0 = sn * elliprf(abs(1 - sn**2), 1 - m * sn**2, 1) * (-1 if u_dot < 0 else 1)

    def quotient(is_A: bool, shift: Real) -> Callable[[Real], Complex]:  # [5]
        def at(t: Real) -> Complex:
            v = v0 + half_rate * t
            v -= 2 * K * nint(v / (2 * K)) if k else 0
            return theta_quotient(is_A, v, shift, K, Kc)

        return at

    found = []
    for is_A, s in ((True, -2 * abs(A) ** 2), (False, 2 * abs(B) ** 2), (False, energy / beta)):
        d = b_minus_au - a * s
        g1, g2, g3 = distances(is_A, d**2 / beta, [abs(s - root) for root in (s1, s2, s3)])
        if not m:  # [8] regular precession: the quotients are constant
            found.append((lambda t: 1 + 0 * t, d / (2 * g1) if g1 else mpf(0)))
            continue
        if is_A:  # [4]
            y = sqrt(g1 / g2) * elliprf(s21 / g2, s21 * g3 / (g2 * s31), 1)
        else:
            y = (
                sqrt(g2 * s31 / (g1 * s32)) * elliprf(s21 * g3 / (g1 * s32), s21 / g1, 1)
                if k
                else 0
            )
        shift = (Kc - y) * (sign(d) or 1)
        found.append((quotient(is_A, shift), mean_rate(is_A, d, g1, g2, g3, k, beta)))
    return found


def distances(is_A: bool, product: Real, g: list[Real]) -> list[Real]:
    """Return g1, g2, g3, the one that may be small from the product of all three [3]."""
    near = 0 if is_A else 1 if g[1] < g[2] else 2
    one, other = (g[k] for k in range(3) if k != near)
    if one and other:
        g[near] = product / (one * other)
    return g


def roots(a2: Real, a1: Real, a0: Real) -> list[Real]:
    """Return the three real roots of s^3 + a2 s^2 + a1 s + a0 [2]."""
    mean = -a2 / 3
    if ((mean + a2) * mean + a1) * mean + a0 > 0:  # the lowest root is apart from the others
        return [-root for root in reversed(roots(-a2, a1, -a0))]
    s = 1 + abs(a2) + abs(a1) + abs(a0)
    while True:  # Newton's method from above
        following = s - (((s + a2) * s + a1) * s + a0) / ((3 * s + 2 * a2) * s + a1)
        if not following < s:
            break
        s = following
    total, product = -(a2 + s), a1 + s * (a2 + s)  # Vieta, of the other two
    if s > abs(total):  # both are small, and their sum would cancel
        product = -a0 / s
        total = (a1 - product) / s
    half, gap = total / 2, total**2 / 4 - product
    if gap <= mpf(10) ** (-mp.dps * 2 // 3) * half**2:
        return [half, half, s]
    far = half + sqrt(gap) * (-1 if half < 0 else 1)  # the other difference would cancel
    return [*sorted((far, product / far)), s]


def theta_quotient(is_A: bool, v: Real, shift: Real, K: Real, Kc: Real) -> Complex:
    """Return th_k(v + i shift)/th4(v) in the smaller nome, up to a constant factor [5]."""
    if Kc >= K:
        q, z, moved = exp(-pi * Kc / K), pi * v / (2 * K), pi * (v + 1j * shift) / (2 * K)
        return theta3(moved + (pi / 2 if is_A else 0), q) / theta3(z + pi / 2, q)
    q, z, moved = exp(-pi * K / Kc), 1j * pi * v / (2 * Kc), 1j * pi * (v + 1j * shift) / (2 * Kc)
    above = theta2(moved, q) if is_A else theta3(moved, q)
    return expj(-pi * v * shift / (2 * K * Kc)) * above / theta2(z, q)


def theta3(z: Complex, q: Real) -> Complex:
    """Return theta_3; theta_4(z) is theta_3(z + pi/2)."""
    return 1 + 2 * series(lambda n: q ** (n * n) * cos(2 * n * z))


def theta2(z: Complex, q: Real) -> Complex:
    """Return theta_2 divided by 2 q^(1/4)."""
    return cos(z) + series(lambda n: q ** (n * n + n) * cos((2 * n + 1) * z))


def series(term: Callable[[int], Complex]) -> Complex:
    """Return the sum of the terms from 1 on."""
    total, n = mpf(0), 1
    while abs(term(n)) > mpf(10) ** -mp.dps:
        total, n = total + term(n), n + 1
    return total


def mean_rate(is_A: bool, d: Real, g1: Real, g2: Real, g3: Real, k: Real, beta: Real) -> Real:
    """Return the mean of d/(2 |u - u_P|) over a nutation, by Bulirsch's iteration [7]."""
    if not k:
        return d / (2 * g2) if is_A else mpf(0)
    near = g1 / g2 if is_A else g2 / g1
    x, y, p = 1 + near, 2 * (1 + k), (1 + k * near if is_A else k + near)
    a, b, power = (1 + k) / 2, sqrt(k), mpf(4)
    while a - b > mpf(10) ** -mp.dps * a:
        e = power * a * b / p
        x, y, p = near * y / p + x, 2 * (x * e + y), near * e + p
        a, b, power = (a + b) / 2, sqrt(a * b), 4 * power
    root, scale = sqrt(near), sqrt(power) * a
    third_kind = (x * scale + root * y) / (scale * (root * scale + p))
    return (sign(d) or 1) * a / 2 * sqrt(beta * g3) * third_kind


if __name__ == "__main__":  # the article's top on cusps, after ten seconds
    at = motion(0.000228, 0.0000572, 0.068, (mp.cos(0.25), mp.sin(0.25), 0, 0), (0, 0, 200))
    print(*(mp.nstr(each, 25) for each in at(10)[0]))
