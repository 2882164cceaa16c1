"""The fit of a record: two searches, more if the residuals are not noise, and other motions.

A search that ends in a wrong minimum leaves residuals that are correlated or larger: the better
motion of all searches is taken.
"""

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from symtop_ros.base.arrays import Real
from symtop_ros.physics import Motion
from symtop_ros.truth.fit.aliases import SPARSE, count_rows, is_alias, list_alias_starts
from symtop_ros.truth.fit.body_starts import list_spins
from symtop_ros.truth.fit.check import HOLDS, Check
from symtop_ros.truth.fit.model import Model, find_momentum
from symtop_ros.truth.fit.record import Record
from symtop_ros.truth.fit.refine import Fit, fit_weighted, refine
from symtop_ros.truth.fit.search import ALIKE, EFFORTS, Candidate, search
from symtop_ros.truth.fit.sides import expand, restate
from symtop_ros.truth.fit.twins import mirror_view, turn_camera, turn_over

AGAIN = 1.001  # ratio of the costs of two searches that found the same minimum
SURE = 2  # searches that have to find it
FARTHEST = 6.0  # deviations; a residual beyond it counts as this
CLEAR = 25.0  # squares of deviations by which a motion fits worse than another
SURELY_NEAR = 12.0  # deviations of a nearness; without it the squares grow by 144, far above CLEAR
DIFFERENT = 0.02  # of p_psi/Ix; motions that are closer are one


def fit_motion(record: Record, report: Callable[[float], None] | None = None) -> Fit:
    """Return the motion that explains a record.

    Parameters
    ----------
    record : Record
        A record with any number of rows; at most `record.MOST` of them are used.
    report : callable
        Is called with the part that is done, 0 to 1.

    Returns
    -------
    Fit

    Examples
    --------
    >>> import numpy as np
    >>> from symtop_ros.physics import Motion, State, Top
    >>> from symtop_ros.truth.fit import fit_motion, make_record
    >>> motion = Motion(Top(1.0, 0.25, 300.0), State.from_euler(theta=0.5, psi_dot=200.0))
    >>> t = np.arange(100) / 100
    >>> fit = fit_motion(make_record(t, motion.at(t).to_world([0.0, 0.0, 1.0]), "axis"))
    >>> fit.x[:2].round(6).tolist()
    [300.0, 50.0]
    """
    record = record.thin()
    found, rivals, is_lone = seek(record, report)
    if count_rows(found) < 2 * SPARSE:
        ends = expand(search(record.plain, EFFORTS[2], list_alias_starts(found)), record)
        rivals += ends
        found = choose_better(found, ends, record)
    best = settle(choose_twin(found), rivals)
    # The residuals of a wrong minimum are correlated from row to row.
    return replace(best, is_lone=is_lone and len(best.noise.partial) > 0)


def seek(
    record: Record, report: Callable[[float], None] | None
) -> tuple[Fit, list[Candidate], bool]:
    """Return the best motion, all that searches found, and True if one search alone found it."""
    found: Fit | None = None
    rivals: list[Candidate] = []
    bests: list[float] = []
    for number, effort in enumerate(EFFORTS, 1):
        ends = expand(search(record.plain, effort), record)
        rivals += ends
        bests.append(min(each.cost for each in ends))
        if found is None or bests[-1] <= min(bests):
            found = choose_better(found, ends, record)
        if report:
            report(number / (len(EFFORTS) + 1))
        if is_sure(found, bests):
            break
    assert found is not None
    return found, rivals, count_agreeing(bests) < SURE


def is_sure(fit: Fit, bests: list[float]) -> bool:
    """Return True if two searches found the same minimum, and its residuals are noise.

    Correlated residuals may be motion that a wrong minimum leaves: then three searches have to find
    it.
    """
    needed = SURE + (len(fit.noise.partial) > 0)
    return count_agreeing(bests) >= needed and Check(fit).of_noise == HOLDS


def count_agreeing(bests: list[float]) -> int:
    """Return how many searches found the best minimum, by the costs of what each found."""
    return sum(each <= AGAIN * min(bests) for each in bests)


def choose_better(fit: Fit | None, ends: list[Candidate], record: Record) -> Fit:
    """Return the best of what a search found, or a fit that is no worse."""
    best = min(ends, key=lambda each: each.cost)
    new = refine(best.model.move(record), best.x)
    return new if fit is None or is_better(new, fit) else fit


def is_better(new: Fit, fit: Fit) -> bool:
    """Return True if a fit has smaller residuals than another, by the noise of either.

    A median alone may be smaller by chance, if the noise is correlated. So sums of squares are
    compared, by the noise of each fit. If they disagree, one of the fits has taken motion for
    noise; its residuals are large, so the median decides.
    """
    gains = [
        sum_squares(each, fit.residuals) - sum_squares(each, new.residuals) for each in (new, fit)
    ]
    if min(gains) * max(gains) > 0:
        return max(gains) > 0
    return measure_median(new) < 0.999 * measure_median(fit)


def settle(fit: Fit, rivals: list[Candidate]) -> Fit:
    """Return the best of a fit and of the motions that fit as well, with the others."""
    best, others = fit, find_others(fit, rivals)
    for each in others:
        other = refine(each.model, each.x)
        if is_better(other, best):
            best = other
    if best is not fit:
        others = find_others(best, rivals)
    slower = next((each for each in others if is_alias(best, each)), None)
    if slower is not None:
        best = choose_twin(refine(slower.model, slower.x))
        others = find_others(best, rivals)
    return replace(best, others=tuple(others))


def choose_twin(fit: Fit) -> Fit:
    """Return the usual one of exact twins.

    For rates, the one with Mgl > 0; for pictures, with an upright camera above the pivot; for
    attitudes, with the smallest turns from row to row that a rigid body allows.
    """
    model, x = fit.model, fit.x
    if model.kind.name == "attitude":
        return choose_turns(fit)
    if model.kind.name == "rates" and x[0] < 0:
        return _take(fit, turn_over(model.find_motion(x)), {})
    if "roll" in model.place and np.cos(x[model.place["roll"]]) < 0:
        fit = _take(fit, *turn_camera(model.find_motion(x), model.find_camera(x)))
    return choose_side(fit) if "elevation" in model.place else fit


def choose_side(fit: Fit) -> Fit:
    """Return the fit with a camera above the pivot, unless the record shows that it was below.

    The side shows only because nearer points are larger. To fit the distance of the camera is not
    enough: both sides fit a film from far away equally well.
    """
    model, is_below = fit.model, fit.x[fit.model.place["elevation"]] < 0
    if not model.record.breaks_twins:
        return _mirror(fit) if is_below else fit
    if is_surely_near(fit):
        return fit
    other = _mirror(fit)
    worse = sum_squares(fit, other.residuals) - sum_squares(fit, fit.residuals)
    if worse >= CLEAR:
        return fit
    return replace(other if is_below else fit, has_mirror=True)


def is_surely_near(fit: Fit) -> bool:
    """Return True if a camera is so near that its picture shows from which side it looks."""
    if "nearness" not in fit.model.place:
        return False
    place = fit.model.place["nearness"]
    deviation = fit.find_deviation(np.eye(len(fit.x))[place])
    return bool(fit.x[place] > SURELY_NEAR * deviation)


def _mirror(fit: Fit) -> Fit:
    return _take(fit, *mirror_view(fit.model.find_motion(fit.x), fit.model.find_camera(fit.x)))


def choose_turns(fit: Fit) -> Fit:
    """Return the fit with the fewest whole turns from row to row, if it is no worse."""
    model, record = fit.model, fit.model.record
    spin, p = float(fit.x[model.place["spin"]]), find_momentum(model, fit.x)
    sampling = 2 * np.pi / record.step
    seen = spin - sampling * np.round(spin / sampling)
    least = next(list_spins(record, seen, p), spin)
    if "Iz/Ix" in record.known or abs(least - spin) < sampling / 2:
        return fit
    x = fit.x.copy()
    x[model.place["spin"]], x[model.place["Iz/Ix"]] = least, p / least
    other = refine(model, x)
    worse = sum_squares(fit, other.residuals) - sum_squares(fit, fit.residuals)
    return other if worse < CLEAR else fit


def _take(fit: Fit, twin: Motion, changed: dict[str, float]) -> Fit:
    return refine(*restate(fit.model, fit.x, twin, changed, fit.model.record))


def measure_median(fit: Fit) -> float:
    """Return the median size of residuals, by the size of the values."""
    spread = np.abs(fit.model.record.values).max() + 1e-300
    return float(np.median(np.abs(fit.residuals)) / spread)


def find_others(fit: Fit, rivals: list[Candidate]) -> list[Fit]:
    """Return other motions that fit a record as well."""
    own = sum_squares(fit, fit.residuals)
    found: list[Fit] = []
    marks = [find_marks(fit.model, fit.x)]
    best = min(each.cost for each in rivals)
    for each in sorted(rivals, key=lambda each: each.cost):
        if each.cost > ALIKE * best:
            break
        mark = find_marks(each.model, each.x)
        if not all(differ(mark, other) for other in marks):
            continue
        other = weigh(each, fit)
        if sum_squares(fit, other.residuals) < own + CLEAR:
            marks.append(mark)
            found.append(choose_twin(other))
    return [each for each in found if differ(find_marks(each.model, each.x), marks[0])]


def weigh(rival: Candidate, fit: Fit) -> Fit:
    """Return the best fit near another motion of the search, weighted by the noise of a fit."""
    model = rival.model.move(fit.model.record)
    return Fit(model, fit_weighted(model, rival.x, fit.noise), fit.noise)


def differ(first: Real, second: Real) -> bool:
    """Return whether two sets of marks belong to different motions."""
    return bool(np.abs(first / second - 1).max() >= DIFFERENT)


def find_marks(model: Model, x: Real) -> Real:
    """Return numbers that are the same for motions that are exact twins of each other."""
    p = find_momentum(model, x)
    if model.kind.name in {"axis", "angles", "attitude"}:
        return np.array([p])
    if model.kind.name != "theta":
        return np.array([abs(p)])
    motion = model.find_motion(x)
    p_phi = float(motion.top.angular_momentum(motion.start)[2])
    return np.sort(np.abs([p, p_phi]))


def sum_squares(fit: Fit, residuals: Real) -> float:
    """Return the sum of the squares of residuals in deviations, each at most FARTHEST."""
    return float((np.minimum(np.abs(fit.noise.whiten(residuals)), FARTHEST) ** 2).sum())
