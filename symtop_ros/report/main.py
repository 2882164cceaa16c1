"""Entry point of `top_report`: its options, and an import for the one that is chosen."""

from __future__ import annotations

import argparse
import math
import signal
import sys
from dataclasses import replace
from pathlib import Path

from symtop_ros.simulation.validation import one_line

LARGEST_MAP = 4000  # points along a side
LARGEST_LIMIT = 3600  # s
INTERRUPTED = 130  # exit status of a program that Ctrl-C has ended
DESCRIPTION = """Measures speed against error, compared with the integrators that are installed:
tables, plots and JSON in a folder. With an option it retells the article, or draws the lesson
or Perry's map."""


def main(args: list[str] | None = None) -> int:
    """Do what the options say; return 0 (good), 1 (failed), 2 (usage) or 130 (interrupted)."""
    options = _parser().parse_args(args)
    try:
        for number in (signal.SIGINT, signal.SIGTERM):
            signal.signal(number, signal.default_int_handler)
        return _run(options)
    except KeyboardInterrupt:
        return INTERRUPTED
    except ImportError as error:
        needed = "the extra `report`: pip install '.[report]'"
        print(f"top_report: needs {needed} ({error})", file=sys.stderr)
        return 1


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(prog="top_report", description=DESCRIPTION)
    parser.add_argument("folder", type=Path, nargs="?", default=Path("report"), help="./report")
    choice = parser.add_mutually_exclusive_group()
    choice.add_argument(
        "--full",
        action="store_true",
        help="every peer, every motion, long times: hours instead of two minutes",
    )
    choice.add_argument("--article", action="store_true", help="the article's figures and claims")
    choice.add_argument(
        "--testset", action="store_true", help="scores of programs in the test set (20 minutes)"
    )
    choice.add_argument(
        "--filters", action="store_true", help="attitude filters fed with the top's noisy sensor"
    )
    choice.add_argument("--lesson", action="store_true", help="the pictures of docs/lesson.md")
    choice.add_argument("--map", action="store_true", help="where hurrying raises the top")
    parser.add_argument("--limit", type=_seconds, help="largest time of one run, 4 s (--full: 60)")
    parser.add_argument("--docs", type=_docs, help="write tables and plots into this folder, too")
    parser.add_argument("--points", type=_points, default=1000, help="along each side of --map")
    return parser


def _points(text: str) -> int:
    # isdecimal comes first: int() refuses very long numbers with an error of a different kind.
    if not text.isdecimal() or len(text) > 9 or not 2 <= int(text) <= LARGEST_MAP:
        msg = f"must be 2 to {LARGEST_MAP}, got {one_line(text)}"
        raise argparse.ArgumentTypeError(msg)
    return int(text)


def _docs(text: str) -> Path:
    path = Path(text)
    # refused before the minutes of measuring, not after them
    if not (path.is_dir() and (path.parent / "README.md").is_file()):
        raise argparse.ArgumentTypeError(f"must be a folder next to a README.md, got {text}")
    return path


def _seconds(text: str) -> float:
    try:
        limit = float(text)
    except ValueError:
        limit = math.nan
    if not 0 < limit <= LARGEST_LIMIT:
        msg = f"must be above 0 and at most {LARGEST_LIMIT} s, got {one_line(text)}"
        raise argparse.ArgumentTypeError(msg)
    return limit


def _run(options: argparse.Namespace) -> int:
    """Import and run one part, so that a part works without the packages that others need."""
    if options.map:
        from symtop_ros.article.maps import write_maps

        return write_maps(options.folder, options.points)
    if options.article:
        from symtop_ros.article.retell import retell

        return retell(options.folder)
    if options.testset:
        from symtop_ros.report.testset import LIMIT, score_testset

        return score_testset(options.folder, options.docs, options.limit or LIMIT)
    if options.filters:
        from symtop_ros.report.filters import judge_filters

        return judge_filters(options.folder, options.docs)
    if options.lesson:
        from symtop_ros.article.lesson import write_lesson

        return write_lesson(options.folder)
    from symtop_ros.report.benchmarks import FULL, QUICK
    from symtop_ros.report.measure import measure

    scope = FULL if options.full else QUICK
    command = "top_report --full" if options.full else "top_report"
    if options.limit:
        scope, command = replace(scope, limit=options.limit), f"{command} --limit {options.limit:g}"
    return measure(options.folder, scope, command, options.docs)
