import math

import pytest

from symtop_ros.physics import Friction, State, Top


def test_what_follows_from_a_state_is_what_the_formulae_say():
    top = Top(Ix=2.0, Iz=1.0, Mgl=3.0)
    state = State.from_euler(theta=math.pi / 2, phi=0.0, phi_dot=4.0, psi_dot=5.0)
    # a few roundings of numbers of this size, cos(pi/2) = 6e-17 included
    assert top.energy(state) == pytest.approx(2.0 * 16 / 2 + 25 / 2, rel=1e-15)
    assert top.axial_momentum(state) == pytest.approx(5.0, rel=1e-15)
    assert top.vertical_momentum(state) == pytest.approx(8.0, rel=1e-15)


def test_only_an_upright_weight_needs_spin_to_sleep():
    assert Top(1.0, 0.5, 4.0).critical_spin == 8.0
    assert Top(1.0, 0.5, -4.0).critical_spin == 0.0


def test_the_torque_of_friction_is_against_each_rate():
    state = State((1.0, 0.0, 0.0, 0.0), (1.0, -2.0, 4.0))
    assert Friction(axial=0.5, transverse=0.25).torque(state).tolist() == [-0.25, 0.5, -2.0]


def test_a_friction_without_a_coefficient_is_false():
    assert not Friction()
    assert Friction(axial=1e-9)
    assert Friction(transverse=1e-9)
