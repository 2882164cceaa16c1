"""Derivatives of a motion's states by its top and its start, by differences of exact states.

A state is right to some roundings, however late it is and whatever it has passed. So what a motion
magnifies and reduces again on its way costs a difference no digits: near an unstable place it would
cost them to derivatives that are integrated along the motion.

The step h of a parameter is the one that moves the states by `RESPONSE`. The derivative comes from
six states. What it lacks is of the order (h/s)^6, where s is the change of the parameter over which
the states curve, and the rounding of the states, divided by h.
"""

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from symtop_ros.arrays import Real, compose, find_rotation_vectors, invert
from symtop_ros.physics.arguments import STARTS, fill_states
from symtop_ros.physics.kernel import states
from symtop_ros.physics.kernel.door import KernelMotion
from symtop_ros.physics.values import EPS, refuse

# Nodes in steps; the weights of the sixth order, and of the fourth, with fewer nodes; and those of
# the sixth difference, in which all that is smooth cancels, and rounding is left.
CENTRAL = np.array(
    (
        (-3, -2, -1, 1, 2, 3),
        (-1 / 60, 3 / 20, -3 / 4, 3 / 4, -3 / 20, 1 / 60),
        (0, 1 / 12, -2 / 3, 2 / 3, -1 / 12, 0),
        np.array((1, -6, 15, 15, -6, 1)) / math.sqrt(924),
    )
)
# A flat disc has no larger Iz, and no smaller Ix.
FORWARD = np.array(
    (
        (1, 2, 3, 4, 5, 6),
        (6, -15 / 2, 20 / 3, -15 / 4, 6 / 5, -1 / 6),
        (4, -3, 4 / 3, -1 / 4, 0, 0),
        np.array((-6, 15, -20, 15, -6, 1)) / math.sqrt(924),
    )
)
RESPONSE = 0.03  # of the outermost states, in rad or in units of the fastest rate
LARGEST_STEP = 0.01  # in units of a parameter's size: 1/Ix curves over Ix
# The difference between the two orders is the error of the fourth, (h/s)^4: that of the sixth is
# then below 1e-9.
LARGEST_DIFFERENCE = 3e-7
STATE_ERROR = 2 * EPS  # of the states in a difference, which are rounded at random
LARGEST_ROUNDING = 5e-10  # of a derivative, in units of the largest of its block
PROMISED = 1e-8  # error of a derivative, in units of the largest of its block
# Smaller effects are measured by this one, in units of the effect on the whole state, or of the one
# of a change by all of a parameter.
SMALLEST = 1e-3
UPRIGHT = 1e-7  # rad; a smaller tilt hardly feels its moments
MOST_NUTATION = 2.0**14  # rad, for which a driven motion takes half a second
TINY = 1e-300  # added to divisors that may be zero
MOST_ROUNDS = 30
SHORTEST = 1e-6  # smallest factor of a step from one round to the next
OTHER = 0.618  # factor of a step by which a derivative is confirmed
UNRESOLVED = (
    "a time at which double precision resolves the derivatives (the start is too near the vertical "
    "or the separatrix)"
)
# Columns that are measured by their largest element: each moment, attitude, and omega.
FIRSTS, COUNTS = (0, 1, 2, 3, 6), (1, 1, 1, 3, 3)
Truths = NDArray[np.bool_]


def differentiate(motion: Any, times: Real) -> Real:
    """Return the derivatives at times (n,) in s, (n, 6, 9).

    Raises
    ------
    ValueError
        If the motion has no state at a time, or if no step resolves the derivatives there.
    """
    if motion.is_driven:
        _limit(motion, times)
    found = np.empty((len(times), 6, 9))
    groups = [np.argsort(np.abs(times))] if len(times) else []
    while groups:
        group = groups.pop()
        found[group], left = _Stencil(motion, times[group]).settle()
        if len(left) and len(group) == 1:
            raise refuse("t", UNRESOLVED, float(times[group[0]]))
        # Few motions have times that need different steps.
        groups += [each for each in np.array_split(group[left], 2) if len(each)]
    return found


def _limit(motion: Any, times: Real) -> None:
    """Refuse times that some fifty driven motions take too long to reach."""
    longest, farthest = (
        MOST_NUTATION / max(_find_rates(motion)[0], TINY),
        np.abs(times).max(initial=0),
    )
    if farthest > longest:
        condition = f"at most {longest:.3g} s for derivatives with friction or a torque"
        raise refuse("t", condition, float(farthest))


class _Stencil:
    """Starts around that of a motion, and derivatives by them at times that share their steps."""

    def __init__(self, motion: Any, times: Real) -> None:
        self._times, self._base = times, motion.at(times)
        self._start = np.frombuffer(motion.packed_start)
        longest = float(np.abs(times).max())
        nutation, fastest = _find_rates(motion)
        rate = fastest or (1 / longest if longest else 1.0)
        Ix, Iz, Mgl = motion.top.moments
        # A top without weight has the size of the weight that would move it at its rate.
        weight = max(abs(Mgl), Ix * (nutation or rate) ** 2)
        self._sizes = np.array([Ix, Iz, weight, 1, 1, 1, rate, rate, rate])
        self._parameters = np.array([Ix, Iz, Mgl or weight, 1, 1, 1, rate, rate, rate])
        self._longest = self._sizes * LARGEST_STEP
        self._steps = self._sizes * min(LARGEST_STEP, RESPONSE / 3 / (1 + rate * longest))
        w, x, y, z = np.abs(self._start[3:7]).tolist()
        self._is_upright = 0 < 2 * min(math.hypot(x, y), math.hypot(w, z)) < UPRIGHT
        self._is_driven = motion.is_driven
        self._targets = np.full(9, RESPONSE)
        self._winding = 1 + rate * np.abs(times)  # rad by which phases have turned, at most
        self._units = np.array([1.0, rate])  # of attitude and omega
        self._schemes = np.stack([CENTRAL] * 9)
        if 2 * Ix - Iz < 8 * LARGEST_STEP * Iz:
            self._schemes[:2] = FORWARD, -FORWARD

    def settle(self) -> tuple[Real, NDArray[np.intp]]:
        """Return the derivatives (n, 6, 9), and the places of times at which they are not right.

        Steps become smaller or larger until all are right.
        """
        count = len(self._times)
        found, done = np.empty((count, 2, 3, 9)), np.zeros((count, 2, 9), np.bool_)
        last, left = np.full(found.shape, np.nan), np.arange(count)
        for _ in range(MOST_ROUNDS):
            columns = np.flatnonzero(~done.all(axis=(0, 1)))
            derivatives, responses, are_curved, roughness = self._differentiate(left, columns)
            found[left] = np.where(done[left][:, :, None], found[left], derivatives)
            are_unsure = self._are_unsure(derivatives, last[left], left)
            last[left] = derivatives
            done[left] |= ~_spread_over_blocks(are_curved | (roughness > 1) | are_unsure)
            are_open = ~done[left]
            left = np.flatnonzero(~done.all(axis=(1, 2)))
            faults = responses, are_curved, roughness, are_unsure
            if not len(left) or not self._adapt(
                *((each * are_open).max(axis=(0, 1)) for each in faults)
            ):
                break
        return found.reshape(count, 6, 9), left

    def _are_unsure(self, new: Real, last: Real, some: NDArray[np.intp]) -> Truths:
        """Return which derivatives another step has to confirm, (m, 2, 9).

        If a step turns a phase by whole turns, states that are moved by it look smooth. A small
        nutation shows no other sign of that.
        """
        turned = 3 * self._steps / self._sizes * self._winding[some, None]
        least = SMALLEST * self._units[:, None] / self._sizes
        largest = np.maximum(_spread_over_blocks(np.abs(new).max(axis=2)), least)
        confirmed = np.abs(new - last).max(axis=2) <= 10 * PROMISED * largest
        return np.asarray((turned > 1)[:, None] & ~confirmed)

    def _adapt(
        self, responses: Real, are_curved: Truths, roughness: Real, are_unsure: Truths
    ) -> bool:
        """Change the steps of columns, (9,); return False if none changes."""
        self._targets[are_curved & (responses < 2 * self._targets)] /= 2
        shorter = np.minimum(self._targets / np.maximum(responses, SHORTEST), 0.5)
        longer = np.clip(2 * roughness, 1.0, 1 / SHORTEST)
        longer[roughness <= 1] = np.where(are_unsure, OTHER, 1.0)[roughness <= 1]
        steps = np.minimum(self._steps * np.where(are_curved, shorter, longer), self._longest)
        self._longest[are_curved] = steps[are_curved]
        changes = bool((steps != self._steps).any())
        self._steps = steps
        return changes

    def _differentiate(
        self, some: NDArray[np.intp], columns: NDArray[np.intp]
    ) -> tuple[Real, Real, Truths, Real]:
        """Return derivatives (m, 2, 3, 9), responses and faults (m, 2, 9); 0 in other columns."""
        nodes, *orders, difference = np.moveaxis(self._schemes[columns], 1, 0)
        starts = self._start + nodes[..., None] * self._list_changes()[columns, None]
        moved, given = self._follow(starts, some), self._measure(starts)[..., columns]
        sixth, fourth = np.zeros((2, len(some), 2, 3, 9))
        for by_order, weights in zip((sixth, fourth), orders, strict=True):
            steps = np.linalg.inv(np.einsum("ck,ckp->pc", weights, given))
            by_order[..., columns] = np.einsum("ck,ckmar->marc", weights, moved) @ steps
        responses, remainders = np.zeros((2, len(some), 2, 9))
        responses[..., columns] = np.abs(moved).max(axis=(1, 4)).transpose(1, 2, 0)
        responses /= self._units[:, None]
        remainders[..., columns] = np.abs(np.einsum("ck,ckmar->marc", difference, moved)).max(
            axis=2
        )
        are_curved, roughness = self._find_faults(sixth, fourth, remainders, responses, some)
        return sixth, responses, are_curved | (responses > 10 * RESPONSE), roughness

    def _list_changes(self) -> Real:
        """Return a step of each column, as changes (9, 15) of the numbers of a start."""
        changes = np.zeros((9, STARTS[-1]))
        turns = compose(self._start[3:7], np.eye(4)[1:]) / 2
        changes[:3, :3] = np.eye(3)
        changes[3:6, 3:7] = turns
        changes[6:, 7:10] = np.eye(3)
        changes *= self._steps[:, None]
        # In units in which the nodes are exact, so that they are equally far from each other.
        units = np.spacing(np.abs(self._start) + 8 * np.abs(changes))
        changes = np.rint(changes / units) * units
        if not changes.any(axis=1).all():
            raise refuse("t", UNRESOLVED, float(self._times[0]))
        return np.asarray(changes)

    def _measure(self, starts: Real) -> Real:
        """Return how far starts (c, 6, 15) are from the motion's, (c, 6, 9), to all digits."""
        change = starts - self._start
        # The vector of q* (q + dq) is that of q* dq, in which nothing cancels.
        step = compose(invert(self._start[3:7]), change[..., 3:7])
        step[..., 0] += self._start[3:7] @ self._start[3:7]
        return np.concatenate((change[..., :3], find_rotation_vectors(step), change[..., 7:10]), -1)

    def _follow(self, starts: Real, some: NDArray[np.intp]) -> Real:
        """Return how far the states of starts (c, 6, 15) are from the motion's, (c, 6, m, 2, 3)."""
        times, rows = self._times[some], starts.reshape(-1, STARTS[-1])
        q, omega = np.empty((len(rows), len(times), 4)), np.empty((len(rows), len(times), 3))
        left = fill_states(rows, times, q, omega)
        for k in np.flatnonzero(left.any(axis=1)):
            states.fill_states(KernelMotion(rows[k].tobytes()), times, q[k], omega[k])
        base, rates = self._base.orientation[some], self._base.angular_velocity[some]
        turned = find_rotation_vectors(compose(invert(base), q))
        changes = np.stack((turned, omega - rates), axis=-2)
        return changes.reshape(*starts.shape[:2], *changes.shape[1:])

    def _find_faults(
        self,
        sixth: Real,
        fourth: Real,
        remainders: Real,
        responses: Real,
        some: NDArray[np.intp],
    ) -> tuple[Truths, Real]:
        """Return which derivatives are curved too much, and how much too rough by rounding."""
        largest = _spread_over_blocks(np.abs(sixth).max(axis=2))
        spins = np.abs(self._base.angular_velocity[some]).max(axis=-1)
        # What is rounded: 1 in a quaternion, and the spin. A body at rest has a size, too.
        spins = np.maximum(spins, self._units[1] * 1e-3)
        sizes = np.stack((np.ones(len(some)), spins), axis=-1)[..., None]
        weights = self._schemes[:, 1]
        norms = np.sqrt(np.square(weights).sum(axis=1)) / self._steps
        lost = STATE_ERROR * norms * sizes
        are_curved = np.abs(sixth - fourth).max(axis=2) > LARGEST_DIFFERENCE * largest + lost
        are_noisy = np.zeros_like(are_curved)
        if self._is_driven:
            # An unstable one amplifies the rounding of its steps: a state may lose more.
            left = 4 * norms * remainders
            are_noisy = left > PROMISED * largest + 12 * lost
        # What is left of states that have moved far is curvature as well.
        has_moved = responses.max(axis=1, keepdims=True) > RESPONSE / 100
        are_curved |= are_noisy & has_moved
        # Where a longer step is of no use, an absolute error is left of rows that happen to change
        # little, such as omega after a whole nutation, and of parameters that hardly count.
        effect = (largest / sizes).max(axis=1, keepdims=True)
        least = SMALLEST * sizes * np.maximum(effect, 1 / np.abs(self._parameters))
        wanted = np.where(
            self._steps < self._longest,
            LARGEST_ROUNDING * largest,
            PROMISED * np.maximum(largest, least),
        )
        if self._is_upright:
            # Of the moments the rounding of the spin's angle remains.
            wanted[..., :3] = PROMISED * largest[..., :3].max(axis=-1, keepdims=True)
        roughness = lost / np.maximum(wanted, SHORTEST * lost + TINY)
        return are_curved, np.where(are_noisy & ~has_moved, 10.0, roughness)


def _spread_over_blocks(values: Any) -> Any:
    """Return the largest value of its block for each column, (..., 9)."""
    return np.repeat(np.maximum.reduceat(values, FIRSTS, axis=-1), COUNTS, axis=-1)


def _find_rates(motion: Any) -> tuple[float, float]:
    """Return rates in rad/s that the axis and the body hardly exceed; 0 for a body at rest."""
    Ix, Iz, Mgl = motion.top.moments
    wx, wy, wz = motion.start.angular_velocity.tolist()
    swing = math.sqrt((abs(Mgl) + math.hypot(*motion.applied_torque)) / Ix)
    nutation = math.hypot(wx, wy, 2 * swing, Iz / Ix * wz)
    return nutation, math.hypot(nutation, wz)
