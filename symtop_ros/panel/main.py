"""Entry point of `top_panel`: a page in the browser to play with a top."""

import argparse
import os
import signal
import sys
import threading
import webbrowser
from pathlib import Path
from typing import TYPE_CHECKING

from symtop_ros.simulation.presets import scene_names
from symtop_ros.simulation.validation import one_line
from symtop_ros.web.join import write_file

if TYPE_CHECKING:
    from symtop_ros.panel.page import Page
    from symtop_ros.panel.source import Source

PORT = 8015
SCENE = "hurry_slow"
PERIOD = 0.2  # s between two looks for the end
SPEED = 0.1  # of real time: nutation is too fast for the eye
WARNING = (
    "warning: anyone who can reach {host} may kick this top and change its parameters; "
    "nothing is encrypted"
)


def main(args: list[str] | None = None) -> int:
    """Serve the page until interrupted; return the exit status."""
    arguments = sys.argv[1:] if args is None else args
    parser = _parser()
    # The rest belongs to ROS (--ros-args ...), which only --node needs.
    options, rest = parser.parse_known_args(arguments)
    if rest and not (options.node and rest[0] == "--ros-args"):
        parser.error(f"unrecognized arguments: {one_line(' '.join(rest), 200)}")
    try:
        if options.write:  # needs neither viser nor ROS
            return _write(options.write)
        from symtop_ros.panel.source import LocalTop

        ending = threading.Event()
        for number in (signal.SIGINT, signal.SIGTERM):
            signal.signal(number, lambda *_: ending.set())
        if options.node:
            return _show_node(options, ["top_panel", *arguments], ending)
        return _show(options, LocalTop(options.scene, SPEED), ending)
    except ModuleNotFoundError as error:
        if error.name != "rclpy":  # the entry point says what is missing, and what brings it
            raise
        text = f"{error.name} is missing: source a ROS 2, or pip install '.[ros]' in the checkout"
        print(f"top_panel: {text}", file=sys.stderr)
        return 1
    except Exception as error:
        print(f"top_panel: {one_line(error) or type(error).__name__}", file=sys.stderr)
        return 1


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="top_panel",
        description="Play with a top on a page in the browser: a local one, or a running node.",
    )
    parser.add_argument(
        "--scene", default=SCENE, choices=scene_names(), metavar="SCENE", help="scene to start with"
    )
    parser.add_argument(
        "--lesson", action="store_true", help="open the lesson: eleven steps for a class"
    )
    parser.add_argument(
        "--write",
        type=Path,
        metavar="FILE.html",
        help="write a page that has its own top, for any browser and without a server, and end",
    )
    parser.add_argument(
        "--node", metavar="NAME", help="show and control a running node, such as /top (needs ROS)"
    )
    parser.add_argument(
        "--port", type=_port, default=PORT, help=f"port of the page (default {PORT}; 0: any)"
    )
    parser.add_argument(
        "--host",
        help="address to listen on (default: this machine only); who can reach it may kick",
    )
    parser.add_argument(
        "--save", type=Path, metavar="PAGE.html", help="write the run as a page when it ends"
    )
    parser.add_argument("--no-browser", action="store_true", help="print the address only")
    return parser


def _port(text: str) -> int:
    port = int(text)
    if not 0 <= port < 2**16:
        raise ValueError
    return port


def _show(options: argparse.Namespace, source: "Source", ending: threading.Event) -> int:
    """Serve the page of a top until `ending` is set; then write what was asked for."""
    from symtop_ros.panel.page import Page
    from symtop_ros.panel.server import LOCAL_HOST, LOCAL_NAMES

    _check_target(options.save)
    options.host = options.host or LOCAL_HOST
    try:
        page = Page(source, options.host, options.port)
    except OSError as error:
        source.close()
        raise OSError(_explain(error, options)) from None
    try:
        if options.host not in LOCAL_NAMES:
            print(f"top_panel: {WARNING.format(host=options.host)}", file=sys.stderr)
        url = page.server.url + ("/#lesson" if options.lesson else "")
        print(f"{source.name}: open {url} in a browser; Ctrl-C ends it", flush=True)
        if not options.no_browser and _has_screen():
            webbrowser.open(url)
        # With a time-out, because on Windows a wait without one does not see Ctrl-C.
        while not ending.wait(PERIOD):
            pass
        if options.save:
            _save(page, options.save)
    finally:
        page.close()
    return 0


def _write(path: Path) -> int:
    """Write the page that needs no server."""
    _check_target(path, "--write")
    path.write_text(write_file(), encoding="utf-8")
    print(f"wrote {path}; open it in a browser")
    return 0


def _check_target(path: Path | None, option: str = "--save") -> None:
    """Refuse a file that could not be written, before anything is played."""
    if path and (path.suffix != ".html" or not path.parent.is_dir()):
        raise ValueError(f"{option} must be a name that ends in .html in a folder, got {path}")


def _save(page: "Page", path: Path) -> None:
    content = page.save_run()
    if content is None:
        raise ValueError("nothing is saved: no page was open, so that the top did not move")
    path.write_bytes(content.content)
    print(f"wrote {path}; open it in a browser")


def _explain(error: OSError, options: argparse.Namespace) -> str:
    reason = (os.strerror(error.errno) if error.errno else str(error)).lower()
    return (
        f"port must be free on an address of this machine, got {options.host} port {options.port} "
        f"({reason}); use --port for another port"
    )


def _has_screen() -> bool:
    """Return True if a browser can open a window; else some systems open one in the terminal."""
    names = ("DISPLAY", "WAYLAND_DISPLAY")
    return sys.platform in {"darwin", "win32"} or any(os.environ.get(name) for name in names)


def _show_node(options: argparse.Namespace, arguments: list[str], ending: threading.Event) -> int:
    """Serve the page of a running node."""
    import rclpy
    from rclpy.signals import SignalHandlerOptions

    from symtop_ros.panel.node_source import NodeTop
    from symtop_ros.shutdown import describe_failure

    try:
        # Without the handlers of rclpy, which would shut ROS down while the page still uses it.
        rclpy.init(args=arguments, signal_handler_options=SignalHandlerOptions.NO)
        node = rclpy.create_node("top_panel", start_parameter_services=False)
        return _show(options, NodeTop(node, options.node), ending)
    except Exception as error:
        raise RuntimeError(describe_failure(error)) from None
    finally:
        rclpy.try_shutdown()


if __name__ == "__main__":
    sys.exit(main())
