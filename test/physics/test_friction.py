import math

import pytest

from symtop_ros.physics import Friction, State


@pytest.mark.parametrize(
    ("values", "sentence"),
    [
        ({"axial": -1}, r"friction\.axial: got -1, allowed is 0 or more \(N m s\)"),
        ({"transverse": math.nan}, r"friction\.transverse: got nan, allowed is 0 or more"),
        ({"axial": "1"}, r"friction\.axial: got '1', allowed is a number"),
        ({"transverse": True}, r"friction\.transverse: got True, allowed is a number"),
    ],
)
def test_what_is_no_friction_is_refused_in_words(values, sentence):
    with pytest.raises(ValueError, match=sentence):
        Friction(**values)


def test_the_torque_is_against_each_rate():
    state = State((1.0, 0.0, 0.0, 0.0), (1.0, -2.0, 4.0))
    assert Friction(axial=0.5, transverse=0.25).torque(state).tolist() == [-0.25, 0.5, -2.0]
    assert not Friction()
    assert Friction(axial=1e-9)
