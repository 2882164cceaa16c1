"""A slow line: a proxy that passes on so many bytes per second, of all connections together."""

from __future__ import annotations

import contextlib
import socket
import threading
import time
from collections.abc import Iterator
from urllib.parse import urlsplit

CHUNK = 2048  # bytes


class Line:
    """The time at which the line is free again, shared by its connections."""

    def __init__(self, rate: float) -> None:
        self._rate, self._free, self._lock = rate, time.monotonic(), threading.Lock()

    def wait(self, count: int) -> None:
        """Take the time that so many bytes need."""
        with self._lock:
            self._free = max(self._free, time.monotonic()) + count / self._rate
            due = self._free
        time.sleep(max(0.0, due - time.monotonic()))


@contextlib.contextmanager
def slow_line(url: str, rate: float) -> Iterator[str]:
    """Address of the same page behind a line of so many bytes per second."""
    target, line = urlsplit(url), Line(rate)
    listener = socket.create_server(("127.0.0.1", 0))

    def accept() -> None:
        with contextlib.suppress(OSError):
            while True:
                near, _ = listener.accept()
                far = socket.create_connection((target.hostname, target.port))
                threading.Thread(target=_pass, args=(far, near, line), daemon=True).start()
                threading.Thread(target=_pass, args=(near, far, None), daemon=True).start()

    threading.Thread(target=accept, daemon=True).start()
    try:
        yield f"http://127.0.0.1:{listener.getsockname()[1]}"
    finally:
        with contextlib.suppress(OSError):
            listener.shutdown(socket.SHUT_RDWR)  # ends the thread that accepts
        listener.close()


def _pass(source: socket.socket, sink: socket.socket, line: Line | None) -> None:
    with contextlib.suppress(OSError):
        while data := source.recv(CHUNK):
            if line:
                line.wait(len(data))
            sink.sendall(data)
    for each in (source, sink):
        with contextlib.suppress(OSError):
            each.shutdown(socket.SHUT_RDWR)
            each.close()
