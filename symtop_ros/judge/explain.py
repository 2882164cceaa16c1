"""The rotations, the delay and the drift that are to be removed, and stated models of these."""

from dataclasses import dataclass, replace

from symtop_ros.judge.causes.cause import LEVELS, Cause
from symtop_ros.judge.causes.causes import MOST_SAMPLES, Search, refine
from symtop_ros.judge.causes.tables import fit_rotations
from symtop_ros.judge.compare import NONE, Offset
from symtop_ros.judge.estimates import Estimates
from symtop_ros.judge.fit import PARAMETERS, Fit
from symtop_ros.judge.truth import Truth
from symtop_ros.simulation.validation import RefusedError

LEVELS_OF = {"none": "none", "heading": "heading", "world": "world", "world-and-body": "both"}
# Rotations, and what the stamps may be off by.
MODELS = [
    f"{rotations}{times}"
    for rotations in LEVELS_OF
    for times in ("", "+delay", "+clock", "+delay+clock")
]


@dataclass(frozen=True, eq=False)
class Explanation:
    """Explanation of most of the errors."""

    offset: Offset = NONE
    hidden: tuple[str, ...] = ()  # what the motion cannot show
    residual: float = 0.0  # root mean square of the angle that is left in rad


def explain(
    estimates: Estimates,
    truth: Truth,
    *,
    rotations: bool = True,
    delay: bool = True,
    drift: bool = True,
) -> Explanation:
    """Return the least squares of constant rotations, a delay up to 0.5 s, and a drift.

    All delays and drifts are tried, and then a delay next to the best drift. Of those that leave as
    little, the one with the fewest numbers and the smallest delay is taken.
    """
    run = truth.select(estimates)
    if len(run) < 2:
        return Explanation()
    search = Search(run, truth)
    level = "none" if not rotations else "world" if "rotations" in search.hidden else "both"
    names = [name for name, wanted in (("delay", delay), ("drift", drift)) if wanted]
    found = [each for name in ("", *names) for each in search.search("", name)]
    if len(names) == 2:
        found += [
            replace(each, parameters=("delay", "drift"))
            for first in found
            if first.parameters == ("drift",)
            for each in search.search("", "delay", first.offset)
        ]
    found += search.shift_periods(found)
    causes = [
        search.refine(("", level, each.parameters), each.offset)
        for each in found
        if rotations or each.level == "none"
    ]
    good = search.select(causes, len(search.some))
    best = min(good, key=lambda each: (len(each.parameters), abs(each.offset.delay)))
    return Explanation(best.offset, search.hidden, best.residual)


def align(estimates: Estimates, truth: Truth, model: str) -> Cause:
    """Return the least squares of a stated model, one of MODELS, without any search.

    Refused is a model with a delay or a clock that changes nothing but its other parameters: in a
    sleeping top a delay is a heading.
    """
    rotations, *names = model.split("+")
    fit, level = Fit(truth.select(estimates).thin(MOST_SAMPLES), truth), LEVELS_OF[rotations]
    exact, known = fit.exact(fit.start)
    models = fit.some.orientations[None], exact[None], known[None].astype(float)
    _, world, body = fit_rotations(models, level)
    start = replace(fit.start, world=world[0], body=body[0])
    found = refine(fit, ("", level, tuple(names)), start, is_sure=True)
    for name in names:
        others = [*LEVELS[level][0], *(PARAMETERS[each] for each in names if each != name)]
        if fit.hides(found.offset, others, PARAMETERS[name]):
            raise RefusedError(f"--aligned must be a model that this motion can show, got {model}")
    return found
