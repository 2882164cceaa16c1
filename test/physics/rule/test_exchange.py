"""Two states of a top: their energies and what was gained, compared with 40 digits."""

import numpy as np
import pytest
from drawn import Numbers
from mpmath import mp, mpf
from physics.tops import EPS
from trials import seeds

from symtop_ros.physics import State
from symtop_ros.physics.kernel.bindings import find_exchange

DIGITS = 40
FIELDS = "orientation", "angular_velocity"
PARTS = "weight", "precession", "nutation", "spin"
# The norm of a state is 1 to 4.5 EPS, and heights are its squares.
NORM = 9
# A half angle is rounded three times, and so is a rate, of which the vertical has four roundings;
# the difference, the sum and the products add one each.
HEIGHT, RATES, AXIAL = 2 * (3 + NORM) + 4, 2 * (3 + 4) + 4, 4


def draw_pair(number):
    """A top of any shape and sign of Mgl, and two states, some alike, some near the vertical."""
    rng = Numbers(f"pair {number}")
    Ix = rng.power(-5, 2)
    top = (
        Ix,
        Ix * rng.choice([0.01, 0.25, 1.0, 1.5, 2.0]),
        rng.choice([-1, 0, 1]) * rng.power(-3, 2),
    )
    apart = rng.choice([0.0, rng.power(-12, -3), 1.0])
    small = rng.choice([1.0, 1.0, rng.power(-9, -2)])
    first = np.array([rng.gauss() for _ in range(7)])
    first[rng.choice([slice(1, 3), slice(0, 4, 3)])] *= small
    last = first + apart * np.array([rng.gauss() for _ in range(7)])
    return top, [State(each[:4], 30 * each[4:]) for each in map(unit, (first, last))]


def unit(numbers):
    square = sum(x * x for x in numbers[:4].tolist())
    return np.concatenate([numbers[:4] / np.sqrt(square), numbers[4:]])


def split_exactly(state):
    """cos(theta), phi' sin(theta), theta' and omega_z of the doubles of a state."""
    w, x, y, z = (mpf(each) for each in state.orientation.tolist())
    a, b, c = (mpf(each) for each in state.angular_velocity.tolist())
    norm = w * w + x * x + y * y + z * z
    up_x, up_y = 2 * (x * z - w * y) / norm, 2 * (y * z + w * x) / norm
    sine = mp.hypot(up_x, up_y)
    height = (w * w + z * z - x * x - y * y) / norm
    return height, (a * up_x + b * up_y) / sine, (a * up_y - b * up_x) / sine, c


def find_exactly(top, states):
    """The parts of the energy at both ends (2, 4), and the smaller one of 1 +- cos(theta)."""
    Ix, Iz, Mgl = map(mpf, top)
    ends, heights = [], []
    for height, along, tilting, axial in map(split_exactly, states):
        ends.append([Mgl * height, Ix / 2 * along**2, Ix / 2 * tilting**2, Iz / 2 * axial**2])
        heights.append(height)
    return ends, min(max(1 - u for u in heights), max(1 + u for u in heights))


@pytest.mark.parametrize("first", seeds(1, 20))
def test_energies_and_gains_have_the_digits_of_their_states(first):
    for number in range(250 * first, 250 * (first + 1)):
        top, states = draw_pair(number)
        q, omega = (np.stack([getattr(each, name) for each in states]) for name in FIELDS)
        found = find_exchange(top, q, omega)
        with mp.workdps(DIGITS):
            ends, near = find_exactly(top, states)
            gains = [last - first for first, last in zip(*ends, strict=True)]
        across = top[0] / 2 * max(x * x + y * y for x, y, _ in omega.tolist())
        axial = [top[1] / 2 * z * z for _, _, z in omega.tolist()]
        allowed = (
            HEIGHT * abs(top[2]) * float(near),
            RATES * across,
            RATES * across,
            AXIAL * float(abs(gains[3])),
        )
        sizes = (HEIGHT * abs(top[2]), RATES * across, RATES * across, AXIAL * max(axial))
        for k, name in enumerate(PARTS):
            assert abs(getattr(found.gained, name) - gains[k]) <= EPS * allowed[k], (number, name)
            for end, record in zip(ends, (found.first, found.last), strict=True):
                assert abs(getattr(record, name) - end[k]) <= EPS * sizes[k], (number, name)
            larger = max(abs(getattr(each, name)) for each in (found.first, found.last))
            assert getattr(found.sizes, name) == (larger if k else abs(top[2]))


def test_an_axis_on_the_vertical_has_no_precession():
    q = np.array([[1.0, 0, 0, 0], [0, 0, 1.0, 0]])
    found = find_exchange((2.0, 1.0, 3.0), q, np.array([[3.0, 4.0, 5.0]] * 2))
    assert (found.first.precession, found.first.nutation, found.first.spin) == (0, 25.0, 12.5)
    assert (found.first.weight, found.last.weight, found.gained.weight) == (3.0, -3.0, -6.0)
    assert found.gained.nutation == found.gained.spin == found.height + 2 == 0
