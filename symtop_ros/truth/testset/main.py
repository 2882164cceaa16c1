"""Entry point of `top_testset`: the test set listed, written, and scored."""

import argparse
import json
from pathlib import Path

from symtop_ros import __version__
from symtop_ros.base.command import new_parser, positive, tell_failures
from symtop_ros.base.header import make_header
from symtop_ros.truth.testset import score
from symtop_ros.truth.testset.folders import write_problem, write_set
from symtop_ros.truth.testset.scoreboard import Entry, format_json, format_table, read_entries

NAME = "top_testset"
ALL = "all"  # in place of a name: every problem
DESCRIPTION = """\
Seventy exact motions of heavy tops, to test a physics engine or integrator:
  top_testset cusps -o cusps        writes one problem: models, start, README
  top_testset cusps cusps/mine.csv  scores your engine's table of t, w, x, y, z"""


def main(args: list[str] | None = None) -> int:
    """List, write or score; return 0 (good), 1 (failed, or above --max-error) or 2 (usage)."""
    parser = make_parser()
    options = parser.parse_args(args)
    if fault := _find_fault(options):
        parser.error(fault)
    return tell_failures(NAME, lambda: _run(options))


def make_parser() -> argparse.ArgumentParser:
    """Return the parser of the command line."""
    form = argparse.RawDescriptionHelpFormatter
    parser = new_parser(NAME, DESCRIPTION, formatter_class=form)
    parser.add_argument(
        "problem",
        nargs="?",
        metavar="PROBLEM",
        help="name of a problem, such as cusps; cusps.turned is the same problem with another "
        "description of its body; all: every problem; default: list all names",
    )
    parser.add_argument(
        "trajectory",
        nargs="?",
        type=Path,
        metavar="TRAJECTORY",
        help="score this CSV file with the columns t, w, x, y, z and, if you have them, wx, wy, "
        "wz; with all: each PROBLEM/NAME.csv in this folder",
    )
    parser.add_argument(
        "-o",
        "--output",
        type=Path,
        metavar="FOLDER",
        help="write the problem into this folder; with all: each into its own folder; without a "
        "name: the whole set as one collection (tables, models, scorer)",
    )
    parser.add_argument("--json", action="store_true", help="print the score as JSON")
    parser.add_argument(
        "--max-error",
        type=positive,
        metavar="RAD",
        help="status 1 if the largest attitude error is above RAD",
    )
    return parser


def _find_fault(options: argparse.Namespace) -> str | None:
    """Return what does not go together in a command line."""
    is_score, folder = bool(options.trajectory), options.output
    faults = {
        "PROBLEM with a TRAJECTORY to score, or with -o FOLDER to write it, is needed": (
            options.problem and not is_score and not folder
        ),
        "TRAJECTORY (to score) must be given without -o (to write)": is_score and folder,
        "--json and --max-error must be used with a TRAJECTORY": (
            (options.json or options.max_error) and not is_score
        ),
    }
    return next((text for text, is_there in faults.items() if is_there), None)


def _run(options: argparse.Namespace) -> int:
    problems = score.read_problems()
    name, folder = options.problem, options.output
    if options.trajectory:
        return _score(problems, options)
    if name == ALL:
        for each in problems:
            write_problem(problems, each, folder / each)
    elif name:
        write_problem(problems, name, folder)
    elif folder:
        write_set(problems, folder)
    else:
        print(score.list_problems(problems))
    return 0


def _score(problems: dict[str, score.Problem], options: argparse.Namespace) -> int:
    """Score a trajectory, or all of a folder."""
    path, testset = options.trajectory, score.describe_testset()
    header = make_header("scores" if options.problem == ALL else "score", [path])
    header |= {"testset": testset, "platform": score.describe_platform()}
    if options.problem == ALL:
        entries = read_entries(problems, path)
        text = format_table(entries, problems)
        facts = format_json(header, entries, problems) if options.json else ""
    else:
        entries = [Entry(path.stem, score.score_file(problems, options.problem, path))]
        only = entries[0].score
        text = f"{only.format()}\n{score.format_engine(only.engine)}"
        facts = json.dumps(header | entries[0].facts(), indent=1)
    cited = score.format_citation(f"symtop_ros {__version__}", testset)
    print(facts if options.json else f"{text}\n{cited}")
    score.enforce_limit(max(each.error for each in entries), options.max_error)
    return 0
