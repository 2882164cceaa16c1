"""The decision between the causes that were found: the best one, and whether it is named.

Each line is a step with its thresholds; causes that do not pass it go where its arrow points::

    all causes that were found
      PER_PARAMETER estimates for each of their numbers            -> dropped
      squares as small as the smallest, within CHANCE or SIMPLER   -> dropped     (`select`)
      the fewest assumptions (`Cause.weight`)                      -> dropped
      the smallest rotations, first parameters, smallest delay     -> also named, if they are as
                                                                      good within TIE and ALIGNED
    the best of them                                                              (`choose`)
      PER_PARAMETER estimates for each of its numbers              -> nothing is explained
      an error CLEAR times smaller than without a cause            => it is named
      numbers SIGNIFICANT times their deviations, and a rest that
      is white, has the shape of noise, and agrees on them         => it is named   (`judge`)
      a gain SURER times that of chance, in each half of the run
      by the other one, in errors that last LASTING times          => it is a candidate
                                                                            (`explains_part`)
                                                                   -> nothing is explained
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from symtop_ros.truth.judge.alignment import PARAMETERS, Alignment
from symtop_ros.truth.judge.causes import Cause
from symtop_ros.truth.residuals.bootstrap import draw_gains
from symtop_ros.truth.residuals.influence import find_influences
from symtop_ros.truth.residuals.residuals import CHANCE, PER_PARAMETER

SIMPLER = 4.0  # if no noise is left, simpler causes count with at most twice the error (squared)
# For correlated errors: in flicker, for example, fewer estimates are independent than it seems.
LASTS = 4.0
TIE = 1.5  # explanations that are as good, by their mean squares
ALIGNED = 2.0  # an explanation with this many times smaller rotations is preferred
SMALL = 1e-3  # rad; smaller rotations count as zero in a comparison of explanations
# required reduction of the mean square, for long correlations or with a mistake of convention
LASTING = 100.0
SURER = 4.0  # required ratio of a gain to that by chance, because many kinds and values are tried
# if the error becomes this many times smaller, its cause is clear, whatever the residuals are
CLEAR = 1000.0


@dataclass(frozen=True, eq=False)
class Choice:
    """The simplest cause, equally simple and good ones, and the smallest cost of all."""

    best: Cause
    others: tuple[Cause, ...]
    lowest: float


def select(found: Sequence[Cause], fits: Mapping[str, Alignment], rounding: float) -> list[Cause]:
    """Return the causes that are as good as the best one, within the noise of the estimates."""
    lowest = min(found, key=lambda each: each.cost)
    left = fits[lowest.change].find_remainder(lowest.offset)
    is_noise = not left.find_fault(lowest.count) and left.has_shape_of_noise
    chance = CHANCE if left.is_white else LASTS * CHANCE
    factor = min(1 + chance / left.numbers, SIMPLER) if is_noise else SIMPLER
    most = factor * lowest.cost + rounding
    known = fits[lowest.change].exact(lowest.offset)[1]
    if known.all():
        return [each for each in found if each.cost <= most]
    # Causes are compared by the estimates that both explain.
    return [each for each in found if fits[each.change].cost_where(each.offset, known) <= most]


def choose(found: Sequence[Cause], fits: Mapping[str, Alignment], rounding: float) -> Choice:
    """Return the simplest of the good explanations, and others that are as simple and good.

    The one with the smallest rotations comes first; then the order of parameters and the delay
    count.
    """
    most = len(fits[""].some) / PER_PARAMETER
    enough = [each for each in found if each.count <= most or not each.weight]
    good = select(enough, fits, rounding)
    order = [*PARAMETERS]
    simple = [each for each in good if each.weight == min(other.weight for other in good)]

    def prefer(cause: Cause) -> tuple[float, float]:
        number = sum(order.index(name) for name in cause.parameters)
        return cause.turns + 1e-3 * (number + abs(cause.offset.delay)), cause.cost

    best = min(simple, key=prefer)
    largest = ALIGNED * max(best.turns, SMALL)
    ties = {
        each.kind: each
        for each in reversed(simple)
        if each.kind != best.kind and each.cost <= TIE * best.cost + rounding
        if (each.turns <= largest and each.change != best.change)
        or each.parameters != best.parameters
    }
    lowest = min(each.cost for each in enough)
    return Choice(best, tuple(reversed(ties.values())), lowest)


def judge(best: Cause, start: Cause, fit: Alignment) -> bool:
    """Return whether an explanation is named: it is significant, and leaves noise or nothing."""
    if len(fit.some) < PER_PARAMETER * best.count:
        return False
    if best.kind != start.kind and best.cost * CLEAR**2 <= start.cost:
        return True
    return _is_sound(best, fit) and fit.find_remainder(best.offset).is_white


def _is_sound(best: Cause, fit: Alignment) -> bool:
    """Return whether a cause is significant, in errors of one kind that agree on it."""
    left = fit.find_remainder(best.offset)
    if best.fault or not (best.is_significant and left.has_shape_of_noise):
        return False
    return left.agrees_on(fit.derive_vectors(best.offset, best.columns))


def explains_part(best: Cause, start: Cause, fit: Alignment, plain: Alignment) -> bool:
    """Return whether an explanation explains a part of the error, although more than noise remains.

    The rest may be the errors of a filter, or come from another cause. The parameters must reduce
    the squares by more than they would reduce such errors by chance, and the values from each half
    of the run must fit the other half. If errors are correlated for too long for deviations, and
    for mistakes of convention, the mean square must also become LASTING times smaller.
    """
    is_far = best.change or not _is_sound(best, fit)
    wanted = 1 / LASTING if is_far else (1 + best.cost / start.cost) / 2
    if best.kind == start.kind or best.cost > wanted * start.cost:
        return False
    if not best.count:
        return True
    gain = (start.cost - best.cost) / best.cost
    left = fit.find_remainder(best.offset)
    frames = fit.derive_frames(best.offset, best.columns)
    chance = max(float(draw_gains(*each, left.independent).max()) for each in frames)
    squares = (plain.find_left(start.offset) ** 2).sum(axis=1)
    return gain > SURER * chance and all(
        predicted <= wanted * half.mean()
        for predicted, half in zip(_predict(best, fit), np.array_split(squares, 2), strict=True)
    )


def _predict(best: Cause, fit: Alignment) -> Iterator[float]:
    """Yield the mean squares that are left in each half, by the parameters of the other."""
    columns, left = fit.derive_vectors(best.offset, best.columns), fit.find_left(best.offset)
    halves = [*zip(np.array_split(columns, 2), np.array_split(left, 2), strict=True)]
    for (own, rest), (other, known) in zip(halves, reversed(halves), strict=True):
        step = find_influences(other, known).sum(axis=0)
        yield float(((rest - own @ step) ** 2).sum(axis=1).mean())
