"""The server of the page: its address, who may connect, and the links that start an experiment.

Anyone who can connect can kick the top, and a web page of any origin can open a connection to this
machine from the user's browser. So a connection is accepted only from a page that this server has
sent, by three checks: the Host header is an address and no foreign name that was made to point
here (DNS rebinding), the Origin header of a WebSocket is this Host, and the page may connect to
no other server, nor stand in a frame of another page.
"""

import contextlib
import functools
import gzip
import http
import io
import ipaddress
import logging
import socket
import warnings
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any
from urllib.parse import parse_qsl, urlsplit

import viser
import websockets.asyncio.server
from websockets.asyncio.server import ServerConnection
from websockets.datastructures import Headers
from websockets.http11 import Request, Response

LOCAL_HOST = "127.0.0.1"  # viser's default is to listen on all networks
LOCAL_NAMES = ("localhost", "127.0.0.1", "::1")
ALL_NETWORKS = ("0.0.0.0", "::")  # no addresses that a browser can open
START = "/start"  # to which the page passes the values of a link
# A header that a page of another origin cannot send without being asked for permission first,
# which this server never gives.
MARK = "X-Top-Panel"
MAX_QUERY = 2000  # characters of a link
SCRIPT = Path(__file__).with_name("page.js")
Start = Callable[[dict[str, str]], None]
# A page may be closed while a message for it is made: viser warns of it, and nothing is lost.
warnings.filterwarnings("ignore", message="Queued a .* on a closed connection")


class PageServer(viser.ViserServer):
    """Viser's server, on one address and port, for its own pages only."""

    def __init__(self, host: str, port: int, start: Start) -> None:
        listener = _listen(host, port)
        shown = socket.gethostname() if host in ALL_NETWORKS else _bracket(host)
        self.url = f"http://{shown}:{listener.getsockname()[1]}"  # address of the page
        guard = Guard({host, *LOCAL_NAMES, socket.gethostname()}, start)
        # Viser takes the next free port if one is taken, and has no argument for the checks: both
        # are arguments of the call by which it starts its WebSocket server.
        with _serving(listener, guard), contextlib.redirect_stdout(io.StringIO()):
            super().__init__(host, port, label="Heavy symmetric top", verbose=False)

    def request_share_url(self, verbose: bool = True) -> None:
        """Do nothing: viser would open a tunnel to a public server when a page asks for it."""

    def stop(self) -> None:
        """Close all connections."""
        with contextlib.redirect_stdout(io.StringIO()):
            super().stop()


class Guard:
    """Answers requests for the page and for links, and refuses all that come from elsewhere."""

    def __init__(self, names: set[str], start: Start) -> None:
        self._names, self._start = names, start

    def answer(self, request: Request) -> Response | None:
        """Return the response to a request; None for what viser may answer."""
        # Two headers of one name are an attempt to pass one check with each.
        hosts, origins = (request.headers.get_all(name) for name in ("Host", "Origin"))
        if len(hosts) != 1 or not self._is_own(hosts[0]):
            return _respond(http.HTTPStatus.FORBIDDEN, "host must be an address of this server")
        if "Upgrade" in request.headers or "Sec-WebSocket-Key" in request.headers:
            if origins != [f"http://{hosts[0]}"]:
                return _respond(http.HTTPStatus.FORBIDDEN, "origin must be this server's own")
            return None
        path = urlsplit(request.path)
        if path.path == START:
            return self._take_link(request, path.query)
        if path.path in {"/", "/index.html"}:
            return _send_page(hosts[0], "gzip" in request.headers.get("Accept-Encoding", ""))
        return _respond(http.HTTPStatus.NOT_FOUND, "not found")

    def _is_own(self, host: str) -> bool:
        """Return True for an address in numbers, with or without a port, or a name of this host."""
        try:
            name = urlsplit(f"//{host}").hostname or ""
        except ValueError:  # brackets that hold no address
            return False
        return name in self._names or _is_address(name)

    def _take_link(self, request: Request, query: str) -> Response:
        if request.headers.get(MARK) is None or len(query) > MAX_QUERY:
            return _respond(http.HTTPStatus.FORBIDDEN, "a start must come from this page")
        self._start(dict(parse_qsl(query)))
        return _respond(http.HTTPStatus.OK, "")


def _listen(host: str, port: int) -> socket.socket:
    family = socket.AF_INET6 if ":" in host else socket.AF_INET
    return socket.create_server((host, port), family=family)


def _is_address(name: str) -> bool:
    try:
        ipaddress.ip_address(name)
    except ValueError:
        return False
    return True


def _bracket(host: str) -> str:
    return f"[{host}]" if ":" in host else host


@contextlib.contextmanager
def _serving(listener: socket.socket, guard: Guard) -> Iterator[None]:
    """In this context, let viser serve on an open socket and ask the guard first."""
    original: Any = websockets.asyncio.server.serve

    def serve(handler: Any, _host: str, _port: int, **options: Any) -> Any:
        others = options.pop("process_request")

        def process(connection: ServerConnection, request: Request) -> Response | None:
            response = guard.answer(request)
            return others(connection, request) if response is None else response

        return original(handler, sock=listener, process_request=process, logger=_quiet(), **options)

    websockets.asyncio.server.serve = serve  # type: ignore[misc, assignment]
    try:
        yield
    finally:
        websockets.asyncio.server.serve = original  # type: ignore[misc]


def _quiet() -> logging.Logger:
    """Return a logger that writes nothing: a peer that hangs up would be reported at length."""
    logger = logging.getLogger(__name__)
    logger.addHandler(logging.NullHandler())
    logger.propagate = False
    return logger


def _send_page(host: str, packed: bool) -> Response:
    plain, compressed = _load_page()
    # The address of viser's page can name another server to connect to, whose content would
    # then run with the rights of this page.
    policy = (
        "default-src 'self' 'unsafe-inline' 'unsafe-eval' data: blob:; "
        f"connect-src 'self' ws://{host} data: blob:; frame-ancestors 'none'"
    )
    headers = {
        "Content-Type": "text/html; charset=utf-8",
        "Content-Encoding": "gzip" if packed else "identity",
        "Content-Security-Policy": policy,
        "X-Frame-Options": "DENY",
        "Referrer-Policy": "no-referrer",
        "Cache-Control": "no-cache",
    }
    return _respond(http.HTTPStatus.OK, compressed if packed else plain, headers)


@functools.cache
def _load_page() -> tuple[bytes, bytes]:
    """Return viser's page with the script of this package, plain and compressed."""
    client = Path(viser.__file__).parent / "client" / "build" / "index.html"
    text = client.read_text(encoding="utf-8")
    script = SCRIPT.read_text(encoding="utf-8")
    text = text.replace("<head>", f"<head>\n<script>\n{script}</script>", 1)
    text = text.replace("<title>Viser</title>", "<title>Heavy symmetric top</title>", 1)
    plain = text.encode()
    return plain, gzip.compress(plain)


def _respond(
    status: http.HTTPStatus, content: str | bytes, headers: dict[str, str] | None = None
) -> Response:
    body = content.encode() if isinstance(content, str) else content
    fields = {"Content-Type": "text/plain; charset=utf-8", **(headers or {})}
    all_headers = Headers({**fields, "Content-Length": str(len(body)), "Connection": "close"})
    return Response(status.value, status.phrase, all_headers, body)
