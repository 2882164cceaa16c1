"""Fits of random records: pulls of what is said to be known, and minima that are wrong."""

import json
import time
from collections.abc import Iterator, Sequence
from itertools import product
from pathlib import Path
from typing import Any

import numpy as np

from symtop_ros.truth.fit import Fit, fit_motion
from symtop_ros.truth.fit.check import HOLDS, Check
from symtop_ros.truth.fit.fitting import CLEAR, sum_squares
from symtop_ros.truth.fit.kinds import READ
from symtop_ros.truth.fit.model import Model, name_parameters
from symtop_ros.truth.fit.refine import refine
from symtop_ros.truth.fit.starts import fill
from symtop_ros.truth.fit.values import list_values
from workshop.fit.baseline import TIMES, Row, compare_all, compare_derivatives
from workshop.fit.plans import SETUPS, hold, write_plans
from workshop.fit.records import NOISES, Sample, draw_sample

SEEDS = 36  # of each kind and noise: 2016 records
FIRST = 400  # seed; those before were looked at while the search was written
# After the pulls of each noise; a motion that fits as well is "another".
COUNTS = "all", "records", "wrong minima", "not said", "in doubt", "another", "CPU, s"
TWINS = ("phi_dot", "mean_precession_rate", "p_psi/Ix")  # of theta alone


def try_record(kind: str, noise: str, seed: int) -> dict[str, Any]:
    """Fit a random record, and return what was found, as JSON has it."""
    sample = draw_sample(kind, noise, seed)
    row: dict[str, Any] = {"kind": kind, "noise": noise, "seed": seed}
    began = time.process_time()
    fit = fit_motion(sample.record)
    check = Check(fit)
    values = list_values(fit)
    row["seconds"] = time.process_time() - began
    row["wrong"] = is_wrong(fit, fit_from_truth(sample))
    row |= {"verdict": check.verdict, "others": len(fit.others), "fault": check.fault}
    truth = sample.truth
    hidden = TWINS if kind == "theta" else ()
    row["pulls"] = {
        each.name: pull(each.value, truth[each.name], each.deviation, each.name)
        for each in values
        if each.is_known and each.name in truth and each.name not in hidden
    }
    row["unknown"] = [each.name for each in values if not each.is_known]
    return row


def is_wrong(fit: Fit, truth: Fit) -> bool:
    """Return True if a fit is worse than the one that begins at the truth: another minimum."""
    worse = sum_squares(truth, fit.residuals) - sum_squares(truth, truth.residuals)
    return bool(worse > CLEAR)


def pull(value: float, truth: float, deviation: float, name: str) -> float:
    """Return the error in deviations; of an azimuth without whole turns."""
    left = value - truth
    if name in {"phi", "roll"}:
        left -= 2 * np.pi * np.round(left / (2 * np.pi))
    return float(left / deviation)


def fit_from_truth(sample: Sample) -> Fit:
    """Return the fit that begins at the truth."""
    record, motion = sample.record, sample.motion
    model = Model(record, motion.start.orientation)
    named = {**name_parameters(motion), **sample.camera}
    return refine(model, fill(model, named))


def run_trial(seeds: Sequence[int], path: Path | None = None) -> list[dict[str, Any]]:
    """Return the rows of all kinds and noises, and write each at once."""
    rows = []
    for seed, noise, kind in product(seeds, NOISES, READ):
        rows.append(try_record(kind, noise, seed))
        if path:
            with path.open("a", encoding="utf-8") as file:
                file.write(json.dumps(rows[-1]) + "\n")
    return rows


def write_table(rows: Sequence[dict[str, Any]]) -> Iterator[str]:
    """Yield the lines of the table of docs/trials.md: pulls by kind and noise, and counts."""
    yield "| " + " | ".join(["kind", *NOISES, *COUNTS]) + " |"
    yield "|---|" + "--:|" * (len(NOISES) + len(COUNTS))
    for kind in READ:
        if mine := [row for row in rows if row["kind"] == kind]:
            yield _write_line(f"`{kind}`", mine)
    yield _write_line("all", rows)


def _write_line(name: str, rows: Sequence[dict[str, Any]]) -> str:
    pulls = (measure_pulls([row for row in rows if row["noise"] == noise]) for noise in NOISES)
    counts = (
        len(rows),
        sum(row["wrong"] for row in rows),
        len(list_unsaid(rows)),
        sum(row["verdict"] != HOLDS for row in rows),
        sum(row["others"] > 0 for row in rows),
    )
    seconds = np.mean([row["seconds"] for row in rows])
    sizes = ("-" if np.isnan(each) else f"{each:.2f}" for each in (*pulls, measure_pulls(rows)))
    cells = [*sizes, *map(str, counts)]
    return f"| {name} | {' | '.join(cells)} | {seconds:.1f} |"


def measure_pulls(rows: Sequence[dict[str, Any]]) -> float:
    """Return the root mean square of the pulls of numbers that are said to be known."""
    pulls = [p for row in rows if row["verdict"] == HOLDS for p in row["pulls"].values()]
    return float(np.sqrt(np.mean(np.square(pulls)))) if pulls else np.nan


def list_unsaid(rows: Sequence[dict[str, Any]]) -> list[dict[str, Any]]:
    """Return wrong minima of which neither a doubt nor another motion is named."""
    return [row for row in rows if row["wrong"] and row["verdict"] == HOLDS and not row["others"]]


def measure_fits(folder: Path) -> None:
    """Write fit.md: all kinds and noises, a comparison with integrated equations, and plans."""
    rows = run_trial(range(FIRST, FIRST + SEEDS), folder / "fit.jsonl")
    both = compare_all()
    own, whole = compare_derivatives()
    derivatives = (
        f"Derivatives at {TIMES} times: {own * 1e3:.2g} ms, by `Motion.jacobian` "
        f"{whole * 1e3:.2g} ms (medians of pairs)."
    )
    plans = [row for setup in SETUPS for row in hold(setup)]
    lines = [*write_table(rows), "", write_comparison(both), derivatives, "", *write_plans(plans)]
    (folder / "fit.md").write_text("\n".join([*lines, ""]), encoding="utf-8")
    print(f"{folder / 'fit.md'} and fit.jsonl")


def write_comparison(rows: Sequence[Row]) -> str:
    """Return one sentence on records that were fitted in both ways."""
    plain, own = (sorted(times)[len(rows) // 2] for times in _list_times(rows))
    return (
        f"Of {len(rows)} records solve_ivp and least_squares from a textbook's guess fit "
        f"{sum(row.plain for row in rows)} ({plain:.2g} s each, median of CPU times), `top_fit` "
        f"{sum(row.found for row in rows)} ({own:.2g} s)."
    )


def _list_times(rows: Sequence[Row]) -> tuple[list[float], list[float]]:
    return [row.plain_seconds for row in rows], [row.seconds for row in rows]
