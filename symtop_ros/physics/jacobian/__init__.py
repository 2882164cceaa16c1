"""Derivatives of a motion's states by its top and its start, by differences of exact states.

A state is right to some roundings, however late it is and whatever it has passed. So what a motion
magnifies and reduces again on its way costs a difference no digits: near an unstable place it would
cost them to derivatives that are integrated along the motion.

A derivative comes from ten states, h apart. What it lacks is of the order (h/s)^10, where s is the
change of the parameter over which the states curve, and the rounding of the states, divided by h.
Both are estimated for each element, and the steps are changed until their sums are as promised:

- `nodes`: weights of values at ten nodes, and the error of their derivative;
- `neighbours`: starts next to the motion's, and where their states are;
- `rounding`: what the states are rounded to;
- `differences`: derivatives by one step of each parameter, with both errors;
- `steps`: the steps, longer or shorter by the larger of the two;
- `estimates`: means of what several steps have given;
- `settling`: the rounds, until all derivatives are right or none helps;
- `scales`: units of all this;
- `differentiable`: the protocol of a motion.

Here are the motions that need more: driven ones, and flat discs.
"""

import math
from typing import Any

import numpy as np

from symtop_ros.base.arrays import Real, compose, invert
from symtop_ros.base.refusals import refuse, show_limit
from symtop_ros.physics.arguments import read_start
from symtop_ros.physics.jacobian.differentiable import Differentiable
from symtop_ros.physics.jacobian.nodes import TINY
from symtop_ros.physics.jacobian.scales import find_rates
from symtop_ros.physics.jacobian.settling import Settling, refuse_time
from symtop_ros.physics.state import State
from symtop_ros.physics.times import ExactTimes, to_rough_seconds
from symtop_ros.physics.top import Top

FLAT = 1.6  # Iz/Ix, from which on steps of the moments would lead beyond the flat disc
# Part of omega by which friction and torque may change it and be left out. Derivatives change by it
# divided by the gap to the separatrix, of which 1e-12 is the narrowest one that is resolved.
WEAKEST = 2.0**-80
MOST_NUTATION = 2.0**14  # rad, for which a driven motion takes half a second


def differentiate(motion: Differentiable, times: Real | ExactTimes) -> Real:
    """Return the derivatives at times (n,), in s or exact, (n, 6, 9).

    Raises
    ------
    ValueError
        If the motion has no state at a time, or if no step resolves the derivatives there.
    """
    seconds = to_rough_seconds(times)
    if motion.is_driven and _changes_nothing(motion, seconds):
        # Without its steps: their errors grow where the axis comes back to an unstable vertical.
        return differentiate(_restart(motion, motion.top, motion.start), times)
    if motion.is_driven:
        _limit(motion, seconds)
    elif motion.top.Iz > FLAT * motion.top.Ix:
        return _differentiate_disc(motion, times)
    found = np.empty((len(seconds), 6, 9))
    groups = [np.argsort(np.abs(seconds))] if len(seconds) else []
    while groups:
        group = groups.pop()
        found[group], left = Settling(motion, times[group]).settle()
        if len(left) and len(group) == 1:
            raise refuse_time(float(seconds[group[0]]))
        # Few motions have times that need different steps.
        groups += [each for each in np.array_split(group[left], 2) if len(each)]
    return found


def _restart(motion: Differentiable, top: Top, start: State) -> Differentiable:
    """Return a motion of the same class, under gravity alone."""
    make: Any = type(motion)
    found: Differentiable = make(top, start)
    return found


def _changes_nothing(motion: Differentiable, times: Real) -> bool:
    """Return whether friction and torque are far too weak to be seen in derivatives by then."""
    fastest = find_rates(motion)[1]
    longest = float(np.abs(times).max(initial=0))
    drive = max(motion.friction.coefficients)
    drive += math.hypot(*motion.applied_torque) / (fastest or 1.0)
    change = drive / min(motion.top.Ix, motion.top.Iz) * longest
    return bool(change * (1 + fastest * longest) < WEAKEST)


def _limit(motion: Differentiable, times: Real) -> None:
    """Refuse times that some ninety driven motions take too long to reach."""
    longest = MOST_NUTATION / max(find_rates(motion)[0], TINY)
    for t in times[np.abs(times) > longest].tolist():
        within = f"within {show_limit(longest)} s of the start"
        raise refuse("t", f"{within} for derivatives with friction or a torque", t)


def _differentiate_disc(motion: Differentiable, times: Real | ExactTimes) -> Real:
    """Return the derivatives for a body next to the flat disc, which has no larger Iz.

    A body with half of Iz and twice the spin has the same Iz omega_z, so that its axis moves in the
    same way. It is turned about the axis by omega_z t, and can be made flatter.
    """
    row = np.frombuffer(motion._packed_start).copy()
    row[1], row[9] = row[1] / 2, 2 * row[9]
    top, start, *_ = read_start(row)
    other = _restart(motion, top, start)
    found = differentiate(other, times)
    state = motion.at(times)
    w, _, _, z = compose(invert(state.orientation), other.at(times).orientation).T[..., None]
    for x, y in (0, 1), (3, 4):  # of both bodies, in their own frames
        across, along = found[:, x].copy(), found[:, y].copy()
        found[:, x] = (w * w - z * z) * across - 2 * w * z * along
        found[:, y] = 2 * w * z * across + (w * w - z * z) * along
    found[:, :, 1], found[:, :, 8] = found[:, :, 1] / 2, 2 * found[:, :, 8]
    wx, wy, _ = state.angular_velocity.T
    t = to_rough_seconds(times)
    found[:, 2:, 8] -= np.stack((t, t * wy, -t * wx, np.ones_like(t)), axis=-1)
    return found
