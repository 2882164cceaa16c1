"""Entry point of `top_judge`: estimates in logs, live topics, and the test set."""

import argparse
import json
import math
import shutil
import sys
from pathlib import Path

from symtop_ros.judge.compare import compare, find_offset
from symtop_ros.judge.estimates import CSV, Estimates, read_csv, read_topic
from symtop_ros.judge.judgement import Judgement
from symtop_ros.judge.truth import Truth, read_truth
from symtop_ros.log.bag import open_run
from symtop_ros.log.reader import LogError
from symtop_ros.log.top_log import TopLog
from symtop_ros.simulation.validation import one_line
from symtop_ros.testset import score

DESCRIPTION = """Compares estimates of attitude and angular velocity with the exact motion of the
top at the estimates' own stamps. The run must be in the log with its ~/events."""
REMOVABLE = ("offset", "delay")


def main(args: list[str] | None = None) -> int:
    """Judge; return 0 (good), 1 (failed, or above --max-error) or 2 (usage)."""
    parser = _parser()
    arguments = sys.argv[1:] if args is None else args
    # The rest belongs to ROS (--ros-args ...), which only --live needs.
    options, rest = parser.parse_known_args(arguments)
    if rest and not (options.live and rest[0] == "--ros-args"):
        parser.error(f"unrecognized arguments: {one_line(' '.join(rest))}")
    has_estimates = options.topic or (options.estimates and not options.live)
    if options.testset is None and not (has_estimates and (options.live or options.files)):
        parser.error("LOG with --topic or --estimates, --live with --topic, or --testset is needed")
    try:
        return _run(options, rest)
    except (LogError, ValueError) as error:
        print(f"top_judge: {one_line(error)}", file=sys.stderr)
    except OSError as error:
        print(
            f"top_judge: {one_line(error.filename or 'output')}: {error.strerror}", file=sys.stderr
        )
    return 1


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(prog="top_judge", description=DESCRIPTION)
    parser.add_argument(
        "files", type=Path, nargs="*", metavar="LOG", help="logs and rosbag2 folders: one run"
    )
    parser.add_argument("--topic", help="full name of the topic with the estimates")
    parser.add_argument("--frame", help="child frame of the estimates, for /tf")
    parser.add_argument("--node", help="full name of the top if there are several")
    parser.add_argument(
        "--estimates",
        type=Path,
        metavar="FILE",
        help="another log, or a CSV file, with the estimates",
    )
    parser.add_argument(
        "--remove",
        action="append",
        choices=REMOVABLE,
        default=[],
        help="take away the constant rotations, or the delay (up to 0.1 s), that were found",
    )
    parser.add_argument("-o", "--output", type=Path, metavar="FOLDER", help="for JSON and plots")
    parser.add_argument(
        "--max-error", type=_angle, metavar="RAD", help="status 1 if the attitude is further off"
    )
    parser.add_argument("--live", action="store_true", help="a line each second, of a running node")
    parser.add_argument("--seconds", type=_angle, help="end of --live")
    parser.add_argument(
        "--testset",
        nargs="?",
        const="",
        metavar="PROBLEM",
        help="list the problems; with a name: score LOG, a CSV file, or copy it to --output",
    )
    return parser


def _angle(text: str) -> float:
    try:
        value = float(text)
    except ValueError:
        value = math.nan
    if not 0 < value < math.inf:
        raise argparse.ArgumentTypeError(f"must be a number above 0, got {one_line(text)}")
    return value


def _run(options: argparse.Namespace, rest: list[str]) -> int:
    if options.testset is not None:
        return _score(options)
    if options.live:
        from symtop_ros.judge.live import judge_live

        return judge_live(options, ["top_judge", *rest])
    truth = read_truth(TopLog(open_run(options.files), options.node))
    judgement = judge(
        _read_estimates(options),
        truth,
        options.topic or str(options.estimates),
        tuple(options.remove),
    )
    print(judgement.format())
    if options.output:
        _write(judgement, options.output)
    if options.max_error and judgement.largest > options.max_error:
        limit = f"{options.max_error:g} rad"
        print(
            f"top_judge: the attitude is off by {judgement.largest:.3g} rad, limit {limit}",
            file=sys.stderr,
        )
        return 1
    return 0


def _write(judgement: Judgement, folder: Path) -> None:
    """Write judge.json, and the plot if Matplotlib is installed."""
    folder.mkdir(parents=True, exist_ok=True)
    text = json.dumps(judgement.facts(), indent=1)
    (folder / "judge.json").write_text(text + "\n", encoding="utf-8")
    try:
        from symtop_ros.judge.plots import write_plot
    except ModuleNotFoundError as error:
        print(f"top_judge: no plot, {error.name} is missing", file=sys.stderr)
    else:
        write_plot(judgement.errors, folder)


def judge(
    estimates: Estimates, truth: Truth, source: str, removed: tuple[str, ...] = ()
) -> Judgement:
    """Compare estimates with the exact motion; `removed` may name "offset" and "delay"."""
    found = find_offset(estimates, truth)
    wanted = {"rotations": "offset" in removed, "delay": "delay" in removed}
    taken = found if all(wanted.values()) else find_offset(estimates, truth, **wanted)
    errors = compare(estimates, truth, taken)
    if not len(errors.total):
        count = len(estimates)
        raise LogError(
            f"{source} must have an attitude at a stamp within the run, got none of {count}"
        )
    return Judgement(source, errors, found, removed, estimates.left_out)


def _read_estimates(options: argparse.Namespace) -> Estimates:
    other: Path | None = options.estimates
    if other and other.suffix == CSV:
        return read_csv(other)
    if not options.topic:
        raise LogError(f"--topic must name the estimates in {other}, got none")
    return read_topic(open_run([other] if other else options.files), options.topic, options.frame)


def _score(options: argparse.Namespace) -> int:
    """List the problems of the test set, score a trajectory, or copy a problem."""
    problems = score.read_problems()
    if not options.testset:
        print(score.list_problems(problems))
    elif options.files:
        result = score.score_file(problems, options.testset, options.files[0])
        print(result.format())
        if options.max_error and result.angles.max() > options.max_error:
            return 1
    else:
        _copy(problems, options.testset, options.output or Path())
    return 0


def _copy(problems: dict[str, score.Problem], name: str, folder: Path) -> None:
    """Write a problem as JSON, and its models, into a folder."""
    problem = score.find_problem(problems, name)
    folder.mkdir(parents=True, exist_ok=True)
    target = folder / f"{name}.json"
    target.write_text(problem.format_json(), encoding="utf-8")
    models = sorted((score.FILE.parent / "models").glob(f"{name}.*"))
    for model in models:
        shutil.copy(model, folder / model.name)
    print(f"wrote {', '.join([target.name, *(model.name for model in models)])} to {folder}")
