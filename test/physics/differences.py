"""Derivatives of exact motions by differences of numbers with many digits."""

from fractions import Fraction

import numpy as np
from mpmath import mp, mpf
from physics.tops import follow_exactly, multiply

from symtop_ros.physics.reference.series import Inputs

DIGITS = 70
FEW_DIGITS = 34  # enough in the first nutations: derivatives with some 20 digits
BLOCKS = ((slice(0, 1)), slice(1, 2), slice(2, 3), slice(3, 6), slice(6, 9))


def differentiate(motion, times, digits=DIGITS):
    """The Jacobians (n, 6, 9) at times in s > 0."""

    def follow(moments, *start):
        exact = follow_exactly(motion, Inputs.exact(*moments, *start), digits)
        return [exact.at(t) for t in times]

    # Of a parameter of size 1: its square is the relative error, as much as rounding leaves.
    step = Fraction(1, 10 ** (digits // 3))
    moments = [Fraction(each) for each in motion.top.moments]
    orientation = [Fraction(each) for each in motion.start.given_orientation.tolist()]
    omega = [Fraction(each) for each in motion.start.angular_velocity.tolist()]
    base = follow(moments, orientation, omega)
    columns = []
    fastest = max(map(abs, omega))
    for k in range(9):
        sizes = abs(moments[k]) or moments[0] if k < 3 else 1 if k < 6 else fastest or 1
        h = step * sizes
        pair = []
        for sign in (h, -h):
            top = list(moments)
            q = orientation
            rates = list(omega)
            if k < 3:
                top[k] += sign
            elif k < 6:
                q = _turn(orientation, k - 3, sign)
            else:
                rates[k - 6] += sign
            pair.append(follow(top, q, rates))
        with mp.workdps(digits):
            twice = 2 * mpf(h.numerator) / h.denominator
            columns.append([_compare(*each, twice) for each in zip(base, *pair, strict=True)])
    return np.array(columns).transpose(1, 2, 0)


def _turn(q, axis, angle):
    """A quaternion turned about an axis of the body by a small angle, not normalised."""
    return multiply(q, (1, *(angle / 2 if k == axis else Fraction(0) for k in range(3))))


def _compare(base, plus, minus, twice):
    """The derivative of attitude, as a rotation vector of the body, and of omega."""
    (w, x, y, z), _ = base
    pairs = zip(_near(plus[0], base), _near(minus[0], base), strict=True)
    change = [(p - m) / twice for p, m in pairs]
    _, *turned = multiply((w, -x, -y, -z), change)
    rates = ((p - m) / twice for p, m in zip(plus[1], minus[1], strict=True))
    return [float(each) for each in (*(2 * each for each in turned), *rates)]


def _near(q, base):
    """The one of q and -q that is near to another quaternion."""
    return q if sum(a * b for a, b in zip(q, base[0], strict=True)) > 0 else [-c for c in q]


def find_errors(motion, found, right, counts_start=False):
    """The largest error of each Jacobian, as a part of the largest element of its block.

    A block has three rows, and one column for a moment or three for the start. Of a moment that
    hardly counts, such as the weight in the first instants, an error is promised as a part of
    1e-3 rad, or of the spin, for all of the moment; with `counts_start` also for 1 rad of a start,
    and for its angular velocity: docs/filters.md promises no more.
    """
    errors = np.zeros(found.shape[:-2])
    spin = np.abs(motion.start.angular_velocity).max()
    for rows, size in ((slice(0, 3), 1.0), (slice(3, 6), spin)):
        for columns in BLOCKS:
            largest = np.abs(right[..., rows, columns]).max(axis=(-1, -2))
            change = [*map(abs, motion.top.moments), counts_start, 0, 0, counts_start * spin]
            if change[columns.start]:
                largest = np.maximum(largest, 1e-3 * size / change[columns.start])
            off = np.abs(found - right)[..., rows, columns].max(axis=(-1, -2))
            errors = np.maximum(errors, off / np.where(largest, largest, 1.0))
    return errors
