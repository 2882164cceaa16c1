"""Where Perry's rule at an instant and in the mean differ: a map, and counts by spin and instant.

At an instant the rule compares theta'' with the kick and without it. In the mean it compares the
sense of the kick with the mean precession, and the mean height with it and without it
(docs/article.md, "In the mean"). The kick is a push on the axle: the spin momentum is held.
"""

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.figure import Figure

from symtop_ros.base.arrays import Real
from symtop_ros.physics import Motion, Motions, State, Verdicts, perrys_rule
from workshop.article.answers.starts import PHI_DOTS, draw_regions
from workshop.article.motions import PSI_DOT, THETA, TOP
from workshop.article.rates import FACTOR

POINTS = 300  # along each side of a panel
SPINS, TILTS = (20.0, 400.0), (0.05, np.pi - 0.05)  # rad/s and rad, along the panels
LOOP = 20.0  # rad/s: phi' at the lower turning point, of the panel over the instants
# What the rule says of theta'' and of the mean height: as Perry, or not.
OUTCOMES = {
    "both as Perry says": "#4f8fca",
    "at the instant alone": "#f2c14e",
    "in the mean alone": "#b7d968",
    "neither": "#d9634c",
    "no mean, or no effect": "#ffffff",
}
BOTH, INSTANT, MEAN, NEITHER, SILENT = range(len(OUTCOMES))
COUNTED_SPINS = 60.0, 130.0, 200.0, 300.0  # rad/s
COUNTED, SEED = 4000, 1890


def find_outcome(verdicts: Verdicts) -> Any:
    """Return the place of each verdict among the `OUTCOMES`."""
    says = verdicts.rule_applies & (verdicts.sense != "") & (verdicts.mean_height != "unchanged")
    in_mean = (verdicts.sense == "along") == (verdicts.mean_height == "higher")
    holds = verdicts.rule_holds
    named = np.select([holds & in_mean, holds, in_mean], [BOTH, INSTANT, MEAN], NEITHER)
    return np.where(says, named, SILENT)


def judge(state: State, factor: float | Real = FACTOR) -> Any:
    """Return the outcomes of pushes on the article's top in some states."""
    return find_outcome(perrys_rule(TOP, state, np.asarray(factor), "spin_momentum"))


def write_map(folder: Path) -> None:
    """Write the map into a folder, and print the counts."""
    for suffix in ("png", "svg"):
        draw_map(folder / f"perry_in_the_mean.{suffix}")
    print(*list_counts(), sep="\n")
    print(f"wrote {folder / 'perry_in_the_mean.png'}, .svg")


def draw_map(target: Any) -> None:
    """Draw the outcomes over spin, tilt and instant; PNG, or the format of a suffix."""
    figure = Figure(figsize=(15, 5.4), layout="constrained")
    panels = figure.subplots(1, 3)
    rates = np.linspace(*PHI_DOTS, POINTS)
    spins, tilts = np.linspace(*SPINS, POINTS), np.linspace(*TILTS, POINTS)
    by_spin = State.from_euler(theta=THETA, phi_dot=rates[:, np.newaxis], psi_dot=spins)
    by_tilt = State.from_euler(theta=tilts, phi_dot=rates[:, np.newaxis], psi_dot=PSI_DOT)
    parts = np.linspace(0.0, 1.0, POINTS)
    _draw(panels[0], judge(by_spin), (*SPINS, *PHI_DOTS))
    _draw(panels[1], judge(by_tilt), (*TILTS, *PHI_DOTS))
    _draw(panels[2], judge(list_instants(spins, parts)), (*SPINS, 0.0, 1.0))
    for axes, across, up, title in zip(
        panels,
        ("spin rate psi' (rad/s)", "tilt theta (rad)", "spin rate psi' (rad/s)"),
        ("precession rate phi' (rad/s)", "", "instant, as a part of the nutation"),
        (
            f"theta' = 0, theta = {THETA:g} rad",
            f"theta' = 0, psi' = {PSI_DOT:g} rad/s",
            f"from phi' = {LOOP:g} rad/s at theta = {THETA:g} rad",
        ),
        strict=True,
    ):
        axes.set(xlabel=across, ylabel=up, title=title)
    figure.legend(*panels[0].get_legend_handles_labels(), loc="outside lower center", ncols=5)
    figure.suptitle(f"A push on the axle that hurries the precession by a factor of {FACTOR:g}")
    figure.savefig(target, dpi=100)


def _draw(axes: Any, outcome: Any, extent: tuple[float, float, float, float]) -> None:
    draw_regions(axes, outcome, OUTCOMES, extent, edgecolor="k", lw=0.3)
    axes.set(xlim=extent[:2], ylim=extent[2:])


def list_instants(spins: Real, parts: Real) -> State:
    """Return states (p, s) of motions that loop, at parts (p,) of their nutations."""
    motions = Motions(TOP, State.from_euler(theta=THETA, phi_dot=LOOP, psi_dot=spins))
    times = motions.nutation_period[:, np.newaxis] * parts
    states = motions.at_each(times)
    return State(states.orientation.swapaxes(0, 1), states.angular_velocity.swapaxes(0, 1))


def list_counts() -> Iterator[str]:
    """Yield rows of a table: of how many pushes the rule and the mean say other things."""
    yield "| psi' in rad/s | instant | pushes | rule as Perry | mean as Perry | they differ |"
    yield "|--:|---|--:|--:|--:|--:|"
    for spin in COUNTED_SPINS:
        outcomes, is_backward = draw_pushes(spin)
        for name, chosen in (("forward", ~is_backward), ("backward", is_backward)):
            found = outcomes[chosen & (outcomes != SILENT)]
            counts = [np.isin(found, each).sum() for each in ((BOTH, INSTANT), (BOTH, MEAN))]
            differ = np.isin(found, (INSTANT, MEAN)).sum()
            yield f"| {spin:g} | {name} | {len(found)} | {counts[0]} | {counts[1]} | {differ} |"


def draw_pushes(spin: float) -> tuple[Any, Any]:
    """Return outcomes of random pushes, and whether phi' is then against the mean precession."""
    rng = np.random.default_rng([SEED, int(spin)])
    tilts, rates = rng.uniform(0.2, 1.5, COUNTED), rng.uniform(-30.0, 60.0, COUNTED)
    factors = rng.choice([FACTOR, 1 / FACTOR], COUNTED)
    states, backward = [], []
    for tilt, rate, part in zip(tilts, rates, rng.uniform(0.0, 1.0, COUNTED), strict=True):
        motion = Motion(TOP, State.from_euler(theta=tilt, phi_dot=rate, psi_dot=spin))
        state = motion.at(part * motion.nutation_period)
        states.append(state)
        backward.append(state.euler_rates.phi_dot * motion.mean_precession_rate < 0)
    many = State(
        np.array([each.orientation for each in states]),
        np.array([each.angular_velocity for each in states]),
    )
    return judge(many, factors), np.array(backward)
