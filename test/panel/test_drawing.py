"""Every scene is drawn, frame by frame, also under friction and torques."""

import math
import time

import numpy as np
import pytest
from panel.pages import open_pages

from symtop_ros.drawing.fictitious import find_scale, place_arrows, torques_of
from symtop_ros.panel.page import REMEMBERED, Page
from symtop_ros.panel.server import LOCAL_HOST
from symtop_ros.panel.source import LocalTop
from symtop_ros.simulation.presets import scene_names
from symtop_ros.simulation.sensor import Imu, Rig
from symtop_ros.web.run import TRACE
from symtop_ros.web.scene import CHUNK, FICTITIOUS

TIMEOUT = 60.0


@pytest.fixture(scope="module", name="page")
def _page():
    page = Page(LocalTop("cusps", factor=0.1), LOCAL_HOST, 0)
    try:
        with open_pages(page.server.url):
            page.actions.request("pause", True)  # so that what is compared stands still
            yield page
    finally:
        page.close()


def wait(page, condition=lambda: True, frames=4):
    """Wait for some frames, and for a condition."""
    begin, deadline = page.frames, time.monotonic() + TIMEOUT
    while page.frames < begin + frames or not condition():
        assert time.monotonic() < deadline, page.pages._notices
        time.sleep(0.005)


@pytest.mark.parametrize("name", scene_names())
def test_a_scene_is_drawn(page, name):
    page.actions.choose_scene(name)
    page.actions.push_tilt(0.5)  # so that there is a ghost, and a potential before
    page.actions.step()
    wait(page, lambda: page.run.stamp > page.run.event.stamp)
    assert page.pages._notices == []
    state, scene = page.run.state, page._scene
    assert np.array_equal(scene._body.wxyz, state.orientation)
    assert scene.handle.position == pytest.approx(state.to_world([0.0, 0.0, 1.0]), abs=1e-15)


def test_the_arrows_have_the_directions_of_the_vectors(page):
    page.actions.choose_scene("looping")
    page.actions.step()
    wait(page, lambda: page.run.stamp > page.run.event.stamp)
    momentum = page.run.motion.top.angular_momentum(page.run.state)
    w, x, y, z = page._scene._arrows["L"].handle.wxyz
    drawn = np.array([2 * (x * z + w * y), 2 * (y * z - w * x), w * w + z * z - x * x - y * y])
    assert drawn == pytest.approx(momentum / np.linalg.norm(momentum), abs=1e-14)  # seen: 1e-16
    nodes = page._scene._nodes.wxyz
    angle = 2 * math.atan2(nodes[3], nodes[0])
    turns = (angle - page.run.state.euler_angles.phi) / (2 * math.pi)
    assert turns == pytest.approx(round(turns), abs=1e-15)


def test_the_ends_of_the_trace_meet_its_newest_points(page):
    page.actions.choose_scene("looping")
    for _ in range(40):
        page.actions.step()  # one in each frame: of several steps only the last has a sample
        wait(page, lambda: page.run.stamp > page.run.event.stamp, frames=1)
    wait(page)
    run, scene = page.run, page._scene
    drawn = np.concatenate([node.points.reshape(-1, 3) for node in scene._trace])
    assert run.traced > CHUNK
    newest = run.axes[-1 - min(run.traced, TRACE - CHUNK) :][:-1]  # with the place of the head
    distances = np.abs(drawn[:, None] - newest[None]).max(axis=2).min(axis=0)
    assert distances.max() < 1e-7  # single precision
    assert np.abs(scene._head.points[0, 1] - run.axes[-1]).max() < 1e-7


def test_a_bug_in_the_drawing_is_a_message_and_the_next_frames_are_drawn(page, monkeypatch):
    with monkeypatch.context() as patch:
        patch.setattr(page._scene, "draw", lambda *_: 1 / 0)
        deadline = time.monotonic() + TIMEOUT
        while not any("failed: ZeroDivisionError" in text for text in page.pages._notices):
            assert time.monotonic() < deadline
            time.sleep(0.01)
    page.actions.choose_scene("cusps")
    page.pages._notices.clear()
    wait(page)
    assert page.pages._notices == []


def test_the_specific_force_is_drawn_if_the_top_carries_a_sensor(page):
    arrow = page._scene._arrows["specific force"].handle
    page.actions.choose_scene("free")  # its centre of mass rests in the pivot
    page.actions.step()
    wait(page, lambda: page.run.stamp > page.run.event.stamp)
    assert not arrow.visible
    page.run.segment = page.run.segment.equip(Rig(9.81, Imu()))
    page._scene.begin_motion(page.run.segment, page.run.state)
    wait(page)
    assert arrow.visible
    assert arrow.wxyz == pytest.approx([1.0, 0.0, 0.0, 0.0], abs=1e-15)  # upwards, against gravity


def test_the_fictitious_torques_are_drawn_once_a_page_shows_them(page):
    page.actions.choose_scene("hurry_slow")
    page.actions.start({"theta": 0.5, "psi_dot": 200.0, "phi_dot": 9.0})
    page.actions.step()
    wait(page, lambda: page.run.stamp > page.run.event.stamp)
    arrows = page._scene._torques
    assert not any(arrow.handle.visible for arrow in arrows.values())
    (client,) = page.server.get_clients()
    name = page.server.page_of(client)
    page._show_layer(name, FICTITIOUS, True)
    wait(page, lambda: arrows["gravity"].handle.visible)
    assert page._layers_of(client) == {FICTITIOUS: True}
    top, state = page.run.motion.top, page.run.state
    scale, phi = find_scale(top, page.run.motion.start), state.euler_angles.phi
    drawn = place_arrows(torques_of(top, state), np.asarray(phi), scale)
    for each, (origin, vector) in drawn.items():
        assert arrows[each].handle.position == pytest.approx(origin, abs=1e-15)
        length = arrows[each].handle.points[0, 1, 2]
        assert length == pytest.approx(np.linalg.norm(vector), abs=0.005)  # two digits are sent
    page._show_layer(name, FICTITIOUS, False)
    wait(page, lambda: not page._scene.shows_torques)


def test_choices_of_pages_that_are_long_gone_are_forgotten(page):
    for number in range(REMEMBERED + 5):
        page._show_layer(f"gone{number}", "trace", False)
    assert len(page._shown) == REMEMBERED
