"""`top_judge --testset`: problems listed, copied, and scored."""

import argparse
import shutil
from pathlib import Path

from symtop_ros.testset import score


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
