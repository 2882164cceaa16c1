"""The program: one message for what cannot be done, and a silent end."""

import ipaddress
import os
import signal
import socket
import subprocess
import sys
from urllib.parse import urlsplit

import pytest
from panel.pages import open_pages, running_panel
from programs import RESOURCE

from symtop_ros.panel import main as module
from symtop_ros.panel.server import LOCAL_HOST

TIMEOUT = 60.0


@pytest.fixture(autouse=True)
def _signals_as_before():
    before = {number: signal.getsignal(number) for number in (signal.SIGINT, signal.SIGTERM)}
    yield
    for number, handler in before.items():
        signal.signal(number, handler)


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_a_signal_ends_it_silently_also_while_a_page_is_open(number):
    with running_panel("--scene", "looping") as (process, url):
        with open_pages(url):
            process.send_signal(number)
            output, errors = process.communicate(timeout=TIMEOUT)
        assert (process.returncode, output, errors) == (0, "", "")


def test_a_port_that_is_taken_is_one_message_and_status_1(capsys):
    with socket.create_server((LOCAL_HOST, 0)) as taken:
        port = taken.getsockname()[1]
        assert module.main(["--port", str(port), "--no-browser"]) == 1
    (line,) = capsys.readouterr().err.splitlines()
    # the one place of this refusal: the address that was tried, why it failed, and what to do
    assert line.startswith("top_panel: port must be ")
    assert f"got 127.0.0.1 port {port} (address already in use); use --port" in line


def test_another_host_is_warned_of():
    with running_panel("--host", "0.0.0.0") as (process, url):
        process.terminate()
        _, errors = process.communicate(timeout=TIMEOUT)
    host = urlsplit(url).hostname
    ipaddress.ip_address(host)  # other machines may not know the name of this one
    assert host != "0.0.0.0"
    (warning,) = errors.splitlines()
    assert warning.startswith("top_panel: warning: ")
    assert "0.0.0.0" in warning


def test_it_runs_where_there_is_no_ros(tmp_path):
    """As on Windows or macOS, where also termios and fcntl are missing."""
    missing = ("rclpy", "rerun", "std_srvs", "geometry_msgs", "termios", "fcntl", "tty", "resource")
    code = (
        f"import sys; sys.modules.update(dict.fromkeys({missing!r}));"
        "from symtop_ros.panel.main import main; sys.exit(main(sys.argv[1:]))"
    )
    root = RESOURCE.parent
    words = [sys.executable, "-c", code, "--port", "0", "--no-browser"]
    environment = {**os.environ, "PYTHONPATH": str(root)}
    with subprocess.Popen(words, stdout=subprocess.PIPE, text=True, env=environment) as process:
        try:
            with open_pages(process.stdout.readline().split()[3], least=1):
                pass
        finally:
            process.terminate()
            assert process.wait(timeout=TIMEOUT) == 0


def test_a_node_without_ros_is_one_message(monkeypatch, capsys):
    monkeypatch.setitem(sys.modules, "rclpy", None)
    assert module.main(["--node", "/top"]) == 1
    assert capsys.readouterr().err == (
        "top_panel: rclpy is missing: source a ROS 2, or pip install '.[ros]' in the checkout\n"
    )


def test_a_browser_is_opened_where_there_is_a_screen(monkeypatch, capsys):
    opened = []

    def open_browser(url):
        opened.append(url)
        signal.raise_signal(signal.SIGTERM)

    monkeypatch.setattr(module.webbrowser, "open", open_browser)
    monkeypatch.setattr(module, "_has_screen", lambda: True)
    assert module.main(["--port", "0"]) == 0
    (line,) = capsys.readouterr().out.splitlines()
    assert line == f"local top: open {opened[0]} in a browser; Ctrl-C ends it"


def test_the_lesson_is_an_address_of_the_page():
    with running_panel("--lesson") as (_, url):
        assert urlsplit(url).fragment == "lesson"


@pytest.mark.parametrize(
    ("platform", "display", "expected"),
    [("linux", "", False), ("linux", ":0", True), ("darwin", "", True), ("win32", "", True)],
)
def test_a_screen_is_found(platform, display, expected, monkeypatch):
    monkeypatch.setattr(module.sys, "platform", platform)
    monkeypatch.setenv("DISPLAY", display)
    monkeypatch.delenv("WAYLAND_DISPLAY", raising=False)
    assert module._has_screen() is expected


def test_the_run_is_saved_when_it_ends(tmp_path):
    path = tmp_path / "run.html"
    with running_panel("--save", str(path)) as (process, url):
        with open_pages(url, least=30):
            process.terminate()
            output, errors = process.communicate(timeout=TIMEOUT)
        assert (process.returncode, errors) == (0, "")
    assert output == f"wrote {path}; open it in a browser\n"
    assert "window.SAVED_RUN" in path.read_text()


@pytest.mark.parametrize("name", ["run.txt", "missing/run.html"])
def test_a_file_that_cannot_be_written_is_refused_at_the_start(name, tmp_path, capsys):
    path = tmp_path / name
    assert module.main(["--port", "0", "--no-browser", "--save", str(path)]) == 1
    assert capsys.readouterr().err == (
        f"top_panel: --save must be a name that ends in .html in a folder, got {path}\n"
    )
