"""Entry point of `top_judge`: estimates in logs and live topics."""

import argparse
import json
import sys
from dataclasses import asdict
from pathlib import Path
from typing import Any

from symtop_ros.base.command import new_parser, positive, tell_failures
from symtop_ros.base.header import make_header
from symtop_ros.base.refusals import one_line
from symtop_ros.truth.judge.clock import format_clocks, measure_clock
from symtop_ros.truth.judge.judgement import Judgement, format_judgements, judge
from symtop_ros.truth.judge.named_causes import MODELS
from symtop_ros.truth.judge.relative import read_lag
from symtop_ros.truth.judge.runs import (
    ATTITUDES,
    Run,
    Source,
    read_run,
    read_sources,
    report_faults,
)
from symtop_ros.truth.tables.attitudes import ORDERS
from symtop_ros.truth.testset.score import enforce_limit

DESCRIPTION = """Compare estimates of attitude and angular velocity with the exact motion of the
top at the estimates' own stamps. The log must contain the ~/events of the run; instead of a log,
--scene names a scene that starts at the stamp 0."""


def main(args: list[str] | None = None) -> int:
    """Judge; return 0 (good), 1 (failed, or above --max-error) or 2 (usage)."""
    parser = make_parser()
    # The rest belongs to ROS (--ros-args ...), which only --live needs.
    options, rest = parser.parse_known_args(args)
    if fault := _find_fault(options, rest):
        parser.error(fault)
    return tell_failures("top_judge", lambda: _run(options, rest))


def _find_fault(options: argparse.Namespace, rest: list[str]) -> str | None:
    """Return what does not go together in a command line."""
    estimates = options.topic or options.clock or (options.estimates and not options.live)
    run = options.live or options.files or options.scene
    faults = {
        f"unrecognized arguments: {one_line(' '.join(rest))}": (
            rest and not (options.live and rest[0] == "--ros-args")
        ),
        "--clock must be used with a recorded run, got --live": options.clock and options.live,
        "a run and its estimates must be given: LOG with --topic, --estimates or --clock; --scene "
        "with --estimates or --clock; or --live with --topic": not (estimates and run),
        "--live must be used with one --topic": options.live and len(options.topic) > 1,
        "--robust and --rpe must be used without --live and --clock": (
            (options.robust or options.rpe) and (options.live or options.clock)
        ),
        "--aligned must be used without --remove and --live": (
            options.aligned and (options.remove or options.live)
        ),
    }
    return next((text for text, is_there in faults.items() if is_there), None)


def make_parser() -> argparse.ArgumentParser:
    """Return the parser of the command line."""
    parser = new_parser("top_judge", DESCRIPTION)
    parser.add_argument(
        "files",
        type=Path,
        nargs="*",
        metavar="LOG",
        help="logs, rosbag2 folders, or the JSON of top_imu: one run",
    )
    parser.add_argument(
        "--topic",
        action="append",
        default=[],
        help="full name of the topic with the estimates; repeat it to compare several topics "
        "in a table",
    )
    parser.add_argument("--frame", help="child frame of the estimates, for /tf")
    parser.add_argument(
        "--attitude-of",
        choices=ATTITUDES,
        help="whose attitude the estimates describe; default: the sensor for Imu messages, else "
        "the body",
    )
    parser.add_argument("--scene", help="a scene that starts at the stamp 0, instead of LOG")
    parser.add_argument("--node", help="full name of the node if the log has several tops")
    parser.add_argument(
        "--estimates",
        type=Path,
        metavar="FILE",
        help="another log, or a table: with named columns, or in the form of Motive, TUM, "
        "EuRoC or KITTI (with times)",
    )
    parser.add_argument(
        "--rpy",
        choices=ORDERS,
        help="order of roll, pitch and yaw of a table, about the axes of the body: zyx, yaw first, "
        "is the order of ROS and of aircraft",
    )
    parser.add_argument(
        "--remove",
        action="append",
        choices=("offset", "delay", "drift"),
        default=[],
        help="subtract what was found: the constant rotations, the delay (up to 0.5 s), or the "
        "drift of the heading",
    )
    parser.add_argument(
        "--aligned",
        choices=MODELS,
        metavar="MODEL",
        help="align with the given model, and look for no other causes of the error: none, "
        "heading, world or world-and-body; +delay, +clock or +delay+clock after it also fits the "
        "error of the stamps",
    )
    parser.add_argument(
        "--clock",
        metavar="TOPIC|FILE",
        help="print how late the stamps of these estimates are, how fast the delay grows, and "
        "their jitter; --aligned names the rotations that are fitted with it (default none)",
    )
    parser.add_argument(
        "--robust",
        action="store_true",
        help="ignore outliers (more than five standard deviations off) in the search for causes of "
        "the error and in fits of models",
    )
    parser.add_argument(
        "--rpe",
        type=read_lag,
        metavar="TIME",
        help="also compute the error of the rotation over a time, such as 1s or 50ms (the relative "
        "pose error of evo)",
    )
    parser.add_argument("--json", action="store_true", help="print JSON instead of text")
    parser.add_argument(
        "-o", "--output", type=Path, metavar="FOLDER", help="folder for JSON and plots"
    )
    parser.add_argument(
        "--max-error",
        type=positive,
        metavar="RAD",
        help="status 1 if the largest attitude error is above RAD",
    )
    parser.add_argument(
        "--live", action="store_true", help="judge a running node: one line each second"
    )
    parser.add_argument("--seconds", type=positive, help="duration of --live")
    return parser


def _run(options: argparse.Namespace, rest: list[str]) -> int:
    if options.live:
        from symtop_ros.truth.judge.live import judge_live

        return judge_live(options, ["top_judge", *rest])
    if options.clock:
        _read_clock(options)
    run = read_run(options)
    sources = read_sources(options, run)
    status = report_faults(run, sources)
    found = (_measure_clocks if options.clock else _judge)(options, run, sources)
    return max(status, found)


def _measure_clocks(options: argparse.Namespace, run: Run, sources: list[Source]) -> int:
    model = options.aligned or "none"
    clocks = [measure_clock(each.estimates, run.truth, each.name, model) for each in sources]
    header = _make_header("clock", options)
    facts = [header | asdict(each) for each in clocks]
    print(json.dumps(facts, indent=1) if options.json else format_clocks(clocks))
    return 0


def _judge(options: argparse.Namespace, run: Run, sources: list[Source]) -> int:
    judgements = [
        judge(
            each.estimates,
            run.truth,
            each.name,
            tuple(options.remove),
            options.aligned,
            options.robust,
            options.rpe,
        )
        for each in sources
    ]
    text = _dump(judgements, options) if options.json or options.output else ""
    print(text if options.json else format_judgements(judgements))
    if options.output:
        _write(judgements, text, options.output)
    largest = max(float(each.errors.total.max()) for each in judgements)
    enforce_limit(largest, options.max_error)
    return 0


def _read_clock(options: argparse.Namespace) -> None:
    """Take the estimates of --clock: a topic, or a file if there is one of this name."""
    if Path(options.clock).exists() or not options.clock.startswith("/"):
        options.estimates = Path(options.clock)
    else:
        options.topic = [options.clock]


def _make_header(kind: str, options: argparse.Namespace) -> dict[str, Any]:
    return make_header(kind, [*options.files, *filter(None, [options.estimates])])


def _dump(judgements: list[Judgement], options: argparse.Namespace) -> str:
    """Return an object for one judgement, a list for several."""
    header = _make_header("judge", options)
    facts = [header | each.facts() for each in judgements]
    return json.dumps(facts[0] if len(facts) == 1 else facts, indent=1)


def _write(judgements: list[Judgement], text: str, folder: Path) -> None:
    """Write judge.json, and the plot of one source if Matplotlib is installed."""
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "judge.json").write_text(text + "\n", encoding="utf-8")
    if len(judgements) > 1:
        return
    try:
        from symtop_ros.base.figure_style import write_figures
        from symtop_ros.truth.judge.error_plot import draw_errors
    except ModuleNotFoundError as error:
        print(f"top_judge: no plot, {error.name} is missing", file=sys.stderr)
    else:
        write_figures({"judge": lambda: draw_errors(judgements[0].errors)}, folder)
