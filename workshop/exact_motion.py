"""The motion of a heavy symmetric top to many digits, in mpmath: what the tests compare with.

Written for clarity and digits, not speed, and on purpose by other means than the package: the
cubic in u = cos(theta) is expanded about u = 0 and solved by Viète's trigonometric formula, every
theta function is summed in the original nome, whatever the modulus, and rates are logarithmic
derivatives of theta functions. A working precision of 150 digits pays for the cancellations.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any

from mpmath import mp, mpc, mpf

DIGITS = 150
Attitude = tuple[mpf, mpf, mpf, mpf]
Vector = tuple[mpf, mpf, mpf]
Pair = tuple[mpc, mpc]
Motion = tuple[mpc, mpc, mpf, mpf]  # A, B, omega_x and omega_y


@dataclass(frozen=True)
class Inputs:
    """Everything a motion depends on; doubles or mpf, taken as exact."""

    Ix: mpf
    Iz: mpf
    Mgl: mpf
    orientation: Sequence[mpf]
    angular_velocity: Sequence[mpf]

    @classmethod
    def of(
        cls, Ix: Any, Iz: Any, Mgl: Any, orientation: Sequence[Any], angular_velocity: Sequence[Any]
    ) -> Inputs:
        """Return the inputs of doubles, integers or fractions of mpmath."""
        return cls(
            mpf(Ix),
            mpf(Iz),
            mpf(Mgl),
            [mpf(x) for x in orientation],
            [mpf(x) for x in angular_velocity],
        )


def exact_motion(inputs: Inputs, t: Any) -> tuple[Attitude, Vector]:
    """Orientation (w, x, y, z) and body angular velocity at t, to at least 30 digits."""
    with mp.workdps(DIGITS):
        norm = mp.sqrt(sum(c * c for c in inputs.orientation))
        w, x, y, z = (c / norm for c in inputs.orientation)
        A, B, wx, wy = _motion(inputs, mpc(w, z), mpc(x, y), mpf(t))
        return (A.real, B.real, B.imag, A.imag), (wx, wy, inputs.angular_velocity[2])


def _motion(inputs: Inputs, A: mpc, B: mpc, t: mpf) -> Motion:
    Ix, Mgl = inputs.Ix, inputs.Mgl
    if Mgl < 0:  # turn the world by pi about x'
        mirrored = Inputs(Ix, inputs.Iz, -Mgl, (), inputs.angular_velocity)
        A, B, wx, wy = _motion(mirrored, -mp.conj(B), mp.conj(A), t)
        return mp.conj(B), -mp.conj(A), wx, wy
    if Mgl == 0:
        return _free(inputs, A, B, t)
    transverse = mpc(inputs.angular_velocity[0], inputs.angular_velocity[1])
    if transverse == 0 and 0 in (A, B):
        half_turn = mp.expj(inputs.angular_velocity[2] * t / 2)
        return A * half_turn, B / half_turn, mpf(0), mpf(0)
    return _heavy(inputs, A, B, t)


def _times(q: Pair, p: Pair) -> Pair:
    (a, b), (c, d) = q, p  # (A, B) pairs: q = A + i-part as w + x i + y j + z k
    w1, x1, y1, z1 = a.real, b.real, b.imag, a.imag
    w2, x2, y2, z2 = c.real, d.real, d.imag, c.imag
    return (
        mpc(w1 * w2 - x1 * x2 - y1 * y2 - z1 * z2, w1 * z2 + x1 * y2 - y1 * x2 + z1 * w2),
        mpc(w1 * x2 + x1 * w2 + y1 * z2 - z1 * y2, w1 * y2 - x1 * z2 + y1 * w2 + z1 * x2),
    )


def _free(inputs: Inputs, A: mpc, B: mpc, t: mpf) -> Motion:
    """Rotation about L by |L| t / Ix after a rotation about the axis by c t."""
    Ix, Iz = inputs.Ix, inputs.Iz
    wx, wy, wz = inputs.angular_velocity
    L = (Ix * wx, Ix * wy, Iz * wz)
    size = mp.sqrt(sum(c * c for c in L))
    c = wz * (Ix - Iz) / Ix
    half = size * t / (2 * Ix)
    s = mp.sin(half) / size if size else mpf(0)
    about_L = (mpc(mp.cos(half), L[2] * s), mpc(L[0] * s, L[1] * s))
    about_axis = (mp.expj(c * t / 2), mpc(0))
    A, B = _times(_times((A, B), about_L), about_axis)
    transverse = mpc(wx, wy) * mp.expj(-c * t)
    return A, B, transverse.real, transverse.imag


def _cubic_roots(a3: mpf, a2: mpf, a1: mpf, a0: mpf) -> list[mpf]:
    """Three real roots in rising order, by Viète's trigonometric formula."""
    shift = a2 / (3 * a3)
    p = a1 / a3 - 3 * shift**2
    q = 2 * shift**3 - shift * a1 / a3 + a0 / a3
    r = mp.sqrt(max(-p / 3, mpf(0)))
    cosine = max(mpf(-1), min(mpf(1), -q / (2 * r**3))) if r else mpf(0)
    angle = mp.acos(cosine) / 3
    return sorted(2 * r * mp.cos(angle - 2 * mp.pi * k / 3) - shift for k in range(3))


def _theta(k: int, z: mpc, q: mpf) -> Pair:
    """Jacobi's theta_3 or theta_4 and its derivative: the sum of (+-1)^n q^(n^2) e^(2 i n z)."""
    turn = mp.expj(2 * z)
    step = -q if k == 4 else q
    weight, forward, back = mpf(1), mpc(1), mpc(1)
    value, slope, n = mpc(1), mpc(0), 0
    while max(abs(forward), abs(back)) * abs(weight) * n >= mpf(10) ** (-DIGITS) or n == 0:
        n += 1
        weight, step = weight * step, step * q**2
        forward, back = forward * turn, back / turn
        value += weight * (forward + back)
        slope += 2j * n * weight * (forward - back)
    return value, slope


def _heavy(inputs: Inputs, A: mpc, B: mpc, t: mpf) -> Motion:  # noqa: PLR0915  # one formula after the other
    Ix, Iz, Mgl = inputs.Ix, inputs.Iz, inputs.Mgl
    wx, wy, wz = inputs.angular_velocity
    G = 2j * mp.conj(A) * B
    u0 = abs(A) ** 2 - abs(B) ** 2
    p_psi = Iz * wz
    p_phi = Ix * (wx * G.real + wy * G.imag) + p_psi * u0
    e = wx**2 + wy**2 + 2 * Mgl * u0 / Ix
    g = 2 * Mgl / Ix
    # f(u) = (e - g u)(1 - u^2) - ((p_phi - p_psi u)/Ix)^2
    b = p_psi / Ix
    roots = _cubic_roots(g, -e - b**2, -g + 2 * p_phi * b / Ix, e - (p_phi / Ix) ** 2)
    u1, u2, u3 = roots
    u1, u2, u3 = max(u1, mpf(-1)), min(u2, mpf(1)), max(u3, mpf(1))
    Omega = mp.sqrt(g * (u3 - u1)) / 2
    tiny = mpf(10) ** (-DIGITS // 2)
    if u2 - u1 < tiny:
        u2 = u1 + tiny
    if u3 - u2 < tiny:
        u3 = u2 + tiny
    # complete integrals by Gauss's mean, which takes 1/50 of the time of Carlson's integrals
    k, kc = mp.sqrt((u2 - u1) / (u3 - u1)), mp.sqrt((u3 - u2) / (u3 - u1))
    K, Kc = mp.pi / (2 * mp.agm(1, kc)), mp.pi / (2 * mp.agm(1, k))
    q = mp.exp(-mp.pi * Kc / K)
    to_z = mp.pi / (2 * K)

    sn2 = min(max((u0 - u1) / (u2 - u1), mpf(0)), mpf(1))
    m = (u2 - u1) / (u3 - u1)
    v0 = mp.sqrt(sn2) * mp.elliprf(1 - sn2, 1 - m * sn2, 1)
    if wx * G.imag - wy * G.real > 0:  # sin(theta) theta' > 0: u falls
        v0 = -v0

    alpha = mp.sqrt(u3 - u1) * mp.elliprf(1 + u1, 1 + u2, 1 + u3)
    beta = mp.sqrt(u3 - 1) * mp.elliprf(1 - u2, (1 - u1) * (u3 - u2) / (u3 - u1), u3 - u2)
    if p_phi + p_psi < 0:
        alpha = -alpha
    if p_phi - p_psi < 0:
        beta = -beta

    def rate(shift: mpf, momentum: mpf, gap: mpf) -> mpf:
        value, slope = _theta(3, 1j * shift * to_z, q)
        return momentum / (2 * Ix * gap) - Omega * (slope * to_z / value).imag

    c = p_psi * (1 / Iz - 1 / Ix)
    rate_a = rate(alpha, p_phi + p_psi, 1 + u2) + c / 2
    rate_b = rate(beta, p_phi - p_psi, 1 - u1) - c / 2

    def factors(time: mpf) -> list[Pair]:
        """Un-normalised A and B and their derivatives."""
        v = v0 + Omega * time
        below, below_slope = _theta(4, mpc(v * to_z), q)
        result = []
        for k, shift, mean in ((4, alpha, rate_a), (3, beta, rate_b)):
            above, above_slope = _theta(k, (v + 1j * shift) * to_z, q)
            turn = mp.expj(mean * time)
            value = above / below * turn
            slope = (above_slope - above * below_slope / below) / below * turn * to_z * Omega
            result.append((value, slope + 1j * mean * value))
        return result

    # A' and B' at the start, from q' = q (0, omega)/2
    w, x, y, z = A.real, B.real, B.imag, A.imag
    A_dot = mpc(-x * wx - y * wy - z * wz, w * wz + x * wy - y * wx) / 2
    B_dot = mpc(w * wx + y * wz - z * wy, w * wy - x * wz + z * wx) / 2
    constants = []
    for (value, slope), start, start_dot in zip(
        factors(mpf(0)), (A, B), (A_dot, B_dot), strict=True
    ):
        constants.append(start / value if abs(start) > tiny else start_dot / slope)
    (A, A_dot), (B, B_dot) = (
        (C * value, C * slope) for C, (value, slope) in zip(constants, factors(t), strict=True)
    )
    transverse = 2 * (mp.conj(A) * B_dot - B * mp.conj(A_dot))
    return A, B, transverse.real, transverse.imag


def error_and_limit(
    inputs: Inputs, t: Any, orientation: Sequence[Any], angular_velocity: Sequence[Any]
) -> tuple[float, float, float]:
    """Errors of a computed state, and what half an ulp of every input does to the exact one.

    Returns the error of the orientation up to sign, that of the angular velocity relative to its
    size, and the limit: the root of the sum of squares over the ten inputs.
    """
    with mp.workdps(DIGITS):
        exact, rates = exact_motion(inputs, t)
        size = mp.norm(rates) or mpf(1)
        error = distance(exact, [mpf(float(c)) for c in orientation])
        parts = zip(rates, angular_velocity, strict=True)
        rate_error = mp.norm([a - mpf(float(b)) for a, b in parts]) / size
        changes = [distance(exact, exact_motion(each, t)[0]) for each in perturb(inputs)]
        return float(error), float(rate_error), float(mp.norm(changes))


def distance(a: Sequence[Any], b: Sequence[Any]) -> mpf:
    """Distance of two quaternions, q and -q being the same attitude."""
    minus, plus = zip(*((x - y, x + y) for x, y in zip(a, b, strict=True)), strict=True)
    return min(mp.norm(minus), mp.norm(plus))


def perturb(inputs: Inputs, eps: float = 2.0**-52) -> Iterator[Inputs]:
    """Each input in turn, larger by half an ulp, which is eps/2: of doubles if it is not given."""
    flat = [inputs.Ix, inputs.Iz, inputs.Mgl, *inputs.orientation, *inputs.angular_velocity]
    for i, value in enumerate(flat):
        if value:
            moved = [*flat[:i], value * (1 + mpf(eps) / 2), *flat[i + 1 :]]
            Ix, Iz, Mgl, *state = moved
            yield Inputs(Ix, Iz, Mgl, state[:4], state[4:])
