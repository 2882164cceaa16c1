"""What `top_fit` says of records that do not share its assumptions."""

import contextlib
import io
import json
import tempfile
import time
from collections.abc import Iterator, Sequence
from itertools import product
from pathlib import Path
from typing import Any

import numpy as np

from symtop_ros.truth.fit.main import main
from workshop.records.assumptions import NAME, WITHIN, write_assumptions
from workshop.records.draws import CLEAN, FAULTS, draw_record
from workshop.speed.publish import publish

EACH = 40  # records of a fault; of those without one this many and a half more
VERDICTS = {"holds": "holds", "in doubt": "unclear", "fails": "fails", "refused": "refused"}
HEADS = *VERDICTS, "pulls, rms", "within 2 in all", "wider", "CPU, s"


def try_record(name: str, seed: int) -> dict[str, Any]:
    """Fit a record by the program, and return what its JSON says next to the truth."""
    drawn = draw_record(name, seed)
    row: dict[str, Any] = {"name": name, "seed": seed}
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "record.csv"
        drawn.write(path)
        out, err = io.StringIO(), io.StringIO()
        began = time.process_time()
        with contextlib.redirect_stdout(out), contextlib.redirect_stderr(err):
            row["status"] = main([str(path), "--json", *drawn.options])
        row["seconds"] = time.process_time() - began
    if not out.getvalue():
        return row | {"verdict": "refused", "text": err.getvalue().strip(), "pulls": {}}
    found = json.loads(out.getvalue())
    values = found["values"] | {
        each["kind"]: {"value": each["numbers"][0], "deviation": each["numbers"][1]}
        for each in found["unknown"]
        if each["kind"] == "cut"
    }
    return row | {
        "verdict": found["model"]["verdict"],
        "text": found["model"]["text"],
        "unknown": [each["text"] for each in found["unknown"]],
        "notes": found["notes"],
        "pulls": dict(_list_pulls(values, drawn.truth, "deviation")),
        "totals": dict(_list_pulls(values, drawn.truth, "total")),
        "wider": {
            name: each["total"] / each["deviation"]
            for name, each in found["values"].items()
            if each.get("total") and name in drawn.truth
        },
    }


def _list_pulls(values: dict[str, Any], truth: Any, of: str) -> Iterator[tuple[str, float]]:
    """Yield errors of known numbers in deviations: those of the noise, or in all."""
    for name, true in truth.items():
        if name in values and (deviation := values[name].get(of)):
            yield name, (values[name]["value"] - true) / deviation


def run_trial(names: Sequence[str], seeds: Sequence[int], path: Path | None = None) -> list[Any]:
    """Return the rows of some records, and write each at once."""
    rows = []
    for seed, name in product(seeds, names):
        rows.append(try_record(name, seed))
        if path:
            with path.open("a", encoding="utf-8") as file:
                file.write(json.dumps(rows[-1]) + "\n")
    return rows


def write_table(rows: Sequence[dict[str, Any]]) -> Iterator[str]:
    """Yield a line for each name: verdicts, pulls, and the share that total deviations cover."""
    yield f"| record | {' | '.join(HEADS)} |"
    yield "|---|" + "--:|" * len(HEADS)
    for name in [*CLEAN, *FAULTS]:
        mine = [row for row in rows if row["name"] == name]
        if mine:
            yield _write_line(name, mine)


def _write_line(name: str, rows: Sequence[dict[str, Any]]) -> str:
    counts = [sum(row["verdict"] == each for row in rows) for each in VERDICTS.values()]
    pulls = [pull for row in rows for pull in row["pulls"].values()]
    totals = [pull for row in rows for pull in row.get("totals", {}).values()]
    wider = [each for row in rows for each in row.get("wider", {}).values()]
    cells = [
        *map(str, counts),
        f"{np.sqrt(np.mean(np.square(pulls))):.2f}" if pulls else "-",
        f"{np.mean(np.abs(totals) < WITHIN):.0%}" if totals else "-",
        f"{np.median(wider):.1f}" if wider else "-",
        f"{np.mean([row['seconds'] for row in rows]):.1f}",
    ]
    return f"| {name} | {' | '.join(cells)} |"


def try_strange_records(folder: Path, docs: Path | None = None) -> None:
    """Write records.md, and docs/fit.md: 60 clean records of each name, and 40 of each fault."""
    path = folder / "records.jsonl"
    rows = run_trial([*CLEAN], range(EACH + EACH // 2), path)
    rows += run_trial([*FAULTS], range(EACH), path)
    (folder / "records.md").write_text("\n".join([*write_table(rows), ""]), encoding="utf-8")
    print(f"{folder / 'records.md'} and records.jsonl")
    if docs:
        publish({NAME: "\n".join(write_assumptions(rows))}, docs)
