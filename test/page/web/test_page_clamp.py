"""A hand that holds the precession of the page's top: by a key, a button, a link and a scene."""

from dataclasses import asdict

import numpy as np
import pytest
from page.web.modules import load_kernel, open_tab
from page.web.opened import read_motion
from page.web.page_words import write_as_page
from physics.tops import ARTICLE, CUSPS, EPS

from symtop_ros.physics import Motion, State, clamp_verdict
from symtop_ros.run.wire.layout import NANOSECONDS

LINK = "#theta=0.5&psi_dot=200&precession=slow"
HELD = "the precession is clamped: let it go first (key c)"


def list_kinds(opened):
    return [(event["kind"], event.get("clamped", False)) for event in opened.read_events()]


@pytest.mark.slow
def test_a_key_holds_the_precession_and_lets_it_go_with_the_bits_of_python(open_page):
    opened = open_page(LINK)
    opened.wait_for_time(0.02)
    opened.press("c")
    _, _, held = opened.read_events()
    assert held["clamped"]
    before = read_motion(held).start
    verdict = clamp_verdict(ARTICLE, before)
    assert opened.tab.locator("#why").get_attribute("data-text") == write_as_page("clamp", verdict)
    assert opened.say("headline") == "Clamped, the axle falls as if the top did not spin."
    opened.wait_for_time(0.06)
    opened.press("c")
    *_, let_go = opened.read_events()
    passed = round((let_go["time"] - held["time"]) * NANOSECONDS)
    state = read_motion(held).at(passed / NANOSECONDS)
    assert let_go["angular_velocity"] == pytest.approx(state.angular_velocity.tolist(), abs=1e-9)
    assert list_kinds(opened)[1:] == [("start", False), ("clamp", True), ("unclamp", False)]
    assert opened.say("headline").startswith("Let go, the top precesses in loops, ")
    assert opened.read_run()["format"] == 3
    events = opened.read_events()
    opened.reload()
    assert opened.read_events() == events


@pytest.mark.parametrize("key", ["h", "d", "ArrowUp", "ArrowRight"])
def test_what_would_act_on_it_is_refused(open_page, key):
    opened = open_page(LINK)
    opened.press("c")
    before = opened.read_events()
    opened.press(key)
    assert opened.say("refusal") == HELD
    assert opened.read_events() == before
    opened.press("r")  # a reset lets go
    assert list_kinds(opened)[-1] == ("start", False)


def test_a_button_holds_it_as_long_as_it_is_held(open_page):
    opened = open_page(LINK)
    opened.open_tab("push")
    button = opened.tab.locator("[data-hold=grasp]")
    button.dispatch_event("pointerdown")
    opened.until(lambda: list_kinds(opened)[-1] == ("clamp", True))
    button.dispatch_event("pointerup")
    opened.until(lambda: list_kinds(opened)[-1] == ("unclamp", False))
    assert len(opened.read_events()) == 4


@pytest.mark.slow
def test_a_scene_a_link_and_a_reset_begin_held(open_page):
    opened = open_page("#scene=perry_clamped")
    assert list_kinds(opened)[-1] == ("start", True)
    assert read_motion(opened.read_events()[-1]).start == CUSPS
    link = opened.tab.input_value("#link")
    opened.press("c")
    opened.press("r")
    assert list_kinds(opened)[-1] == ("start", True)
    again = open_page(f"#{link.split('#')[1]}")
    assert list_kinds(again)[-1] == ("start", True)


def test_other_friction_is_refused_and_other_weight_falls_as_well(open_page):
    opened = open_page(LINK)
    opened.press("c")
    opened.enter("top.Mgl", "0.05")
    assert list_kinds(opened)[-1] == ("change", True)
    opened.enter("friction.axial", "1e-6")
    assert "without friction" in opened.say("refusal")
    assert list_kinds(opened)[-1] == ("change", True)


def test_a_vertical_axis_cannot_be_held(open_page):
    opened = open_page("#scene=sleeping")
    before = opened.read_events()
    opened.press("c")
    assert "a tilted axis" in opened.say("refusal")
    assert opened.read_events() == before


def test_charts_of_gravity_alone_are_hidden_while_it_is_held(open_page):
    opened = open_page("#scene=perry_clamped")
    for chart in ("#impulses-chart", "#kinds-chart"):
        assert opened.tab.locator(chart).is_hidden()
    opened.press("c")
    assert opened.tab.locator("#impulses-chart").is_visible()


def test_the_torque_that_is_drawn_has_that_of_the_hand(browser):
    start = State.from_euler(theta=0.5, phi=1.0, theta_dot=-3.0, psi_dot=200.0)
    motion = Motion(ARTICLE, start, clamped=True)
    tab = open_tab(browser)
    load_kernel(tab)
    found = tab.evaluate(
        """async ([top, orientation, omega]) => {
          const { Course } = await import("/physics/course.js");
          const { State } = await import("/physics/state.js");
          const { findVectors } = await import("/scene/vectors.js");
          const state = new State(kernel, orientation, omega);
          const course = new Course(kernel, top, state, undefined, undefined, null, true);
          return findVectors(course, state).torque;
        }""",
        [asdict(ARTICLE), start.orientation.tolist(), start.angular_velocity.tolist()],
    )
    right = motion.total_torque(start)
    assert np.abs(np.array(found) - right).max() < 16 * EPS * np.abs(right).max()
    tab.close()
