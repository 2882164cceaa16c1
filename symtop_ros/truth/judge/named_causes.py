"""Causes that the user selects, by `--remove` or `--aligned`."""

from collections.abc import Collection
from dataclasses import replace

from symtop_ros.base.refusals import RefusedError
from symtop_ros.truth.judge.alignment import PARAMETERS, Alignment
from symtop_ros.truth.judge.causes import LEVELS, Cause
from symtop_ros.truth.judge.choice import select
from symtop_ros.truth.judge.grid import fit_rotations
from symtop_ros.truth.judge.refine import refine
from symtop_ros.truth.judge.search import MOST_SAMPLES, Search
from symtop_ros.truth.judge.truth import Truth
from symtop_ros.truth.topics.estimates import Estimates

LEVELS_OF = {"none": "none", "heading": "heading", "world": "world", "world-and-body": "both"}
# Rotations, and what the stamps may be off by.
MODELS = [
    f"{rotations}{times}"
    for rotations in LEVELS_OF
    for times in ("", "+delay", "+clock", "+delay+clock")
]


def explain(
    estimates: Estimates, truth: Truth, removed: Collection[str] = ("offset", "delay", "drift")
) -> Cause:
    """Return the least squares of constant rotations (offset), a delay up to 0.5 s, and a drift.

    All delays and drifts are tried, and then a delay next to the best drift. Of those that leave as
    little, the one with the fewest numbers and the smallest delay is taken.
    """
    run = truth.select(estimates)
    if len(run) < 2:
        raise RefusedError(
            f"--remove must have at least 2 estimates that can be judged, got {len(run)}"
        )
    search = Search(run, truth)
    turned = "offset" in removed
    level = "none" if not turned else "world" if "rotations" in search.hidden else "both"
    names = [name for name in ("delay", "drift") if name in removed]
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
        if turned or each.level == "none"
    ]
    return min(
        select(search.select_in_more(causes), search.of_more, search.fit.rounding),
        key=lambda each: (len(each.parameters), abs(each.offset.delay)),
    )


def align(estimates: Estimates, truth: Truth, model: str, begin: int | None = None) -> Cause:
    """Return the least squares of a stated model, one of MODELS, without any search.

    If the delay grows, `delay` is its value at the stamp `begin`, by default the first one.

    A model is refused if its delay or its clock has the same effect as its other parameters: for a
    sleeping top a delay is equivalent to a heading.
    """
    rotations, *names = model.split("+")
    fit = Alignment(truth.select(estimates).thin(MOST_SAMPLES), truth)
    level = LEVELS_OF[rotations]
    exact, known = fit.exact(fit.start)
    models = fit.some.orientations[None], exact[None], known[None].astype(float)
    _, world, body = fit_rotations(models, level)
    start = replace(
        fit.start,
        world=world[0],
        body=body[0],
        begin=fit.start.begin if begin is None else begin,
    )
    found = refine(fit, ("", level, tuple(names)), start, is_sure=True)
    for name in names:
        others = [*LEVELS[level][0], *(PARAMETERS[each] for each in names if each != name)]
        if fit.hides(found.offset, others, PARAMETERS[name]):
            raise RefusedError(f"--aligned must be a model that this motion can show, got {model}")
    return found


def find_nearest(run: Estimates, truth: Truth, model: str | None) -> Cause:
    """Return the cause with the smallest residual, named or not: of a given model, or of all."""
    return Search(run, truth).choose().best if model is None else align(run, truth, model)
