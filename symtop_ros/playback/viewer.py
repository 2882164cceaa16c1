"""The Rerun viewer: on the screen, or in a browser on this machine."""

import os
import signal
import socket
import subprocess
import sys
from pathlib import Path

import rerun_cli

from symtop_ros.playback.web import HOST, serve_page

PROGRAM = Path(rerun_cli.__file__).parent / "rerun"


def settings() -> dict[str, str]:
    """Return the environment variables of a viewer.

    In a venv its settings are in the venv, and not in the home of the user, and its usage
    statistics are switched off.
    """
    if sys.prefix == sys.base_prefix:
        return {**os.environ}
    folder = Path(sys.prefix, "rerun")
    own = {"XDG_CONFIG_HOME": str(folder), "XDG_DATA_HOME": str(folder / "data")}
    environment = {**os.environ, **own}
    if not (folder / "rerun" / "analytics.json").exists():
        command = [str(PROGRAM), "analytics", "disable"]
        subprocess.run(command, env=environment, capture_output=True, check=False)
    return environment


def has_screen() -> bool:
    """Return True if a window can be opened."""
    return sys.platform in {"darwin", "win32"} or any(
        os.environ.get(name) for name in ("DISPLAY", "WAYLAND_DISPLAY")
    )


def start(*files: str, port: int | None = None, web: bool = False) -> subprocess.Popen[bytes]:
    """Start a viewer, or a server for browsers whose address is printed.

    It runs in a separate session, so that Ctrl-C ends the caller first, which can then still send
    its last data.
    """
    port = port or free_port()
    options = ["--bind", HOST, "--port", str(port)]
    if web:
        page = free_port()
        options += ["--serve-web", "--web-viewer-port", str(page)]
        source = f"rerun%2Bhttp%3A%2F%2F{HOST}%3A{port}%2Fproxy"
        address = f"http://{HOST}:{serve_page(page, port)}/?url={source}"
        print(f"open {address} in a browser; Ctrl-C ends it", flush=True)
    if sys.platform != "win32":  # a closed terminal ends the caller, which ends the viewer
        signal.signal(signal.SIGHUP, lambda *_: signal.raise_signal(signal.SIGTERM))
    return subprocess.Popen(
        [PROGRAM, *options, *files],
        stdout=subprocess.DEVNULL,
        env={"RUST_LOG": "warn", **settings()},
        start_new_session=True,
    )


def show(recording: Path, web: bool) -> int:
    """Show a recording until the viewer or this process is ended; return the exit status."""
    signal.signal(signal.SIGTERM, signal.default_int_handler)  # so that the viewer is ended too
    process = start(str(recording), web=web)
    try:
        return 0 if process.wait() == 0 else 1
    except KeyboardInterrupt:
        return 0
    finally:
        process.terminate()
        process.wait()


def free_port() -> int:
    """Return a port that is not in use."""
    with socket.socket() as probe:
        probe.bind((HOST, 0))
        return int(probe.getsockname()[1])
