"""`top_judge --testset`: problems listed, copied, and scored."""

import argparse
import shutil
from pathlib import Path

from symtop_ros.testset import score

ALL = "all"  # in place of a name: copies every problem into a folder of its own
SHARED = ("score.py", "README.md", "LICENSE")


def run_testset(options: argparse.Namespace) -> int:
    """List the problems of the test set, score a trajectory, or copy a problem."""
    problems = score.read_problems()
    if not options.testset:
        print(score.list_problems(problems))
    elif options.files:
        result = score.score_file(problems, options.testset, options.files[0])
        print(result.format())
        if options.max_error and result.angles.max() > options.max_error:
            return 1
    elif options.testset == ALL:
        for name in problems:
            _copy(problems, name, (options.output or Path()) / name)
    else:
        _copy(problems, options.testset, options.output or Path())
    return 0


def _copy(problems: dict[str, score.Problem], name: str, folder: Path) -> None:
    """Write a problem, its models, and what is needed to score it alone, into a folder."""
    problem = score.find_problem(problems, name)
    folder.mkdir(parents=True, exist_ok=True)
    target = folder / f"{name}.json"
    target.write_text(problem.format_json(), encoding="utf-8")
    source = score.FILE.parent
    copied = [*sorted((source / "models").glob(f"{name}.*")), *(source / each for each in SHARED)]
    for each in copied:
        shutil.copy(each, folder / each.name)
    print(f"wrote {', '.join([target.name, *(each.name for each in copied)])} to {folder}")
