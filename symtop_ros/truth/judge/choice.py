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
      numbers SIGNIFICANT times their deviations, and a rest with
      the shape of noise, in which all of the run agrees on them   -> nothing is explained
      a rest that is white                                         => it is named
      squares LESS times smaller than without a cause              => it is a candidate
                                                                   -> nothing is explained
                                                                                  (`judge`)
"""

from collections.abc import Mapping, Sequence

from symtop_ros.truth.judge.alignment import PARAMETERS, Alignment
from symtop_ros.truth.judge.causes import Cause
from symtop_ros.truth.residuals.residuals import CHANCE, PER_PARAMETER

SIMPLER = 4.0  # if no noise is left, simpler causes count with at most twice the error (squared)
TIE = 1.5  # explanations that are as good, by their mean squares
ALIGNED = 2.0  # an explanation with this many times smaller rotations is preferred
SMALL = 1e-3  # rad; smaller rotations count as zero in a comparison of explanations
LESS = 4.0  # the squares become so many times smaller: the cause is worth a sentence
CLEAR = 1000.0  # the error becomes so many times smaller: its cause is clear, whatever is left


def select(found: Sequence[Cause], fits: Mapping[str, Alignment], rounding: float) -> list[Cause]:
    """Return those that are as good as the best one, in the noise of so many estimates."""
    lowest = min(found, key=lambda each: each.cost)
    left = fits[lowest.change].find_remainder(lowest.offset)
    is_noise = not left.find_fault(lowest.count) and left.has_shape_of_noise
    factor = min(1 + CHANCE / left.numbers, SIMPLER) if is_noise else SIMPLER
    most = factor * lowest.cost + rounding
    known = fits[lowest.change].exact(lowest.offset)[1]
    if known.all():
        return [each for each in found if each.cost <= most]
    # Causes are compared by the estimates that both explain.
    return [each for each in found if fits[each.change].cost_where(each.offset, known) <= most]


def choose(
    found: Sequence[Cause], fits: Mapping[str, Alignment], rounding: float
) -> tuple[Cause, list[Cause]]:
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
    return best, [*reversed(ties.values())]


def judge(best: Cause, start: Cause, fit: Alignment) -> tuple[bool, bool]:
    """Return whether an explanation is named, and else whether it would leave clearly less.

    It is named if it is significant, and leaves noise or next to nothing. What is left may be
    correlated because a filter's errors are, or because there is another cause.
    """
    if len(fit.some) < PER_PARAMETER * best.count:
        return False, False
    if best.kind != start.kind and best.cost * CLEAR**2 <= start.cost:
        return True, False
    left = fit.find_remainder(best.offset)
    is_sound = not best.fault and best.is_significant and left.has_shape_of_noise
    if not (is_sound and left.agrees_on(fit.derive_vectors(best.offset, best.columns))):
        return False, False
    return left.is_white, best.cost * LESS <= start.cost
