"""Entry point of `top_live`: stream a running top to a Rerun viewer."""

import argparse
import contextlib
import math
import socket
import subprocess
import sys
import threading
import time
from collections.abc import Callable, Iterator

import rclpy
import rerun as rr
from rclpy.executors import SingleThreadedExecutor

from symtop_ros.base.command import has_screen
from symtop_ros.base.shutdown import run_with_ros, spin_until
from symtop_ros.replay import viewer
from symtop_ros.replay.options import view_options
from symtop_ros.replay.view.view import View, ViewOptions
from symtop_ros.ros.live.feed import Feed
from symtop_ros.ros.live.options import make_parser
from symtop_ros.run.log.reader import LogError
from symtop_ros.run.wire.names import full_name

SEND_PERIOD = 0.05  # s between two batches
PROBE_PERIOD = 1.0  # s between two checks that the viewer is running
SILENCE = 5.0  # s without a message at the start, after which it says so
START_TIMEOUT = 30.0  # s for the viewer to start
END_TIMEOUT = 3.0  # s for the viewer to take what is left


def main(args: list[str] | None = None) -> int:
    """Stream until interrupted, or until the viewer that was opened is closed."""
    return run_with_ros(make_parser(), args, _run)


def _run(options: argparse.Namespace, listen: Callable[[], None]) -> int:
    node = rclpy.create_node("top_live", start_parameter_services=False)
    executor = SingleThreadedExecutor()
    executor.add_node(node)
    feed = Feed(node, full_name(options.node))
    listen()
    with _viewer(options.port, options.web) as process:
        _stream(executor, feed, options, process)
    return 0


@contextlib.contextmanager
def _viewer(port: int, web: bool) -> Iterator[subprocess.Popen[bytes] | None]:
    """Start a viewer if none listens on the port; it is ended on exit."""
    if _listens(port):
        yield None
        return
    if not web and not has_screen():
        raise LogError(
            f"no viewer listens on port {port}, and there is no screen for a new one: use --web"
        )
    with viewer.start(port=port, web=web) as process:
        try:
            deadline = time.monotonic() + START_TIMEOUT
            while rclpy.ok() and not _listens(port):
                if process.poll() is not None or time.monotonic() > deadline:
                    raise LogError(f"the Rerun viewer did not start within {START_TIMEOUT:g} s")
                time.sleep(0.1)
            yield process
        finally:
            process.terminate()


def _stream(
    executor: SingleThreadedExecutor,
    feed: Feed,
    options: argparse.Namespace,
    process: subprocess.Popen[bytes] | None,
) -> None:
    view: View | None = None
    probed = 0.0
    heard = time.monotonic()
    try:
        while process is None or process.poll() is None:
            now = time.monotonic()
            if now - probed > PROBE_PERIOD:
                probed = now
                view = _connect(view, feed, options)
            spin_until(executor, now + SEND_PERIOD)
            batch = feed.batch()
            if batch.columns or batch.events:
                heard = math.inf
            elif now > heard + SILENCE:
                heard = math.inf
                print(
                    f"top_live: nothing heard from {full_name(options.node)} for {SILENCE:g} s: "
                    "is top_node running, with the same ROS_DOMAIN_ID and --node?",
                    file=sys.stderr,
                    flush=True,
                )
            if view:
                view.send(batch)
    finally:
        _end(view)  # while the viewer still runs


def _connect(view: View | None, feed: Feed, options: argparse.Namespace) -> View | None:
    """Return the view while the viewer runs, None without one, a new view for a new viewer."""
    if not _listens(options.port):
        if view:
            print("the viewer ended; waiting for a new one", file=sys.stderr, flush=True)
            _end(view)
        return None
    if view is None:
        print(f"showing the top in the viewer on port {options.port}", flush=True)
        feed.repeat_event()
        recording = rr.RecordingStream(viewer.APPLICATION)
        recording.connect_grpc(f"rerun+http://{viewer.HOST}:{options.port}/proxy")
        view = View(recording, live=True, options=ViewOptions(**view_options(options)))
    return view


def _end(view: View | None) -> None:
    """Send what is left, for some seconds: Rerun waits for ever for a viewer that takes nothing."""
    if view:
        ending = threading.Thread(target=view.close, daemon=True)
        ending.start()
        ending.join(END_TIMEOUT)
        if ending.is_alive():
            rr.unregister_shutdown()  # which would wait again
            print("top_live: the viewer does not answer", file=sys.stderr, flush=True)


def _listens(port: int) -> bool:
    with socket.socket() as probe:
        probe.settimeout(0.5)
        return probe.connect_ex((viewer.HOST, port)) == 0
