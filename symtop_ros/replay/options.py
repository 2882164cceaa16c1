"""Options of `top_replay`, and those of the 3D scene that `top_live` has too; without Rerun."""

import argparse
from pathlib import Path

from symtop_ros.base.command import decimal, new_parser
from symtop_ros.run.simulation.run_file import RATE


def add_view_options(parser: argparse.ArgumentParser) -> None:
    """Add the options for parts of the scene: those of `ViewOptions`, which needs Rerun."""
    for option, text in (
        ("--no-ghost", "do not draw the ghost (the same top without its last kick or clamp)"),
        ("--angles", "draw the axes of world and body, and Euler's angles phi, theta, psi"),
        (
            "--torques",
            "draw dL/dt and the inertial torque, in the body frame and in the precessing frame",
        ),
        (
            "--fictitious",
            "draw the torques in the precessing frame: gravity, Coriolis and centrifugal",
        ),
    ):
        parser.add_argument(option, action="store_true", help=text)


def view_options(options: argparse.Namespace) -> dict[str, bool]:
    """Return the fields of `ViewOptions` that the options ask for."""
    return {
        "ghost": not options.no_ghost,
        "angles": options.angles,
        "torques": options.torques,
        "fictitious": options.fictitious,
    }


def make_parser() -> argparse.ArgumentParser:
    """Return the parser of the command line."""
    parser = new_parser(
        "top_replay",
        "Play a log of top_node, or a run of the page, in the Rerun viewer; or save, "
        "check, repair or convert it.",
        epilog="Plain `rerun FILE.mcap` also draws the top, on the timeline that Rerun selects.",
    )
    parser.add_argument(
        "files",
        type=Path,
        nargs="+",
        metavar="FILE.mcap|run.json",
        help="a log, complete or damaged; a rosbag2 folder or a .db3 file; several files of one "
        "run; or a run that the page has saved",
    )
    parser.add_argument("--node", help="full name of the node if the log has several tops")
    add_view_options(parser)
    ways = parser.add_mutually_exclusive_group()
    ways.add_argument(
        "--save",
        type=Path,
        metavar="OUT",
        help="write a Rerun recording (OUT.rrd) or a page for any browser (OUT.html)",
    )
    ways.add_argument(
        "--web", action="store_true", help="serve the replay to a browser on this machine"
    )
    ways.add_argument(
        "--check", action="store_true", help="compute the run again from its events and compare"
    )
    ways.add_argument(
        "--repair",
        type=Path,
        metavar="OUT.mcap",
        help="write the readable messages of an MCAP file to a complete log",
    )
    ways.add_argument(
        "--mcap",
        type=Path,
        metavar="OUT.mcap",
        help="convert run.json to the log that a node would have written",
    )
    parser.add_argument(
        "--strict",
        action="store_true",
        help="with --check: status 1 also if topics of the node are missing in the log",
    )
    parser.add_argument(
        "--json", action="store_true", help="with --check: print JSON instead of text"
    )
    parser.add_argument(
        "--rate", type=decimal, help=f"samples per second for --mcap (default {RATE:g})"
    )
    return parser
