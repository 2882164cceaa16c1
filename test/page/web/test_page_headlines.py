"""The headline says what is so, and agrees with the reason below it; so do sentences at buttons."""

import math

import numpy as np
import pytest
from page.web.opened import read_motion
from trials import choose

from symtop_ros.page.web.join import LANGUAGES, read_texts
from symtop_ros.physics import Motion
from symtop_ros.physics.kicks import push_axle


def test_a_kick_under_friction_is_judged_apart_from_friction_and_said_to_be_past(opened):
    opened.start_scene("friction")
    opened.press("h")
    headline = opened.say("headline")
    assert headline.endswith(" (apart from friction).") or "(apart from friction):" in headline
    assert "between" not in headline
    why = opened.say("why")
    assert why.startswith("At this instant: precession ")
    assert why.count(" (neglecting friction and applied torque): ") == 2


def read_history(opened):
    entries = opened.tab.locator("#entries button")
    return entries.evaluate_all("all => all.map(e => e.dataset.text)")


def test_history_is_in_the_words_of_the_user_and_the_unit_of_the_page(opened):
    opened.enter("theta", "0.6")
    opened.tab.click("#hurry")
    opened.enter("top.Mgl", "0.05")
    opened.open_tab("history")
    assert read_history(opened) == [
        "Mgl changed to 0.05",
        "hurried: phi' times 1.4, spin momentum held",
        "started: theta 0.6 rad, phi' 6.497, psi' 200 rad/s",
        "Perry's rule holds",
    ]
    opened.open_tab("view")
    opened.tab.select_option("#unit", "deg")
    opened.open_tab("history")
    assert "started: theta 34.38°, phi' 6.497, psi' 200 rad/s" in read_history(opened)
    opened.tab.click("#entries button:text('started:')")
    assert opened.read_last().euler_angles.theta == pytest.approx(0.6)


@pytest.mark.slow
@pytest.mark.parametrize("language", choose([*LANGUAGES], ("de",)))
def test_a_run_of_one_language_is_read_in_the_words_of_another(opened, open_page, language):
    opened.start_scene("cusps")
    opened.enter("top.Mgl", "0.05")
    opened.press("ArrowUp")
    opened.press("r")
    run = opened.read_run()
    assert "request" not in str(run)
    other = open_page(f"#lang={language}")
    texts = read_texts(language)
    other.drop(run)
    changed = texts["request.parameter"].replace("{name}", "Mgl")
    expected = [
        texts["request.reset"],
        texts["request.up"],
        changed.replace("{value:4g}", f"0{texts['point']}05"),
        texts["scene.cusps.title"],
    ]
    other.until(lambda: read_history(other)[:4] == expected)
    assert other.read_events() == run["events"]


def test_words_that_a_run_of_before_has_are_shown_as_they_are_and_make_no_buttons(opened):
    run = opened.read_run()
    start = {name: value for name, value in run["events"][0].items() if name != "made_by"}
    texts = ["[x|nothing]", "Perrys Regel gilt", "theta <b>"]
    run["events"] = [{**start, "request": text} for text in texts]
    run["events"].append({**start, "made_by": {"kind": "scene", "name": "of another version"}})
    named = {"kind": "parameter", "name": "[y|theta]", "value": 1}
    run["events"].append({**start, "kind": "change", "made_by": named})
    opened.drop(run)
    opened.until(lambda: len(opened.read_events()) == len(run["events"]))
    changed, started, *given = read_history(opened)
    assert given == texts[::-1]
    assert started.startswith("started: ")
    assert changed == "[y|theta] changed to 1"
    assert opened.tab.locator("#entries button button").count() == 0
    assert opened.read_events() == run["events"]


@pytest.mark.slow
@pytest.mark.wording
def test_a_kick_names_the_point_that_it_has_moved_and_one_that_is_no_longer_reached(opened):
    opened.tab.click("text=Pause")
    opened.open_tab("push")
    cases = (
        # theta was 2.000 to 2.089 and is 2.000 to 2.050
        (
            "theta=2&psi_dot=200&phi_dot=3",
            "hurry_held",
            "falls 0.039 rad less far than without the push.",
        ),
        # theta was 0.439 to 0.500 and is 0.500 to 0.5017
        (
            *("theta=0.5&psi_dot=200&phi_dot=9", "delay_held"),
            "falls 0.0017 rad lower than without the push, and no longer rises.",
        ),
        # theta was 0.500 to 0.664 and is 0.500
        (
            "scene=cusps&precession=slow",
            "hurry_held",
            "rises 0.063 rad higher than without the push.",
        ),
    )
    for fragment, act, words in cases:
        opened.follow(fragment)
        opened.tab.click(f"[data-act={act}]")
        assert opened.say("headline") == f"The top {words}"


# The article's top at both roots, at slow roots of a slower spin that sink and that rise, a disc, a
# hanging top, and one that is let go.
STEADY = [
    f"theta=0.5&psi_dot={spin}&precession={root}"
    for spin in (112, 120, 200)
    for root in ("slow", "fast")
]
PRESSED = [*STEADY, "scene=perry_fails", "scene=hanging", "scene=cusps", "scene=conical_pendulum"]
HEIGHTS = {1: "higher", -1: "lower", 0: "as high as before"}


def push_for_a_second(motion):
    way = math.copysign(1.0, motion.mean_precession_rate)
    for k in range(20):
        state = motion.at(0.05 if k else 0.0)
        pushed = push_axle(motion.top, state, way * 0.015 * abs(motion.top.Mgl) / 20)
        motion = Motion(motion.top, pushed)
    return motion


def turn_for_a_second(motion):
    torque = (0.0, 0.0, 0.0075 * abs(motion.top.Mgl))
    return Motion(motion.top, Motion(motion.top, motion.start, torque=torque).at(1.0))


@pytest.mark.wording
@pytest.mark.parametrize("fragment", choose(PRESSED, PRESSED[:2]))
def test_what_a_button_that_is_held_would_do_is_computed(open_page, fragment):
    page = open_page(f"#{fragment}")
    motion = read_motion(page.read_events()[-1])
    for name, act in (("press", push_for_a_second), ("torque", turn_for_a_second)):
        after = act(motion)
        said = page.say(f"outlook-{name}")
        heights = [np.cos(each.turning_angles).sum() * motion.top.Mgl for each in (motion, after)]
        assert f"the weight is {HEIGHTS[int(np.sign(heights[1] - heights[0]))]}" in said, said
        rates = (
            f"{after.mean_precession_rate:.2f} instead of {motion.mean_precession_rate:.2f} rad/s"
        )
        assert rates in said, said


@pytest.mark.slow
@pytest.mark.wording
def test_each_push_is_named_by_its_way_in_the_history(opened):
    words = {
        "up": "pushed up",
        "down": "pushed down",
        "along": "pushed along the precession",
        "back": "pushed against the precession",
    }
    opened.open_tab("push")
    for way in words:
        opened.tab.click(f"[data-push={way}]")
    opened.open_tab("history")
    said = [text for text in read_history(opened) if text in words.values()]
    assert said[::-1] == [*words.values()]  # the latest one stands first


@pytest.mark.slow
def test_the_reason_is_one_sentence_and_shows_its_arrows_for_a_moment(opened):
    opened.tab.click("#hurry")
    assert not opened.tab.is_visible("#because")
    opened.tab.click("#reason > summary")
    said = opened.tab.inner_text("#because")
    assert said.count(".") == 1
    assert len(said.split()) <= 20
    arrows = [opened.tab.locator(".label", has_text=name) for name in ("torque", "L")]
    for arrow in arrows:
        arrow.first.wait_for(state="visible")
    assert not opened.tab.is_visible("#why")
    for arrow in arrows:
        arrow.first.wait_for(state="hidden")
    opened.tab.click("#numbers summary")
    assert "Perry's rule holds" in opened.tab.inner_text("#why")


def test_the_reason_stands_beside_the_picture(opened):
    opened.tab.click("#reason > summary")
    opened.tab.click("#numbers summary")
    opened.wait_for_frames()
    reason, scene = (opened.tab.locator(name).bounding_box() for name in ("#reason", "#picture"))
    assert reason["y"] + reason["height"] <= scene["y"] + 1  # px


@pytest.mark.slow
@pytest.mark.wording
def test_an_instant_is_explained_while_it_can_be_read(opened):
    opened.follow("theta=0.5&psi_dot=200")  # in cusps
    opened.tab.select_option("#speed", "1")
    opened.wait_for_time(0.2)
    opened.until(lambda: opened.say("instant") == "")
    opened.press("Space")
    opened.until(lambda: opened.say("instant").startswith("Now: turning the "))
    falls = opened.read_last().euler_rates.theta_dot > 0
    assert (" down" in opened.say("instant")) == falls or "begins" in opened.say("instant")
    opened.tab.click("[data-act=reset]")
    # at its start it has not moved yet
    opened.until(lambda: opened.say("instant").endswith("so the axle begins to move down."))
