"""Entry point of `top_replay`: play a log or a run in Rerun, check, repair or convert it."""

import argparse
import os
import sys
import tempfile
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path

from symtop_ros.base.command import has_screen, tell_failures
from symtop_ros.base.header import make_header
from symtop_ros.base.refusals import number
from symtop_ros.page.web.join import write_file
from symtop_ros.replay.check import check
from symtop_ros.replay.options import make_parser, view_options
from symtop_ros.run.log.bags import open_run
from symtop_ros.run.log.catalog import Catalog, read_catalog
from symtop_ros.run.log.names import Names
from symtop_ros.run.log.reader import LogError, McapFile, log_errors
from symtop_ros.run.log.repair import repair
from symtop_ros.run.log.top_log import TopLog
from symtop_ros.run.session.run_log import write_run_log
from symtop_ros.run.simulation.points import Points
from symtop_ros.run.simulation.run_file import RATE, RunEvent, read_run, record_run, write_run
from symtop_ros.run.simulation.settings import MAX_PUBLISH_RATE


def main(args: list[str] | None = None) -> int:
    """Replay, check or repair a log; return 0 (success), 1 (failure) or 2 (usage)."""
    parser = make_parser()
    options = parser.parse_args(args)
    if options.rate is not None and not options.mcap:
        parser.error("--rate must be used with --mcap")
    if options.strict and not options.check:
        parser.error("--strict must be used with --check")
    if options.json and not options.check:
        parser.error("--json must be used with --check")
    return tell_failures("top_replay", lambda: _run(options))


def _run(options: argparse.Namespace) -> int:
    if options.mcap:
        _write_mcap(options.files, options.mcap, RATE if options.rate is None else options.rate)
        print(f"wrote {options.mcap}")
        return 0
    if options.repair:
        return _repair(McapFile(_only_file(options.files)), options.repair)
    with _open_file(options.files, options.node) as log:
        _print_problems(log.catalog)
        return _check(log, options) if options.check else _show(log, options)


def _only_file(paths: Sequence[Path]) -> Path:
    """Return the file that is to be repaired; LogError if there are several, or a folder."""
    if len(paths) > 1:
        raise LogError(f"--repair must be given one MCAP file, got {len(paths)}")
    if os.path.isdir(paths[0]):  # Path.is_dir raises for names that are too long
        raise LogError(f"--repair must be given one MCAP file, got the folder {paths[0]}")
    return paths[0]


def _repair(file: McapFile, target: Path) -> int:
    catalog = read_catalog(file, Names(file))
    _print_problems(catalog)
    print(f"wrote {repair(file, target, catalog)} to {target}")
    return 0


def _check(log: TopLog, options: argparse.Namespace) -> int:
    header = make_header("check", options.files) if options.json else None
    return check(log, options.strict, header)


def _show(log: TopLog, options: argparse.Namespace) -> int:
    # Rerun, which a check and a repair do without
    from symtop_ros.replay import viewer
    from symtop_ros.replay.view.view import ViewOptions

    drawn = ViewOptions(**view_options(options))
    save = options.save
    if save:
        if save.suffix == ".html":
            _save_page(log, save)
        elif save.suffix == ".rrd":
            viewer.replay(log, save, drawn, _find_points(log))
        else:
            raise LogError(f"--save must be a name that ends in .rrd or .html, got {save}")
        program = "in a browser" if save.suffix == ".html" else f"with: rerun {save}"
        print(f"wrote {save}; open it {program}")
        return 0
    if not options.web and not has_screen():
        raise LogError(
            "no screen for the viewer: use --save OUT.rrd to write a recording, or --web for a "
            "browser"
        )
    with tempfile.TemporaryDirectory() as folder:
        recording = Path(folder, f"{log.file.path.stem}.rrd")
        viewer.replay(log, recording, drawn, _find_points(log))
        return viewer.show(recording, options.web)


def _print_problems(catalog: Catalog) -> None:
    """Print what is wrong with a log, before anything else."""
    for line in catalog.lines:
        print(f"top_replay: {line}", file=sys.stderr)


def _read_run(paths: Sequence[Path]) -> tuple[list[RunEvent], int, Points | None]:
    """Return the events of a run of the page, its end in ns, and its measured points."""
    if len(paths) != 1:
        raise LogError(f"a run of the page must be one file, got {len(paths)}")
    with log_errors("open", paths[0]):
        return read_run(paths[0])


@contextmanager
def _open_file(paths: Sequence[Path], node: str | None) -> Iterator[TopLog]:
    """Open a log, or the log that a node would have written of a run of the page."""
    if all(path.suffix != ".json" for path in paths):
        yield TopLog(open_run(paths), node)
        return
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder, f"{paths[0].stem}.mcap")
        events, end, points = _read_run(paths)
        write_run_log(events, end, path, points=points)
        yield TopLog(open_run([path]), node)


def _save_page(log: TopLog, path: Path) -> None:
    """Write the page with the run of a log in it."""
    catalog = log.catalog
    shown = catalog.list_continuous()
    if not shown:
        raise LogError(f"{log.file.path}: a run must have an event to be saved")
    last = 0 if catalog.end is None else catalog.end
    end = min(last, shown[-1].end)
    if end < last and shown[-1] is not catalog.intervals[-1]:
        text = f"the page ends at {end} ns: how the top moved then is not known"
        print(f"top_replay: {text}", file=sys.stderr)
    run, reached = record_run((each.event for each in shown if each.event), end)
    with log_errors("write", path):
        content = write_run(run, reached, _find_points(log))
        path.write_text(write_file(run=content), encoding="utf-8")


def _find_points(log: TopLog) -> Points | None:
    """Return the measured points of a log; damaged ones are left out, and named."""
    try:
        return log.read_points()
    except LogError as error:
        print(f"top_replay: {error}", file=sys.stderr)
        return None


def _write_mcap(paths: Sequence[Path], path: Path, rate: float) -> None:
    """Write the log that a node would have written of a run of the page."""
    if path.suffix != ".mcap" or not path.parent.is_dir():
        raise LogError(f"--mcap must be OUT.mcap in a folder that exists, got {path}")
    number("--rate", rate, "Hz", 1.0, MAX_PUBLISH_RATE)
    with log_errors("write", path):
        events, end, points = _read_run(paths)
        write_run_log(events, end, path, rate, points)
