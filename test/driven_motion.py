"""The top under friction and an applied torque to many digits: a Taylor series in mpmath.

Straight from Euler's equations and q' = q omega/2 in the body frame: neither the frame nor the
variables of the package's engine. Every series is one recurrence; products are Cauchy products.
"""

from __future__ import annotations

from collections.abc import Sequence

from mpmath import mp, mpf

DIGITS = 38
TERMS = 40
CUT = mpf("1e-33")  # of the largest number: what the terms left out of a step are worth

Numbers = Sequence[float]


class DrivenTop:
    """A top, its friction and what pulls at it; numbers are taken as exact."""

    def __init__(self, moments: Numbers, friction: Numbers, torque: Numbers) -> None:
        self.Ix, self.Iz, self.Mgl = map(mpf, moments)
        self.axial, self.transverse = map(mpf, friction)
        self.torque = [mpf(part) for part in torque]

    def state_at(self, orientation: Numbers, angular_velocity: Numbers, t: float):
        """Orientation (w, x, y, z) and body angular velocity at t, to at least 30 digits."""
        with mp.workdps(DIGITS):
            norm = mp.sqrt(sum(mpf(c) ** 2 for c in orientation))
            y = [mpf(c) / norm for c in orientation] + [mpf(c) for c in angular_velocity]
            left = mpf(t)
            while left:
                series = self._series(y)
                h = _reach(series)
                h = left if abs(left) <= h else mp.sign(left) * h
                y = [_sum(each, h) for each in series]
                left -= h
            return tuple(y[:4]), tuple(y[4:])

    def _series(self, y):
        """Taylor coefficients of the seven numbers."""
        y = [[value] for value in y]
        for n in range(TERMS):
            for series, slope in zip(y, self._slopes(y, n), strict=True):
                series.append(slope / (n + 1))
        return y

    def _slopes(self, series, n):
        """Coefficient n of the derivatives."""

        def times(i, j):
            return mp.fdot(series[i], series[j][n::-1])

        w, x, y, z, wx, wy, wz = range(7)
        cross = (self.Ix - self.Iz) / self.Ix
        tx, ty, tz = self._body_torque(times, n)
        return [
            -(times(x, wx) + times(y, wy) + times(z, wz)) / 2,
            (times(w, wx) + times(y, wz) - times(z, wy)) / 2,
            (times(w, wy) + times(z, wx) - times(x, wz)) / 2,
            (times(w, wz) + times(x, wy) - times(y, wx)) / 2,
            cross * times(wy, wz) + (tx - self.transverse * series[wx][n]) / self.Ix,
            -cross * times(wz, wx) + (ty - self.transverse * series[wy][n]) / self.Ix,
            (tz - self.axial * series[wz][n]) / self.Iz,
        ]

    def _body_torque(self, times, n):
        """Gravity's and the applied torque: columns of the rotation matrix times what acts."""
        w, x, y, z = range(4)
        one = 1 if n == 0 else 0
        gx, gy = 2 * (times(x, z) - times(w, y)), 2 * (times(y, z) + times(w, x))
        tx, ty, tz = self.Mgl * gy, -self.Mgl * gx, mpf(0)
        if any(self.torque):
            gz = one - 2 * (times(x, x) + times(y, y))
            a = [
                one - 2 * (times(y, y) + times(z, z)),
                2 * (times(x, y) - times(w, z)),
                2 * (times(x, z) + times(w, y)),
            ]
            b = [
                2 * (times(x, y) + times(w, z)),
                one - 2 * (times(x, x) + times(z, z)),
                2 * (times(y, z) - times(w, x)),
            ]
            u, v, up = self.torque
            tx += a[0] * u + b[0] * v + gx * up
            ty += a[1] * u + b[1] * v + gy * up
            tz += a[2] * u + b[2] * v + gz * up
        return tx, ty, tz


def _reach(series):
    """How far the series go, by the size of their last terms."""
    allowed = CUT * max(abs(each[0]) for each in series)
    last = [(n, max(abs(each[n]) for each in series)) for n in (TERMS - 1, TERMS)]
    return min(mp.root(allowed / size, n) for n, size in last if size)


def _sum(series, h):
    """Horner's sum of a series."""
    total = mpf(0)
    for coefficient in reversed(series):
        total = total * h + coefficient
    return total
