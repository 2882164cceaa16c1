"""How the engine's work is bounded, with a clock that a test turns."""

from symtop_ros.node.effort import PATIENCE, SHARE, STEPS, Effort
from symtop_ros.physics import Friction, State, Top, motion
from symtop_ros.run.segment import Segment

TOP, START = Top(1e-3, 1e-3, 1.0), State.from_euler(theta=1.0, psi_dot=1e4)
SECOND = 1_000_000_000


def fast():
    """A motion that takes some thousand steps a second."""
    return motion(TOP, START, Friction(transverse=1e-3))


class Clock:
    """Goes on by some seconds whenever it is read."""

    def __init__(self, each):
        self.time, self.each = 0.0, each

    def __call__(self):
        self.time += self.each
        return self.time


def test_the_closed_form_takes_no_effort():
    path = motion(TOP, START)
    effort = Effort(Clock(0.0))
    assert effort.prepare(Segment.begin(path, 0, 100.0), 0, 10**6 * SECOND) is None
    assert effort.spent == 0.0


def test_what_is_near_is_prepared():
    effort = Effort(Clock(PATIENCE / 1000))
    assert effort.prepare(Segment.begin(fast(), 0, 1.0), 0, SECOND // 10) is None
    assert 0 < effort.spent < PATIENCE


def test_what_takes_too_long_is_given_up_and_says_what_can_be_done():
    effort = Effort(Clock(PATIENCE / 9.5))
    shortfall = effort.prepare(Segment.begin(fast(), 0, 1.0), 0, 1000 * SECOND)
    assert shortfall is not None
    assert shortfall.reached == fast().reach(1000.0, 10 * STEPS)  # after ten looks at the clock
    assert shortfall.factor == SHARE * shortfall.reached / effort.spent


def test_at_rest_there_is_nothing_to_prepare():
    effort = Effort(Clock(1.0))
    resting = Segment.begin(fast(), 0, 1.0).paused(0)
    assert effort.prepare(resting, 0, 10**6 * SECOND) is None
