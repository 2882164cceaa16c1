"""The constant rotations, the delay and the drift that explain most of the errors of estimates.

A steady motion cannot show all of them: the top in regular precession looks the same after any
delay, but for rotations of the world and of the body. The rank of the problem says what it hides.
"""

from dataclasses import dataclass

import numpy as np

from symtop_ros.judge.causes.search import fit_level
from symtop_ros.judge.compare import NONE, Offset
from symtop_ros.judge.estimates import Estimates
from symtop_ros.judge.fit import ROTATIONS, SAMPLES, Fit
from symtop_ros.judge.truth import Truth

MODELS = {"none": "none", "heading": "heading", "world": "world", "world-and-body": "both"}


@dataclass(frozen=True, eq=False)
class Explanation:
    """Explanation of most of the errors."""

    offset: Offset = NONE
    # what the motion cannot show: "delay", "drift", or "rotations" (the world's and the body's)
    hidden: tuple[str, ...] = ()
    residual: float = 0.0  # root mean square of the angle that is left in rad


def explain(
    estimates: Estimates,
    truth: Truth,
    *,
    rotations: bool = True,
    delay: bool = True,
    drift: bool = True,
) -> Explanation:
    """Return the explanation by constant rotations, a delay up to 0.1 s, and a drift.

    The rotations follow by least squares for each delay and drift (Kabsch 1976, in four
    dimensions). All delays are tried, since a spinning top repeats itself with each turn; if they
    and a slow drift leave errors, once more with the best of all drifts. What is found is refined
    by the method of Gauss and Newton. The simplest explanation that leaves no more is taken: the
    one with the smallest delay.
    """
    turns = tuple(ROTATIONS) if rotations else ()
    fit = Fit(truth.select(estimates).thin(SAMPLES), truth, turns)
    if len(fit.some) < 2:
        return Explanation()
    fit.hidden.extend(fit.find_hidden())
    sees_drift = drift and "drift" not in fit.hidden
    best = fit.find_best(delay and "delay" not in fit.hidden, sees_drift)
    if delay and "delay" not in fit.hidden and fit.loses_delay(best):
        fit.hidden.append("delay")
        best = fit.find_best(False, sees_drift)
    return Explanation(best, tuple(fit.hidden), float(np.sqrt(4 * fit.cost(best))))


def align(estimates: Estimates, truth: Truth, model: str) -> Offset:
    """Return the least squares of a stated model, one of MODELS, without any search."""
    run = truth.select(estimates)
    exact, *_ = truth.states_at(run.stamps, run.of_sensor)
    return fit_level(run.orientations, exact, MODELS[model])
