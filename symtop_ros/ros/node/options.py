"""Options of `top_node`, without ROS."""

import argparse

from symtop_ros.base.command import new_parser
from symtop_ros.run.simulation.presets import scene_names

HELP = """\
examples:
  top_node --ros-args -p scene:=hurry_slow
  top_node --ros-args -p top.Mgl:=-0.068 -p initial.theta:=0.3 -p publish_rate:=1000
  top_node --ros-args --params-file my_top.yaml

scenes: {scenes}
"""


def make_parser() -> argparse.ArgumentParser:
    """Return the parser of the command line; the rest is read by ROS."""
    return new_parser(
        "top_node",
        "Simulate a heavy symmetric top in real time. Parameters are ROS parameters.",
        epilog=HELP.format(scenes=", ".join(scene_names())),
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
