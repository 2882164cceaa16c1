"""The programs of Rerun: its viewer on this screen, or in a browser on this machine."""

from __future__ import annotations

import os
import signal
import socket
import subprocess
import sys
from pathlib import Path

import rerun_cli

HOST = "127.0.0.1"  # Rerun's own default is every network the machine is in


def has_screen() -> bool:
    """Whether a window can be opened."""
    return sys.platform in {"darwin", "win32"} or any(
        os.environ.get(name) for name in ("DISPLAY", "WAYLAND_DISPLAY")
    )


def start(*files: str, port: int | None = None, web: bool = False) -> subprocess.Popen[bytes]:
    """Start a viewer, or in the background a server for browsers, and say where it is.

    Parameters
    ----------
    *files : str
        What it opens.
    port : int or None
        Where it takes data; any free one.
    web : bool
        Serve browsers on this machine instead of opening a window.
    """
    port = port or free_port()
    options = ["--bind", HOST, "--port", str(port)]
    if web:
        page = free_port()
        options += ["--serve-web", "--web-viewer-port", str(page)]
        source = f"rerun%2Bhttp%3A%2F%2F{HOST}%3A{port}%2Fproxy"
        print(f"open http://{HOST}:{page}/?url={source} in a browser; Ctrl-C ends it", flush=True)
    program = Path(rerun_cli.__file__).parent / "rerun"
    return subprocess.Popen([program, *options, *files], stdout=subprocess.DEVNULL)


def show(recording: Path, web: bool) -> int:
    """Show a recording until the viewer is closed or we are ended; return the exit status."""
    signal.signal(signal.SIGTERM, signal.default_int_handler)  # a viewer is not left behind
    process = start(str(recording), web=web)
    try:
        return 0 if process.wait() == 0 else 1
    except KeyboardInterrupt:
        return 0
    finally:
        process.terminate()
        process.wait()


def free_port() -> int:
    """Return a port that nobody listens on."""
    with socket.socket() as probe:
        probe.bind((HOST, 0))
        return int(probe.getsockname()[1])
