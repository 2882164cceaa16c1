"""Causes of errors: changes of convention, parameters, what a search has found, likely mistakes.

Tables of many values of a parameter have the best constant rotations for each in closed form. For a
rotation of one frame the least squares are an eigenvalue of a matrix of four rows (Markley et al.
2007). For both frames the turns from one estimate to the next have the same angles as the exact
ones, about axes that the body's rotation has turned (the hand-eye problem, Park and Martin 1994).
Mistakes are conventions that were mixed up, found by undoing each of them.
"""

from collections.abc import Callable, Iterator
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
from scipy.spatial.transform import Rotation

from symtop_ros.base.arrays import Real, compose, find_rotation_vectors, invert
from symtop_ros.truth.judge.compare import IDENTITY, NONE, Errors, Offset, Scaling, compare
from symtop_ros.truth.judge.estimates import Estimates
from symtop_ros.truth.judge.fit import MOST_DELAY, PARAMETERS, SAMPLES
from symtop_ros.truth.judge.truth import Truth
from symtop_ros.truth.testset.score import turn_to_body
from symtop_ros.words import write

# Which rotations are free, with their columns of derivatives, and how much each counts when the
# simplest explanation is looked for.
LEVELS: dict[str, tuple[tuple[int, ...], float]] = {
    "none": ((), 0.0),
    "heading": ((2,), 1.0),
    "world": ((0, 1, 2), 2.5),
    "body": ((3, 4, 5), 2.5),
    "both": ((0, 1, 2, 3, 4, 5), 5.0),
}
# East-north-up to north-east-down, and forward-left-up to forward-right-down.
FLIP_WORLD, FLIP_BODY = np.array([[0.0, np.sqrt(0.5), np.sqrt(0.5), 0.0], [0.0, 1.0, 0.0, 0.0]])
ALL = tuple(LEVELS)
Undoing = Callable[[Estimates], Estimates]
# A parameter is tried in steps in which it turns the attitude by so many rad, and at most so often.
GRID_STEP, MOST_STEPS = 0.5, 1000
MOST_CLOCK, MOST_SCALE = 5e-3, 0.05  # s per s, and part of the scale of a gyroscope
WHOLE = 8 * 2 * np.pi  # rad, of world or body within the run, by a drift
BATCH = 32  # scales of which paths are computed together, as far as a cache reaches
COARSE = 150  # estimates that the search takes; the refinement takes SAMPLES
# An eigenvalue at a grid point is at most a quarter of a step from the best value; with more than
# this left, nothing is explained there.
HOPELESS = 0.05  # mean square of half angles
# Components that a rotation of a level may have; of the other levels all.
FREE = {"none": (1, 0, 0, 0), "heading": (1, 0, 0, 1)}
Models = tuple[Real, Real, Real]  # estimates and exact attitudes (g, n, 4), and the known (g, n)
VELOCITIES: dict[str, Callable[[Real, Real], Real]] = {
    "the angular velocities are in deg/s": lambda q, omega: np.radians(omega),
    "the angular velocities are in the world frame": turn_to_body,
    "the angular velocities are in deg/s, in the world frame": lambda q, omega: turn_to_body(
        q, np.radians(omega)
    ),
}
SIGNIFICANT = 6.0  # deviations: thousands of values are tried
MUCH = 10.0  # a change explains an error that it makes this many times smaller
SMALL = 0.05  # part of the rates; smaller errors are no mistakes of convention


@dataclass(frozen=True, eq=False)
class Cause:
    """One explanation, and what it leaves."""

    change: str
    level: str  # which rotations are free
    parameters: tuple[str, ...]
    offset: Offset
    cost: float  # mean square of the distances of quaternions
    # standard deviations of the parameters and of the rotations (rad); none if they were not asked
    # for, or cannot be given
    deviations: tuple[float, ...] = ()
    turn_deviation: float = 0.0
    independent: float | None = (
        None  # number of independent estimates, if deviations were asked for
    )
    fault: str = ""  # why there are no deviations: "few", "wanders"
    correlation_time: float = 0.0  # s

    @property
    def weight(self) -> float:
        """Number of assumptions that it makes; smaller is simpler."""
        return CHANGES[self.change][0] + LEVELS[self.level][1] + len(self.parameters)

    @property
    def residual(self) -> float:
        """Root mean square of the angle that is left in rad."""
        return float(np.sqrt(4 * self.cost))

    @property
    def turns(self) -> float:
        """Sum of both rotations in rad."""
        return float(sum(self.offset.angles))

    @property
    def kind(self) -> tuple[str, str, tuple[str, ...]]:
        """Its kind, without numbers."""
        return self.change, self.level, self.parameters

    @property
    def columns(self) -> list[int]:
        """Columns of the derivatives that are free."""
        return [*LEVELS[self.level][0], *(PARAMETERS[name] for name in self.parameters)]

    @property
    def count(self) -> int:
        """Number of parameters and components of rotations."""
        return len(self.columns)

    @property
    def is_significant(self) -> bool:
        """True if all parameters and the rotations are many deviations from zero."""
        sizes = [abs(getattr(self.offset, name)) for name in self.parameters]
        pairs = [*zip(sizes, self.deviations, strict=True)] if self.deviations else []
        turned = [(self.turns, self.turn_deviation)] if self.level != "none" else []
        return all(size > SIGNIFICANT * deviation for size, deviation in [*pairs, *turned])


@dataclass(frozen=True, eq=False)
class Finding:
    """An explanation of the errors of estimates."""

    best: Cause
    others: tuple[Cause, ...] = ()  # as simple and as good
    hidden: tuple[str, ...] = ()
    explained: bool = True  # False: most of the error is left
    fault: str = ""  # why no cause is given: "few", "wanders"
    # a cause that is significant and leaves clearly less, but not noise: it may be only a part
    candidate: Cause | None = None
    still: bool = False  # True: the estimates do not move, and the top does
    period: float | None = None  # s; delays that differ by it are as good, with `repeated`
    repeated: Offset = NONE


def set_parameter(offset: Offset, name: str, value: float) -> Offset:
    """Return an offset with a parameter; without a name, the same."""
    changed: dict[str, Any] = {name: value} if name else {}
    return replace(offset, **changed)


def _turn(change: Callable[[Real], Real]) -> Undoing:
    return lambda e: replace(e, orientations=change(e.orientations))


# Undoing each: its weight, and the rotations that may be free with it.
CHANGES: dict[str, tuple[float, tuple[str, ...], Undoing]] = {
    "": (0.0, ALL, lambda e: e),
    "order": (1.0, ALL, _turn(lambda q: q[:, [3, 0, 1, 2]])),
    "conjugate": (1.0, ALL, _turn(invert)),
    # These are the same as rotations of both frames, so few rotations are free with them.
    "conjugate_order": (1.0, ALL[:3], _turn(lambda q: invert(q[:, [3, 0, 1, 2]]))),
    "frame": (1.0, ALL[:3], lambda e: replace(e, of_sensor=not e.of_sensor)),
    "ned": (1.0, ALL[:2], _turn(lambda q: compose(FLIP_WORLD, q))),
    "frd": (1.0, ALL[:2], _turn(lambda q: compose(q, FLIP_BODY))),
    "ned_frd": (1.0, ALL[:2], _turn(lambda q: compose(compose(FLIP_WORLD, q), FLIP_BODY))),
}


@dataclass(eq=False)
class Tables:
    """Consequences of values of parameters; exact attitudes of whole ranges are kept."""

    truth: Truth
    fastest: float  # angular velocity of the motion in rad/s
    kept: dict[tuple[str, bool], tuple[Real, Real]] = field(default_factory=dict)

    def tabulate(
        self, some: Estimates, name: str, base: Offset = NONE, values: Real | None = None
    ) -> tuple[Real, Models]:
        """Return values (g,) of a parameter, the whole range if none are given, and their models.

        Without a name they are those of nothing. The drift of the base is taken away.
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


def fit_rotations(models: Models, level: str) -> tuple[Real, Real, Real]:
    """Return the rotations W and M of a level, for which W exact M is nearest to the estimates.

    First about the mean squares of the half angles that are left, (g,), then W and M, (g, 4).
    """
    q, exact, known = models
    along = np.broadcast_to(IDENTITY, (len(q), 4))
    bodies = _guess_bodies(q, exact, known) if level == "both" else along
    turned = compose(exact, bodies[:, np.newaxis])
    left = compose(invert(exact), q) if level == "body" else compose(q, invert(turned))
    left = left * known[..., np.newaxis] * np.array(FREE.get(level, (1, 1, 1, 1)))
    sizes, vectors = np.linalg.eigh(np.swapaxes(left, 1, 2) @ left)
    means = vectors[..., -1]
    counts = known.sum(axis=1)
    costs = np.maximum(1 - sizes[:, -1] / np.maximum(counts, 1), 0.0)
    costs[counts < max(2, known.shape[1] // 2)] = np.inf
    means = np.asarray(means * np.copysign(1.0, means[:, :1]))
    return (costs, bodies, means) if level == "body" else (costs, means, bodies)


def _guess_bodies(q: Real, exact: Real, known: Real) -> Real:
    """Return rotations M of the body, (g, 4)."""
    ours, theirs = (find_rotation_vectors(compose(invert(p[:, :-1]), p[:, 1:])) for p in (q, exact))
    both = (known[:, 1:] * known[:, :-1])[..., np.newaxis]
    u, _, vt = np.linalg.svd(np.swapaxes(theirs * both, 1, 2) @ (ours * both))
    u[..., -1] *= np.linalg.det(u @ vt)[:, np.newaxis]  # a rotation, not a reflection
    return np.asarray(Rotation.from_matrix(u @ vt).as_quat()[:, [3, 0, 1, 2]])


def find_mistakes(estimates: Estimates, truth: Truth, found: Finding) -> list[str]:
    """Return the likely mistakes as sentences: that of the attitude, then that of the rates."""
    some = estimates.thin(SAMPLES)
    change = found.best.change
    mended = CHANGES[change][2](some)
    # Rates are in the frame of the body, which a half turn of the attitude has not turned.
    offset = NONE if change else found.best.offset
    rates = [] if estimates.angular_velocities is None else [*_find_rates(mended, truth, offset)]
    return [*_name_changes(found, some.of_sensor), *rates]


def _name_changes(found: Finding, of_sensor: bool) -> list[str]:
    """Return the mistake of the attitude, with others that would explain as much."""
    several = {each.change: each for each in (found.best, *found.others)}
    if list(several) == [""]:
        return []
    names = {"": "none", "frame": "body" if of_sensor else "sensor"}
    return [", or ".join(write(f"change.{names.get(name, name)}", {}) for name in several)]


def _find_rates(some: Estimates, truth: Truth, offset: Offset) -> Iterator[str]:
    """Yield the mistake of the angular velocities, if there is one.

    Rates of an engine that diverges become smaller by any division, too: what is left must be small
    against the exact rates.
    """
    now = _rate(compare(some, truth, offset))
    q = some.orientations
    omega = np.asarray(some.angular_velocities)
    exact = truth.states_at(some.stamps, some.of_sensor)[1]
    size = float(np.sqrt((exact**2).sum(axis=1).mean()))
    if now > SMALL * size:
        errors = {
            text: _rate(compare(replace(some, angular_velocities=mend(q, omega)), truth, offset))
            for text, mend in VELOCITIES.items()
        }
        best = min(errors, key=lambda name: errors[name])
        if errors[best] < min(now, size) / MUCH:
            yield best


def _rate(errors: Errors) -> float:
    rate = np.zeros(1) if errors.rate is None or not len(errors.rate) else errors.rate
    return float(np.sqrt((rate**2).mean()))
