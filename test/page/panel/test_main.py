"""The program: a file, a server, or a node; one message for what cannot be done."""

import contextlib
import ipaddress
import os
import re
import signal
import urllib.request
from pathlib import Path
from urllib.parse import urlsplit

import pytest
from disks import mounted
from documents import ROOT
from programs import command, running
from run.simulation.page_runs import change as page_run
from trials import choose
from waiting import TIMEOUT

from symtop_ros import __version__
from symtop_ros.page.panel import main as module
from symtop_ros.page.panel.server import LOCAL_HOST
from symtop_ros.page.web.join import write_file

pytestmark = pytest.mark.usefixtures("signals_as_before")


@pytest.fixture(autouse=True)
def _folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)


@contextlib.contextmanager
def running_panel(*words):
    """top_panel on any free port, and the address that it prints; it has ended afterwards."""
    words = command("top_panel", "--port", "0", "--no-browser", *words)
    with running(words, 0, env={**os.environ, "PYTHONPATH": str(ROOT)}) as process:
        line = process.stdout.readline()
        found = re.fullmatch(r".+: open (http://\S+) in a browser; Ctrl-C ends it\n", line)
        assert found, line
        yield process, found[1]


def load(url):
    with urllib.request.urlopen(url, timeout=TIMEOUT) as answer:
        return answer.read().decode()


@pytest.mark.slow
@pytest.mark.parametrize("number", choose((signal.SIGINT, signal.SIGTERM), (signal.SIGINT,)))
def test_a_signal_ends_the_server_silently(number):
    with running_panel() as (process, url):
        assert load(url) == write_file()
        process.send_signal(number)
        output, errors = process.communicate(timeout=TIMEOUT)
        assert (process.returncode, output, errors) == (0, "", "")


def test_a_port_that_is_taken_is_one_message_and_status_1(capsys):
    with contextlib.closing(module.PageServer(LOCAL_HOST, 0, "").socket) as taken:
        port = taken.getsockname()[1]
        assert module.main(["--port", str(port), "--no-browser"]) == 1
    (line,) = capsys.readouterr().err.splitlines()
    # the one place of this refusal: the address that was tried, why it failed, and what to do
    assert line.startswith("top_panel: port must be ")
    assert f"got 127.0.0.1 port {port} (address already in use); use --port" in line


@pytest.mark.slow
def test_other_machines_are_told_an_address_and_nothing_is_to_be_guarded():
    with running_panel("--host", "0.0.0.0") as (process, url):
        process.terminate()
        _, errors = process.communicate(timeout=TIMEOUT)
    host = urlsplit(url).hostname
    ipaddress.ip_address(host)  # other machines may not know the name of this one
    assert host != "0.0.0.0"
    assert (process.returncode, errors) == (0, "")  # each page has its own top


def test_without_options_the_file_is_written_here_and_opened(monkeypatch, capsys):
    opened = []
    monkeypatch.setattr(module.webbrowser, "open", lambda url: opened.append(url) or True)
    monkeypatch.setenv("DISPLAY", ":0")
    assert module.main([]) == 0
    assert opened == [Path("top.html").absolute().as_uri()]
    assert capsys.readouterr().out == "wrote top.html, and opened it in a browser\n"
    assert Path("top.html").read_text() == write_file()


def test_a_saved_run_of_the_same_name_is_kept():
    Path("top.html").write_text("a run")
    assert module.main(["--no-browser"]) == 0
    assert module.main(["--no-browser"]) == 0  # the same page is the same file
    assert Path("top.html").read_text() == "a run"
    assert sorted(path.name for path in Path().iterdir()) == ["top.html", "top_2.html"]


@pytest.mark.slow
@pytest.mark.parametrize("change", [(__version__, "0.4.0"), ("<body", "<body data-old")])
def test_a_page_without_a_run_is_renewed_whatever_its_version(change, capsys):
    Path("top.html").write_text(write_file().replace(*change))
    assert module.main(["--no-browser"]) == 0
    assert capsys.readouterr().out == "wrote top.html, open it in a browser\n"
    assert Path("top.html").read_text() == write_file()
    assert len([*Path().iterdir()]) == 1


def test_a_page_with_a_run_is_kept_and_named(capsys):
    saved = write_file(run=page_run(1))
    Path("top.html").write_text(saved)
    assert module.main(["--no-browser"]) == 0
    assert capsys.readouterr().out.splitlines() == [
        "kept top.html, because it contains a saved run",
        "wrote top_2.html, open it in a browser",
    ]
    assert Path("top.html").read_text() == saved
    assert Path("top_2.html").read_text() == write_file()


@pytest.mark.parametrize("words", ["--node /top", "--port 8000", "--host 0.0.0.0"])
def test_a_page_that_is_written_is_not_served_as_well(words, capsys):
    with pytest.raises(SystemExit, match="2"):
        module.main(["--write", "x.html", *words.split()])
    option = words.split()[0]
    said = f"--write must be without --node, --port and --host, got {option}\n"
    assert capsys.readouterr().err.endswith(said)
    assert not Path("x.html").exists()


def test_the_lesson_is_opened_by_the_file_itself():
    """Some systems drop the fragment of an address of a file."""
    assert module.main(["--lesson", "--write", "lesson.html"]) == 0
    assert '"opening": "lesson=1"' in Path("lesson.html").read_text()


@pytest.mark.parametrize(
    ("platform", "display", "expected"),
    [("linux", "", False), ("linux", ":0", True), ("darwin", "", True), ("win32", "", True)],
)
def test_a_screen_is_found(platform, display, expected, monkeypatch):
    monkeypatch.setattr(module.sys, "platform", platform)
    monkeypatch.setenv("DISPLAY", display)
    monkeypatch.delenv("WAYLAND_DISPLAY", raising=False)
    assert module.has_screen() is expected


def test_a_full_disk_leaves_no_part_of_a_page_and_the_page_that_was_there(tmp_path, capsys):
    with mounted(tmp_path / "small", "size=300k") as folder:
        (old := folder / "old.html").write_text("a page")
        for name in ("old.html", "new.html"):
            assert module.main(["--write", str(folder / name)]) == 1
            said = f"top_panel: cannot write {folder / name}: No space left on device\n"
            assert capsys.readouterr().err == said
        assert [*folder.iterdir()] == [old]
        assert old.read_text() == "a page"
