"""Pages without a browser: connections that speak viser's protocol, and count what they get."""

from __future__ import annotations

import asyncio
import contextlib
import re
import socket
import subprocess
import threading
import time
from collections.abc import Iterator
from urllib.parse import urlsplit

import msgspec
import viser
import websockets
from programs import command
from viser import _messages

TIMEOUT = 60.0
CAMERA = _messages.ViewerCameraMessage(
    wxyz=(1.0, 0.0, 0.0, 0.0),
    position=(2.0, -2.0, 1.0),
    fov=0.7,
    near=0.01,
    far=100.0,
    image_height=720,
    image_width=660,
    look_at=(0.0, 0.0, 0.0),
    up_direction=(0.0, 0.0, 1.0),
)


class Pages:
    """Open pages, each with the number of messages that it has received."""

    def __init__(self, url: str, count: int) -> None:
        self.counts = [0] * count
        self._address = urlsplit(url).netloc
        self._loop = asyncio.new_event_loop()
        self._all: asyncio.Future[list[None]]
        self._thread = threading.Thread(target=self._run, daemon=True)
        self._thread.start()

    def close(self) -> None:
        with contextlib.suppress(RuntimeError):  # the server has ended before
            self._loop.call_soon_threadsafe(self._all.cancel)
        self._thread.join(timeout=TIMEOUT)

    def rates(self, seconds: float) -> list[float]:
        """Messages per second of each page over a time."""
        before, begin = list(self.counts), time.monotonic()
        time.sleep(seconds)
        passed = time.monotonic() - begin
        return [(now - old) / passed for now, old in zip(self.counts, before, strict=True)]

    def _run(self) -> None:
        asyncio.set_event_loop(self._loop)
        self._all = asyncio.gather(*(self._watch(k) for k in range(len(self.counts))))
        with contextlib.suppress(asyncio.CancelledError):
            self._loop.run_until_complete(self._all)
        self._loop.close()

    async def _watch(self, k: int) -> None:
        protocol = websockets.Subprotocol(f"viser-v{viser.__version__}")
        async with websockets.connect(
            f"ws://{self._address}",
            origin=websockets.Origin(f"http://{self._address}"),
            subprotocols=[protocol],
            compression=None,
            max_size=None,
        ) as connection:
            await connection.send(msgspec.msgpack.encode(CAMERA.as_serializable_dict([])))
            try:
                async for _ in connection:
                    self.counts[k] += 1
            finally:
                connection.transport.abort()  # as a browser that is closed: with no last words


@contextlib.contextmanager
def running_panel(*words: str) -> Iterator[tuple[subprocess.Popen[str], str]]:
    """top_panel on any free port, and the address that it prints; it has ended afterwards."""
    process = subprocess.Popen(
        command("top_panel", "--port", "0", "--no-browser", *words),
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )
    try:
        line = process.stdout.readline() if process.stdout else ""
        found = re.fullmatch(r".+: open (http://\S+) in a browser; Ctrl-C ends it\n", line)
        assert found, line
        yield process, found[1]
    finally:
        process.terminate()
        process.wait(timeout=TIMEOUT)


@contextlib.contextmanager
def open_pages(url: str, count: int = 1, least: int = 3) -> Iterator[Pages]:
    """Pages that are open in this context, and have received at least some messages.

    The server may still be starting.
    """
    deadline = time.monotonic() + TIMEOUT
    address = urlsplit(url)
    while not _listens(address.hostname, address.port):
        assert time.monotonic() < deadline, f"no server at {url}"
        time.sleep(0.05)
    pages = Pages(url, count)
    try:
        while min(pages.counts) < least:
            assert time.monotonic() < deadline, f"only {pages.counts} messages"
            time.sleep(0.02)
        yield pages
    finally:
        pages.close()


def _listens(host, port):
    with socket.socket() as probe:
        return probe.connect_ex((host, port)) == 0
