"""Entry point of `top_report`: what is measured and drawn, each with what it needs."""

from __future__ import annotations

import argparse
import signal
import sys
from pathlib import Path

from symtop_ros.wire.text import one_line

MOST_POINTS = 4000
ENDED = 130  # as a shell says it of Ctrl-C
LONGEST = 1e6  # s
DESCRIPTION = """Speed against error, beside the integrators that are installed: tables, plots and
JSON in a folder. Or the article retold, Perry's maps, or the node's load, one of them at a time."""


def main(args: list[str] | None = None) -> int:
    """Do what the options say; return 0 (good), 1 (failed), 2 (usage) or 130 (ended)."""
    options = _parser().parse_args(args)
    try:
        for number in (signal.SIGINT, signal.SIGTERM):  # nodes that were started are ended
            signal.signal(number, signal.default_int_handler)
        return _chosen(options)
    except KeyboardInterrupt:
        return ENDED
    except ImportError as error:
        needed = (
            "ROS 2"
            if options.node or options.soak
            else "the extra `report`: pip install '.[report]'"
        )
        print(f"top_report: needs {needed} ({error})", file=sys.stderr)
        return 1


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(prog="top_report", description=DESCRIPTION)
    parser.add_argument("folder", type=Path, nargs="?", default=Path("report"), help="./report")
    one = parser.add_mutually_exclusive_group()
    one.add_argument(
        "--full",
        action="store_true",
        help="seven motions, long runs of the peers: half an hour",
    )
    one.add_argument("--article", action="store_true", help="the article's figures and claims")
    one.add_argument("--map", action="store_true", help="where hurrying raises the top")
    one.add_argument("--node", action="store_true", help="the node beside a bare one; no files")
    one.add_argument("--soak", action="store_true", help="the node kicked at random; no files")
    one.add_argument("--stress", action="store_true", help="the node under loads; no files")
    parser.add_argument("--points", type=_points, default=1000, help="along each side of --map")
    parser.add_argument(
        "--seconds",
        type=_seconds,
        help="for each figure of --node and --stress (10), of --soak (3600)",
    )
    return parser


def _points(text: str) -> int:
    if not text.isdecimal() or not 2 <= int(text) <= MOST_POINTS:
        msg = f"got {one_line(text)}, allowed is 2 ... {MOST_POINTS}"
        raise argparse.ArgumentTypeError(msg)
    return int(text)


def _seconds(text: str) -> float:
    try:
        seconds = float(text)
    except ValueError:
        seconds = 0.0
    if not 0 < seconds <= LONGEST:
        msg = f"got {one_line(text)}, allowed is more than 0, up to {LONGEST:g}"
        raise argparse.ArgumentTypeError(msg)
    return seconds


def _chosen(options: argparse.Namespace) -> int:
    """Import and run what was asked for."""
    if options.node:
        from symtop_ros.report.load import table

        for part in table(options.seconds or 10.0):
            print(part, end="", flush=True)
        return 0
    if options.soak:
        from symtop_ros.report.soak import HEAD, row, soak

        print(HEAD)
        for reading in soak(options.seconds or 3600.0):
            print(row(reading), flush=True)
        return 0 if reading.good else 1
    if options.stress:
        from symtop_ros.report import stress

        print(stress.HEAD)
        good = True
        for outcome in stress.stress(options.seconds or 10.0):
            print(stress.row(outcome), flush=True)
            good = good and outcome.good
        return 0 if good else 1
    if options.map:
        from symtop_ros.report.perry.main import chart

        return chart(options.folder, options.points)
    if options.article:
        from symtop_ros.report.article.main import retell

        return retell(options.folder)
    from symtop_ros.report.precision.chapters import FULL, QUICK
    from symtop_ros.report.precision.main import measure

    command = "top_report --full" if options.full else "top_report"
    return measure(options.folder, FULL if options.full else QUICK, command)
