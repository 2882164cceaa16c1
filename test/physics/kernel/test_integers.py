"""Starts of small integers: sums that are exactly zero are found as zero, by both engines."""

import itertools

import pytest
from physics.kernel.test_kernel import assert_same_bits, compiled, compute_both

from symtop_ros.physics import Motion, State, Top

HALF_ROOT = 0.5**0.5
ATTITUDES = (
    *((0.5, 0.5, 0.5, 0.5), (HALF_ROOT, HALF_ROOT, 0, 0), (0.8, 0.6, 0, 0), (0, 0.6, 0.8, 0)),
    *((0.6, 0, 0.8, 0), (HALF_ROOT, 0, HALF_ROOT, 0), (0, 1, 0, 0)),
)
FEW, ALL = (-1, 0, 2), (-1, 0, 1, 2)  # components of the angular velocity
TOPS = [
    moments for moments in itertools.product((1, 2, 3), (1, 2, 3, 4), (-1, 1, 2))
    if moments[1] <= 2 * moments[0]
]  # fmt: skip


@compiled
@pytest.mark.parametrize("components", [FEW, pytest.param(ALL, marks=pytest.mark.long)])
@pytest.mark.parametrize("moments", TOPS)
def test_small_integers_have_the_same_bits(moments, components):
    for attitude, rates in itertools.product(ATTITUDES, itertools.product(components, repeat=3)):
        assert_same_bits(*compute_both(Top(*moments), State(attitude, rates), 1.0))


def test_regular_precession_of_a_horizontal_axis_is_computed_by_python_alone():
    start = State((0.5, 0.5, 0.5, 0.5), (0, 1, 1))
    state = Motion(Top(1, 1, 1), start, pure=True).at(1.0)
    assert state.euler_rates == pytest.approx((1.0, 0.0, 1.0), abs=1e-15)  # as at the start


def test_a_component_that_rests_at_zero_is_exactly_zero():
    # phi' = psi', so (phi - psi)/2, of which y has the sine, stays zero
    start = State((HALF_ROOT, HALF_ROOT, 0, 0), (0, 1, 1))
    motion = Motion(Top(2, 1, 1), start)
    assert motion.kind == "regular"
    assert (motion.at([0.5, 1.0, 1e6]).orientation[:, 2] == 0).all()
