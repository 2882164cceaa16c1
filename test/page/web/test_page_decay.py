"""The page says of friction what a node says."""

import pytest
from page.web.opened import read_motion

from symtop_ros.run.simulation.changes.decay import Decay
from symtop_ros.words import write

TOPS = {  # fields that are changed in the scene with friction
    "as it is": {},
    "backwards": {"psi_dot": "-150"},
    "hanging": {"top.Mgl": "-0.05"},
    "at the slow root, little friction": {"phi_dot": "6.5", "friction.axial": "1e-6"},
    "no friction at the spin": {"friction.axial": "0"},
    "for days": {"friction.axial": "1e-12"},
}


@pytest.mark.parametrize("name", TOPS)
def test_the_page_says_of_the_precession_what_a_node_says(name, shared):
    shared.start_scene("friction")
    for field, text in TOPS[name].items():
        shared.enter(field, text)
    decay = Decay.of(read_motion(shared.read_events()[-1]))
    said = shared.say("why").partition(" Friction slows the spin")
    expected = write("decay", decay) if decay else ""
    assert "".join(said[1:]).strip() == expected
    assert bool(decay) == (name not in ("no friction at the spin", "for days"))
