"""Entry point of `python -m workshop`: its commands, and an import for the one that is chosen."""

import argparse
import sys
from importlib import import_module
from pathlib import Path

import yaml

from symtop_ros.base.command import positive
from symtop_ros.page.web.join import LANGUAGES

COMMANDS: dict[str, dict[str, str]] = yaml.safe_load(
    Path(__file__).with_name("commands.yaml").read_text(encoding="utf-8")
)
DESCRIPTION = """Measures speed against error, compared with the integrators that are installed,
retells the article with its numbers, and draws the lesson, the maps of Perry's rule and pictures of
the documents. `make help` lists the targets that call it."""


def main(args: list[str] | None = None) -> int:
    """Run a command; return 0 (good), 1 (failed) or 2 (usage)."""
    options = vars(make_parser().parse_args(args))
    module, _, name = COMMANDS[options.pop("command")]["run"].rpartition(".")
    try:
        if folder := options.get("folder"):
            folder.mkdir(parents=True, exist_ok=True)
        # Those that can fail return a status.
        return getattr(import_module(module), name)(**options) or 0
    except BrokenPipeError:
        raise
    except OSError as error:
        file = error.filename or options["folder"]
        print(f"workshop: {file}: {error.strerror or error}", file=sys.stderr)
        return 1


def make_parser() -> argparse.ArgumentParser:
    """Return the parser of all commands."""
    parser = argparse.ArgumentParser(prog="workshop", description=DESCRIPTION)
    commands = parser.add_subparsers(dest="command", metavar="COMMAND", required=True)
    of = {name: commands.add_parser(name, help=each["help"]) for name, each in COMMANDS.items()}
    of["language"].add_argument("languages", nargs="*", default=LANGUAGES, metavar="TAG")
    for name in of.keys() - {"language"}:
        folder = "docs" if name in ("pictures", "tables") else "report"
        of[name].add_argument(
            "folder", type=Path, nargs="?", default=Path(folder), help=f"./{folder}"
        )
    for name in ("speed", "testset", "derivatives", "filters", "records"):
        of[name].add_argument("--docs", type=_docs, help="write tables and plots here, too")
    text = "every peer, every motion, long times: hours instead of minutes"
    of["speed"].add_argument("--full", action="store_true", help=text)
    text = "largest time of one run, 4 s (--full: 60)"
    of["speed"].add_argument("--limit", type=positive, metavar="S", help=text)
    return parser


def _docs(text: str) -> Path:
    path = Path(text)
    # refused before the minutes of measuring, not after them
    if not (path.is_dir() and (path.parent / "README.md").is_file()):
        raise argparse.ArgumentTypeError(f"must be a folder next to a README.md, got {text}")
    return path
