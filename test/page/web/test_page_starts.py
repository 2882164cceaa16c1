"""Starts by an address: over 300 decades, and by the links that the page writes."""

import random

import pytest
from page.web.odd_tops import draw_start, write_address
from page.web.opened import UNDRAWN
from run.simulation.page_runs import change
from trials import trials

from symtop_ros.run.simulation.presets import scene_names

# Of a start that is shown: steps of its outlook (`words/outlooks.js`), about 0.1 s, and calls of
# the kernel, each of 0.1 ms at most.
MOST_STEPS, MOST_CALLS = 10_000, 1000
# An axis of values far larger than their span: k + 1 is k.
HANGING = "#Ix=1&Iz=0.5&Mgl=0&theta=0.5&psi_dot=25&precession=fast"


@pytest.mark.slow
@pytest.mark.parametrize("count", trials(12, 500))
def test_starts_over_300_decades_open_by_little_work_each(open_page, count):
    opened = open_page(script=f"patches.countWork();{UNDRAWN}")
    rng = random.Random(49)
    assert opened.tab.evaluate("work.calls") > 0
    opened.press("Space")  # what is seen later takes more work, the longer it is looked at
    for address in (HANGING, *(write_address(draw_start(rng)) for _ in range(count))):
        opened.tab.evaluate("Object.assign(work, { calls: 0, hundreds: 0 })")
        opened.tab.evaluate("acts.open", address)
        work = opened.tab.evaluate("work")
        assert work["hundreds"] <= MOST_STEPS / 100, address
        assert work["calls"] < MOST_CALLS, address
        assert opened.problems == [], address
    opened.press("r")
    assert opened.say("refusal") == ""


NAMES = ("scene", "precession", "Ix", "Mgl", "axial", "theta", "psi_dot", "orientation", "torque")
VALUES = (
    "",
    "x",
    "__proto__",
    "NaN",
    "-Infinity",
    "1e999",
    "1e-320",
    "-1e100",
    "0x10",
    "1,2,3,4",
    "%00",
    "%E0%A4%A",
    "<script>alert(1)</script>",
    "9" * 5000,
)
HOSTILE = [f"#{name}={value}" for name in NAMES for value in VALUES]
HOSTILE += ["#", "##", "#=", "#&&", "#theta", "#__proto__", "#constructor=1", "#hasOwnProperty=1"]
HOSTILE += [f"#lesson={value}" for value in VALUES]
HOSTILE += ["#theta=1&theta=2&theta=x", "#scene=looping&scene=x", "#" + "theta=1&" * 5000]


# Every third of them in each run of the tests: some of each name and of each value.
@pytest.mark.slow
@pytest.mark.parametrize("step", [3, pytest.param(1, marks=pytest.mark.long)])
def test_hostile_addresses_end_nothing_and_a_key_is_answered_after_each(opened, step):
    answers = opened.tab.evaluate("acts.follow", HOSTILE[::step])
    assert {started for started, _ in answers} == {0, 1}
    assert {answered for _, answered in answers} == {1}


def read_link(opened):
    return opened.tab.input_value("#link").split("#")[1]


def get_motion(event):
    names = ("top", "orientation", "angular_velocity", "friction", "torque")
    return {name: event[name] for name in names}


# Scenes in which the last digits decide, and a torque; all in the long tests.
@pytest.mark.slow
@pytest.mark.parametrize("count", trials(2, 99))
def test_a_link_starts_the_motion_with_the_same_doubles(opened, open_page, count):
    names = dict.fromkeys(["hurry_slow", "vertical_torque", *scene_names()])
    runs = [f"scene={name}" for name in list(names)[:count]]
    other = open_page()
    for page in (opened, other):  # the headline of a driven motion follows it
        page.press("Space")
    for fragment in (*runs, write_address(draw_start(random.Random(4)))[1:]):
        opened.follow(fragment)
        link = read_link(opened)
        headline = opened.say("headline")
        other.follow(link)
        assert get_motion(other.read_events()[-1]) == get_motion(opened.read_events()[-1])
        assert other.say("headline") == headline
        assert read_link(other) == link


def test_a_link_is_the_whole_start_whatever_was_there_before(opened):
    """Friction, a torque and another body of the motion before are not those of a link."""
    opened.follow("theta=0.75&psi_dot=150")
    expected = get_motion(opened.read_events()[-1])
    for before in ("scene=friction", "scene=vertical_torque", "Mgl=-0.05&clamped=true&theta=1"):
        opened.follow(before)
        assert get_motion(opened.read_events()[-1]) != expected
        opened.follow("theta=0.75&psi_dot=150")
        event = opened.read_events()[-1]
        assert get_motion(event) == expected
        assert not event.get("clamped", False)


def test_a_reset_of_a_loaded_run_keeps_its_torque(opened):
    run = change(0, torque=[0.0, 0.0, 5e-4])
    run["events"] = run["events"][:1]
    opened.drop(run)
    opened.until(lambda: opened.read_events() == run["events"])
    opened.press("r")
    assert opened.read_events()[1]["torque"] == [0.0, 0.0, 5e-4]


REFUSED = [
    ("precession=medium", "precession must be slow or fast, got medium"),
    ("precession=", "precession must be slow or fast, got nothing"),
    ("theta=1&precession=slow&phi_dot=3", "precession must be given without phi_dot, got both"),
    ("torque=1,2", "torque must have 3 elements (N m), got 2"),
    ("torque=1,2,soon", "torque must be a number, got soon"),
    ("orientation=1,0,0,0", "orientation in a link must be given with angular_velocity, and "),
    ("angular_velocity=1,0,0&theta=1", "orientation in a link must be given with "),
    ("orientation=1,1,0,0&angular_velocity=0,0,1", "orientation "),
    ("__proto__=1", "name in a link must be one of scene, precession, clamped, "),
    ("theta=1e999", "theta must be a number, got 1e999"),
    ("Ix=1e-300", "Ix, Iz and Mgl must be finite"),
    ("scene=__proto__", "scene must be one of "),
]


@pytest.mark.slow
def test_a_link_that_cannot_be_followed_is_refused(opened):
    events = opened.read_events()
    for fragment, refusal in REFUSED:
        opened.follow(fragment)
        assert opened.say("refusal").startswith(refusal)
        assert opened.read_events() == events


def test_a_refused_link_names_its_fields_as_they_are_typed_and_makes_no_button(opened):
    opened.follow("[phi|theta]=1")
    refused = opened.tab.locator("#refusal")
    assert "phi_dot" in refused.inner_text()
    assert "theta, psi" in refused.inner_text()
    assert refused.inner_text().endswith("got [phi|theta]")
    assert refused.locator("button, math").count() == 0


@pytest.mark.wording
def test_a_scene_that_is_opened_by_a_link_tells_its_story(open_page):
    page = open_page("#scene=closed_cusps")
    assert page.tab.locator("#scenes").input_value() == "closed_cusps"
    assert page.say("story").startswith("The trace has six cusps")
    page.follow("scene=friction")
    page.until(lambda: page.say("story").startswith("The article's top with friction"))
    assert not page.tab.is_visible("#start-scene")
