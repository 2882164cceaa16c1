"""A long computation ends at Ctrl-C: the kernel is called for some milliseconds at a time."""

from types import SimpleNamespace

import numpy as np
import pytest
from physics.tops import ARTICLE, CUSPS, within

from symtop_ros.physics import Friction, Motion, State, Top, arguments
from symtop_ros.physics.kernel import compiled, find_kernel

needs_kernel = pytest.mark.skipif(find_kernel(False) is None, reason="no compiled kernel")


class Spy:
    """The kernel, with the number of states of each call."""

    def __init__(self, sizes):
        self._kernel, self._sizes = find_kernel(False), sizes

    def Motion(self, *given):
        motion = self._kernel.Motion(*given)

        def fill(times, *rest):
            self._sizes.append(len(times))
            return motion.fill(times, *rest)

        return SimpleNamespace(fill=fill)

    def fill_many(self, starts, times, *rest):
        self._sizes.append(len(starts) * (times.shape[-1] + arguments.STATES_OF_SETUP))
        self._kernel.fill_many(starts, times, *rest)

    def describe_many(self, starts, *rest):
        self._sizes.append(len(starts) * arguments.STATES_OF_SETUP)
        self._kernel.describe_many(starts, *rest)


@pytest.mark.parametrize("pure", [False, True])
@pytest.mark.parametrize("t", [1e7, -1e7])
def test_an_integration_that_takes_hours_is_interrupted(t, pure):
    motion = Motion(ARTICLE, CUSPS, Friction(1e-12, 0.0), pure=pure)
    with pytest.raises(KeyboardInterrupt), within(0.1, KeyboardInterrupt):
        motion.at(t)
    alone = Motion(ARTICLE, CUSPS, Friction(1e-12, 0.0), pure=pure)
    assert motion.at(0.5).orientation.tolist() == alone.at(0.5).orientation.tolist()


@needs_kernel
def test_one_call_of_the_kernel_has_some_ten_thousand_states_at_most():
    sizes = []
    state = tuple(CUSPS.orientation.tolist()), tuple(CUSPS.angular_velocity.tolist())
    motion = compiled.CompiledMotion(Spy(sizes), ARTICLE.moments, *state, Friction(), (0.0,) * 3)
    count = 3 * compiled.STATES + 1
    motion.fill(np.zeros(count), np.empty((count, 4)), np.empty((count, 3)))
    assert sum(sizes) == count
    assert max(sizes) == compiled.STATES


@needs_kernel
def test_one_call_for_many_motions_has_some_ten_thousand_states_at_most(monkeypatch):
    sizes = []
    monkeypatch.setattr("symtop_ros.physics.motions.find_kernel", lambda pure: Spy(sizes))
    starts = State.from_euler(theta=np.linspace(0.1, 3.0, 2000))
    motions = Motion(Top(1.0, 1.0, 1.0), starts)
    motions.at(np.arange(9.0))
    assert len(sizes) > 1
    calls = len(sizes)
    assert (motions.kind != "driven").all()
    assert len(sizes) > calls + 1
    assert max(sizes) <= arguments.STATES
