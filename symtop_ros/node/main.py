"""Entry point of `top_node`."""

from __future__ import annotations

import argparse
import gc
import sys
from collections.abc import Callable

import rclpy
from rclpy.executors import ExternalShutdownException, SingleThreadedExecutor
from rclpy.utilities import remove_ros_args

from symtop_ros.ending import ros
from symtop_ros.node.scene import scene_names
from symtop_ros.node.top_node import TopNode
from symtop_ros.wire.text import one_line

HELP = """\
examples:
  top_node --ros-args -p scene:=hurry_slow
  top_node --ros-args -p top.Mgl:=-0.068 -p initial.theta:=0.3 -p publish_rate:=1000
  top_node --ros-args --params-file my_top.yaml

scenes: {scenes}
"""
SWITCH = 1e-4  # s; a tick waits no longer than this for the thread that writes the log


def main(args: list[str] | None = None) -> int:
    """Run the node until it is shut down; return the exit status."""
    arguments = sys.argv if args is None else ["top_node", *args]
    parser = argparse.ArgumentParser(
        prog="top_node",
        description="A heavy symmetric top in real time. Parameters are given the ROS way.",
        epilog=HELP.format(scenes=", ".join(scene_names())),
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    try:
        parser.parse_args(remove_ros_args(arguments)[1:])
        sys.setswitchinterval(SWITCH)
        with ros(arguments) as listen:
            return _run(listen)
    except ExternalShutdownException:
        return 0
    except Exception as error:
        print(f"top_node: {one_line(error) or type(error).__name__}", file=sys.stderr)
        return 1


def _run(listen: Callable[[], None]) -> int:
    """Spin until shutdown; return 1 where a tick failed, which was told, or the end of the log."""
    executor = SingleThreadedExecutor()
    top = TopNode()
    gc.freeze()  # what is there now stays: to look through it for garbage would delay ticks
    try:
        listen()
        rclpy.spin(top, executor)
    except Exception:
        if rclpy.ok():
            raise
    finally:
        top.close()
    if top.log.untold:
        print(f"top_node: recording stopped: {top.log.untold}", file=sys.stderr)
    return 1 if top.failure or top.log.untold else 0
