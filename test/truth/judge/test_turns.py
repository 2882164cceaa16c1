"""The axis of a rotation, as it is read in the sentence of the judge."""

import math
import re

import numpy as np
import pytest
from drawn import Numbers, cos, sin

from symtop_ros.truth.judge.turns import AXES, TURNS, describe_axis
from symtop_ros.words import write

NUMBER = r"(-?\d+(?:\.\d+)?)"


def rotation(axis, angle):
    unit = np.divide(axis, math.sqrt(sum(each * each for each in axis)))
    return np.array([cos(angle / 2), *(sin(angle / 2) * each for each in unit)])


def read(text):
    """Return degrees or None, and the axis that a person reads."""
    named = re.fullmatch(r" \((-?\d+) degrees about ([xyz]|\(.*\))\)", text)
    words = named[2] if named else re.fullmatch(r" about (\(.*\))", text)[1]
    if words in AXES:
        axis = [float(each == words) for each in AXES]
    else:
        axis = [float(each) for each in re.findall(NUMBER, words)]
    return float(named[1]) if named else None, axis


def apart(q, axis, degrees):
    """The angle in rad between a rotation and one that was read."""
    other = rotation(axis, math.radians(degrees))
    return 2 * math.acos(min(abs(float(q @ other)), 1.0))


def test_there_are_the_rotations_that_take_axes_to_axes():
    turns = [rotation(*each) for each in ((a, math.radians(d)) for a, d in TURNS)]
    assert len(turns) == 23
    for k, q in enumerate(turns):
        assert all(abs(float(q @ other)) < 0.99 for other in turns[:k])
        w, x, y, z = q.tolist()
        column = [w * w + x * x - y * y - z * z, 2 * (x * y + w * z), 2 * (x * z - w * y)]
        assert sorted(abs(round(each, 9)) for each in column) == [0, 0, 1]


@pytest.mark.parametrize("sign", [1, -1])  # of the quaternion
@pytest.mark.parametrize(("axis", "degrees"), TURNS)
def test_a_turn_of_axes_has_its_name_within_its_deviation_alone(axis, degrees, sign):
    q = sign * rotation(axis, math.radians(degrees))
    text = write("axis", describe_axis(q, None))
    read_degrees, read_axis = read(text)
    assert apart(q, read_axis, read_degrees) < 1e-7
    off = sign * rotation(axis, math.radians(degrees) + 0.01)
    assert read(write("axis", describe_axis(off, 0.01))) == (read_degrees, read_axis)
    # a hundredth of a radian is ten deviations: no turn of axes
    assert read(write("axis", describe_axis(off, 0.001)))[0] is None


@pytest.mark.parametrize("seed", range(200))
def test_another_axis_is_said_to_the_digits_that_are_known(seed):
    rng = Numbers(seed)
    (q,) = rng.quaternions(1)
    deviation = rng.power(-6, -2)
    text = write("axis", describe_axis(q, deviation))
    degrees, axis = read(text)
    w, *vector = (q if q[0] >= 0 else -q).tolist()
    if degrees is not None:
        assert apart(q, axis, degrees) <= 4 * deviation + 1e-9
        return
    size = math.sqrt(sum(each * each for each in vector))
    places = len(re.search(r"\.(\d+)", text)[1])
    for shown, exact in zip(axis, vector, strict=True):
        assert abs(shown - exact / size) <= 0.5 * 10.0**-places + 1e-12
    # the last digit is no smaller than a tenth of what is known of the axis
    assert places in (1, 3) or 10.0**-places >= 0.1 * 4 * deviation / (2 * math.atan2(size, w))


def test_no_axis_is_said_of_an_angle_that_may_be_zero():
    small = rotation((0, 0, 1), 1e-3)
    assert write("axis", describe_axis(small, 1e-3)) == ""
    assert read(write("axis", describe_axis(small, 1e-5)))[1] == [0.0, 0.0, 1.0]
