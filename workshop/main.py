"""Entry point of `python -m workshop`: its commands, and an import for the one that is chosen."""

import argparse
import sys
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

from symtop_ros.command import positive
from symtop_ros.simulation.validation import one_line
from symtop_ros.web.join import LANGUAGES

LARGEST_MAP = 4000  # points along a side
DESCRIPTION = """Measures speed against error, compared with the integrators that are installed,
retells the article with its numbers, and draws the lesson, the maps of Perry's rule and pictures of
the documents. `make help` lists the targets that call it."""


def main(args: list[str] | None = None) -> int:
    """Run a command; return 0 (good), 1 (failed) or 2 (usage)."""
    options = _parser().parse_args(args)
    try:
        run, _ = COMMANDS[options.command]
        return run(options)
    except OSError as error:
        file = error.filename or options.folder
        print(f"workshop: {file}: {error.strerror or error}", file=sys.stderr)
        return 1


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(prog="workshop", description=DESCRIPTION)
    commands = parser.add_subparsers(dest="command", metavar="COMMAND", required=True)
    of = {name: commands.add_parser(name, help=text) for name, (_, text) in COMMANDS.items()}
    of["language"].add_argument("languages", nargs="*", default=LANGUAGES, metavar="TAG")
    for name in of.keys() - {"language"}:
        folder = "docs" if name == "pictures" else "report"
        of[name].add_argument(
            "folder", type=Path, nargs="?", default=Path(folder), help=f"./{folder}"
        )
    for name in ("speed", "testset", "derivatives", "filters"):
        of[name].add_argument("--docs", type=_docs, help="write tables and plots here, too")
    text = "every peer, every motion, long times: hours instead of minutes"
    of["speed"].add_argument("--full", action="store_true", help=text)
    for name, default in (("speed", "4 s (--full: 60)"), ("testset", "0.2 s")):
        text = f"largest time of one run, {default}"
        of[name].add_argument("--limit", type=positive, metavar="S", help=text)
    text = "releases of engines, each in its own environment, instead (an hour; needs a network)"
    of["testset"].add_argument("--releases", action="store_true", help=text)
    text = "the worksheet and the teacher's sheet (HTML, to print) instead of the pictures"
    of["lesson"].add_argument("--sheets", action="store_true", help=text)
    text = "language of the sheets (default: en)"
    of["lesson"].add_argument("--language", choices=LANGUAGES, default="en", help=text)
    of["maps"].add_argument("--points", type=_points, default=1000, help="along each side")
    return parser


def _points(text: str) -> int:
    # isdecimal comes first: int() refuses very long numbers with an error of a different kind.
    if not text.isdecimal() or len(text) > 9 or not 2 <= int(text) <= LARGEST_MAP:
        raise argparse.ArgumentTypeError(f"must be 2 to {LARGEST_MAP}, got {one_line(text)}")
    return int(text)


def _docs(text: str) -> Path:
    path = Path(text)
    # refused before the minutes of measuring, not after them
    if not (path.is_dir() and (path.parent / "README.md").is_file()):
        raise argparse.ArgumentTypeError(f"must be a folder next to a README.md, got {text}")
    return path


def _map(options: argparse.Namespace) -> int:
    from workshop.article.maps import write_maps

    return write_maps(options.folder, options.points)


def _retell(options: argparse.Namespace) -> int:
    from workshop.article.retell import retell

    return retell(options.folder)


def _draw_lesson(options: argparse.Namespace) -> int:
    from workshop.lesson.pictures import write_lesson, write_sheets

    if options.sheets:
        return write_sheets(options.folder, options.language)
    return write_lesson(options.folder)


def _check_language(options: argparse.Namespace) -> int:
    from workshop.languages import check_languages

    return check_languages(options.languages)


def _draw_pictures(options: argparse.Namespace) -> int:
    from workshop.pictures.documents import write_pictures

    return write_pictures(options.folder)


def _score(options: argparse.Namespace) -> int:
    if options.releases:
        from workshop.releases.page import measure_releases

        return measure_releases(options.folder, options.docs)
    from workshop.speed.testset import LIMIT, score_testset

    return score_testset(options.folder, options.docs, options.limit or LIMIT)


def _derive(options: argparse.Namespace) -> int:
    from workshop.speed.derivatives import compare_derivatives

    return compare_derivatives(options.folder, options.docs)


def _filter(options: argparse.Namespace) -> int:
    from workshop.speed.filters import judge_filters

    return judge_filters(options.folder, options.docs)


def _measure(options: argparse.Namespace) -> int:
    from workshop.speed.benchmarks import FULL, QUICK
    from workshop.speed.measure import measure

    scope = FULL if options.full else QUICK
    command = "make -C workshop report ARGS=--full" if options.full else "make -C workshop report"
    if options.limit:
        scope = replace(scope, limit=options.limit)
        command = f"python -m workshop speed --limit {options.limit:g}"
    return measure(options.folder, scope, command, options.docs)


# Each imports what it needs, so that a part works without the packages that others need.
COMMANDS: dict[str, tuple[Callable[[argparse.Namespace], int], str]] = {
    "speed": (_measure, "speed against error: tables, plots and JSON (some minutes)"),
    "testset": (_score, "scores of programs in the test set (20 minutes)"),
    "derivatives": (_derive, "derivatives by top and start, compared with heyoka (a minute)"),
    "filters": (_filter, "attitude filters fed with the top's noisy sensor (4 minutes)"),
    "article": (_retell, "the article's figures, its motions in 3D, and its claims"),
    "lesson": (_draw_lesson, "the pictures of the lesson, or sheets to print"),
    "language": (_check_language, "whether the texts of the page are complete in a language"),
    "maps": (_map, "where hurrying the precession raises the top"),
    "pictures": (_draw_pictures, "all pictures of the documents, and the steps of docs/lesson.md"),
}
