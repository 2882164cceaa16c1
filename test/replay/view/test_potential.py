"""The charts show the constants of the motion: lines, marks and dots are where the numbers say."""

import math
from itertools import combinations

import numpy as np
import pytest
from colours import VISIONS, perceive
from log_files import ARTICLE, CUSPS, REGULAR

from symtop_ros.physics import EffectivePotential, Motion, State, Top
from symtop_ros.replay.view import entities
from symtop_ros.replay.view.potential import HEIGHT, WIDTH, Chart, frame_cubic, frame_potential

MOTIONS = {
    "cusps": Motion(ARTICLE, CUSPS),
    "regular": Motion(ARTICLE, REGULAR),
    "through the pole": Motion(ARTICLE, State.from_euler(theta=0.5, theta_dot=30.0)),
    "sleeping": Motion(ARTICLE, State.from_euler(theta=0.0, psi_dot=200.0)),
    "hanging": Motion(Top(1.0, 0.5, -1.0), State.from_euler(theta=1.0, phi_dot=1.0, psi_dot=3.0)),
    "free": Motion(Top(1.0, 0.5, 0.0), State.from_euler(theta=1.0, phi_dot=1.0, psi_dot=3.0)),
    "resting": Motion(Top(1.0, 0.5, 0.0), State.from_euler(theta=1.0)),
}


@pytest.mark.parametrize("motion", MOTIONS.values(), ids=MOTIONS)
def test_turning_angles_energy_and_the_roots_that_are_angles_are_inside_the_charts(motion):
    potential = EffectivePotential.from_state(motion.top, motion.start)
    chart = frame_potential(motion, potential)
    assert chart.left <= motion.turning_angles[0] <= motion.turning_angles[1] <= chart.right
    assert chart.bottom < potential.energy < chart.top
    assert math.isfinite(chart.top - chart.bottom)
    chart = frame_cubic(motion, potential)
    assert chart.left < -1 < 1 < chart.right
    assert chart.bottom < 0 < chart.top


def test_a_curve_is_cut_at_the_edges_of_the_chart():
    chart = Chart(left=0.0, right=10.0, bottom=-1.0, top=0.5)
    x = np.linspace(0.0, 10.0, 1001)
    strips = chart.cut(x, np.sin(x))
    assert len(strips) == 3  # the two hills are cut off
    for strip in strips:
        assert (strip[:, 0] >= 0).all()
        assert (strip[:, 0] <= WIDTH).all()
        assert (strip[:, 1] <= 0).all()
        assert (strip[:, 1] >= -HEIGHT).all()


def test_a_point_is_placed_in_proportion_and_outside_at_the_edge():
    chart = Chart(left=0.0, right=4.0, bottom=-1.0, top=1.0)
    assert chart.place(1.0, 0.0).tolist() == [WIDTH / 4, -HEIGHT / 2]
    assert chart.place(9.0, -9.0).tolist() == [WIDTH, 0.0]


COLORS = ("BLUE", "GREEN", "RED", "GOLD", "ORANGE", "VIOLET", "WHITE")
APART = 25.0  # CIE 1976 units; 2.3 are just noticeable, and lines are thin


@pytest.mark.parametrize("name", VISIONS)
def test_any_two_colours_differ(name):
    seen = {color: perceive(getattr(entities, color), name) for color in COLORS}
    for one, other in combinations(COLORS, 2):
        assert np.linalg.norm(seen[one] - seen[other]) > APART, (one, other)
