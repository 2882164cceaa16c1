"""Entry point of `top_node`."""

import argparse
import gc
import sys
from collections.abc import Callable, Sequence
from functools import partial

import rclpy
from rclpy.executors import SingleThreadedExecutor
from rclpy.parameter import Parameter

from symtop_ros.base.refusals import RefusedError, one_line
from symtop_ros.base.shutdown import run_with_ros
from symtop_ros.ros.node.host import shorten_slice, use_profile, use_real_time
from symtop_ros.ros.node.options import SCENE, find_fault, make_parser
from symtop_ros.ros.node.top_node import TopNode

# s that a tick may wait for the thread that writes the log, or for the first sample after a kick. A
# shorter time has two threads with work hand the interpreter's lock to each other for longer than
# their work takes: at 0.1 ms that first sample came 0.1 ms later, and one in a hundred 0.4 ms.
SWITCH_INTERVAL = 1e-3


def main(args: list[str] | None = None) -> int:
    """Run the node until it is shut down; return the exit status."""
    sys.setswitchinterval(SWITCH_INTERVAL)
    # Those of the middleware inherit it: else a request waits for each of them on a busy machine.
    shorten_slice()
    # Fast DDS announces this node every 0.1 s instead of 3 s: the file says why.
    use_profile("fastdds_discovery.xml")
    words = sys.argv[1:] if args is None else args
    if fault := find_fault(words):
        print(f"top_node: {one_line(fault)}", file=sys.stderr)
        return 2
    return run_with_ros(make_parser(), args, partial(_run, words))


def _run(words: Sequence[str], options: argparse.Namespace, listen: Callable[[], None]) -> int:
    """Spin until shutdown or a failure of the top; return 1 if it or the recording failed."""
    # Not rclpy's EventsExecutor, whose `spin` handles nothing in the wheels (docs/ros_reference.md
    # says why). By `spin_once` with a time-out it gains nothing: the samples come from another
    # thread.
    # The executor is created before a signal can shut ROS down, as the node.
    if fault := find_fault(words, options.scene):
        raise RefusedError(fault)
    scene = [] if options.scene is None else [Parameter(SCENE, value=options.scene)]
    executor = SingleThreadedExecutor()
    top = TopNode(parameter_overrides=scene)
    # Requests come through this thread; a busy machine would else preempt it while it holds the
    # interpreter's lock, for which the ticks then wait. Refused, the node has said so.
    if priority := top.simulation.settings.scheduling_priority:
        use_real_time(priority)
    gc.freeze()  # collecting garbage among the objects of the start would delay ticks
    try:
        listen()
        executor.add_node(top)
        while rclpy.ok() and not top.failure:
            executor.spin_once()
    except Exception:
        if rclpy.ok():
            raise
    finally:
        top.destroy_node()  # else the middleware ends after what it shares with other processes
    failure = top.session.recording.unreported_failure
    if failure:
        print(f"top_node: recording stopped: {failure}", file=sys.stderr)
    return 1 if top.failure or failure else 0
