"""A log as a recording, and the Rerun viewer: on the screen, or in a browser on this machine.

The page of the viewer asks servers on the internet for fonts, examples, a log-in and telemetry, and
has no switch for that. So the page is served with a policy that makes the browser refuse such
connections.
"""

import errno
import http.client
import http.server
import os
import shutil
import signal
import socket
import subprocess
import sys
import threading
from pathlib import Path
from typing import Any

import rerun as rr
import rerun_cli

from symtop_ros.replay.view.view import DEFAULT_OPTIONS, View, ViewOptions
from symtop_ros.run.log.reader import LogError
from symtop_ros.run.log.top_log import TopLog
from symtop_ros.run.simulation.points import Points

PROGRAM = Path(rerun_cli.__file__).parent / "rerun"
HOST = "127.0.0.1"
KEPT = ("Content-Type", "rerun-final-length")  # headers that the viewer reads
APPLICATION = "symtop_ros"
MIN_SIZE_FOR_BAR = 20 * 2**20  # bytes; smaller files take less than a second
BAR_LENGTH = 40  # characters
GROWTH = 8  # a recording has five times the size of its log


def settings() -> dict[str, str]:
    """Return the environment variables of a viewer.

    In a venv its settings are in the venv, and not in the home of the user, and its usage
    statistics are switched off.
    """
    if sys.prefix == sys.base_prefix:
        return {**os.environ}
    folder = Path(sys.prefix, "rerun")
    environment = {
        **os.environ,
        "XDG_CONFIG_HOME": str(folder),
        "XDG_DATA_HOME": str(folder / "data"),
    }
    if not (folder / "rerun" / "analytics.json").exists():
        subprocess.run(
            [PROGRAM, "analytics", "disable"], env=environment, capture_output=True, check=False
        )
    return environment


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
    """Show a recording until the viewer or this process is ended; return the exit status.

    LogError if the viewer fails, as on a machine without a graphics card.
    """
    signal.signal(signal.SIGTERM, signal.default_int_handler)  # so that the viewer is ended too
    with start(str(recording), web=web) as process:
        try:
            status = process.wait()
        except KeyboardInterrupt:
            return 0
        finally:
            process.terminate()
    if status > 0:
        raise LogError(
            "the viewer ended with an error: without a graphics card use --save OUT.html to write "
            "a page for any browser, or --web"
        )
    return 0 if status == 0 else 1


def free_port() -> int:
    """Return a port that is not in use.

    Linux gives it to no other program that asks for any port: it stays bound until this process
    ends. A server that sets SO_REUSEADDR, as Rerun and Python's do, can still listen on it.
    """
    probe = socket.socket()
    probe.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
    probe.bind((HOST, 0))
    port = int(probe.getsockname()[1])
    if sys.platform == "linux":
        probe.detach()
    else:  # where no other could bind it, or any other could take it
        probe.close()
    return port


def serve_page(page: int, data: int) -> int:
    """Serve the viewer's page, which Rerun serves at a port; return the port of this one.

    `data` is the port of the recording, the only other one that the page may connect to.
    """
    server = _Server((HOST, 0), _handler(page, data))
    threading.Thread(target=server.serve_forever, daemon=True).start()
    return server.server_port


class _Server(http.server.ThreadingHTTPServer):
    def handle_error(self, request: Any, client_address: Any) -> None:
        """Report an unexpected exception in one line, but not a page that was closed."""
        error = sys.exc_info()[1]
        if not isinstance(error, OSError):
            print(f"the page of the viewer was not sent: {error!r}", file=sys.stderr)


def _handler(page: int, data: int) -> type[http.server.BaseHTTPRequestHandler]:
    policy = (
        "default-src 'self' 'unsafe-inline' 'wasm-unsafe-eval' data: blob:; "
        f"connect-src 'self' http://{HOST}:{data} ws://{HOST}:{data} data: blob:; "
        "form-action 'none'; frame-ancestors 'none'"
    )

    class Handler(http.server.BaseHTTPRequestHandler):
        def do_GET(self) -> None:
            source = http.client.HTTPConnection(HOST, page, timeout=60.0)
            try:
                source.request("GET", self.path)
                answer = source.getresponse()
                content = answer.read()
            # Rerun is starting, has ended, or ends within its answer
            except (OSError, http.client.HTTPException):
                self.send_error(503)
                return
            finally:
                source.close()
            self.send_response(answer.status)
            fields = {
                **{name: value for name in KEPT if (value := answer.getheader(name))},
                "Content-Length": str(len(content)),
                "Content-Security-Policy": policy,
                "Referrer-Policy": "no-referrer",
            }
            for name, value in fields.items():
                self.send_header(name, value)
            self.end_headers()
            self.wfile.write(content)

        def log_message(self, *_: object) -> None:
            """Write nothing."""

    return Handler


def replay(
    log: TopLog,
    target: Path,
    options: ViewOptions = DEFAULT_OPTIONS,
    points: Points | None = None,
) -> None:
    """Write a log as a Rerun recording, with the measured points of its run.

    Problems of the log are listed with its events.
    """
    try:
        if shutil.disk_usage(target.parent).free < GROWTH * log.file.size:
            raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))  # else Rerun waits for ever
        recording = create_recording(target, log.file.path.stem)
    except (OSError, RuntimeError) as error:
        raise LogError(
            f"cannot write {target}: {getattr(error, 'strerror', None) or error}"
        ) from None
    catalog = log.catalog
    view = View(recording, options=options, unknown=[*catalog.unknown, *catalog.undecided])
    for batch in log.batches():
        view.send(batch)
        _show_progress(log.file.offset, log.file.size)
    if points:
        view.send_points(points, catalog.intervals)
    for problem in catalog.lines:
        view.log_text(problem)
    recording.flush()
    view.close()


def create_recording(file: Path, name: str) -> rr.RecordingStream:
    """Return a recording that is written to a file; OSError if that is not possible."""
    file.open("wb").close()  # Rerun itself only warns if it cannot write
    recording = rr.RecordingStream(APPLICATION, recording_id=name)
    recording.save(file)
    return recording


def _show_progress(done: int, size: int) -> None:
    if size > MIN_SIZE_FOR_BAR and sys.stderr.isatty():
        filled = round(BAR_LENGTH * done / size)
        bar = "#" * filled + "." * (BAR_LENGTH - filled)
        print(
            f"[{bar}] {done / 2**20:.0f} of {size / 2**20:.0f} MiB",
            end="\n" if done == size else "\r",
            file=sys.stderr,
        )
