"""Options of `top_node`, without ROS."""

import argparse
import re
from collections.abc import Sequence
from itertools import pairwise

from symtop_ros.base.command import new_parser
from symtop_ros.run.simulation.presets import scene_names
from symtop_ros.run.simulation.settings import PARAMETERS

ASSIGNED = re.compile(r"([\w.]+):=(.*)", re.DOTALL)
PARAMETER_OPTIONS = ("-p", "--param")
SCENE = "scene"

HELP = """\
examples:
  top_node --scene hurry_slow
  top_node --ros-args -p scene:=hurry_slow
  top_node --ros-args -p top.Mgl:=-0.068 -p initial.theta:=0.3 -p publish_rate:=1000
  top_node --ros-args --params-file my_top.yaml

scenes: {scenes}
"""


def make_parser() -> argparse.ArgumentParser:
    """Return the parser of the command line; the rest is read by ROS."""
    parser = new_parser(
        "top_node",
        "Simulate a heavy symmetric top in real time. Parameters are ROS parameters.",
        epilog=HELP.format(scenes=", ".join(scene_names())),
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.forms = {name: f"--scene {name}" for name in scene_names()}
    parser.add_argument("--scene", metavar="NAME", help="scene to start with (default cusps)")
    return parser


def find_fault(words: Sequence[str], scene: str | None = None) -> str:
    """Return what is wrong with the arguments of ROS, and the right form; empty if nothing is.

    `scene:=NAME`, as `ros2 launch` has it, is a remapping to ROS, which then does nothing.
    """
    is_of_ros = False
    for before, word in pairwise(["", *words]):
        is_of_ros = word == "--ros-args" or (is_of_ros and word != "--")
        found = ASSIGNED.fullmatch(word)
        if not found:
            continue
        if before in PARAMETER_OPTIONS and not is_of_ros:
            return f"{before} must come after --ros-args (--ros-args {before} {word}), got none"
        if found[1] not in (*PARAMETERS, SCENE):
            continue
        if before not in PARAMETER_OPTIONS:
            right = f"--ros-args -p {word}"
            if found[1] == SCENE:
                right = f"--scene {found[2]}, or {right}"
            return f"{found[1]} must be given as a parameter ({right}), got a remapping, {word}"
        if scene is not None and found[1] == SCENE:
            return f"scene must be given once, got --scene {scene} and {before} {word}"
    return ""
