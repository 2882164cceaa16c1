"""top_live between a real node and a real viewer; both may end and be restarted."""

import contextlib
import socket

import pytest
from programs import PATIENT, command, run, running, running_node
from waiting import until

from symtop_ros.replay import viewer
from workshop.load.domains import share_domain
from workshop.pictures.viewer import running_viewer, views

DOMAIN = share_domain()


def moving(client):
    """Wait until the top is seen to move."""
    pictures = set()
    until(lambda: len(pictures) > 1, lambda: pictures.update(picture_now(client)))


def picture_now(client):
    """Return a picture of the scene; none if a new node's blueprint replaced its view meanwhile.

    None either if the viewer has no processor to draw it in its 15 s.
    """
    space = views(client, 13)["the top"]
    try:
        return {client.take_screenshot(space.view_id)}
    except TimeoutError:
        return set()
    except ConnectionError as error:
        if "NotFound" not in str(error):
            raise
        return set()


@pytest.mark.slow
def test_the_scene_follows_a_node_and_finds_it_again():
    port = viewer.free_port()
    words = command("top_live", "--port", port)
    with running_viewer(port=port) as (client, _), running(words, DOMAIN):
        for scene in ("cusps", "looping"):
            with running_node(DOMAIN, f"scene:={scene}"):
                moving(client)
                assert run("top_ctl", *PATIENT, "hurry", domain=DOMAIN).returncode == 0
                assert not any(each.reports for each in views(client, 13).values())


@pytest.mark.slow
def test_a_program_on_the_port_that_does_not_answer_does_not_keep_it_from_ending():
    with socket.create_server((viewer.HOST, 0)) as mute:
        words = command("top_live", "--port", mute.getsockname()[1])
        with running(words, DOMAIN) as process:
            assert process.stdout.readline().startswith("showing the top in the viewer")
            process.terminate()
            said = "top_live: the viewer does not answer\n"
            assert process.communicate(timeout=300) == ("", said)
            assert process.returncode == 0


@pytest.mark.long
def test_a_viewer_that_was_closed_is_found_again():
    port = viewer.free_port()
    gyro = ("--node", "/gyro")
    with running_node(DOMAIN, "scene:=cusps", name="gyro"):
        assert run("top_ctl", *PATIENT, *gyro, "hurry", domain=DOMAIN).returncode == 0
        with contextlib.ExitStack() as stack:
            with running_viewer(port=port) as (client, _):
                words = command("top_live", *gyro, "--port", port)
                process = stack.enter_context(running(words, DOMAIN))
                moving(client)
            for line in process.stderr:
                if line.startswith("the viewer ended; waiting for a new one"):
                    break
            with running_viewer(port=port) as (client, _):
                moving(client)
            process.terminate()
            said, _ = process.communicate(timeout=300)
        assert said.count(f"showing the top in the viewer on port {port}\n") == 2


def test_without_viewer_and_screen_the_message_names_the_option(monkeypatch):
    monkeypatch.delenv("DISPLAY", raising=False)
    monkeypatch.delenv("WAYLAND_DISPLAY", raising=False)
    port = viewer.free_port()
    result = run("top_live", "--port", str(port), domain=DOMAIN)
    expected = f"no viewer listens on port {port}, and there is no screen for a new one: use --web"
    assert (result.returncode, result.stderr) == (1, f"top_live: {expected}\n")
