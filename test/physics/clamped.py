"""A clamped motion with many digits, by Jacobi's functions of the pendulum's half angle.

Nothing of it is shared with the kernel, which has theta functions of three heights.
"""

from mpmath import mp, mpf

DIGITS = 40


def follow_clamped(top, start, t, digits=DIGITS):
    """Orientation and angular velocity of exactly the doubles that are given, at a time."""
    with mp.workdps(digits + 20):
        t, Ix, Mgl = mpf(t), mpf(top.Ix), mpf(top.Mgl)
        w, x, y, z = (mpf(each) for each in start.given_orientation.tolist())
        wx, wy, wz = (mpf(each) for each in start.angular_velocity.tolist())
        norm = mp.sqrt(w * w + x * x + y * y + z * z)
        upper, lower = mp.mpc(w, z) / norm, mp.mpc(x, y) / norm
        across = mp.mpc(wx, wy) * upper * mp.conj(lower) / abs(upper * lower)
        half, rate = fall(Mgl / Ix, mp.atan2(abs(lower), abs(upper)), across.real, t)
        turned = mp.expj(wz * t / 2)
        A = mp.cos(half) * upper / abs(upper) * turned
        B = mp.sin(half) * lower / abs(lower) / turned
        node = rate * mp.conj(upper) / abs(upper) * lower / abs(lower) / turned**2
        return (A.real, B.real, B.imag, A.imag), (node.real, node.imag, wz)


def fall(pull, half, rate, t):
    """Half of the angle of a plane pendulum from upright, and theta', at a time."""
    if not pull:
        return half + rate * t / 2, rate
    # from the lowest place: chi'' = -k sin(chi)
    lowest = mp.pi / 2 if pull > 0 else mpf(0)
    k = abs(pull)
    chi = half - lowest
    m = rate**2 / (4 * k) + mp.sin(chi) ** 2
    if m == 0:
        return half, rate
    found, slope = (swing if m < 1 else circle)(k, m, chi, rate, t)
    return lowest + found, slope


def swing(k, m, chi, rate, t):
    """sin(chi) = sqrt(m) sn(u, m)."""
    size = mp.sqrt(m)
    begin = mp.ellipf(mp.atan2(mp.sin(chi), rate / (2 * mp.sqrt(k))), m)
    u = begin + mp.sqrt(k) * t
    sn, cn, dn = (mp.ellipfun(name, u, m=m) for name in ("sn", "cn", "dn"))
    return mp.atan2(size * sn, dn), 2 * mp.sqrt(k) * size * cn


def circle(k, m, chi, rate, t):
    """sin(chi) = sn(sqrt(m) u, 1/m): it goes round."""
    side = mp.sign(rate)
    fast = mp.sqrt(k * m)
    u = side * mp.ellipf(chi, 1 / m) + fast * t
    sn, cn, dn = (mp.ellipfun(name, u, m=1 / m) for name in ("sn", "cn", "dn"))
    return side * mp.atan2(sn, cn), 2 * side * fast * dn
