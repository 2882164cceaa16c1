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
from typing import Any
from urllib.parse import urlsplit

import msgspec
import viser
import websockets
import zstandard
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
    """Open pages, each with the messages and bytes that it has received of its scene and charts."""

    def __init__(self, url: str, count: int) -> None:
        self.counts = [0] * count
        self.open = 0  # connections that the server has accepted: two for each page
        self.bytes = [0] * count
        self.ages: list[float] = []  # s between a frame's sending and its arrival
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
        self._all = asyncio.gather(
            *(
                each(k)
                for k in range(len(self.counts))
                for each in (self._watch_scene, self._watch_charts)
            )
        )
        with contextlib.suppress(asyncio.CancelledError):
            self._loop.run_until_complete(self._all)
        self._loop.close()

    def _open(self, path: str, **options: Any) -> Any:
        return websockets.connect(
            f"ws://{self._address}/{path}",
            origin=websockets.Origin(f"http://{self._address}"),
            compression=None,
            max_size=None,
            **options,
        )

    async def _watch_scene(self, k: int) -> None:
        protocol = websockets.Subprotocol(f"viser-v{viser.__version__}")
        async with self._open(f"scene/{k}", subprotocols=[protocol]) as connection:
            self.open += 1
            await connection.send(msgspec.msgpack.encode(CAMERA.as_serializable_dict([])))
            try:
                async for message in connection:
                    self.counts[k] += 1
                    self.bytes[k] += len(message)
                    self.ages.append(time.perf_counter() - sent_at(message))
            finally:
                connection.transport.abort()  # as a browser that is closed: with no last words

    async def _watch_charts(self, k: int) -> None:
        async with self._open(f"controls/{k}") as connection:
            self.open += 1
            try:
                async for message in connection:
                    self.bytes[k] += len(message)
            finally:
                connection.transport.abort()


def sent_at(message: bytes) -> float:
    """Time on this machine's `perf_counter` at which viser made a message."""
    size, packed = (int.from_bytes(message[k : k + 8], "little") for k in (0, 8))
    content = zstandard.ZstdDecompressor().decompress(message[16 : 16 + packed], size)
    return float(msgspec.msgpack.decode(content)["timestampSec"])


@contextlib.contextmanager
def running_panel(*words: str) -> Iterator[tuple[subprocess.Popen[str], str]]:
    """top_panel on any free port, and the address that it prints; it has ended afterwards."""
    with subprocess.Popen(
        command("top_panel", "--port", "0", "--no-browser", *words),
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    ) as process:
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

    The server may still be starting. All connections are open, because a server that ends refuses
    those that come later with status 503.
    """
    deadline = time.monotonic() + TIMEOUT
    address = urlsplit(url)
    while not _listens(address.hostname, address.port):
        assert time.monotonic() < deadline, f"no server at {url}"
        time.sleep(0.05)
    pages = Pages(url, count)
    try:
        while min(pages.counts) < least or pages.open < 2 * count:
            assert time.monotonic() < deadline, f"only {pages.counts} messages"
            time.sleep(0.02)
        yield pages
    finally:
        pages.close()


def _listens(host, port):
    with socket.socket() as probe:
        return probe.connect_ex((host, port)) == 0
