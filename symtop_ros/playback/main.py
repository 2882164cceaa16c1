"""Entry point of `top_replay`: play a log or a run in Rerun, check, repair or convert it."""

import argparse
import sys
import tempfile
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path

from symtop_ros.command import decimal, has_screen, tell_failures
from symtop_ros.log.account import Account, read_account
from symtop_ros.log.bags import open_run
from symtop_ros.log.names import Names
from symtop_ros.log.reader import LogError, McapFile, log_errors
from symtop_ros.log.repair import repair
from symtop_ros.log.top_log import TopLog
from symtop_ros.playback.check import check
from symtop_ros.session.run_log import RATE, write_run_log
from symtop_ros.simulation.run_file import RunEvent, read_run, record_run, write_run
from symtop_ros.simulation.settings import MAX_PUBLISH_RATE
from symtop_ros.simulation.validation import number
from symtop_ros.web.join import write_file


def main(args: list[str] | None = None) -> int:
    """Replay, check or repair a log; return 0 (success), 1 (failure) or 2 (usage)."""
    parser = _parser()
    options = parser.parse_args(args)
    if options.rate is not None and not options.mcap:
        parser.error("--rate goes with --mcap")
    if options.strict and not options.check:
        parser.error("--strict goes with --check")
    return tell_failures("top_replay", lambda: _run(options))


def add_view_options(parser: argparse.ArgumentParser) -> None:
    """Add the options for parts of the scene: those of `ViewOptions`, which needs Rerun."""
    for option, text in (
        ("--no-ghost", "do not draw the top that was not kicked"),
        ("--angles", "draw both frames and Euler's angles phi, theta, psi"),
        (
            "--torques",
            "draw dL/dt and the inertial torque, in the body frame and in that of the nodes",
        ),
        (
            "--fictitious",
            "draw the torques in the precessing frame: gravity's, Coriolis' and centrifugal",
        ),
    ):
        parser.add_argument(option, action="store_true", help=text)


def view_options(options: argparse.Namespace) -> dict[str, bool]:
    """Return the fields of `ViewOptions` that the options ask for."""
    return {
        "ghost": not options.no_ghost,
        "angles": options.angles,
        "torques": options.torques,
        "fictitious": options.fictitious,
    }


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="top_replay",
        description="Play a log of top_node, or a run of the page, in the Rerun viewer; or save, "
        "check, repair or convert it.",
        epilog="Plain `rerun FILE.mcap` draws the top as well, on the timeline that it opens.",
    )
    parser.add_argument(
        "files",
        type=Path,
        nargs="+",
        metavar="FILE.mcap|run.json",
        help="a log, complete or damaged; a rosbag2 folder or a .db3 file; several are one run; or "
        "a run that the page has saved",
    )
    parser.add_argument("--node", help="full name of the node if the log has several tops")
    add_view_options(parser)
    ways = parser.add_mutually_exclusive_group()
    ways.add_argument(
        "--save",
        type=Path,
        metavar="OUT",
        help="write a Rerun recording (OUT.rrd) or a page for any browser (OUT.html)",
    )
    ways.add_argument("--web", action="store_true", help="serve it to a browser on this machine")
    ways.add_argument(
        "--check", action="store_true", help="compute the run again from its events and compare"
    )
    ways.add_argument(
        "--repair",
        type=Path,
        metavar="OUT.mcap",
        help="write the readable messages to a complete log",
    )
    ways.add_argument(
        "--mcap",
        type=Path,
        metavar="OUT.mcap",
        help="write the log that a node would have written of run.json",
    )
    parser.add_argument(
        "--strict",
        action="store_true",
        help="with --check: status 1 as well if topics of the node were never recorded",
    )
    parser.add_argument(
        "--rate", type=decimal, help=f"samples per second for --mcap (default {RATE:g})"
    )
    return parser


def _run(options: argparse.Namespace) -> int:
    if options.mcap:
        _write_mcap(options.files, options.mcap, RATE if options.rate is None else options.rate)
        print(f"wrote {options.mcap}")
        return 0
    if options.repair:
        if len(options.files) > 1:
            raise LogError(f"--repair must be given one log, got {len(options.files)}")
        return _repair(McapFile(options.files[0]), options.repair)
    with _open_file(options.files, options.node) as log:
        _print_problems(log.account)
        return check(log, options.strict) if options.check else _show(log, options)


def _repair(file: McapFile, target: Path) -> int:
    account = read_account(file, Names(file))
    _print_problems(account)
    print(f"wrote {repair(file, target, account)} to {target}")
    return 0


def _show(log: TopLog, options: argparse.Namespace) -> int:
    # Rerun, which a check and a repair do without
    from symtop_ros.playback import viewer
    from symtop_ros.playback.view.view import ViewOptions

    drawn, save = ViewOptions(**view_options(options)), options.save
    if save:
        if save.suffix == ".html":
            _save_page(log, save)
        elif save.suffix == ".rrd":
            viewer.replay(log, save, drawn)
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
        viewer.replay(log, recording, drawn)
        return viewer.show(recording, options.web)


def _print_problems(account: Account) -> None:
    """Print what is wrong with a log, before anything else."""
    for line in account.lines:
        print(f"top_replay: {line}", file=sys.stderr)


def _read_run(paths: Sequence[Path]) -> tuple[list[RunEvent], int]:
    """Return the events of a run of the page, and its end in ns."""
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
        write_run_log(*_read_run(paths), path)
        yield TopLog(open_run([path]), node)


def _save_page(log: TopLog, path: Path) -> None:
    """Write the page with the run of a log in it."""
    account = log.account
    shown = account.list_continuous()
    if not shown:
        raise LogError(f"{log.file.path}: a run must have an event to be saved")
    last = 0 if account.end is None else account.end
    end = min(last, shown[-1].end)
    if end < last and shown[-1] is not account.stretches[-1]:
        text = f"the page ends at {end} ns: how the top moved then is not known"
        print(f"top_replay: {text}", file=sys.stderr)
    run, reached = record_run((each.event for each in shown if each.event), end)
    with log_errors("write", path):
        path.write_text(write_file(run=write_run(run, reached)), encoding="utf-8")


def _write_mcap(paths: Sequence[Path], path: Path, rate: float) -> None:
    """Write the log that a node would have written of a run of the page."""
    if path.suffix != ".mcap" or not path.parent.is_dir():
        raise LogError(f"--mcap must be a name that ends in .mcap in a folder, got {path}")
    number("--rate", rate, "Hz", 1.0, MAX_PUBLISH_RATE)
    with log_errors("write", path):
        write_run_log(*_read_run(paths), path, rate)
