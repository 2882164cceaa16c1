"""Many values of a parameter, and the best constant rotations for each of them.

The rotations have a closed form. For a rotation of one frame the least squares are an eigenvalue of
a matrix of four rows (Markley et al. 2007). For both frames the turns from one estimate to the next
have the same angles as the exact ones, about axes that the body's rotation has turned (the hand-eye
problem, Park and Martin 1994).
"""

from collections.abc import Collection
from dataclasses import dataclass, field, replace

import numpy as np
from scipy.spatial.transform import Rotation

from symtop_ros.base.arrays import Places, Real, compose, find_rotation_vectors, invert
from symtop_ros.truth.judge.alignment import MOST_DELAY
from symtop_ros.truth.judge.causes import set_parameter
from symtop_ros.truth.judge.compare import IDENTITY, NONE, Offset, Scaling
from symtop_ros.truth.judge.truth import Truth
from symtop_ros.truth.topics.estimates import Estimates

# Angle (rad) by which one step of a parameter turns the attitude, and the largest number of steps.
GRID_STEP, MOST_STEPS = 0.5, 1000
MOST_CLOCK, MOST_SCALE = 5e-3, 0.05  # s per s, and part of the scale of a gyroscope
WHOLE = 8 * 2 * np.pi  # rad, of world or body within the run, by a drift
BATCH = 32  # scales whose paths are computed together; more would not fit into a cache
COARSE = 150  # estimates that the search takes; the refinement takes SAMPLES
# An eigenvalue at a grid point is at most a quarter of a step from the best value; with more than
# this left, nothing is explained there.
HOPELESS = 0.05  # mean square of half angles
# Components that a rotation of a level may have; other levels have all.
FREE = {"none": (1, 0, 0, 0), "heading": (1, 0, 0, 1)}
Models = tuple[Real, Real, Real]  # estimates and exact attitudes (g, n, 4), and the known (g, n)
Fitted = tuple[Real, Real, Real]  # costs (g,), and rotations of the world and the body, (g, 4)


@dataclass(eq=False)
class Tables:
    """Predicted attitudes for values of parameters; exact attitudes of whole ranges are cached."""

    truth: Truth
    fastest: float  # angular velocity of the motion in rad/s
    kept: dict[tuple[str, bool], tuple[Real, Real]] = field(default_factory=dict)

    def tabulate(
        self, some: Estimates, name: str, base: Offset = NONE, values: Real | None = None
    ) -> tuple[Real, Models]:
        """Return values (g,) of a parameter, the whole range if none are given, and their models.

        Without a name there is one model, that of the base. The drift of the base is removed from
        the estimates.
        """
        some, is_whole = some.thin(COARSE) if name else some, values is None
        if values is None:
            values = self._list_values(name, float(some.stamps[-1] - some.stamps[0]) * 1e-9)
        base = replace(base, begin=int(some.stamps[0]), world=IDENTITY, body=IDENTITY)
        offsets = [set_parameter(base, name, each) for each in values.tolist()]
        kept = self.kept.get((name, some.of_sensor)) if is_whole else None
        exact, known = kept or self._find_exact(some, name, offsets)
        if is_whole:
            self.kept[name, some.of_sensor] = exact, known
        q = some.orientations[np.newaxis]
        if name == "drift" or base.drift:
            q = np.stack([compose(invert(e.turn_world(some.stamps)), q[0]) for e in offsets])
        q, exact = (np.broadcast_to(p, (len(values), len(some), 4)) for p in (q, exact))
        return values, (q, exact, np.broadcast_to(known, q.shape[:2]))

    def _find_exact(self, some: Estimates, name: str, offsets: list[Offset]) -> tuple[Real, Real]:
        """Return exact attitudes, as the body shows them, and which are known."""
        moved = offsets if name in ("delay", "clock") else offsets[:1]
        stamps = np.concatenate([each.shift(some.stamps) for each in moved])
        exact, _, known = self.truth.states_at(stamps, some.of_sensor)
        exact = exact.reshape(len(moved), -1, 4)
        if name == "scale":
            turn = Scaling(self.truth, some.stamps).turn
            scales = [e.scale for e in offsets]
            parts = np.array_split(np.array(scales), len(scales) // BATCH + 1)
            exact = compose(np.concatenate([turn(each) for each in parts]), exact)
        if name == "spin":
            exact = compose(exact, np.stack([each.turn_body(some.stamps) for each in offsets]))
        return exact, known.reshape(len(moved), -1).astype(np.float64)

    def _list_values(self, name: str, span: float) -> Real:
        """Return the values of a parameter that are tried, in a run of a span in s."""
        span = max(span, 1e-9)  # all estimates may have one stamp: a clock stood still
        angle = max(self.fastest * span, 1.0)
        most, turn = {  # the largest value, and by how many rad it turns the attitude
            "": (0.0, 0.0),
            "delay": (MOST_DELAY, MOST_DELAY * self.fastest),
            "clock": (MOST_CLOCK, MOST_CLOCK * angle),
            "scale": (min(MOST_SCALE, WHOLE / angle), min(MOST_SCALE * angle, WHOLE)),
        }.get(name, (WHOLE / span, WHOLE))
        count = int(min(max(turn / GRID_STEP, 10), MOST_STEPS)) if name else 0
        return np.linspace(-most, most, 2 * count + 1)


def fit_levels(models: Models, levels: Collection[str]) -> dict[str, Fitted]:
    """Return the rotations of several levels, by their names, as `fit_rotations` does."""
    q, exact, known = models
    still = np.broadcast_to(IDENTITY, (len(q), 4))
    sums: Real | None = None  # of the levels without a rotation of the body
    found = {}
    for level in levels:
        if level == "both":
            bodies = _guess_bodies(q, exact, known)
            turned = compose(exact, bodies[:, np.newaxis])
            costs, worlds = _find_nearest(_multiply(compose(q, invert(turned)), known), known)
            found[level] = costs, worlds, bodies
        elif level == "body":
            costs, bodies = _find_nearest(_multiply(compose(invert(exact), q), known), known)
            found[level] = costs, still, bodies
        else:
            free = np.array(FREE.get(level, (1, 1, 1, 1)))
            sums = _multiply(compose(q, invert(exact)), known) if sums is None else sums
            costs, worlds = _find_nearest(sums * np.outer(free, free), known)
            found[level] = costs, worlds, still
    return found


def fit_rotations(models: Models, level: str) -> Fitted:
    """Return the rotations W and M of a level, for which W exact M is nearest to the estimates.

    Return the approximate mean squares of the remaining half angles, (g,), then W and M, (g, 4).
    """
    return fit_levels(models, [level])[level]


def _multiply(left: Real, known: Real) -> Real:
    """Return the sums of products of the components of the residuals, (g, 4, 4)."""
    left = left * known[..., np.newaxis]
    return np.asarray(np.swapaxes(left, 1, 2) @ left)


def _find_nearest(sums: Real, known: Real) -> tuple[Real, Real]:
    """Return the approximate mean squares of half angles, (g,), and the nearest rotations."""
    sizes, vectors = np.linalg.eigh(sums)
    means = vectors[..., -1]
    counts = known.sum(axis=1)
    costs = np.maximum(1 - sizes[:, -1] / np.maximum(counts, 1), 0.0)
    costs[counts < max(2, known.shape[1] // 2)] = np.inf
    return costs, np.asarray(means * np.copysign(1.0, means[:, :1]))


def _guess_bodies(q: Real, exact: Real, known: Real) -> Real:
    """Return rotations M of the body, (g, 4)."""
    ours, theirs = (find_rotation_vectors(compose(invert(p[:, :-1]), p[:, 1:])) for p in (q, exact))
    both = (known[:, 1:] * known[:, :-1])[..., np.newaxis]
    u, _, vt = np.linalg.svd(np.swapaxes(theirs * both, 1, 2) @ (ours * both))
    u[..., -1] *= np.linalg.det(u @ vt)[:, np.newaxis]  # a rotation, not a reflection
    return np.asarray(Rotation.from_matrix(u @ vt).as_quat()[:, [3, 0, 1, 2]])


def find_minima(costs: Real, most: int, limit: float) -> Places:
    """Return the places of the lowest minima of costs (g,), at most `most`, below a limit."""
    padded = np.pad(costs, 1, constant_values=np.inf)
    low = (costs <= padded[:-2]) & (costs <= padded[2:]) & (costs <= limit)
    places = np.flatnonzero(low)
    return np.asarray(places[np.argsort(costs[places], kind="stable")][:most])


def find_depths(costs: Real) -> tuple[Places, Real]:
    """Return the lowest of each row of costs (v, k), and the least of the parabola next to it."""
    rows = np.arange(len(costs))
    best = costs.argmin(axis=1)
    middle = np.clip(best, 1, costs.shape[1] - 2)
    low, own, high = (costs[rows, middle + step] for step in (-1, 0, 1))
    with np.errstate(invalid="ignore"):  # next to delays at which nothing is known
        bend, tilt = low - 2 * own + high, (high - low) / 2
        depths = own - np.where(bend > 0, tilt**2 / np.where(bend > 0, 2 * bend, 1.0), 0.0)
    known = np.isfinite(depths) & (best == middle)
    return best, np.where(known, depths, costs[rows, best])
