"""Derivatives of a motion's states by its top and its start, by differences of exact states.

A state is right to some roundings, however late it is and whatever it has passed. So what a motion
magnifies and reduces again on its way costs a difference no digits: near an unstable place it would
cost them to derivatives that are integrated along the motion.

A derivative comes from ten states, h apart. What it lacks is of the order (h/s)^10, where s is the
change of the parameter over which the states curve, and the rounding of the states, divided by h.
Both are estimated for each element, and the steps are changed until their sums are as promised.

The nodes are unequally distant. A step that turns a phase by whole turns moves it to where it was:
at equally distant nodes a fast oscillation may look smooth, or like nothing. No step does so at all
of these nodes.
"""

import math
from typing import Any

import numpy as np

from symtop_ros.base.arrays import Places, Real, compose, find_rotation_vectors, invert
from symtop_ros.base.refusals import refuse
from symtop_ros.physics.arguments import STARTS, fill_states, read_start
from symtop_ros.physics.kernel import door, states
from symtop_ros.physics.times import ExactTimes, to_rough_seconds
from symtop_ros.physics.values import EPS

ORDER = 10  # of the derivatives, and as many nodes
PAIRS = (1.0, 2.13, 2.88, 4.07, 5.0)
# In steps, from the nearest: on both sides of 0, and on one.
CENTRAL = np.array([sign * node for node in PAIRS for sign in (1, -1)])
FORWARD = np.array((*PAIRS, 6.11, 6.93, 8.05, 9.12, 10.0))
TINY = 1e-300  # added to divisors that may be zero
LEAST_ERROR = 1e-140  # whose square has an inverse
RESPONSE = 0.25  # of the outermost states, in rad or in units of the fastest rate
FARTHEST = 2.0  # response beyond which states say nothing of a derivative
LARGEST_STEP = 0.03  # in units of the size of a parameter: 1/Ix curves over Ix
# Rounding of a state in a difference. Its standard deviation is 0.5 to 0.8 EPS.
STATE_ERROR = 3 * EPS
# It may also be this much of what is left in the tenth differences, of the fourth smallest of nine
# parameters: next to an unstable place five are smooth.
REMAINDERS, SMOOTH = 4, 4
# All states of a driven motion have an error of its steps, which no difference shows: after an
# unstable place it is some ten times as large.
DRIVEN_REMAINDERS = 48
FLAT = 1.6  # Iz/Ix, from which on steps of the moments would lead beyond the flat disc
NORM_ERROR = 0.999e-3  # of a given quaternion, nearly
PROMISED = 1e-8  # error of a derivative, in units of the largest of its block
# Smaller effects are measured by this one, in rad or in units of the spin, of a change by all of a
# moment, by 1 rad, or by the fastest rate.
SMALLEST = 1e-3
# Error of a row by the curvature of the other ones: next to the vertical the angle about the axis
# looks smooth by steps that are far too long for the tilt.
SPREAD = 2e-6
# Part of omega by which friction and torque may change it and be left out. Derivatives change by it
# divided by the gap to the separatrix, of which 1e-12 is the narrowest one that is resolved.
WEAKEST = 2.0**-80
WILD = 1e7  # promised errors; steps that leave so much in a row turn phases by whole turns
MOST_NUTATION = 2.0**14  # rad, for which a driven motion takes half a second
MOST_ROUNDS = 24
# Factors of a step from one round to the next. Those next to the best one are such that no step is
# taken twice.
LONGER, MOST_LONGER, SHORTER, MOST_SHORTER = 1.5, 1e6, 0.95, 0.02
NEXT = 1.09
UNRESOLVED = (
    "a time at which double precision resolves the derivatives (the start is too near the vertical "
    "or the separatrix)"
)
# Columns that are measured by their largest element: each moment, attitude, and omega.
ROWS = np.arange(2), np.arange(3)  # attitude and omega, and their components
FIRSTS, COUNTS = (0, 1, 2, 3, 6), (1, 1, 1, 3, 3)


def differentiate(motion: Any, times: Real | ExactTimes) -> Real:
    """Return the derivatives at times (n,), in s or exact, (n, 6, 9).

    Raises
    ------
    ValueError
        If the motion has no state at a time, or if no step resolves the derivatives there.
    """
    seconds = to_rough_seconds(times)
    if motion.is_driven and _changes_nothing(motion, seconds):
        # Without its steps: their errors grow where the axis comes back to an unstable vertical.
        return differentiate(type(motion)(motion.top, motion.start), times)
    if motion.is_driven:
        _limit(motion, seconds)
    elif motion.top.Iz > FLAT * motion.top.Ix:
        return _differentiate_disc(motion, times)
    found = np.empty((len(seconds), 6, 9))
    groups = [np.argsort(np.abs(seconds))] if len(seconds) else []
    while groups:
        group = groups.pop()
        found[group], left = _Starts(motion, times[group]).settle()
        if len(left) and len(group) == 1:
            raise refuse("t", UNRESOLVED, float(seconds[group[0]]))
        # Few motions have times that need different steps.
        groups += [each for each in np.array_split(group[left], 2) if len(each)]
    return found


def _changes_nothing(motion: Any, times: Real) -> bool:
    """Return whether friction and torque are far too weak to be seen in derivatives by then."""
    fastest = _find_rates(motion)[1]
    longest = float(np.abs(times).max(initial=0))
    drive = max(motion.friction.coefficients)
    drive += math.hypot(*motion.applied_torque) / (fastest or 1.0)
    change = drive / min(motion.top.Ix, motion.top.Iz) * longest
    return bool(change * (1 + fastest * longest) < WEAKEST)


def _limit(motion: Any, times: Real) -> None:
    """Refuse times that some ninety driven motions take too long to reach."""
    longest = MOST_NUTATION / max(_find_rates(motion)[0], TINY)
    for t in times[np.abs(times) > longest].tolist():
        within = f"within {longest:.3g} s of the start"
        raise refuse("t", f"{within} for derivatives with friction or a torque", t)


def _differentiate_disc(motion: Any, times: Real | ExactTimes) -> Real:
    """Return the derivatives for a body next to the flat disc, which has no larger Iz.

    A body with half of Iz and twice the spin has the same Iz omega_z, so that its axis moves in the
    same way. It is turned about the axis by omega_z t, and can be made flatter.
    """
    row = np.frombuffer(motion.packed_start).copy()
    row[1], row[9] = row[1] / 2, 2 * row[9]
    top, start, *_ = read_start(row)
    other = type(motion)(top, start)
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


class _Starts:
    """Starts around that of a motion, and derivatives by them at times that share their steps."""

    def __init__(self, motion: Any, times: Real | ExactTimes) -> None:
        self._times = times
        self._base = motion.at(times)
        self._seconds = to_rough_seconds(times)
        self._start = np.frombuffer(motion.packed_start)
        longest = float(np.abs(self._seconds).max())
        nutation, fastest = _find_rates(motion)
        rate = fastest or (1 / longest if longest else 1.0)
        Ix, Iz, Mgl = motion.top.moments
        # A top without weight has the size of the weight that would move it at its rate.
        weight = max(abs(Mgl), Ix * (nutation or rate) ** 2)
        self._sizes = np.array([Ix, Iz, weight, 1, 1, 1, rate, rate, rate])
        self._parameters = np.array([Ix, Iz, Mgl or weight, 1, 1, 1, rate, rate, rate])
        self._longest = self._sizes * LARGEST_STEP
        # The outermost orientations have a norm of 1 + (5 h)^2/8, times that of the given one.
        off = abs(float(np.linalg.norm(self._start[3:7])) - 1)
        self._longest[3:6] = min(LARGEST_STEP, math.sqrt(max(NORM_ERROR - off, 1e-6)) / 2)
        response = RESPONSE / 5 / (1 + rate * longest)
        self._steps = np.minimum(self._longest, self._sizes * response)
        self._too_long = np.full(9, -1)  # the element for which a step of a column was
        self._units = np.array([1.0, rate])  # of attitude and omega
        self._margin = 2 * Ix - Iz
        # The sizes of which errors are parts, 1 rad and the spin, (n, 2, 1); one at rest, too.
        spins = np.maximum(np.abs(self._base.angular_velocity).max(axis=-1), rate * 1e-3)
        self._counted = np.stack((np.ones(len(spins)), spins), axis=-1)[..., None]
        self._least, self._most = self._find_rounding(motion)
        self._remainders = DRIVEN_REMAINDERS if motion.is_driven else REMAINDERS
        self._left = np.full((len(self._seconds), 2, 3, 9), np.inf)

    def _find_rounding(self, motion: Any) -> tuple[Real, Real]:
        """Return the least and the largest sizes of what is rounded, (n, 2, 3, 1).

        Next to the vertical what is across the axis is small, and has digits of its own, at the
        time or at least where it is largest. A driven motion may amplify the rounding of its steps.
        """
        least = np.repeat(self._counted[:, :, None], 3, axis=2)
        w, x, y, z = np.moveaxis(self._base.orientation, -1, 0)
        least[:, 0, :2, 0] = (2 * np.hypot(w, z) * np.hypot(x, y))[:, None]
        least[:, 1, :2, 0] = np.hypot(*self._base.angular_velocity[:, :2].T)[:, None]
        if motion.is_driven:
            return least, np.full_like(least, np.inf)
        most = np.repeat(self._counted[:, :, None], 3, axis=2)
        most[:, :, :2] = np.array(_find_widths(motion))[:, None, None]
        least[:, 1, 2] = most[:, 1, 2] = 0  # omega_z is that of the start
        return least, np.maximum(most, least)

    def settle(self) -> tuple[Real, Places]:
        """Return the derivatives (n, 6, 9), and the places of times at which they are not right."""
        found = _Estimates(len(self._seconds))
        last = np.zeros_like(found.derivatives)
        left = np.arange(len(self._seconds))
        columns = np.arange(9)
        for _ in range(MOST_ROUNDS):
            part = np.ix_(left, *ROWS, columns)
            last[part], responses, curved, rough = self._differentiate(left, columns)
            limit = self._find_allowed(last[left], left)[..., columns]
            wildness = (curved / limit).max(axis=(1, 2), keepdims=True)
            curved = np.maximum(curved, limit * SPREAD * wildness)
            unusable = np.where(wildness > WILD, np.inf, 0.0)
            found.add(part, self._steps[columns], last[part], curved + unusable, rough)
            known = np.where(np.isinf(found.errors), last, found.derivatives)
            allowed = self._find_allowed(known[left], left)
            excess = found.errors[left] / allowed
            faults = allowed[..., columns], responses, curved, rough
            may_end = self._adapt(part, excess[..., columns], faults)
            is_open = excess > 1
            # A step about one axis of the body is rounded to one about all three.
            is_open[..., 3:6] = is_open[..., 3:6].any(axis=-1, keepdims=True)
            columns = np.flatnonzero(is_open.any(axis=(0, 1, 2)))
            left = left[is_open.any(axis=(1, 2, 3))]
            if not len(left) or not may_end:
                break
        return found.derivatives.reshape(-1, 6, 9), left

    def _find_allowed(self, derivatives: Real, some: Places) -> Real:
        """Return the promised errors of derivatives (m, 2, 3, 9), (m, 2, 1, 9)."""
        blocks = np.maximum.reduceat(np.abs(derivatives).max(axis=2), FIRSTS, axis=-1)
        largest = np.repeat(blocks, COUNTS, axis=-1)
        # An absolute error is left of parameters that hardly count, such as those of the start in
        # the first instants.
        least = SMALLEST * self._counted[some] / np.abs(self._parameters)
        return np.asarray(PROMISED * np.maximum(largest, least)[:, :, None] + TINY)

    def _adapt(self, part: Any, excess: Real, faults: tuple[Real, ...]) -> bool:
        """Change the steps of columns by their worst elements; return False if that is no use."""
        columns = part[-1].ravel()
        worst = excess.reshape(-1, len(columns)).argmax(axis=0)
        places = np.unravel_index(worst * len(columns) + np.arange(len(columns)), excess.shape)
        limit, responses, curved, rough = (
            np.broadcast_to(each, excess.shape)[places] for each in faults
        )
        elements = part[0].ravel()[places[0]] * 6 + worst % 6
        most = excess[places]
        is_near = self._too_long[columns] == elements
        is_long = curved > rough / 3
        is_open = most > 1
        # The best step has an error by curvature of a tenth of that by rounding.
        shorter = (rough / np.maximum(10 * curved, rough + TINY)) ** (1 / (ORDER + 1))
        shorter = np.where(responses > FARTHEST, RESPONSE / (4 * responses + TINY), shorter)
        shorter = np.clip(shorter, MOST_SHORTER, SHORTER)
        longer = np.where(is_near, NEXT, np.clip(3 * rough / limit, LONGER, MOST_LONGER))
        factors = np.where(is_long, shorter, longer)
        self._too_long[columns[is_long]] = elements[is_long]
        steps = np.minimum(self._steps[columns] * factors, self._longest[columns])
        # More steps reduce an error by rounding, by their root.
        is_lost = (steps == self._steps[columns]) | (
            is_near & ~is_long & (rough > MOST_ROUNDS / 3 * limit)
        )
        self._steps[columns[is_open]] = steps[is_open]
        return not (is_lost & is_open).any()

    def _list_nodes(self) -> Real:
        """Return those of each column, (9, 10): a flat disc has no larger Iz, and no smaller Ix."""
        nodes = np.tile(CENTRAL, (9, 1))
        of_Ix, of_Iz, *_ = 6 * self._steps
        if self._margin < 2 * of_Ix:
            nodes[0] = FORWARD
        if self._margin < of_Iz:
            nodes[1] = -FORWARD
        return nodes

    def _find_noise(self, left: Real, some: Places, columns: Places) -> Real:
        """Return the rounding of states (m, 2, 3, 1) by what is left in tenth differences.

        It is the same for all parameters, and most of them are smooth by the first steps.
        """
        part = np.ix_(some, *ROWS, columns)
        self._left[part] = np.minimum(self._left[part], left)
        return self._remainders * np.sort(self._left[some], axis=-1)[..., SMOOTH - 1 : SMOOTH]

    def _differentiate(self, some: Places, columns: Places) -> tuple[Real, Real, Real, Real]:
        """Return derivatives (m, 2, 3, c), responses, and errors by curvature and by rounding."""
        starts = self._list_starts()[columns]
        moved = self._follow(starts, some)
        given = self._measure(starts)[..., columns]
        places = np.arange(len(columns))
        nodes = given[places, :, places] / self._steps[columns, None]
        orders = np.stack([_weigh(nodes, count) for count in (ORDER, ORDER - 2, ORDER - 4)])
        by_order = np.einsum("ock,ckmar->omarc", orders, moved)
        inverses = np.linalg.inv(np.einsum("ock,ckp->opc", orders, given))
        tenth, eighth, sixth = by_order @ inverses[:, None, None]
        widths = np.abs(moved).max(axis=1).transpose(1, 2, 3, 0)
        responses = (widths / self._units[:, None, None]).max(axis=(1, 2), keepdims=True)
        left = np.abs(np.einsum("ck,ckmar->marc", _weigh_difference(nodes), moved))
        left[:, :, :2] = left[:, :, :2].max(axis=2, keepdims=True)
        across = np.array((1, 1, 0))[:, None]
        per_step = _measure_rounding(orders[0]) / self._steps[columns]
        least, most = (
            STATE_ERROR * (each[some] + across * widths) for each in (self._least, self._most)
        )
        rough = np.clip(self._find_noise(left, some, columns), least, most) * per_step
        curved = np.maximum(_find_curvature(tenth, eighth, sixth), 2 * left * per_step - rough)
        return tenth, responses, np.where(responses > FARTHEST, np.inf, curved), rough

    def _list_starts(self) -> Real:
        """Return the starts of the columns, (9, 10, 15)."""
        changes = np.zeros((9, STARTS[-1]))
        changes[:3, :3] = np.eye(3)
        changes[3:6, 3:7] = compose(self._start[3:7], np.eye(4)[1:]) / 2
        changes[6:, 7:10] = np.eye(3)
        changes *= self._steps[:, None]
        if (self._start + changes / 2 == self._start).all(axis=1).any():
            raise refuse("t", UNRESOLVED, float(self._seconds[0]))
        return np.asarray(self._start + self._list_nodes()[..., None] * changes[:, None])

    def _measure(self, starts: Real) -> Real:
        """Return how far starts (c, 10, 15) are from the motion's, (c, 10, 9), to all digits."""
        change = starts - self._start
        # The vector of q* (q + dq) is that of q* dq, in which nothing cancels.
        step = compose(invert(self._start[3:7]), change[..., 3:7])
        step[..., 0] += self._start[3:7] @ self._start[3:7]
        return np.concatenate((change[..., :3], find_rotation_vectors(step), change[..., 7:10]), -1)

    def _follow(self, starts: Real, some: Places) -> Real:
        """Return how far the states of starts (c, 10, 15) are from its own, (c, 10, m, 2, 3)."""
        times = self._times[some]
        rows = starts.reshape(-1, STARTS[-1])
        q, omega = np.empty((len(rows), len(some), 4)), np.empty((len(rows), len(some), 3))
        left = fill_states(rows, times, q, omega)
        for k in np.flatnonzero(left.any(axis=1)):
            states.fill_states(door.KernelMotion(rows[k].tobytes()), times, q[k], omega[k])
        base, rates = self._base.orientation[some], self._base.angular_velocity[some]
        turned = find_rotation_vectors(compose(invert(base), q))
        changes = np.stack((turned, omega - rates), axis=-2)
        return changes.reshape(*starts.shape[:2], *changes.shape[1:])


def _weigh(nodes: Real, count: int) -> Real:
    """Return weights of the derivatives at 0 by the first nodes of each row, (c, 10).

    They are those of values less the one at 0.
    """
    near = nodes[:, :count]
    ratios = near[:, None] / (near[:, None] - near[:, :, None] + np.diag(near[0]))
    ratios[:, range(count), range(count)] = 1
    weights = np.zeros_like(nodes)
    weights[:, :count] = ratios.prod(axis=2) / near
    return weights


def _weigh_difference(nodes: Real) -> Real:
    """Return weights of the tenth difference, in which all that is smooth cancels, (c, 10).

    What is left is rounding, as large as that of a value.
    """
    distances = nodes[:, :, None] - nodes[:, None]
    distances[:, range(ORDER), range(ORDER)] = nodes
    weights = 1 / distances.prod(axis=2)
    return np.asarray(weights / _measure_rounding(weights)[:, None])


def _measure_rounding(weights: Real) -> Real:
    """Return the rounding of a sum in units of that of a value; the one at 0 is rounded, too."""
    return np.asarray(np.sqrt(np.square(weights).sum(axis=1) + weights.sum(axis=1) ** 2))


def _find_curvature(tenth: Real, eighth: Real, sixth: Real) -> Real:
    """Return about twice the error of derivatives of the tenth order by what they leave out.

    The differences between the orders fall by the same factor from each to the next.
    """
    near, far = np.abs(tenth - eighth), np.abs(eighth - sixth)
    return np.asarray(2 * near * (near / np.maximum(np.maximum(far, near), TINY)))


class _Estimates:
    """Means of derivatives by several steps, (n, 2, 3, 9), and their errors.

    Each estimate counts by the inverse square of its error: next to the vertical no one step suits
    the phases and the small tilt. Where two contradict each other the shorter step is right.
    """

    def __init__(self, count: int) -> None:
        shape = count, 2, 3, 9
        self.derivatives, self._curved, self._rough, self._weights = np.zeros((4, *shape))
        self.errors, self._shortest = np.full((2, *shape), np.inf)

    def add(self, part: Any, steps: Real, new: Real, curved: Real, rough: Real) -> None:
        """Add estimates with errors by curvature, which they share, and by rounding."""
        changes = new - self.derivatives[part]
        errors = curved + rough
        weights = 1 / np.square(np.maximum(errors, LEAST_ERROR))
        before = self._weights[part]
        is_shorter = steps < self._shortest[part]
        differ = np.abs(changes) > 2 * (errors + self.errors[part])
        weights = np.where(differ & ~is_shorter, 0.0, weights)
        before = np.where(differ & is_shorter, 0.0, before)
        share = weights / np.maximum(weights + before, TINY)
        curved = np.where(share > 0, curved, 0.0)
        self.derivatives[part] += share * changes
        self._curved[part] += share * (curved - self._curved[part])
        self._rough[part] = np.hypot((1 - share) * self._rough[part], share * rough)
        self._weights[part] = weights + before
        means = self._curved[part] + self._rough[part]
        self.errors[part] = np.where(weights + before > 0, means, np.inf)
        self._shortest[part] = np.minimum(self._shortest[part], np.where(share > 0, steps, np.inf))


def _find_rates(motion: Any) -> tuple[float, float]:
    """Return rates in rad/s that the axis and the body hardly exceed; 0 for a body at rest."""
    Ix, Iz, Mgl = motion.top.moments
    wx, wy, wz = motion.start.angular_velocity.tolist()
    swing = math.sqrt((abs(Mgl) + math.hypot(*motion.applied_torque)) / Ix)
    nutation = math.hypot(wx, wy, 2 * swing, Iz / Ix * wz)
    return nutation, math.hypot(nutation, wz)


def _find_widths(motion: Any) -> tuple[float, float]:
    """Return the largest sine of the tilt and the largest omega across the axis, without a drive.

    Near the vertical they are small, and have the relative precision of all numbers.
    """
    Ix, _, Mgl = motion.top.moments
    wx, wy, _ = motion.start.angular_velocity.tolist()
    least, most = motion.turning_angles
    sine = 1.0 if least < math.pi / 2 < most else max(math.sin(least), math.sin(most))
    height = 2 * math.sin((most + least) / 2) * math.sin((most - least) / 2)
    return sine, math.sqrt(wx * wx + wy * wy + 2 * abs(Mgl) / Ix * height)
