"""The search for the motion: the starts that are best on longer and longer parts of a record.

A long record has many minima: a nutation that is counted wrong by one turn fits almost as well. On
a short part their valleys are wide, and each longer part begins inside the valley of the last one.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np
from scipy.ndimage import median_filter
from scipy.optimize import least_squares

from symtop_ros.base.arrays import Real
from symtop_ros.truth.fit.body_starts import list_starts
from symtop_ros.truth.fit.model import FRICTION, THINNEST, Model
from symtop_ros.truth.fit.record import FEWEST, Record
from symtop_ros.truth.fit.starts import Starts
from symtop_ros.truth.residuals.spread import find_spread

GROWTH = 1.7  # factor by which the next part is longer
BROAD = 3.0  # scales of the residuals at which starts are compared
SOFT = 0.1  # first scale of a robust loss, relative to the spread of the values
SAME = 1e-4  # relative difference of the costs of one minimum
NEAR = 1e-6  # relative change of a cost by the last step
ALIKE = 1.1  # largest ratio of the costs of motions that fit equally well
# a row that differs from the median of its neighbours by SPIKE times this percentile is wrong
USUAL, SPIKE = 90, 4.0
NEAREST = 0.9  # length of the axis in distances of the camera
QUICK = 10_000  # rows of a search


@dataclass(frozen=True)
class Effort:
    """The size of a search: starts tried, those kept, and rows of the first part."""

    tried: int
    kept: int
    first: int
    share: float = 0.0  # of all rows, in the first part


# The first part of the second search is long: in a quick record 40 rows show no nutation.
EFFORTS = (Effort(24, 4, 40), Effort(24, 4, 40, 0.35), Effort(80, 6, 24), Effort(150, 8, 60, 0.2))


@dataclass(frozen=True, eq=False)
class Candidate:
    """Parameters of a model, and the cost of their residuals."""

    model: Model
    x: Real
    cost: float


def search(record: Record, effort: Effort, starts: Sequence[Starts] = ()) -> list[Candidate]:
    """Return motions that fit the whole record, the best first."""
    record = replace(record, values=drop_spikes(record.values))
    count = min(len(record), max(effort.first, int(effort.share * len(record))))
    part = record.select(slice(count))
    shows = record.kind.name == "theta"  # its starts need a whole turn
    found = starts or [*list_starts(record.thin(QUICK) if shows else part)]
    best = choose(found, part, effort.tried)
    most = 12
    while True:
        part = record.select(slice(count)).thin(QUICK)
        tried = [improve(each.model.move(part), each.x, most) for each in best]
        best = drop_twins(sorted(tried, key=lambda each: each.cost), effort.kept)
        if count >= len(record) and most > 12:
            return best
        most = 40
        count = min(len(record), int(count * GROWTH))


def choose(found: Sequence[Starts], part: Record, most: int) -> list[Candidate]:
    """Return the starts that are nearest to a part of a record."""
    wide = BROAD * float(np.median(find_spread(part.values)))
    rated = []
    for starts in found:
        model = starts.model.move(part)
        for rows in np.array_split(starts.x, len(starts.x) // 64 + 1):
            left = np.abs(model.compare(model.show(rows)))
            costs = np.minimum(left, wide).mean(axis=(1, 2))
            rated += [
                Candidate(model, x, cost) for x, cost in zip(rows, costs.tolist(), strict=True)
            ]
    return sorted(rated, key=lambda each: each.cost)[:most]


def drop_twins(found: Sequence[Candidate], most: int) -> list[Candidate]:
    """Return the best of some candidates in order, each minimum once."""
    best: list[Candidate] = []
    for each in found:
        if all(abs(each.cost - other.cost) > SAME * other.cost for other in best):
            best.append(each)
    return best[:most]


def improve(model: Model, x: Real, most: int) -> Candidate:
    """Return the minimum near a start, by a loss in which outliers count little."""
    scale = SOFT * float(np.median(find_spread(model.record.values))) + 1e-12

    def find(x: Real) -> Real:
        return model.find_residuals(x) / scale

    def derive(x: Real) -> Real:
        return model.find_jacobian(x) / scale

    return minimise(model, x, find, derive, "soft_l1", most, NEAR)


def minimise(
    model: Model,
    x: Real,
    find: Callable[[Real], Real],
    derive: Callable[[Real], Real],
    loss: Literal["linear", "soft_l1"],
    most: int,
    precise: float,
) -> Candidate:
    """Return the least squares of residuals and known parameters, from a start.

    It ends if a step makes the sum of squares smaller by less than a part `precise`.
    """
    low, high = list_bounds(model)
    known = [
        (model.place[n], *known) for n, known in model.record.known.items() if n in model.place
    ]
    slopes = np.zeros((len(known), len(x)))
    for row, (place, _, deviation) in enumerate(known):
        slopes[row, place] = 1 / deviation

    def find_all(x: Real) -> Real:
        return np.append(find(x).ravel(), [(x[k] - value) / dev for k, value, dev in known])

    def derive_all(x: Real) -> Real:
        return np.vstack([derive(x).reshape(-1, len(x)), slopes])

    start, scales = np.clip(x, low + 1e-9, high - 1e-9), model.find_scales(x)
    bounds = low, high
    try:
        found = least_squares(
            find_all,
            start,
            derive_all,
            bounds,
            ftol=precise,
            x_scale=scales,
            loss=loss,
            max_nfev=most,
        )
    except (ValueError, np.linalg.LinAlgError):  # the start is far from any motion
        return Candidate(model, x, np.inf)
    return Candidate(model, found.x, float(found.cost))


def list_bounds(model: Model) -> tuple[Real, Real]:
    """Return the least and the largest value of each parameter."""
    low, high = np.full(len(model.names), -np.inf), np.full(len(model.names), np.inf)
    limits = {"Iz/Ix": (THINNEST, 2.0), "elevation": (-np.pi / 2, np.pi / 2)}
    # a kick next to an end shows nothing
    begin, *_, end = model.record.times[[FEWEST // 2, -FEWEST // 2]] - model.record.times[0]
    limits["kick_time"] = float(begin), float(end)
    limits |= {"nearness": (0.0, NEAREST), "gravity": (0.1, np.inf)}
    limits |= dict.fromkeys(FRICTION, (-1e-6, np.inf))
    for name, (least, largest) in limits.items():
        if name in model.place:
            low[model.place[name]], high[model.place[name]] = least, largest
    return low, high


def drop_spikes(values: Real) -> Real:
    """Return values (n, m) in which single wrong rows are replaced by medians of their neighbours.

    A few wrong lines hide the extent of a motion, and may lead a search elsewhere.
    """
    middle = median_filter(values, (5, 1), mode="nearest")
    far = np.abs(values - middle)
    usual = np.percentile(far, USUAL, axis=0)  # a median differs at the ends of a swing alone
    wrong = (far > SPIKE * usual + 1e-300).any(axis=1, keepdims=True)
    return np.asarray(np.where(wrong, middle, values))
