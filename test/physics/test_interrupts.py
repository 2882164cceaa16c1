"""A long computation ends at Ctrl-C: the kernel is called for some milliseconds at a time."""

import numpy as np
import pytest
from physics.tops import ARTICLE, CUSPS, within

from symtop_ros.physics import Friction, Motion, Motions, State, Top, perrys_rule


@pytest.mark.parametrize("t", [1e7, -1e7])
def test_an_integration_that_takes_hours_is_interrupted(t):
    motion = Motion(ARTICLE, CUSPS, Friction(1e-12, 0.0))
    with pytest.raises(KeyboardInterrupt), within(0.1, KeyboardInterrupt):
        motion.at(t)
    alone = Motion(ARTICLE, CUSPS, Friction(1e-12, 0.0))
    assert motion.at(0.5).orientation.tolist() == alone.at(0.5).orientation.tolist()


TILTS = np.arange(1, 200_001) / 2**17
LONG = {  # each takes some seconds
    "states": lambda: Motion(ARTICLE, CUSPS).at(np.zeros(10_000_000)),
    "motions": lambda: Motions(Top(1.0, 1.0, 1.0), State.from_euler(theta=TILTS)).at(np.zeros(99)),
    "kinds": lambda: Motions(Top(1.0, 1.0, 1.0), State.from_euler(theta=TILTS)).kind,
    "verdicts": lambda: perrys_rule(ARTICLE, State.from_euler(theta=TILTS, phi_dot=1.0)),
}


@pytest.mark.parametrize("name", LONG)
def test_a_call_for_many_is_interrupted(name):
    with pytest.raises(KeyboardInterrupt), within(0.1, KeyboardInterrupt):
        LONG[name]()
