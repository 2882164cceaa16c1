"""A long computation ends at Ctrl-C: the kernel is called for some milliseconds at a time.

Python sees a signal between two calls. How long a call takes depends on the machine, so what is
asserted is how much is asked of one.
"""

import signal

import numpy as np
import pytest
from physics.tops import ARTICLE, CUSPS

from symtop_ros.physics import Friction, Motion, Motions, State, Top, perrys_rule
from symtop_ros.physics.kernel.bindings import bind_functions

# Limits of one call, some ms each; the constants of a motion take as long as 200 states.
STATES, STEPS, VERDICTS, SETUP = 2**16, 256, 256, 200


@pytest.fixture(name="calls")
def _calls(monkeypatch, signals_as_before):
    """Arguments of the kernel's functions, called until Ctrl-C is pressed in the third call."""
    calls = []
    signal.signal(signal.SIGINT, signal.default_int_handler)  # a shell may have it ignored
    for name in ("states", "states_of_many", "describe_many", "judge"):
        monkeypatch.setattr(
            bind_functions(), name, interrupt(getattr(bind_functions(), name), calls)
        )
    return calls


def interrupt(function, calls):
    def call(*arguments):
        calls.append(arguments)
        if len(calls) == 3:
            signal.raise_signal(signal.SIGINT)
        return function(*arguments)

    return call


@pytest.mark.parametrize("t", [1e7, -1e7])
def test_an_integration_that_takes_hours_is_interrupted(t, calls):
    motion = Motion(ARTICLE, CUSPS, Friction(1e-12, 0.0))
    with pytest.raises(KeyboardInterrupt):
        motion.at(t)
    assert {steps for _, _, _, steps, *_ in calls} == {STEPS}
    assert 0 < abs(motion._reach(t, 0)) < 1e-3 * abs(t)
    alone = Motion(ARTICLE, CUSPS, Friction(1e-12, 0.0))
    assert motion.at(0.5).orientation.tolist() == alone.at(0.5).orientation.tolist()


def spread(count):
    """Return so many starts."""
    return State.from_euler(theta=np.arange(1, count + 1) / 2**17, phi_dot=1.0)


BALL = Top(1.0, 1.0, 1.0)
LONG = {  # each as much as three calls may take
    "states": lambda: Motion(ARTICLE, CUSPS).at(np.zeros(3 * STATES)),
    "motions": lambda: Motions(BALL, spread(3 * (STATES // (99 + SETUP)))).at(np.zeros(99)),
    "kinds": lambda: Motions(BALL, spread(3 * (STATES // SETUP))).kind,
    "verdicts": lambda: perrys_rule(ARTICLE, spread(3 * VERDICTS)),
}


@pytest.mark.parametrize("name", LONG)
def test_a_call_for_many_is_interrupted(name, calls):
    with pytest.raises(KeyboardInterrupt):
        LONG[name]()
    assert len(calls) == 3
