"""Friction of a free top: the rate at which it slows the spin, and a turn across the axis."""

import math

import pytest

from symtop_ros.physics import Friction, Motion, State, Top

TOP = Top(Ix=0.5, Iz=0.25, Mgl=0.0)


@pytest.mark.parametrize(
    ("friction", "omega"),
    [
        (Friction(axial=0.125), (0.0, 0.0, 2.0)),
        (Friction(transverse=0.125), (2.0, 0.0, 0.0)),
        (Friction(axial=0.125, transverse=0.03125), (0.0, 0.0, 2.0)),
        (Friction(axial=0.03125, transverse=0.125), (2.0, 0.0, 0.0)),
    ],
    ids=str,
)
def test_the_fastest_decay_is_that_of_the_rotation_which_friction_slows_most(friction, omega):
    motion = Motion(TOP, State((1.0, 0.0, 0.0, 0.0), omega), friction)
    after = motion.at(3.0).angular_velocity @ omega / 4.0
    # a driven state is within hundreds of eps
    assert after == pytest.approx(math.exp(-3.0 * friction._find_decay(TOP)), rel=1e-12)
