"""The server of the page: its address, who may connect, and the links that start an experiment.

Anyone who can connect can kick the top, and a web page of any origin can open a connection to this
machine from the user's browser. So a connection is accepted only from a page that this server has
sent, by three checks: the Host header is an address and no foreign name that was made to point
here (DNS rebinding), the Origin header of a WebSocket is this Host, and the page may connect to
no other server, nor stand in a frame of another page.
"""

import asyncio
import base64
import contextlib
import functools
import gzip
import hashlib
import http
import io
import ipaddress
import re
import socket
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import NamedTuple
from urllib.parse import parse_qs, urlsplit

import viser
from websockets.datastructures import Headers
from websockets.http11 import Request, Response

from symtop_ros.panel.serving import SCENE, Serve, serving
from symtop_ros.web.page import HIDING, write_page

LOCAL_HOST = "127.0.0.1"  # viser's default is to listen on all networks
LOCAL_NAMES = ("localhost", "127.0.0.1", "::1")
ALL_NETWORKS = ("0.0.0.0", "::")  # no addresses that a browser can open
# Requests by which a user came to a page from nowhere else; pages of other sites cannot claim it.
TRUSTED = ("none", "same-origin")
SCRIPT = re.compile(r"<script>(.*?)</script>", re.DOTALL)


class File(NamedTuple):
    """A file that a page loads: its content and its type."""

    content: bytes
    kind: str


Files = Mapping[str, Callable[[str], File | None]]  # by path; they take the name of the page


class PageServer(viser.ViserServer):
    """Viser's server, on one address and port, for its own pages only."""

    def __init__(self, host: str, port: int, serve: Serve, files: Files) -> None:
        listener = _listen(host, port)
        self.url = f"http://{_find_name(host)}:{listener.getsockname()[1]}"  # of the page
        guard = Guard({host, *LOCAL_NAMES, socket.gethostname()}, files)
        # Viser takes the next free port if one is taken, and has no argument for the checks: both
        # are arguments of the call by which it starts its WebSocket server.
        with serving(listener, guard.answer, serve), contextlib.redirect_stdout(io.StringIO()):
            super().__init__(host, port, label="Heavy symmetric top", verbose=False)

    def page_of(self, client: int) -> str:
        """Return the name of the page whose scene a client of viser draws."""
        connection = self._websock_server._live_connections.get(client)
        path = connection.request.path if connection and connection.request else ""
        return path.removeprefix(SCENE)

    def request_share_url(self, verbose: bool = True) -> None:
        """Do nothing: viser would open a tunnel to a public server when a page asks for it."""

    def stop(self) -> None:
        """Close all connections."""
        with contextlib.redirect_stdout(io.StringIO()):
            super().stop()


class Guard:
    """Answers requests for the page and its files, and refuses all that come from elsewhere."""

    def __init__(self, names: set[str], files: Files) -> None:
        self._names, self._files = names, files

    async def answer(self, request: Request) -> Response | None:
        """Return the response to a request; None for a WebSocket that may be opened."""
        # Two headers of one name are an attempt to pass one check with each.
        hosts, origins = (request.headers.get_all(name) for name in ("Host", "Origin"))
        if len(hosts) != 1 or not self._is_own(hosts[0]):
            return _respond(http.HTTPStatus.FORBIDDEN, "host must be an address of this server")
        if "Upgrade" in request.headers or "Sec-WebSocket-Key" in request.headers:
            if origins != [f"http://{hosts[0]}"]:
                return _respond(http.HTTPStatus.FORBIDDEN, "origin must be this server's own")
            return None
        path = urlsplit(request.path)
        packed = "gzip" in request.headers.get("Accept-Encoding", "")
        site = request.headers.get("Sec-Fetch-Site", "")
        if path.path in {"/", "/index.html"}:
            return _send_page(_load_page(site in TRUSTED), f"ws://{hosts[0]}", packed, framed=False)
        if path.path == SCENE.rstrip("/"):
            return _send_page(_load_scene(), f"ws://{hosts[0]}", packed, framed=True)
        return await self._send_file(path.path, path.query, site)

    def _is_own(self, host: str) -> bool:
        """Return True for an address in numbers, with or without a port, or a name of this host."""
        try:
            name = urlsplit(f"//{host}").hostname or ""
        except ValueError:  # brackets that hold no address
            return False
        return name in self._names or _is_address(name)

    async def _send_file(self, path: str, query: str, site: str) -> Response:
        """Send what the page offers for download; pages of other sites cannot have it made."""
        if path not in self._files:
            return _respond(http.HTTPStatus.NOT_FOUND, "not found")
        if site not in ("", *TRUSTED):
            return _respond(http.HTTPStatus.FORBIDDEN, "a file must be asked for by this page")
        page = parse_qs(query).get("page", [""])[0]
        loop = asyncio.get_running_loop()
        file = await loop.run_in_executor(None, self._files[path], page)
        if file is None:
            return _respond(http.HTTPStatus.NOT_FOUND, "the file does not exist yet")
        headers = {"Content-Type": file.kind, "Content-Disposition": "attachment"}
        return _respond(http.HTTPStatus.OK, file.content, headers)


def _find_name(host: str) -> str:
    """Return a name by which other machines may find this one: its address on their network."""
    if host not in ALL_NETWORKS:
        return f"[{host}]" if ":" in host else host
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe:
        try:  # no packet is sent: only the route is looked up
            probe.connect(("192.0.2.1", 9))
            return str(probe.getsockname()[0])
        except OSError:
            return LOCAL_HOST


def _listen(host: str, port: int) -> socket.socket:
    family = socket.AF_INET6 if ":" in host else socket.AF_INET
    return socket.create_server((host, port), family=family)


def _is_address(name: str) -> bool:
    try:
        ipaddress.ip_address(name)
    except ValueError:
        return False
    return True


def _send_page(page: str, address: str, packed: bool, framed: bool) -> Response:
    plain, compressed, hashes = _pack(page)
    # The address of viser's page can name another server to connect to, whose content would
    # then run with the rights of this page.
    scripts = "'unsafe-inline' 'wasm-unsafe-eval' blob: data:" if framed else hashes
    ancestors = "'self'" if framed else "'none'"
    policy = (
        f"default-src 'self' data: blob:; script-src 'self' {scripts}; "
        "style-src 'self' 'unsafe-inline' data:; base-uri 'none'; form-action 'none'; "
        f"connect-src 'self' {address} data: blob:; frame-ancestors {ancestors}"
    )
    headers = {
        "Content-Type": "text/html; charset=utf-8",
        "Content-Encoding": "gzip" if packed else "identity",
        "Content-Security-Policy": policy,
        "X-Frame-Options": "SAMEORIGIN" if framed else "DENY",
        "Cross-Origin-Opener-Policy": "same-origin",
        "Referrer-Policy": "no-referrer",
        "Cache-Control": "no-store",
    }
    return _respond(http.HTTPStatus.OK, compressed if packed else plain, headers)


@functools.cache
def _pack(page: str) -> tuple[bytes, bytes, str]:
    """Return a page plain and compressed, and the hash of its script for its policy."""
    plain = page.encode()
    digests = [hashlib.sha256(script.encode()).digest() for script in SCRIPT.findall(page)]
    hashes = " ".join(f"'sha256-{base64.b64encode(each).decode()}'" for each in digests[:1])
    return plain, gzip.compress(plain), hashes


@functools.cache
def _load_page(is_trusted: bool) -> str:
    """Return the page; it starts what its address asks for only if the user has typed that."""
    return write_page().replace(
        "<html ", f'<html data-trusted="{"yes" if is_trusted else "no"}" ', 1
    )


@functools.cache
def _load_scene() -> str:
    """Return viser's page without its own panel: the controls are those of this package."""
    client = Path(viser.__file__).parent / "client" / "build" / "index.html"
    return client.read_text(encoding="utf-8").replace("<head>", f"<head>{HIDING}", 1)


def _respond(
    status: http.HTTPStatus, content: str | bytes, headers: dict[str, str] | None = None
) -> Response:
    body = content.encode() if isinstance(content, str) else content
    fields = {"Content-Type": "text/plain; charset=utf-8", **(headers or {})}
    fields |= {"X-Content-Type-Options": "nosniff", "Cross-Origin-Resource-Policy": "same-origin"}
    all_headers = Headers({**fields, "Content-Length": str(len(body)), "Connection": "close"})
    return Response(status.value, status.phrase, all_headers, body)
