"""The colours of a recording can be distinguished by people with any kind of colour vision."""

from itertools import combinations

import numpy as np
import pytest
from colours import VISIONS, perceive

from symtop_ros.playback.view import entities

COLORS = ("BLUE", "GREEN", "RED", "GOLD", "ORANGE", "VIOLET", "WHITE")
APART = 25.0  # CIE 1976 units; 2.3 are just noticeable, and lines are thin


@pytest.mark.parametrize("name", VISIONS)
def test_any_two_colours_differ(name):
    seen = {color: perceive(getattr(entities, color), name) for color in COLORS}
    for one, other in combinations(COLORS, 2):
        assert np.linalg.norm(seen[one] - seen[other]) > APART, (one, other)


@pytest.mark.parametrize("color", COLORS)
def test_each_colour_is_much_lighter_than_the_background(color):
    lightness = perceive(getattr(entities, color), "usual")[0]
    assert lightness - perceive(entities.BACKGROUND, "usual")[0] > 40
