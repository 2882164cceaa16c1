"""The relative pose error (RPE): errors of the rotation from each estimate to one a lag later.

A constant rotation of the world causes no such error, and a drift causes a constant one (Sturm et
al. 2012). evo computes the same for a lag in whole estimates, with `--delta_unit f --all_pairs
--pose_relation angle_rad`.
"""

import argparse
import re
from dataclasses import dataclass
from typing import Any

import numpy as np

from symtop_ros.base.arrays import Places, Real, Stamps, compose, invert
from symtop_ros.base.refusals import RefusedError, one_line
from symtop_ros.truth.judge.compare import Offset, find_exact, undo
from symtop_ros.truth.judge.summary import format_row, summarize
from symtop_ros.truth.judge.truth import Truth
from symtop_ros.truth.testset.score import measure_angles
from symtop_ros.truth.topics.estimates import Estimates

LAG = re.compile(r"(\d+(?:\.\d*)?|\.\d+)(s|ms)")
LABEL = 18  # characters of a label in the table of errors
UNITS = {"s": 1_000_000_000, "ms": 1_000_000}  # ns


def read_lag(text: str) -> int:
    """Read a lag such as 1s or 50ms, in ns."""
    found = LAG.fullmatch(text)
    value = round(float(found[1]) * UNITS[found[2]]) if found else 0
    if not 0 < value < 2**62:
        raise argparse.ArgumentTypeError(f"must be a time such as 1s or 50ms, got {one_line(text)}")
    return value


@dataclass(frozen=True, eq=False)
class Relative:
    """Errors (n,) in rad of the turns over a lag in s."""

    lag: float
    errors: Real

    def facts(self) -> dict[str, Any]:
        """Return the figures, for JSON."""
        return {"lag": self.lag, "pairs": len(self.errors), **summarize(self.errors)}

    def format(self) -> str:
        """Return the row of a table."""
        return format_row(f"RPE, {self.lag:.4g} s (rad)", LABEL, summarize(self.errors))


def measure_relative(estimates: Estimates, truth: Truth, offset: Offset, lag: int) -> Relative:
    """Return the errors of turns over a lag (ns), after an offset is removed."""
    chosen, exact, _ = find_exact(estimates, truth, offset)
    first, last = pair(chosen.stamps, lag)
    q = undo(chosen, offset)
    turned, right = (compose(invert(each[first]), each[last]) for each in (q, exact))
    return Relative(lag / UNITS["s"], measure_angles(turned, right, np.zeros(4)))


def pair(stamps: Stamps, lag: int) -> tuple[Places, Places]:
    """Return the places of estimates, and those of the nearest to a lag (ns) later.

    They are within half of a median step of it.
    """
    if len(stamps) < 2:
        raise RefusedError(
            f"--rpe must have at least 2 estimates that can be judged, got {len(stamps)}"
        )
    later = stamps + lag
    near = np.clip(np.searchsorted(stamps, later), 1, len(stamps) - 1)
    near -= later - stamps[near - 1] < stamps[near] - later
    is_close = 2 * np.abs(stamps[near] - later) <= np.median(np.diff(stamps))
    first = np.flatnonzero(is_close & (near > np.arange(len(near))))
    if not len(first):
        span = (stamps[-1] - stamps[0]) / UNITS["s"]
        raise RefusedError(
            f"--rpe must be within the run of {span:.4g} s, got {lag / UNITS['s']:g} s"
        )
    return first, near[first]
