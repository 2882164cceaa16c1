"""The server of the page, and what it refuses for a running node."""

import contextlib
import gzip
import http.client
import json
import select
import socket
import threading

import pytest
from listening import tcp_addresses
from serving import serving
from waiting import TIMEOUT, until

from symtop_ros.page.panel.server import LOCAL_HOST, MAX_REQUEST, PageServer

PORTS = ("", ":{port}")
PAGE = "<!doctype html><title>Heavy symmetric top</title>"


class Node:
    """A node that answers with what it was asked, and sends three messages."""

    def __init__(self):
        self.asked = []

    def answer(self, request):
        self.asked.append(request)
        return {"granted": True, "answer": "yes"}

    def follow(self):
        yield from ({"time": number} for number in range(3))


@pytest.fixture(name="static", scope="module")
def _static():
    with serving(PAGE) as server:
        yield server


@pytest.fixture(name="live", scope="module")
def _live():
    with serving(PAGE, Node()) as server:
        yield server


def address(server):
    return server.url.removeprefix("http://").rstrip("/")


def ask(server, path="/", method="GET", body=None, **headers):
    """Status, headers and content of the answer to a request."""
    connection = http.client.HTTPConnection(address(server), timeout=TIMEOUT)
    named = {name.replace("_", "-"): value for name, value in headers.items()}
    connection.request(method, path, body, headers={"Host": address(server), **named})
    with contextlib.closing(connection):
        answer = connection.getresponse()
        return answer.status, dict(answer.getheaders()), answer.read()


def kick(server, body='{"service": "kick"}', **headers):
    """Status of a request to the node, with the headers of its page unless others are given."""
    given = {"Origin": f"http://{address(server)}", **headers}
    named = {name: value for name, value in given.items() if value is not None}
    return ask(server, "/request", "POST", body, **named)


def test_it_listens_on_this_machine_only(static):
    found = tcp_addresses(threading.main_thread().native_id)
    assert {host for host, port in found if port == static.server_address[1]} == {LOCAL_HOST}


def test_a_page_with_its_own_top_may_stand_in_frames_and_be_found_by_any_name(static):
    status, headers, content = ask(static, Host="teacher.example")
    assert (status, content) == (200, PAGE.encode())
    assert "Content-Security-Policy" not in headers


@pytest.mark.parametrize("path", ["/news", "/request", "/x", "/../secret", "/%2e%2e/secret"])
def test_a_page_with_its_own_top_has_nothing_else(static, path):
    assert ask(static, path)[0] == 404
    assert ask(static, path, "POST", "{}")[0] == 404


def test_compressed_and_plain_pages_are_the_same(static):
    _, headers, content = ask(static, "/index.html", Accept_Encoding="gzip")
    assert headers["Content-Encoding"] == "gzip"
    assert gzip.decompress(content) == PAGE.encode()


@pytest.mark.parametrize(("path", "status"), [("/", 200), ("/nowhere", 404)])
def test_head_is_the_same_answer_without_its_content(live, path, status):
    found, headers, content = ask(live, path)
    assert (found, len(content)) == (status, int(headers["Content-Length"]))
    again, others, nothing = ask(live, path, "HEAD")
    assert (again, others["Content-Length"], nothing) == (status, headers["Content-Length"], b"")


def test_a_page_of_a_node_stands_in_no_frame_and_connects_to_its_server_only(live):
    policy = ask(live)[1]["Content-Security-Policy"]
    assert "frame-ancestors 'none'" in policy
    assert "connect-src 'self'" in policy


def test_the_page_of_a_node_asks_it(live):
    status, headers, content = kick(live)
    assert (status, headers["Content-Type"]) == (200, "application/json")
    assert json.loads(content) == {"granted": True, "answer": "yes"}
    assert live.node.asked[-1] == {"service": "kick"}


@pytest.mark.parametrize(
    "origin",
    [
        "http://evil.example",
        "http://127.0.0.1:1",
        "https://{address}",
        "null",
        "",
        None,
        "http://{address}.evil.example",
        "http://localhost:{port}",  # sent as 127.0.0.1
    ],
)
def test_a_request_of_another_origin_is_refused(live, origin):
    before = len(live.node.asked)
    text = origin and origin.format(address=address(live), port=live.server_address[1])
    assert kick(live, Origin=text)[0] == 403
    assert len(live.node.asked) == before


def test_a_second_origin_does_not_help(live):
    own = address(live)
    origins = ["Origin: http://evil.example", f"Origin: http://{own}"]
    lines = ["POST /request HTTP/1.1", f"Host: {own}", *origins, "Content-Length: 2"]
    with socket.create_connection(live.server_address[:2], timeout=TIMEOUT) as connection:
        connection.sendall("\r\n".join([*lines, "", "{}"]).encode())
        assert connection.recv(100).startswith(b"HTTP/1.1 403 ")


@pytest.mark.parametrize(
    ("host", "status"),
    [
        # a name may have been made to point to this machine
        *((f"{name}evil.example{port}", 403) for name in ("", "127.0.0.1.") for port in PORTS),
        ("[::1", 403),
        ("", 403),
        *((f"{name}:{{port}}", 200) for name in ("localhost", "127.0.0.1", "[::1]")),
    ],
)
@pytest.mark.parametrize("path", ["/", "/news"])
def test_of_a_node_the_host_must_be_an_address_of_this_server(live, host, status, path):
    assert ask(live, path, Host=host.format(port=live.server_address[1]))[0] == status


def test_the_name_of_this_machine_may_have_capitals(monkeypatch):
    monkeypatch.setattr(socket, "gethostname", lambda: "Lab-PC")
    with serving(PAGE, Node()) as server:
        assert ask(server, Host=f"Lab-PC:{server.server_address[1]}")[0] == 200


BODIES = [(text, {}) for text in ("", "[1]", "{", "[" * 60_000, b"\xff", " " * (MAX_REQUEST + 1))]


@pytest.mark.parametrize(("body", "headers"), [*BODIES, ("{}", {"Content_Length": "-1"})])
def test_a_request_that_is_no_object_or_too_long_is_refused(live, body, headers):
    before = len(live.node.asked)
    assert kick(live, body, **headers)[0] == 400
    assert len(live.node.asked) == before


def test_news_are_messages_of_an_event_stream(live):
    status, headers, content = ask(live, "/news")
    assert (status, headers["Content-Type"]) == (200, "text/event-stream")
    lines = content.decode().split("\n\n")[:-1]
    found = [json.loads(line.removeprefix("data: ")) for line in lines]
    assert found == [{"time": number} for number in range(3)]


def test_a_page_that_is_closed_is_no_error(capsys):
    begun, ended = threading.Event(), threading.Event()

    class Endless(Node):
        def follow(self):
            try:
                while True:
                    yield {"text": "x" * 1000}
                    begun.set()
            finally:
                ended.set()

    with serving(PAGE, Endless()) as server:
        with socket.create_connection(server.server_address[:2]) as connection:
            connection.sendall(f"GET /news HTTP/1.1\r\nHost: {address(server)}\r\n\r\n".encode())
            assert begun.wait(TIMEOUT)
        assert ended.wait(TIMEOUT)
    assert capsys.readouterr().err == ""


def test_a_slow_page_is_sent_little_that_it_has_not_taken(monkeypatch):
    sent, taken = [], []

    class Fast(Node):
        def follow(self):
            while True:
                sent.append(len(sent))
                yield {"text": "x" * 1000}

    def keep(server, request, address):
        taken.append(request)
        process(server, request, address)

    def is_full():
        return bool(taken) and not select.select([], taken, [], 0)[1]

    process = PageServer.process_request
    monkeypatch.setattr(PageServer, "process_request", keep)
    # The system doubles both buffers; what is in them is at most what a page has to catch up.
    most = 100
    with serving(PAGE, Fast()) as server, socket.socket() as connection:
        connection.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 4096)
        connection.connect(server.server_address[:2])
        connection.sendall(f"GET /news HTTP/1.1\r\nHost: {address(server)}\r\n\r\n".encode())
        until(lambda: len(sent) >= most or is_full())
        assert 0 < len(sent) < most


def test_an_unexpected_exception_is_one_line(capsys):
    class Broken(Node):
        def answer(self, request):
            raise RuntimeError("a bug")

    with serving(PAGE, Broken()) as server, pytest.raises(http.client.RemoteDisconnected):
        kick(server)
    assert capsys.readouterr().err == "top_panel: a request failed: RuntimeError('a bug')\n"


def test_a_request_of_nested_lists_is_refused(live):
    asked = len(live.node.asked)
    nested = "[" * 500 + "]" * 500
    status, _, content = kick(live, f'{{"service": "kick", "argument": {nested}}}')
    assert (status, content) == (400, b"a request must be a JSON object, 16 deep at most")
    assert len(live.node.asked) == asked


def test_the_pages_of_a_class_wait_in_its_queue_at_once(static):
    assert static.request_queue_size >= 128
