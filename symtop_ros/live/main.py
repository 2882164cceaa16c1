"""Entry point of `top_live`: a running top in a Rerun viewer."""

from __future__ import annotations

import argparse
import contextlib
import socket
import subprocess
import sys
import time
from collections.abc import Iterator

import rclpy
import rerun as rr
from rclpy.executors import ExternalShutdownException, SingleThreadedExecutor
from rclpy.utilities import remove_ros_args

from symtop_ros.ending import ros
from symtop_ros.live.feed import Feed
from symtop_ros.playback import viewer
from symtop_ros.playback.mcap_file import LogError
from symtop_ros.playback.replay import APPLICATION
from symtop_ros.playback.scene.scene import Scene
from symtop_ros.wire.text import one_line

PORT = 9876  # Rerun's own
SENDING = 0.05  # s between two batches
PROBING = 1.0  # s between two looks whether the viewer is there
STARTING = 30.0  # s that a viewer may take to come up


def main(args: list[str] | None = None) -> int:
    """Stream until interrupted, or until the viewer that was opened is closed."""
    arguments = sys.argv if args is None else ["top_live", *args]
    try:
        options = _parser().parse_args(remove_ros_args(arguments)[1:])
        with ros(arguments) as listen:
            node = rclpy.create_node("top_live", start_parameter_services=False)
            executor = SingleThreadedExecutor()
            executor.add_node(node)
            feed = Feed(node, f"/{options.node.strip('/')}")
            listen()
            with _viewer(options.port, options.web) as process:
                _stream(executor, feed, options.port, process)
    except ExternalShutdownException:
        return 0
    except Exception as error:
        print(f"top_live: {one_line(error) or type(error).__name__}", file=sys.stderr)
        return 1
    return 0


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="top_live",
        description="Show a running top in a Rerun viewer: in the one that listens on the port, "
        "which may end and come again, or in one of its own.",
    )
    parser.add_argument("--node", default="/top", help="name of the node (default /top)")
    parser.add_argument("--port", type=_port, default=PORT, help=f"of the viewer (default {PORT})")
    parser.add_argument("--web", action="store_true", help="serve a browser on this machine")
    return parser


def _port(text: str) -> int:
    port = int(text)
    if not 0 < port < 2**16:
        raise ValueError
    return port


@contextlib.contextmanager
def _viewer(port: int, web: bool) -> Iterator[subprocess.Popen[bytes] | None]:
    """A viewer of our own where none listens: it ends with us, and we with it."""
    if _listens(port):
        yield None
        return
    if not web and not viewer.has_screen():
        msg = f"no viewer listens on port {port}, and there is no screen for one: try --web"
        raise LogError(msg)
    process = viewer.start(port=port, web=web)
    try:
        deadline = time.monotonic() + STARTING
        while rclpy.ok() and not _listens(port):
            if process.poll() is not None or time.monotonic() > deadline:
                msg = "the Rerun viewer did not start"
                raise LogError(msg)
            time.sleep(0.1)
        yield process
    finally:
        process.terminate()
        process.wait()


def _stream(
    executor: SingleThreadedExecutor,
    feed: Feed,
    port: int,
    process: subprocess.Popen[bytes] | None,
) -> None:
    scene: Scene | None = None
    probed = 0.0
    try:
        while process is None or process.poll() is None:
            now = time.monotonic()
            if now - probed > PROBING:
                probed = now
                scene = _followed(scene, feed, port)
            _spin(executor, now + SENDING)
            batch = feed.batch()
            if scene:
                scene.send(batch)
    finally:
        scene = None  # it hands over what it holds, as long as there is the viewer


def _followed(scene: Scene | None, feed: Feed, port: int) -> Scene | None:
    """The scene while the viewer is there, none while it is gone, a new one when it is back."""
    if not _listens(port):
        if scene:
            print("the viewer is gone; waiting for it to come back", file=sys.stderr, flush=True)
        return None
    if scene is None:
        print(f"showing in the viewer on port {port}", flush=True)
        feed.start_again()
        scene = Scene(_recording(port), live=True)
    return scene


def _recording(port: int) -> rr.RecordingStream:
    recording = rr.RecordingStream(APPLICATION)
    recording.connect_grpc(f"rerun+http://{viewer.HOST}:{port}/proxy")
    return recording


def _spin(executor: SingleThreadedExecutor, deadline: float) -> None:
    while (left := deadline - time.monotonic()) > 0:
        executor.spin_once(timeout_sec=left)


def _listens(port: int) -> bool:
    with socket.socket() as probe:
        probe.settimeout(0.5)
        return probe.connect_ex((viewer.HOST, port)) == 0


if __name__ == "__main__":
    sys.exit(main())
