"""top_live between a real node and a real viewer; both may end and be restarted."""

import subprocess
import time
from types import SimpleNamespace

import pytest
from programs import PATIENT, command, environment, run, running_node

from symtop_ros.live import main as module
from symtop_ros.log.batch import Batch
from symtop_ros.log.reader import LogError
from symtop_ros.playback import viewer
from workshop.load.domains import claim_domain
from workshop.pictures.viewer import running_viewer, views

DOMAIN = claim_domain()
TIMEOUT = 60.0


@pytest.fixture
def live():
    """top_live on a port on which nothing listens yet, and the port."""
    port = viewer.free_port()
    with running_viewer(port=port) as (client, _):
        arguments = ["--port", str(port)]
        process = subprocess.Popen(
            command("top_live", *arguments),
            env=environment(DOMAIN),
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
        )
        try:
            yield process, client, port
        finally:
            process.terminate()
            process.communicate(timeout=60)


def moving(client):
    """Wait until the top is seen to move."""
    pictures, deadline = set(), time.monotonic() + TIMEOUT
    while len(pictures) < 2:
        assert time.monotonic() < deadline, "nothing moves"
        pictures |= picture_now(client)
        time.sleep(0.2)


def picture_now(client):
    """Return a picture of the scene; none if a new node's blueprint replaced its view meanwhile."""
    space = views(client, 13)["the top"]
    try:
        return {client.take_screenshot(space.view_id)}
    except ConnectionError as error:
        if "NotFound" not in str(error):
            raise
        return set()


def test_the_scene_follows_a_node_and_finds_it_again(live):
    _, client, _ = live
    for scene in ("cusps", "looping"):
        with running_node(DOMAIN, f"scene:={scene}"):
            moving(client)
            assert run("top_ctl", *PATIENT, "hurry", domain=DOMAIN).returncode == 0
            assert all(not each.reports for each in views(client, 13).values())


@pytest.mark.long
def test_a_viewer_that_was_closed_is_found_again():
    port = viewer.free_port()
    gyro = ("--node", "/gyro")
    with running_node(DOMAIN, "scene:=cusps", name="gyro"):
        assert run("top_ctl", *PATIENT, *gyro, "hurry", domain=DOMAIN).returncode == 0
        with running_viewer(port=port) as (client, _):
            process = subprocess.Popen(
                command("top_live", *gyro, "--port", str(port)),
                env=environment(DOMAIN),
                stderr=subprocess.PIPE,
                stdout=subprocess.PIPE,
                text=True,
            )
            moving(client)
        try:
            for line in process.stderr:
                if line.startswith("the viewer ended; waiting for a new one"):
                    break
            with running_viewer(port=port) as (client, _):
                moving(client)
        finally:
            process.terminate()
            said, _ = process.communicate(timeout=60)
        assert said.count(f"showing the top in the viewer on port {port}\n") == 2


def test_without_viewer_and_screen_the_message_names_the_option(monkeypatch):
    monkeypatch.delenv("DISPLAY", raising=False)
    monkeypatch.delenv("WAYLAND_DISPLAY", raising=False)
    port = viewer.free_port()
    result = run("top_live", "--port", str(port), domain=DOMAIN)
    assert result.returncode == 1
    expected = f"no viewer listens on port {port}, and there is no screen for a new one: use --web"
    assert result.stderr == f"top_live: {expected}\n"


def test_a_viewer_that_ends_at_once_is_told(monkeypatch):
    monkeypatch.setattr(viewer, "start", lambda **_: subprocess.Popen(["false"]))
    monkeypatch.setattr(module.rclpy, "ok", lambda: True)
    with (
        pytest.raises(LogError, match="the Rerun viewer did not start"),
        module._viewer(viewer.free_port(), web=True),
    ):
        pass


def test_help_is_answered():
    assert run("top_live", "--help", domain=DOMAIN).returncode == 0


def test_without_a_node_it_says_once_what_is_missing(monkeypatch, capsys):
    monkeypatch.setattr(module, "SILENCE", 0.05)
    monkeypatch.setattr(module, "_connect", lambda *_: None)
    monkeypatch.setattr(module, "_spin", lambda *_: time.sleep(0.02))
    turns = iter([None] * 10)
    process = SimpleNamespace(poll=lambda: next(turns, 0))
    options = module._parser().parse_args(["--node", "lab2/top"])
    module._stream(None, SimpleNamespace(batch=Batch), options, process)
    (line,) = capsys.readouterr().err.splitlines()
    assert line.startswith("top_live: nothing heard from /lab2/top for 0.05 s")
