"""Python in a thread that rounds in another way: nothing is computed."""

import ctypes
import platform
from functools import partial

import pytest
from physics.tops import ARTICLE, CUSPS

from symtop_ros import physics

# FE_UPWARD of fenv.h, by the system and the processor
UPWARD = {"Linux x86_64": 0x800, "Linux aarch64": 0x400000}.get(" ".join(platform.uname()[::4]))
TOPS = physics.Top(ARTICLE.Ix, ARTICLE.Iz, [0.0625, 0.125])
MOTION = physics.Motion(ARTICLE, CUSPS)
DRIVEN = physics.Motion(ARTICLE, CUSPS, physics.Friction(axial=1e-6))
POTENTIAL = physics.EffectivePotential.from_state(ARTICLE, CUSPS)
# What is found once is kept: nothing of it is known before.
FOUND = (
    "kind",
    "turning_angles",
    "nutation_period",
    "nutation_rate",
    "mean_precession_rate",
    "mean_spin_rate",
    "precession_per_nutation",
    "mean_cosine",
    "spin_reverses",
    "farthest_time",
    "fast_top_precession_rate",
    "fast_top_nutation_rate",
)
OF_A_STATE = "vertical", "is_vertical", "euler_angles", "euler_rates", "matrix"
OF_A_TOP = (
    "energy",
    "axial_momentum",
    "vertical_momentum",
    "angular_momentum",
    "gravity_torque",
    "sleeping_is_stable",
)


def fresh():
    """A motion and a state of which nothing is known."""
    return physics.Motion(ARTICLE, CUSPS), physics.State(*CUSPS._parts)


CALLS = {
    "motion": partial(physics.Motion, ARTICLE, CUSPS),
    "state": partial(MOTION.at, 0.5),
    "states": partial(MOTION.at, [0.5, 1.0]),
    "motions": partial(physics.Motions(TOPS, CUSPS).at, 0.5),
    "angles": partial(physics.State.from_euler, theta=0.5),
    "kick": partial(physics.hurry, CUSPS),
    "rates": partial(physics.regular_precession_rates, ARTICLE, 0.5, 200.0),
    "verdict": partial(physics.perrys_rule, ARTICLE, CUSPS),
    "verdict on a kick": partial(physics.kick_verdict, MOTION, CUSPS, "spin_rate"),
    "steps": partial(DRIVEN._reach, 1.0, 100),
    "state of a driven motion": partial(DRIVEN.at, 0.5),
    "jacobian": partial(MOTION.jacobian, 0.5),
    "torque": partial(MOTION.total_torque, CUSPS),
    "kinds": lambda: physics.Motions(TOPS, CUSPS).kind,
    "fast tops": lambda: physics.Motions(TOPS, CUSPS).fast_top_precession_rate,
    "critical spin": lambda: ARTICLE.critical_spin,
    "a norm": partial(physics.State, (1.0005, 0, 0, 0), (0, 0, 0)),
    "a matrix": partial(physics.State.from_matrix, CUSPS.matrix, (0, 0, 0)),
    "a potential": partial(physics.EffectivePotential.from_state, ARTICLE, CUSPS),
    "a potential at an angle": partial(POTENTIAL.at, 0.5),
    "a cubic": partial(POTENTIAL.cubic, 0.5),
    "a third root": partial(POTENTIAL.find_third_root, 0.5, 0.6),
    **{name: partial(getattr, fresh()[0], name) for name in FOUND},
    **{name: partial(getattr, fresh()[1], name) for name in OF_A_STATE},
    **{name: partial(getattr(ARTICLE, name), fresh()[1]) for name in OF_A_TOP},
    "map": partial(physics.compare_hurried, ARTICLE, 0.5, 8.0, 200.0),
}


@pytest.mark.skipif(UPWARD is None, reason="other systems have other constants")
@pytest.mark.parametrize("name", CALLS)
def test_a_thread_that_rounds_upward_gets_no_number_and_nothing_is_kept_of_it(name):
    library = ctypes.CDLL("libm.so.6")
    library.fesetround(UPWARD)
    try:
        with pytest.raises(FloatingPointError, match="arithmetic must be that of IEEE 754"):
            CALLS[name]()
    finally:
        library.fesetround(0)
    CALLS[name]()


@pytest.mark.skipif(UPWARD is None, reason="other systems have other constants")
def test_what_was_refused_is_found_as_ever_when_the_thread_rounds_again():
    motion, _ = fresh()
    library = ctypes.CDLL("libm.so.6")
    library.fesetround(UPWARD)
    try:
        for name in FOUND:
            with pytest.raises(FloatingPointError):
                getattr(motion, name)
    finally:
        library.fesetround(0)
    for name in FOUND:
        assert getattr(motion, name) == getattr(MOTION, name)
