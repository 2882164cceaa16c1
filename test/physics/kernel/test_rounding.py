"""Python in a thread that rounds in another way: nothing is computed."""

import ctypes
import platform
from functools import partial

import pytest
from physics.tops import ARTICLE, CUSPS

from symtop_ros import physics

# FE_UPWARD of fenv.h, by the system and the processor
UPWARD = {"Linux x86_64": 0x800, "Linux aarch64": 0x400000}.get(" ".join(platform.uname()[::4]))
TOPS, MOTION = physics.Top(ARTICLE.Ix, ARTICLE.Iz, [0.0625, 0.125]), physics.Motion(ARTICLE, CUSPS)
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
    "map": partial(physics.compare_hurried, ARTICLE, 0.5, 8.0, 200.0),
}


@pytest.mark.skipif(UPWARD is None, reason="other systems have other constants")
@pytest.mark.parametrize("name", CALLS)
def test_a_thread_that_rounds_upward_gets_no_number(name):
    library = ctypes.CDLL("libm.so.6")
    library.fesetround(UPWARD)
    try:
        with pytest.raises(FloatingPointError, match=" must "):
            CALLS[name]()
    finally:
        library.fesetround(0)
