"""The server of the page: one file, and for a running node what it sends and is asked.

A page with its own top needs no guard: each has another top. Through a page of a node the node
can be kicked, and a web page of any origin can send requests to this machine from the user's
browser. So there the Host header must be an address and no foreign name that was made to point here
(DNS rebinding), the Origin header of a request must be this Host, and the page stands in no frame.
"""

import gzip
import ipaddress
import json
import socket
import sys
from collections.abc import Iterator, Mapping
from contextlib import suppress
from http import HTTPStatus
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from socketserver import TCPServer
from typing import Any, Protocol
from urllib.parse import urlsplit

LOCAL_HOST = "127.0.0.1"
LOCAL_NAMES = ("localhost", "127.0.0.1", "::1")
MAX_REQUEST = 65_536  # bytes
# Of what is sent and not yet received: a page behind a slow line would see what was seconds ago.
SENT = 16_384  # bytes
# In addition to the policy of the page itself, which says what it may run and load.
NO_FRAME = {"Content-Security-Policy": "connect-src 'self'; frame-ancestors 'none'"}
DEEPEST = 16  # objects and lists in each other, of a request; an argument of a service has fewer
PAGE = ("/", "/index.html")
NEWS = "/news"
REQUEST = "/request"


class Node(Protocol):
    """A running node, as the pages see it."""

    def follow(self) -> Iterator[Mapping[str, Any]]:
        """Yield what is new for one page."""

    def answer(self, request: Mapping[str, Any]) -> Mapping[str, Any]:
        """Do what a page asks for; return the answer."""


class PageServer(ThreadingHTTPServer):
    """A server of one page, on one address and port; `node` is asked for by its pages."""

    daemon_threads = True
    request_queue_size = 128  # connections that wait: a class opens its pages at once

    def __init__(self, host: str, port: int, page: str, node: Node | None = None) -> None:
        self.address_family = socket.AF_INET6 if ":" in host else socket.AF_INET
        self.page = page.encode()
        self.node = node
        self.is_ending = False
        self.packed = gzip.compress(self.page, mtime=0)
        self.names = {name.lower() for name in (host, *LOCAL_NAMES, socket.gethostname())}
        super().__init__((host, port), PageHandler)
        self.url = f"http://{_find_name(host)}:{self.server_address[1]}/"

    def server_bind(self) -> None:
        """Bind without a look-up of the name of the host, which takes seconds without a network."""
        TCPServer.server_bind(self)

    def shutdown(self) -> None:
        """End the server, and with it the pages' connections."""
        self.is_ending = True
        super().shutdown()

    def handle_error(self, request: Any, client_address: Any) -> None:
        """Report an unexpected exception in one line, but not a page that was closed."""
        error = sys.exc_info()[1]
        if not isinstance(error, OSError):
            print(f"top_panel: a request failed: {error!r}", file=sys.stderr)


class PageHandler(BaseHTTPRequestHandler):
    """Answers one connection."""

    server: PageServer
    protocol_version = "HTTP/1.1"
    timeout = 60.0  # s; a connection that asks for nothing is closed

    def do_HEAD(self) -> None:
        """Answer as to GET, without the content."""
        self.do_GET()

    def do_GET(self) -> None:
        """Send the page, or the news of the node."""
        path = urlsplit(self.path).path
        node = self.server.node
        if node and not self._is_own_host():
            self._send(HTTPStatus.FORBIDDEN, b"host must be an address of this server")
        elif path in PAGE:
            self._send_page()
        elif node and path == NEWS:
            self._send_news(node)
        else:
            self._send(HTTPStatus.NOT_FOUND, b"not found")

    def do_POST(self) -> None:
        """Ask the node."""
        node = self.server.node
        size = self.headers.get("Content-Length", "")
        origins = self.headers.get_all("Origin")
        if not node or urlsplit(self.path).path != REQUEST:
            self._send(HTTPStatus.NOT_FOUND, b"not found", close=True)
        elif not self._is_own_host() or origins != [f"http://{self.headers['Host']}"]:
            self._send(HTTPStatus.FORBIDDEN, b"origin must be this server's own", close=True)
        elif not size.isdecimal() or int(size) > MAX_REQUEST:
            self._send(HTTPStatus.BAD_REQUEST, b"a request must be short", close=True)
        else:
            self._send_answer(node, self.rfile.read(int(size)))

    def _send_answer(self, node: Node, data: bytes) -> None:
        try:
            request = json.loads(data)
        except (ValueError, RecursionError):
            request = None
        if not isinstance(request, dict) or _is_deeper(request, DEEPEST):
            self._send(HTTPStatus.BAD_REQUEST, b"a request must be a JSON object, 16 deep at most")
            return
        self._send(
            HTTPStatus.OK,
            json.dumps(node.answer(request)).encode(),
            {"Content-Type": "application/json"},
        )

    def _send_page(self) -> None:
        packed = "gzip" in self.headers.get("Accept-Encoding", "")
        fields = {
            "Content-Type": "text/html; charset=utf-8",
            "Content-Encoding": "gzip" if packed else "identity",
            "Cache-Control": "no-cache",
        }
        fields |= NO_FRAME if self.server.node else {}
        self._send(HTTPStatus.OK, self.server.packed if packed else self.server.page, fields)

    def _send_news(self, node: Node) -> None:
        """Send messages, each as soon as the page has taken most of those before it."""
        self.connection.setsockopt(socket.SOL_SOCKET, socket.SO_SNDBUF, SENT)
        fields = {"Content-Type": "text/event-stream", "Cache-Control": "no-store"}
        self._send_head(HTTPStatus.OK, fields)
        self.close_connection = True
        if self.command == "HEAD":
            return
        for message in node.follow():
            if self.server.is_ending:
                return
            self.wfile.write(f"data: {json.dumps(message)}\n\n".encode())

    def _send(
        self,
        status: HTTPStatus,
        content: bytes,
        fields: Mapping[str, str] | None = None,
        *,
        close: bool = False,
    ) -> None:
        all_fields = {
            "Content-Type": "text/plain; charset=utf-8",
            "X-Content-Type-Options": "nosniff",
            **(fields or {}),
            "Content-Length": str(len(content)),
            **({"Connection": "close"} if close else {}),
        }
        self._send_head(status, all_fields)
        if self.command != "HEAD":
            self.wfile.write(content)

    def _send_head(self, status: HTTPStatus, fields: Mapping[str, str]) -> None:
        self.send_response(status)
        for name, value in fields.items():
            self.send_header(name, value)
        self.end_headers()

    def _is_own_host(self) -> bool:
        """Return True for an address in numbers, with or without a port, or a name of this host."""
        # Two headers of one name are an attempt to pass one check with each.
        hosts = self.headers.get_all("Host") or []
        with suppress(ValueError):  # of brackets that hold no address, and of a foreign name
            name = urlsplit(f"//{hosts[0]}").hostname or "" if len(hosts) == 1 else ""
            return name in self.server.names or bool(ipaddress.ip_address(name))
        return False

    def log_message(self, format: str, *args: Any) -> None:  # noqa: A002
        """Log nothing: requests are no news."""


def _is_deeper(value: Any, depth: int) -> bool:
    """Return True for objects and lists in each other more often than so many times."""
    if not isinstance(value, dict | list):
        return False
    parts = value.values() if isinstance(value, dict) else value
    return depth == 0 or any(_is_deeper(each, depth - 1) for each in parts)


def _find_name(host: str) -> str:
    """Return a name by which other machines may find this one: its address on their network."""
    if host not in ("0.0.0.0", "::"):  # which no browser can open
        return f"[{host}]" if ":" in host else host
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe:
        try:  # no packet is sent: only the route is looked up
            probe.connect(("192.0.2.1", 9))
            return str(probe.getsockname()[0])
        except OSError:
            return LOCAL_HOST
