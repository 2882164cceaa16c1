"""Entry point of `top_panel`: the page to play with a top, as a file, served, or of a node."""

import argparse
import errno
import os
import signal
import socket
import sys
import threading
import time
import webbrowser
from contextlib import closing, suppress
from pathlib import Path

from symtop_ros.base.command import has_screen, new_parser, port, tell_failures
from symtop_ros.base.refusals import one_line
from symtop_ros.page.panel.server import LOCAL_HOST, LOCAL_NAMES, Node, PageServer
from symtop_ros.page.web.join import LANGUAGES, write_file

PORT = 8015
PERIOD = 0.2  # s between two looks for the end
# What a page holds in which no run was saved.
WITHOUT_RUN = '<script type="application/json" id="top-run">null</script>'
FILE = Path("top.html")  # in the folder where the program is started: browsers may not read others


def main(args: list[str] | None = None) -> int:
    """Write, open or serve the page; return 0 (good), 1 (failed) or 2 (usage)."""
    arguments = sys.argv[1:] if args is None else args
    parser = make_parser()
    # The rest belongs to ROS (--ros-args ...), which only --node needs.
    options, rest = parser.parse_known_args(arguments)
    if rest and not (options.node and rest[0] == "--ros-args"):
        parser.error(f"unrecognized arguments: {one_line(' '.join(rest), 200)}")
    others = [name for name in ("node", "port", "host") if getattr(options, name) is not None]
    if options.write and others:
        parser.error(f"--write must be without --node, --port and --host, got --{others[0]}")
    return tell_failures("top_panel", lambda: _run(options, arguments))


def make_parser() -> argparse.ArgumentParser:
    """Return the parser of the command line."""
    parser = new_parser(
        "top_panel",
        "Open a page with a top in the browser. By default the page is a file with its own top, "
        f"{FILE} in this folder; with --host or --port it is served, and with --node it shows a "
        "running node.",
    )
    parser.add_argument(
        "--lesson", action="store_true", help="open the lesson: fifteen steps for a class"
    )
    parser.add_argument(
        "--language", choices=LANGUAGES, help="language of the page (default: the browser's)"
    )
    parser.add_argument("--write", type=Path, metavar="FILE.html", help="write the page, and exit")
    parser.add_argument(
        "--node", metavar="NAME", help="show and control a running node, such as /top (needs ROS)"
    )
    parser.add_argument(
        "--port",
        type=port,
        help=f"serve the page on this port (with --host or --node {PORT} by default; 0: any)",
    )
    parser.add_argument(
        "--host",
        help=f"serve the page on this address (default {LOCAL_HOST}: this machine only); 0.0.0.0: "
        "other machines too",
    )
    parser.add_argument("--no-browser", action="store_true", help="do not open a browser")
    return parser


def _run(options: argparse.Namespace, arguments: list[str]) -> int:
    opening = "lesson=1" if options.lesson else ""
    if options.node and not options.write:
        return _show_node(options, ["top_panel", *arguments], opening)
    page = write_file(opening=opening, language=options.language)
    if options.write:
        _write(options.write, page)
        print(f"wrote {options.write}; open it in a browser")
        return 0
    if options.port is None and options.host is None:
        return _open_file(options, page)
    return _serve(options, page, "each page has its own top")


def _write(path: Path, page: str) -> None:
    """Write the page."""
    if path.suffix != ".html" or not path.parent.is_dir():
        raise ValueError(f"--write must be FILE.html in a folder that exists, got {path}")
    part = path.resolve().with_suffix(".part")  # what was there stays, if the disk is full
    try:
        part.write_text(page, encoding="utf-8")
        part.replace(path.resolve())
    except OSError as error:
        raise ValueError(f"cannot write {path}: {error.strerror}") from None
    finally:
        with suppress(OSError):
            part.unlink()


def _open_file(options: argparse.Namespace, page: str) -> int:
    """Write the page into this folder and open it; a run that was saved there is kept."""
    path = FILE
    number = 1
    while path.exists() and not _is_own(path):
        print(f"kept {path}, because it contains a saved run")
        number += 1
        path = FILE.with_stem(f"{FILE.stem}_{number}")
    _write(path, page)
    is_opened = (
        not options.no_browser and has_screen() and webbrowser.open(path.absolute().as_uri())
    )
    print(f"wrote {path}, {'and opened it' if is_opened else 'open it'} in a browser")
    return 0


def _is_own(path: Path) -> bool:
    """Return True for a page without a run, of any version: it is renewed."""
    return WITHOUT_RUN in path.read_text(encoding="utf-8", errors="replace")


def _serve(options: argparse.Namespace, page: str, name: str, node: Node | None = None) -> int:
    """Serve a page until a signal."""
    # A list: the handler of a signal would wait for the lock of an event that its thread waits for.
    signals: list[int] = []
    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, lambda number, _: signals.append(number))
    host = options.host or LOCAL_HOST
    port = PORT if options.port is None else options.port
    try:
        server = PageServer(host, port, page, node)
    except (OSError, TypeError) as error:  # the latter for a host that is no name at all
        code = getattr(error, "errno", None)
        if isinstance(error, socket.gaierror) or code == errno.EADDRNOTAVAIL:
            raise ValueError(f"--host must be an address of this machine, got {host}") from None
        reason = (os.strerror(code) if code else str(error)).lower()
        raise ValueError(
            f"port must be free on an address of this machine, got {host} port {port} ({reason}); "
            "use --port for another port"
        ) from None
    if node and host not in LOCAL_NAMES:
        print(
            f"top_panel: warning: anyone who can reach {host} may kick this top and change its "
            "parameters; nothing is encrypted",
            file=sys.stderr,
        )
    threading.Thread(target=server.serve_forever, daemon=True).start()
    try:
        print(f"{name}: open {server.url} in a browser; Ctrl-C ends it", flush=True)
        if not options.no_browser and has_screen():
            webbrowser.open(server.url)
        while not signals:
            time.sleep(PERIOD)
    finally:
        server.shutdown()
        server.server_close()
    return 0


def _show_node(options: argparse.Namespace, arguments: list[str], opening: str) -> int:
    """Serve the page of a running node."""
    import rclpy
    from rclpy.signals import SignalHandlerOptions

    from symtop_ros.base.shutdown import describe_failure
    from symtop_ros.page.panel.bridge import Bridge

    try:
        # Without the handlers of rclpy, which would shut ROS down while the page still uses it.
        rclpy.init(args=arguments, signal_handler_options=SignalHandlerOptions.NO)
        node = rclpy.create_node("top_panel", start_parameter_services=False)
        with closing(Bridge(node, options.node)) as bridge:
            page = write_file(opening=opening, node=bridge.name, language=options.language)
            return _serve(options, page, bridge.name, bridge)
    except Exception as error:
        raise ValueError(describe_failure(error)) from None
    finally:
        rclpy.try_shutdown()
