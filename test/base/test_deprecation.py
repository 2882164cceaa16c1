"""Old names work and warn of their replacements, at the line that uses them."""

import pytest

import symtop_ros.physics
from symtop_ros.physics import (
    DEFAULT_GRAVITY,
    Body,
    EffectivePotential,
    Exchange,
    Friction,
    Ledger,
    Motion,
    State,
    Top,
)

RATES = State.from_euler(theta=0.5, phi_dot=1.0, theta_dot=2.0, psi_dot=3.0).euler_rates


@pytest.mark.parametrize("name", ["phi", "theta", "psi"])
def test_rates_have_their_old_names_with_a_warning(name):
    with pytest.warns(DeprecationWarning, match=f"Rates.{name} is now {name}_dot") as caught:
        assert getattr(RATES, name) == getattr(RATES, f"{name}_dot")
    assert caught[0].filename == __file__


MOTION = Motion(Top(1.0, 1.0, 1.0), State.from_euler(theta=0.5))
INTERNAL = [
    *((MOTION, name) for name in ("packed_start", "pack_with", "fill", "reach")),
    *((State, name) for name in ("wrap", "of_given")),
    (MOTION.start, "parts"),
    (Friction(), "find_decay"),
]


@pytest.mark.parametrize(("owner", "name"), INTERNAL)
def test_internal_members_have_their_old_names_with_a_warning(owner, name):
    with pytest.warns(DeprecationWarning, match=f"{name} is internal") as caught:
        found = getattr(owner, name)
    assert found == getattr(owner, f"_{name}")
    assert caught[0].filename == __file__


def test_the_gravity_that_is_not_the_standard_one_has_its_old_name_with_a_warning():
    with pytest.warns(
        DeprecationWarning, match="STANDARD_GRAVITY is now DEFAULT_GRAVITY"
    ) as caught:
        from symtop_ros.physics import STANDARD_GRAVITY
    assert STANDARD_GRAVITY == DEFAULT_GRAVITY == 9.81
    assert {each.filename for each in caught} == {__file__}
    assert not hasattr(symtop_ros.physics, "STANDARD")


CONSTRUCTORS = [
    (Body, "of", "from_top"),
    (Body, "of_parts", "from_parts"),
    (Body, "disc", "from_disc"),
    (Body, "about_pivot", "from_pivot_moments"),
    (EffectivePotential, "of", "from_state"),
    (Ledger, "of", "from_times"),
    (Ledger, "between_turns", "from_turns"),
    (Exchange, "of", "from_ledger"),
]


@pytest.mark.parametrize(("owner", "old", "new"), CONSTRUCTORS)
def test_constructors_have_their_old_names_with_a_warning(owner, old, new):
    with pytest.warns(DeprecationWarning, match=f"{owner.__name__}.{old} is now .*{new}") as caught:
        found = getattr(owner, old)
    assert found == getattr(owner, new)
    assert caught[0].filename == __file__
