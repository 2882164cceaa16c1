"""Entry point of `top_node`."""

import argparse
import gc
import sys
from collections.abc import Callable

import rclpy
from rclpy.executors import ExternalShutdownException, SingleThreadedExecutor
from rclpy.utilities import remove_ros_args

from symtop_ros.distribution import use_profile
from symtop_ros.node.top_node import TopNode
from symtop_ros.shutdown import describe_failure, ros_context
from symtop_ros.simulation.presets import scene_names

HELP = """\
examples:
  top_node --ros-args -p scene:=hurry_slow
  top_node --ros-args -p top.Mgl:=-0.068 -p initial.theta:=0.3 -p publish_rate:=1000
  top_node --ros-args --params-file my_top.yaml

scenes: {scenes}
"""
# Fast DDS announces this node every 0.1 s instead of 3 s: the file says why.
PROFILE = "fastdds_discovery.xml"
SWITCH_INTERVAL = 1e-4  # s that a tick may wait for the thread that writes the log


def main(args: list[str] | None = None) -> int:
    """Run the node until it is shut down; return the exit status."""
    arguments = sys.argv if args is None else ["top_node", *args]
    parser = argparse.ArgumentParser(
        prog="top_node",
        description="Simulate a heavy symmetric top in real time. Parameters are ROS parameters.",
        epilog=HELP.format(scenes=", ".join(scene_names())),
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    try:
        parser.parse_args(remove_ros_args(arguments)[1:])
        sys.setswitchinterval(SWITCH_INTERVAL)
        use_profile(PROFILE)
        with ros_context(arguments) as listen:
            return _run(listen)
    except ExternalShutdownException:
        return 0
    except Exception as error:
        print(f"top_node: {describe_failure(error)}", file=sys.stderr)
        return 1


def _run(listen: Callable[[], None]) -> int:
    """Spin until shutdown; return 1 if a tick or the recording failed (both were reported)."""
    # Not rclpy's EventsExecutor: as it waits, other threads stand still (rclpy 9.1, Kilted).
    executor = SingleThreadedExecutor()
    top = TopNode()
    gc.freeze()  # collecting garbage among the objects of the start would delay ticks
    try:
        listen()
        rclpy.spin(top, executor)
    except Exception:
        if rclpy.ok():
            raise
    finally:
        top.close()
    failure = top.session.recording.unreported_failure
    if failure:
        print(f"top_node: recording stopped: {failure}", file=sys.stderr)
    return 1 if top.failure or failure else 0
