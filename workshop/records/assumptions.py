"""The table of docs/fit.md on what is assumed: what each violation does to the numbers of a fit."""

from collections.abc import Iterator, Sequence
from typing import Any, NamedTuple

import numpy as np

NAME = "assumptions"
SHOWN = "Mgl/Ix", "p_psi/Ix", "theta"
HEADS = "assumed", "what is false", *SHOWN, "seen", "within 2 in all"
WITHIN = 2.0  # total deviations


class Assumption(NamedTuple):
    """An assumption of the fit, and the records in which it is false."""

    assumed: str
    false: str
    record: str  # a name of FAULTS in draws.py


ASSUMPTIONS = [
    Assumption(
        "a near camera looks at the middle of the film",
        "half a length higher, without `--size`",
        "aim",
    ),
    Assumption("the film is the whole picture", "cut by 120 and 40 px of 1280 x 720", "crop"),
    Assumption("a film is not mirrored", "mirrored: p_psi gets the other sign", "mirrored"),
    Assumption("a lens without distortion", "1 % at half a width", "barrel"),
    Assumption("square pixels", "1 % wider", "stretch"),
    Assumption("a frame is an instant", "exposed for 8 ms from its time on", "shutter"),
    Assumption("all rows at one time", "20 ms from the first to the last", "rolling shutter"),
    Assumption("a clock that is right", "30 for 29.97 frames a second", "time base"),
    Assumption("a symmetric body", "Iy = 1.02 Ix, rates", "asymmetric, rates"),
    Assumption("a symmetric body", "Iy = 1.02 Ix, points of the axis", "asymmetric, axis"),
    Assumption("equal gains of a sensor", "2 % across the axis", "gains"),
    Assumption("a sensor along the axes", "0.01 and 0.005 rad", "tilted sensor"),
    Assumption("no kick", "0.15 rad/s in the middle, axis", "kick, axis"),
    Assumption("no kick", "0.15 rad/s in the middle, rates", "kick, rates"),
    Assumption("no friction", "5 % of the spin in 3 s, linear", "linear friction, axis"),
    Assumption("no friction", "5 % of the spin in 3 s, dry, axis", "dry friction, axis"),
    Assumption("no friction", "5 % of the spin in 3 s, dry, rates", "dry friction, rates"),
]


def write_assumptions(rows: Sequence[dict[str, Any]]) -> Iterator[str]:
    """Yield the lines of the table: medians of errors in deviations of the noise, and shares."""
    yield f"| {' | '.join(HEADS)} |"
    yield "|---|---|" + "--:|" * (len(HEADS) - 2)
    for each in ASSUMPTIONS:
        mine = [row for row in rows if row["name"] == each.record]
        if mine:
            cells = [*_write_errors(mine), _write_seen(mine), _write_share(mine)]
            yield f"| {each.assumed} | {each.false} | {' | '.join(cells)} |"


def _write_errors(rows: Sequence[dict[str, Any]]) -> Iterator[str]:
    for name in SHOWN:
        pulls = [abs(row["pulls"][name]) for row in rows if name in row["pulls"]]
        yield f"{np.median(pulls):.1f}" if pulls else "-"


def _write_seen(rows: Sequence[dict[str, Any]]) -> str:
    return f"{sum(map(_is_seen, rows))} of {len(rows)}"


def _is_seen(row: dict[str, Any]) -> bool:
    """Return True if the model does not hold or is in doubt, or a mirrored film is named."""
    named = any("mirrored picture" in each for each in row.get("unknown", ()))
    return row["verdict"] != "holds" or (row["name"] == "mirrored" and named)


def _write_share(rows: Sequence[dict[str, Any]]) -> str:
    totals = [abs(pull) for row in rows for pull in row.get("totals", {}).values()]
    return f"{sum(pull < WITHIN for pull in totals)} of {len(totals)}" if totals else "-"
