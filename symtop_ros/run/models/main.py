"""Entry point of `top_model`: a top as URDF, SDF, MJCF or USD."""

import argparse
import sys
from pathlib import Path

from symtop_ros.base.command import decimal, new_parser, tell_failures
from symtop_ros.physics import Body
from symtop_ros.run.models import FORMATS
from symtop_ros.run.simulation.changes.requests import initial_state
from symtop_ros.run.simulation.settings import Settings


def main(args: list[str] | None = None) -> int:
    """Write a model; return 0 (good), 1 (refused or failed) or 2 (usage)."""
    return tell_failures("top_model", lambda: _write(make_parser().parse_args(args)))


def _write(options: argparse.Namespace) -> int:
    given = {"gravity": options.gravity, "mass": options.mass}
    settings = Settings.from_scene(
        options.scene, **{name: value for name, value in given.items() if value is not None}
    )
    text = FORMATS[options.format](
        settings.top,
        initial_state(settings.top, settings.initial, {}),
        Body.from_top(settings.top, settings.gravity, settings.mass or None),
    )
    if options.output:
        options.output.write_text(text, encoding="utf-8")
    else:
        print(text, end="")
    left_out = {"friction": settings.friction, "steady_torque": any(settings.steady_torque)}
    for name in (name for name, is_set in left_out.items() if is_set):
        print(f"top_model: left out: {name}", file=sys.stderr)
    return 0


def make_parser() -> argparse.ArgumentParser:
    """Return the parser of the command line."""
    parser = new_parser("top_model", "Write a top and its start as a model for other engines.")
    parser.add_argument("--format", choices=sorted(FORMATS), required=True)
    parser.add_argument("--scene", default="cusps", help="name of a scene, default cusps")
    parser.add_argument("--gravity", type=decimal, help="m/s^2, default that of the scene (9.81)")
    parser.add_argument("--mass", type=decimal, help="kg; default: a mass is assumed")
    parser.add_argument(
        "-o", "--output", type=Path, metavar="FILE", help="default: standard output"
    )
    return parser
