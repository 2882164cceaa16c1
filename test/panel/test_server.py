"""Connections that the server accepts, and those that it refuses."""

import asyncio
import contextlib
import gzip
import http.client
import socket
import threading
import time

import pytest
import viser
import websockets
from listening import tcp_addresses
from panel.pages import TIMEOUT, open_pages
from viser._messages import SetPositionMessage
from websockets.sync.client import connect

from symtop_ros.panel.server import LOCAL_HOST, File, PageServer

PROTOCOL = websockets.Subprotocol(f"viser-v{viser.__version__}")


@pytest.fixture(scope="module", name="started")
def _started():
    """A server, and the pages that have asked for its file."""
    asked = []

    async def serve(connection, _):
        await connection.wait_closed()

    def write(page):
        asked.append(page)
        return File(b"1,2", "text/csv") if page else None

    server = PageServer(LOCAL_HOST, 0, serve, {"/series.csv": write})
    yield server, asked
    server.stop()


def address(server):
    return server.url.removeprefix("http://")


def ask(server, path="/", method="GET", **headers):
    """Status, headers and content of the answer to a request."""
    connection = http.client.HTTPConnection(address(server), timeout=10)
    named = {name.replace("_", "-"): value for name, value in headers.items()}
    connection.request(method, path, headers={"Host": address(server), **named})
    with contextlib.closing(connection):
        answer = connection.getresponse()
        return answer.status, dict(answer.getheaders()), answer.read()


def refuses(server, origin, path="/scene/a", **headers):
    """Return the status with which a WebSocket is refused; None if it is accepted."""
    try:
        with connect(
            f"ws://{address(server)}{path}",
            origin=origin,
            subprotocols=[PROTOCOL],
            compression=None,
            max_size=None,
            additional_headers=headers or None,
        ):
            return None
    except websockets.InvalidStatus as refusal:
        return refusal.response.status_code


def test_it_listens_on_this_machine_only(started):
    server, _ = started
    found = tcp_addresses(threading.main_thread().native_id)
    assert {host for host, port in found if port == server.get_port()} == {LOCAL_HOST}


def test_its_own_page_is_accepted(started):
    server, _ = started
    assert refuses(server, server.url) is None
    assert refuses(server, server.url, "/controls/a") is None


@pytest.mark.parametrize(
    "origin",
    [
        "http://evil.example",
        "http://127.0.0.1:1",
        "https://{address}",
        "http://{address}.evil.example",
        "http://localhost:{port}",  # the page was sent as 127.0.0.1: another origin
        "null",
        "",
        None,
    ],
)
def test_another_origin_is_refused(started, origin):
    server, _ = started
    text = origin and origin.format(address=address(server), port=server.get_port())
    assert refuses(server, text) == 403
    assert refuses(server, text, "/controls/a") == 403


def test_a_second_origin_does_not_help(started):
    server, _ = started
    assert refuses(server, "http://evil.example", Origin=server.url) == 403


@pytest.mark.parametrize(
    ("host", "status"),
    [
        ("evil.example", 403),  # a name that was made to point to this machine
        ("evil.example:{port}", 403),
        ("127.0.0.1.evil.example", 403),
        ("[::1", 403),
        ("", 403),
        ("localhost:{port}", 200),
        ("127.0.0.1:{port}", 200),
        ("[::1]:{port}", 200),
    ],
)
def test_the_host_must_be_an_address_of_this_server(started, host, status):
    server, _ = started
    assert ask(server, Host=host.format(port=server.get_port()))[0] == status


def test_the_page_may_connect_to_nobody_else_and_stand_in_no_frame(started):
    server, _ = started
    status, headers, content = ask(server)
    assert status == 200
    policy = headers["Content-Security-Policy"]
    assert f"connect-src 'self' ws://{address(server)} data: blob:;" in policy
    assert "frame-ancestors 'none'" in policy
    assert "unsafe-eval'" not in policy
    assert b"<title>Heavy symmetric top</title>" in content
    scene = ask(server, "/scene")[1]["Content-Security-Policy"]
    assert f"connect-src 'self' ws://{address(server)} data: blob:;" in scene
    assert "frame-ancestors 'self'" in scene
    assert "'unsafe-eval'" not in scene


@pytest.mark.parametrize(
    ("site", "trusted"), [("none", "yes"), ("same-origin", "yes"), ("cross-site", "no"), ("", "no")]
)
def test_only_a_page_to_which_no_other_site_has_led_starts_what_its_address_asks_for(
    started, site, trusted
):
    server, _ = started
    headers = {"Sec-Fetch-Site": site} if site else {}
    content = ask(server, "/?theta=1", **headers)[2]
    assert f'data-trusted="{trusted}"'.encode() in content


def test_compressed_and_plain_pages_are_the_same(started):
    server, _ = started
    _, headers, content = ask(server, "/index.html", Accept_Encoding="gzip")
    assert headers["Content-Encoding"] == "gzip"
    assert gzip.decompress(content) == ask(server, Accept_Encoding="identity")[2]


@pytest.mark.parametrize(("path", "status"), [("/", 200), ("/scene", 200), ("/nowhere", 404)])
def test_head_is_the_same_answer_without_its_content(started, path, status):
    server, _ = started
    found, headers, content = ask(server, path)
    assert (found, len(content)) == (status, int(headers["Content-Length"]))
    assert ask(server, path, "HEAD") == (status, headers, b"")


def test_a_file_is_for_this_page(started):
    server, asked = started
    status, headers, content = ask(server, "/series.csv?page=a")
    assert (status, content, asked) == (200, b"1,2", ["a"])
    assert headers["Content-Disposition"] == "attachment"
    assert headers["Cross-Origin-Resource-Policy"] == "same-origin"
    assert ask(server, "/series.csv")[0] == 404  # as long as there is none
    assert ask(server, "/series.csv?page=a", **{"Sec-Fetch-Site": "cross-site"})[0] == 403
    assert asked == ["a", ""]


@pytest.mark.parametrize("path", ["/assets/x.js", "/../secret", "/%2e%2e/secret", "/favicon.ico"])
def test_there_is_nothing_else(started, path):
    server, _ = started
    assert ask(server, path)[0] == 404


def test_a_port_that_is_taken_is_an_error_and_not_another_port():
    with socket.create_server((LOCAL_HOST, 0)) as taken, pytest.raises(OSError, match="in use"):
        PageServer(LOCAL_HOST, taken.getsockname()[1], None, {})


def test_a_page_cannot_ask_for_a_public_address(started):
    server, _ = started
    assert server.request_share_url() is None
    assert server._share_tunnel is None


def test_an_open_page_is_counted_while_it_is_open(started):
    server, _ = started
    server.scene.add_frame("/frame")
    with open_pages(server.url, 2, least=1):
        deadline = time.monotonic() + TIMEOUT
        while len(server.get_clients()) != 2:  # a client is counted after its first message
            assert time.monotonic() < deadline
            time.sleep(0.02)


def test_only_the_loop_wakes_what_waits_for_a_message(started):
    """A set from another thread may fail, or be lost, while the loop begins to wait."""
    server, _ = started
    loop = server.get_event_loop()
    for buffer in (server._websock_server._broadcast_buffer, made_in(loop)):
        loop.call_soon_threadsafe(buffer.message_event.clear)
        waiting = asyncio.run_coroutine_threadsafe(begin(buffer.message_event), loop).result(
            TIMEOUT
        )
        with atomic(buffer):
            buffer.push(SetPositionMessage("/a", (0.0, 0.0, 0.0)))
            assert not buffer.message_event.is_set()
        asyncio.run_coroutine_threadsafe(asyncio.wait_for(waiting, TIMEOUT), loop).result()


async def begin(event):
    return asyncio.ensure_future(event.wait())


def made_in(loop):
    """The messages to one page, as viser makes them."""

    async def make():
        return viser.infra._infra.AsyncMessageBuffer(loop, persistent_messages=False)

    return asyncio.run_coroutine_threadsafe(make(), loop).result(TIMEOUT)


@contextlib.contextmanager
def atomic(buffer):
    buffer.atomic_start()
    yield
    buffer.atomic_end()


def test_a_pose_is_sent_if_it_has_changed_however_little(started):
    server, _ = started
    frame = server.scene.add_frame("/moved", position=(1.0, 2.0, 3.0))
    buffer = server._websock_server._broadcast_buffer
    before = buffer.message_counter
    frame.position = (1.0, 2.0, 3.0)
    assert buffer.message_counter == before
    frame.position = (1.0, 2.0, 3.0 + 1e-12)
    assert buffer.message_counter == before + 1
    assert frame.position.tolist() == [1.0, 2.0, 3.0 + 1e-12]
