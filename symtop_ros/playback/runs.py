"""Runs of the page and logs, each as the other: run.json becomes a log, a log becomes a page."""

import tempfile
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path

from symtop_ros.log.bag import open_run
from symtop_ros.log.reader import LogError, log_errors
from symtop_ros.log.top_log import TopLog
from symtop_ros.session.run_log import write_run_log
from symtop_ros.simulation.run_file import RunEvent, read_run, record_run, write_run
from symtop_ros.simulation.settings import MAX_PUBLISH_RATE
from symtop_ros.simulation.validation import number
from symtop_ros.web.join import write_file

SUFFIX = ".json"  # of a run of the page


def read(paths: Sequence[Path]) -> tuple[list[RunEvent], int]:
    """Return the events of a run of the page, and its end in ns."""
    if len(paths) != 1:
        raise LogError(f"a run of the page must be one file, got {len(paths)}")
    with log_errors("open", paths[0]):
        return read_run(paths[0])


@contextmanager
def open_file(paths: Sequence[Path], node: str | None) -> Iterator[TopLog]:
    """Open a log, or the log that a node would have written of a run of the page."""
    if all(path.suffix != SUFFIX for path in paths):
        yield TopLog(open_run(paths), node)
        return
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder, f"{paths[0].stem}.mcap")
        write_run_log(*read(paths), path)
        yield TopLog(open_run([path]), node)


def save_page(log: TopLog, path: Path) -> None:
    """Write the page with the run of a log in it."""
    end = 0
    for batch in log.batches():
        stamps = [int(columns.stamps[-1]) for columns in batch.columns.values()]
        end = max([end, *stamps])
    run, reached = record_run(log.events(), end)
    if not run:
        raise LogError(f"{log.file.path}: a run must have an event to be saved")
    with log_errors("write", path):
        path.write_text(write_file(run=write_run(run, reached)), encoding="utf-8")


def write_mcap(paths: Sequence[Path], path: Path, rate: float) -> None:
    """Write the log that a node would have written of a run of the page."""
    if path.suffix != ".mcap" or not path.parent.is_dir():
        raise LogError(f"--mcap must be a name that ends in .mcap in a folder, got {path}")
    number("--rate", rate, "Hz", 1.0, MAX_PUBLISH_RATE)
    with log_errors("write", path):
        write_run_log(*read(paths), path, rate)
