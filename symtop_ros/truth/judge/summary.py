"""A quantity of all estimates in a few numbers, and in a row of a table."""

import numpy as np

from symtop_ros.base.arrays import Real
from symtop_ros.truth.judge.compare import PERCENTILES


def format_row(label: str, width: int, summary: dict[str, float]) -> str:
    """Return a row of a table."""
    return f"{label:{width}}" + "".join(f"{x:10.2e}" for x in summary.values())


def summarize(values: Real) -> dict[str, float]:
    """Return root mean square, mean and percentiles."""
    marks = np.percentile(values, PERCENTILES).tolist()
    return {
        "rms": float(np.sqrt((values**2).mean())),
        "mean": float(values.mean()),
        **{f"p{p}": x for p, x in zip(PERCENTILES, marks, strict=True)},
    }
