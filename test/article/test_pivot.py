import numpy as np
import pytest

from symtop_ros.physics import Body, Top
from workshop.article import pivot
from workshop.article.motions import TOP, cusps, regular


def test_another_body_would_need_another_force(monkeypatch):
    body = Body.of(TOP)
    other = Body(body.mass, 1.01 * body.arm, body.Ix, body.Iz, body.gravity)
    with pytest.raises(ValueError, match="that of the body"):
        other.pivot_force(cusps(), cusps().start)
    monkeypatch.setattr(Body, "centre_of_mass", lambda _, state: state.to_world([0, 0, other.arm]))
    assert not pivot.force_accelerates_the_mass(cusps()).holds


def test_in_regular_precession_the_pivot_carries_just_the_weight():
    body = Body.of(TOP)
    vertical, _ = pivot.pivot_forces(regular(), np.linspace(0.0, 1.0, 50))
    # sums of a few rounded products, a hundredth of the weight each
    np.testing.assert_allclose(vertical, body.mass * body.gravity, rtol=1e-14)
    assert not pivot.pivot_carries_the_weight(regular()).holds  # it never differs from the weight


def test_a_top_that_is_hardly_heavy_does_not_fall_fast_enough_to_lift():
    assert pivot.peg_lifts(TOP).holds
    assert not pivot.peg_lifts(Top(TOP.Ix, 1e-7, TOP.Mgl)).holds
