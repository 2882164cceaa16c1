"""The example record of `top_fit` as a run, which the page has for a step of the lesson.

python -m workshop.lesson.example
"""

import json
from importlib.resources import as_file, files
from pathlib import Path
from typing import Any

from symtop_ros.page.web.join import RECORD
from symtop_ros.truth.fit import Fit, fit_motion, make_record
from symtop_ros.truth.fit.files import read_rows
from symtop_ros.truth.fit.main import EXAMPLE
from symtop_ros.truth.fit.runs import make_run

DECIMALS = 4  # of a point, as in the record; its noise is forty times larger
DIGITS = 3  # of a residual


def fit_example() -> Fit:
    """Return the fit of the example, as `top_fit --example` prints it."""
    with as_file(files("symtop_ros.truth.fit") / EXAMPLE) as path:
        rows = read_rows(path, None, lambda done: None)
    return fit_motion(make_record(rows.times, rows.values, rows.kind))


def write_content() -> dict[str, Any]:
    """Return the run of the fit with as many digits as the page shows."""
    fit = fit_example()
    content = make_run(fit, len(fit.model.record), {}).to_json()
    points = content["points"]
    points["values"] = [[round(each, DECIMALS) for each in row] for row in points["values"]]
    left = points["residuals"]
    points["residuals"] = [[float(f"{each:.{DIGITS}g}") for each in row] for row in left]
    return content


def main(path: Path = RECORD) -> None:
    """Write the file of the page."""
    path.write_text(json.dumps(write_content()) + "\n", encoding="utf-8")
    print(f"wrote {path}")


if __name__ == "__main__":
    main()
