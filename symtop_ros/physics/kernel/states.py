"""States of a motion at many times, in blocks: Python sees signals, such as Ctrl-C, between two."""

import numpy as np

from symtop_ros.base.arrays import Real
from symtop_ros.base.refusals import refuse, show_limit
from symtop_ros.physics.arguments import read_start
from symtop_ros.physics.kernel.bindings import NOT_PUSHED, KernelMotion, demand, refuse_status
from symtop_ros.physics.kernel.records import (
    BAD_KICK,
    MORE_STEPS,
    OK,
    TOO_FAR,
    TOO_FAST,
    TOO_LONG,
    TOO_STIFF,
    VERTICAL,
    PieceRecord,
)
from symtop_ros.physics.times import ExactTimes, to_rough_seconds

# In one call of the kernel, some ms.
STATES = 2**16
STEPS = 256.0
LONGEST_WAY = 1e7  # steps, up to a minute; of kernel/driven/trail.hpp
MOST_DECAYS = 1e5  # decay times on the way to a time, some seconds; of kernel/driven/motion.hpp
WHY_NOT_PUSHED = {
    VERTICAL: "the axis is vertical then, and no side is that of phi",
    BAD_KICK: "it makes the top too fast",
}


def fill_states(motion: KernelMotion, times: Real | ExactTimes, q: Real, omega: Real) -> None:
    """Write the states at times (n,) into (n, 4) and (n, 3).

    Raises
    ------
    ValueError
        If a state cannot be computed; the reason names the time.
    """
    if motion.engine != "taylor":
        _fill_in_order(motion, times, q, omega)
        return
    # A driven motion takes least time if the times lead away from the start, on either side.
    seconds = to_rough_seconds(times)
    order = np.argsort(np.abs(seconds), kind="stable")
    for side in (seconds >= 0, seconds < 0):
        places = order[side[order]]
        parts = np.empty((len(places), 4)), np.empty((len(places), 3))
        _fill_in_order(motion, times[places], *parts)
        q[places], omega[places] = parts


def _fill_in_order(motion: KernelMotion, times: Real | ExactTimes, q: Real, omega: Real) -> None:
    first = 0
    while first < len(q):
        part = slice(first, first + STATES)
        written, status = motion.fill(times[part], q[part], omega[part], STEPS)
        first += written
        if status not in (OK, MORE_STEPS):
            raise _refuse_time(motion, float(to_rough_seconds(times)[first]), status)


def find_piece(motion: KernelMotion, t: ExactTimes) -> PieceRecord:
    """Return what moves at one time between two pushes.

    Raises
    ------
    ValueError
        If there is none; the reason names the time.
    """
    status = MORE_STEPS
    while status == MORE_STEPS:
        found, status = motion.find_piece(t, STEPS)
    if status != OK:
        raise _refuse_time(motion, float(t.rough_seconds), status)
    return found


def reach(motion: KernelMotion, t: float, steps: float) -> float:
    """Integrate towards a time in a limited number of steps, or as far as it can."""
    while True:
        reached, status = motion.reach(t, min(steps, STEPS))
        if status not in (MORE_STEPS, TOO_FAST, *NOT_PUSHED):
            demand(status)
        steps -= STEPS
        if status != MORE_STEPS or steps <= 0:
            return reached


def _refuse_time(motion: KernelMotion, t: float, status: int) -> Exception:
    """Return the error for a time at which there is no state."""
    if status == TOO_FAR:
        farthest = show_limit(motion.farthest_time)
        return refuse("t", f"less than {farthest} s from the start (1e15 turns)", t)
    if status not in (TOO_FAST, TOO_STIFF, TOO_LONG, *NOT_PUSHED):
        return refuse_status(status)
    reached = reach(motion, t, 0) if motion.engine == "taylor" else motion.farthest_time
    if status in NOT_PUSHED:
        why = f"the push then cannot be made: {WHY_NOT_PUSHED[status]}"
        return refuse("t", f"before {show_limit(reached)} s ({why})", t)
    if status == TOO_LONG:
        # No time can be named: back in time friction drives a top, and the steps become shorter.
        way = "ten million steps of integration (up to a minute)"
        return refuse("t", f"within {way} of what is reached, {reached:.3g} s", t)
    end = abs(reached)
    why = "the motion then becomes too fast"
    if status == TOO_STIFF:
        # After some decay times the top creeps, but explicit series cannot take longer steps.
        top, _, friction, _ = read_start(np.frombuffer(motion.start))
        decay = 1 / float(friction._find_decay(top))
        end += MOST_DECAYS * decay
        why = f"friction stops the top in {decay:.3g} s, and every such time takes a step"
    return refuse("t", f"within {end:.3g} s of the start ({why})", t)
