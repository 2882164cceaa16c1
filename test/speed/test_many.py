"""Many different motions: every program has the same ones, and errors come from another method."""

import time

import numpy as np
import pytest

from workshop.speed.many import find_programs, measure_many
from workshop.speed.peers import CLOSED_FORM

COUNT, SPAN = 3, 1.0


def program(**options):
    """The package, or a copy of it that is turned by an angle or takes time, and its calls."""
    turn, delays, calls = options.get("turn", 0.0), iter(options.get("delays", ())), []
    q = np.array([np.cos(turn / 2), 0.0, 0.0, np.sin(turn / 2)])

    def compute(motions, t):
        calls.append(len(motions.start.given_orientation))
        time.sleep(next(delays, 0.0))
        w, x, y, z = find_programs()[0][1](motions, t).T
        c, s = q[0], q[3]  # of a rotation about the axis of the top, after that of the package
        return np.stack([w * c - z * s, x * c + y * s, y * c - x * s, z * c + w * s], axis=1)

    return compute, calls


def test_the_errors_of_the_package_are_those_from_an_independent_method():
    cost = measure_many(CLOSED_FORM, find_programs()[0][1], COUNT, SPAN)
    assert 0 < cost.error < 2.2e-15  # 10 eps are promised; 0 would be a comparison with itself


def test_an_error_is_the_angle_from_the_exact_attitude():
    cost = measure_many("turned", program(turn=1e-9)[0], COUNT, SPAN)
    assert cost.error == pytest.approx(1e-9, rel=1e-5)  # the package's own error is 1e-15
