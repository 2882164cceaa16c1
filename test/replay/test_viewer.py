"""The Rerun viewer: it leaves the home of the user unchanged."""

import errno
import http.client
import os
import re
import socket
import sys
import threading
from urllib.parse import urlsplit

import pytest
from log_files import ARTICLE
from programs import execute
from waiting import until

from symtop_ros.physics import Motion, State, Top
from symtop_ros.replay import viewer
from symtop_ros.replay.view.plots import describe_motion
from symtop_ros.run.log.reader import LogError
from symtop_ros.run.simulation.segment import Segment


def test_in_a_venv_its_settings_are_there_without_statistics(tmp_path, monkeypatch):
    monkeypatch.setenv("HOME", str(tmp_path / "home"))
    monkeypatch.setattr(sys, "prefix", str(tmp_path / "venv"))
    for name in ("XDG_CONFIG_HOME", "XDG_DATA_HOME"):
        monkeypatch.delenv(name, raising=False)
    words = [viewer.PROGRAM, "analytics", "config"]
    config = execute(words, env=viewer.settings(), check=True).stdout
    assert '"analytics_enabled": false' in config
    assert not (tmp_path / "home").exists()


def facts(motion, equations=()):
    text = describe_motion(Segment.begin(motion, 0, 1.0), motion.start, {}, dict(equations))
    rows = [row.strip("| ").split(" | ") for row in text.splitlines()[2:]]
    return {name: value.strip("*") for name, value in rows}


def test_exact_rates_stand_next_to_those_of_the_fast_top():
    found = facts(Motion(ARTICLE, State.from_euler(theta=0.5, psi_dot=200.0)))
    assert found["nutation"] == "0.15954 s, 39.382 rad/s (p_psi/Ix: 50.175)"
    assert found["mean precession"] == "6.6381 rad/s (Mgl/p_psi: 5.9441)"
    assert found["in a nutation"] == "0.16856 turns"


@pytest.mark.parametrize("top", [ARTICLE, Top(1.0, 0.5, 0.0)])
def test_what_is_undefined_for_a_sleeping_top_is_a_dash(top):
    found = facts(Motion(top, State.from_euler(theta=0.0)))
    assert found["mean precession"] == "- (Mgl/p_psi: -)"
    assert found["in a nutation"] == "-"


TIMEOUT = 120.0


def test_a_viewer_that_fails_is_a_line_that_says_what_else_there_is(monkeypatch, tmp_path):
    monkeypatch.setattr(viewer, "PROGRAM", sys.executable)  # knows none of the options
    monkeypatch.setattr(viewer, "settings", dict)
    monkeypatch.setattr(viewer.signal, "signal", lambda *_: None)  # the tests keep their own
    with pytest.raises(LogError, match=r"the viewer ended with an error: .*--save OUT\.html"):
        viewer.show(tmp_path / "run.rrd", web=False)


def test_the_page_asks_no_other_host(capsys, browser):
    process = viewer.start(web=True)
    asked = []
    said = []
    address = re.search(r"open (\S+) in", capsys.readouterr().out)[1]
    try:
        tab = browser.new_page()
        tab.on("response", lambda response: asked.append(urlsplit(response.url).hostname))
        tab.on("requestfinished", lambda request: asked.append(urlsplit(request.url).hostname))
        tab.on("console", lambda line: said.append(line.text))
        url = f"{address}&renderer=webgl"
        until(lambda: tab.goto(url).status != 503, timeout=TIMEOUT)
        assert {host for host in asked if host} == {"127.0.0.1"}
        refused = [text for text in said if "Content Security Policy" in text]
        assert any("fonts.googleapis.com" in text for text in refused)  # as it tries to
        tab.close()
    finally:
        process.terminate()
        process.wait(timeout=TIMEOUT)


def serve_once(listening, answer):
    """Send an answer to one connection, and close it."""
    connection, _ = listening.accept()
    with connection:
        connection.recv(1000)
        connection.sendall(answer)


def test_a_viewer_that_ends_within_its_answer_is_not_there(capsys):
    with socket.create_server((viewer.HOST, 0)) as ending:
        answer = b"HTTP/1.1 200 OK\r\nContent-Length: 1000\r\n\r\n<!doc"
        thread = threading.Thread(target=serve_once, args=(ending, answer))
        thread.start()
        port = viewer.serve_page(ending.getsockname()[1], data=1)
        page = http.client.HTTPConnection(viewer.HOST, port, timeout=TIMEOUT)
        page.request("GET", "/")
        assert page.getresponse().status == 503
        page.close()
        thread.join(TIMEOUT)
    assert capsys.readouterr().err == ""


def test_a_page_that_was_closed_is_no_error_and_a_bug_is_one_line(capsys):
    server = viewer._Server((viewer.HOST, 0), None)
    for error in (BrokenPipeError(), RuntimeError("a bug")):
        try:
            raise error
        except Exception:  # as the thread of a request reports it
            server.handle_error(None, None)
    server.server_close()
    said = "the page of the viewer was not sent: RuntimeError('a bug')\n"
    assert capsys.readouterr().err == said


@pytest.mark.skipif(sys.platform != "linux", reason="elsewhere a port is not kept")
def test_a_port_that_was_found_is_kept_for_a_server_that_reuses_it():
    place = viewer.HOST, viewer.free_port()
    with socket.socket() as other, pytest.raises(OSError, match=os.strerror(errno.EADDRINUSE)):
        other.bind(place)
    with socket.socket() as probe:
        assert probe.connect_ex(place) == errno.ECONNREFUSED
    with socket.create_server(place), socket.create_connection(place):
        pass
