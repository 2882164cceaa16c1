"""Each claim of the article fails if the physics, or the top, is a little different."""

import numpy as np
import pytest

from symtop_ros.physics import Motion, State, Top
from workshop.article.answers import corrections, statements
from workshop.article.motions import HANGING_DISC, TOP, accelerations
from workshop.article.retell import check_claims

# Of these, whatever the top is, the numbers come from formulas that are compared with each other;
# test_torque, test_rates, test_kinds, test_fictitious and test_ledger change one of the two.
ALWAYS_TRUE = {1, 2, 20, 21, 27, 28, 29, 42, 49, 60}
TOPS = {
    "heavier": Top(TOP.Ix, TOP.Iz, 1.01 * TOP.Mgl),
    "no weight": Top(TOP.Ix, TOP.Iz, 0.0),
    "disc": HANGING_DISC,
}
AT, TORQUE, MOMENTUM = Motion.at, Top.gravity_torque, Top.body_angular_momentum


def spin_faster(motion, t):
    """Angular velocities that grow with the time, by a hundredth of their size in a second."""
    state = AT(motion, t)
    growth = 1 + 0.01 * np.asarray(t)[..., None]
    return State(state.orientation, state.angular_velocity * growth)


WRONG = {
    "torque": [(Top, "gravity_torque", lambda top, state: 1.001 * TORQUE(top, state))],
    "rates": [(Motion, "at", spin_faster)],
    "principal axes": [
        (
            Top,
            "body_angular_momentum",
            lambda top, state: MOMENTUM(top, state) + np.array([0.0, 1e-9, 0.0]),
        )
    ],
    "accelerations": [
        (module, "accelerations", lambda *given: 1.0001 * accelerations(*given))
        for module in (corrections, statements)
    ],
}


def failing(top=TOP):
    return {number for number, claim in enumerate(check_claims(top), 1) if not claim.holds}


@pytest.fixture(scope="module")
def found():
    """The numbers of the claims that fail for another top, and with other physics."""
    failed = {name: failing(top) for name, top in TOPS.items()}
    for name, changes in WRONG.items():
        with pytest.MonkeyPatch.context() as patch:
            for change in changes:
                patch.setattr(*change)
            failed[name] = failing()
    return failed


def test_each_claim_fails_for_something_else(found):
    everything = set(range(1, len(check_claims()) + 1))
    assert failing() == set()
    assert everything - set().union(*found.values()) == ALWAYS_TRUE


@pytest.mark.parametrize("name", [*TOPS, *WRONG])
def test_each_change_is_noticed(name, found):
    assert found[name]
