"""Every scene is drawn, frame by frame, also under friction and torques."""

import math
import time

import numpy as np
import pytest
from panel.pages import open_pages

from symtop_ros.panel.page import Page
from symtop_ros.panel.server import LOCAL_HOST
from symtop_ros.panel.source import LocalTop
from symtop_ros.simulation.presets import scene_names
from symtop_ros.simulation.sensor import Imu, Rig

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
        assert time.monotonic() < deadline, page.actions.message
        time.sleep(0.005)


@pytest.mark.parametrize("name", scene_names())
def test_a_scene_is_drawn(page, name):
    page.actions.choose_scene(name)
    page.actions.push_tilt(0.5)  # so that there is a ghost, and a potential before
    page.actions.step()
    wait(page, lambda: page.run.stamp > page.run.event.stamp)
    assert page.actions.message == ""
    state, scene = page.run.state, page._scene
    assert np.array_equal(scene._body.wxyz, state.orientation)
    assert scene.handle.position == pytest.approx(state.to_world([0.0, 0.0, 1.0]), abs=1e-15)


def test_the_arrows_have_the_directions_of_the_vectors(page):
    page.actions.choose_scene("looping")
    page.actions.step()
    wait(page, lambda: page.run.stamp > page.run.event.stamp)
    momentum = page.run.motion.top.angular_momentum(page.run.state)
    w, x, y, z = page._scene._arrows["L"].wxyz
    drawn = np.array([2 * (x * z + w * y), 2 * (y * z - w * x), w * w + z * z - x * x - y * y])
    assert drawn == pytest.approx(momentum / np.linalg.norm(momentum), abs=1e-14)  # seen: 1e-16
    nodes = page._scene._nodes.wxyz
    angle = 2 * math.atan2(nodes[3], nodes[0])
    turns = (angle - page.run.state.euler_angles.phi) / (2 * math.pi)
    assert turns == pytest.approx(round(turns), abs=1e-15)


def test_a_hidden_layer_is_not_drawn(page):
    page.actions.choose_scene("cusps")
    nodes = (page._scene._trace, page._scene._arrows["L"])
    for shown in (False, True):
        page._scene.shown["trace"] = page._scene.shown["L"] = shown
        wait(page)
        assert [node.visible for node in nodes] == [shown, shown]


def test_the_marks_of_the_precession_are_the_regular_rates(page):
    page.actions.choose_scene("hurry_slow")
    wait(page, lambda: page.run.stamp > page.run.event.stamp)
    assert page._controls._marked == pytest.approx((6.497, 69.82), rel=1e-3)
    assert page._controls._phi_dot.value == pytest.approx(6.497, abs=1e-3)
    page.actions.set_parameters({"top.Mgl": 0.01})
    page.actions.start({"theta": 0.5, "psi_dot": 100.0, "precession": "slow"})
    wait(page, lambda: page._controls._marked[0] < 6)
    assert page._controls._marked == pytest.approx((1.84, 36.3), rel=1e-2)


def test_markup_in_a_link_is_shown_as_text(page):
    page.actions.follow_link({"<script>alert(1)</script>": "0"})
    wait(page, lambda: "&lt;script&gt;alert(1)" in page._controls._verdict.content)
    assert "<script" not in page._controls._verdict.content


def test_a_bug_in_the_drawing_is_a_message_and_the_next_frames_are_drawn(page, monkeypatch):
    with monkeypatch.context() as patch:
        patch.setattr(page._scene, "draw", lambda *_: 1 / 0)
        deadline = time.monotonic() + TIMEOUT
        while "drawing failed: ZeroDivisionError" not in page.actions.message:
            assert time.monotonic() < deadline
            time.sleep(0.01)
    page.actions.choose_scene("cusps")
    wait(page)
    assert page.actions.message == ""


def test_the_specific_force_is_drawn_if_the_top_carries_a_sensor(page):
    arrow = page._scene._arrows["specific force"]
    page.actions.choose_scene("free")  # its centre of mass rests in the pivot
    page.actions.step()
    wait(page, lambda: page.run.stamp > page.run.event.stamp)
    assert not arrow.visible
    page.run.segment = page.run.segment.equip(Rig(9.81, Imu()))
    page._scene.begin_motion(page.run.segment, page.run.state)
    wait(page)
    assert arrow.visible
    assert arrow.wxyz == pytest.approx([1.0, 0.0, 0.0, 0.0], abs=1e-15)  # upwards, against gravity
    page._scene.shown["specific force"] = False
    wait(page)
    assert not arrow.visible
