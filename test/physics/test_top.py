import math

import pytest

from symtop_ros.physics import State, Top


@pytest.mark.parametrize(
    ("moments", "sentence"),
    [
        ((0.0, 1.0, 1.0), "Ix: got 0, allowed is Ix > 0"),
        ((-1.0, 1.0, 1.0), "Ix: got -1, allowed is Ix > 0"),
        ((1.0, 0.0, 1.0), "Iz: got 0, allowed is 0 < Iz <= 2 Ix = 2"),
        ((1.0, 2.1, 1.0), "Iz: got 2.1, allowed is 0 < Iz <= 2 Ix = 2"),
        ((1.0, 1.0, math.nan), "Mgl: got nan, allowed is a finite number"),
        ((1.0, "1", 1.0), "Iz: got '1', allowed is a number"),
        ((True, 1.0, 1.0), "Ix: got True, allowed is a number"),
    ],
)
def test_a_body_that_cannot_be_is_refused_in_words(moments, sentence):
    with pytest.raises(ValueError, match=sentence):
        Top(*moments)


def test_what_follows_from_a_state_is_what_the_formulae_say():
    top = Top(Ix=2.0, Iz=1.0, Mgl=3.0)
    state = State.from_euler(theta=math.pi / 2, phi=0.0, phi_dot=4.0, psi_dot=5.0)
    assert top.angular_momentum(state).tolist() == pytest.approx([0.0, -5.0, 8.0], abs=1e-14)
    assert top.torque(state).tolist() == pytest.approx([3.0, 0.0, 0.0], abs=1e-14)
    assert top.energy(state) == pytest.approx(2.0 * 16 / 2 + 25 / 2)
    assert top.axial_momentum(state) == pytest.approx(5.0)
    assert top.vertical_momentum(state) == pytest.approx(8.0)


def test_only_an_upright_weight_needs_spin_to_sleep():
    assert Top(1.0, 0.5, 4.0).critical_spin == 8.0
    assert Top(1.0, 0.5, -4.0).critical_spin == 0.0
