"""A run is kept: over a reload, with Back, through a sleep of the computer, and in a small file."""

import pytest
from web.opened import find_time, read_motion, read_state

from symtop_ros.physics import State, Top, hurry
from symtop_ros.web.join import write_file

HOUR = 3600.0  # s
ACTS = 40  # in an hour
LARGEST = 20_000  # bytes


@pytest.mark.parametrize(
    "fragment", [pytest.param("", marks=pytest.mark.long), "#theta=0.7&psi_dot=180"]
)
def test_a_reload_loses_nothing(open_page, fragment):
    page = open_page(fragment)
    page.wait_for_time(0.02)
    page.tab.click("#hurry")
    page.tab.select_option("#speed", label="1/20 of real time")
    page.wait_for_time(0.04)
    page.tab.click("#pause")
    run, headline = page.read_run(), page.say("headline")
    page.reload()
    assert page.read_run() == run
    assert page.say("headline") == headline
    assert page.say("pause") == "Run"
    assert page.tab.input_value("#speed") == "0.05"
    page.tab.click("#pause")
    page.wait_for_time(run["end"])
    page.reload()
    assert page.say("pause") == "Pause"  # what ran runs on
    assert page.read_events() == run["events"]


def test_a_run_is_there_after_another_page_and_back(open_page):
    page = open_page()
    page.tab.click("#hurry")
    events = page.read_events()
    page.tab.goto("about:blank")
    page.tab.go_back()
    page.wait_for_page()
    assert page.read_events() == events
    assert "higher" in page.say("headline")


def test_a_sleep_of_the_computer_loses_nothing(open_page):
    page = open_page()
    page.tab.click("#hurry")
    events, before = page.read_events(), page.read_run()["end"]
    # nothing runs for some time, and the clock runs
    page.tab.evaluate("const end = performance.now() + 1500; while (performance.now() < end) {}")
    page.tab.wait_for_timeout(400)
    run = page.read_run()
    assert run["events"] == events
    assert before < run["end"] < before + 0.1  # s: it continues from where it was
    page.wait_for_time(run["end"])


def make_hour():
    """A run of an hour: a top that is kicked again and again."""
    top, state = Top(0.000228, 0.0000572, 0.068), State.from_euler(theta=0.5, psi_dot=200.0)
    events = []
    for n in range(ACTS):
        event = {
            "kind": "kick" if n else "start",
            "time": n * HOUR / ACTS,
            "top": [*top.moments],
            "orientation": state.given_orientation.tolist(),
            "angular_velocity": state.angular_velocity.tolist(),
            "friction": [0, 0],
            "torque": [0, 0, 0],
            "request": "hurried: phi' times 1.1" if n else "started",
        }
        if n:
            act = {"precession_rate_factor": 1.1, "hold": "spin_rate"}
            event |= {"act": act, "hold": "spin_rate"}
        events.append(event)
        time = find_time({"time": n * HOUR / ACTS}, {"time": (n + 1) * HOUR / ACTS})
        state = hurry(read_motion(event).at(time), 1.1 if n % 2 else 1 / 1.1)
    return {"format": 2, "events": events, "end": HOUR}


def test_the_run_of_an_hour_is_a_small_file_and_every_moment_of_it_is_there(opened, tmp_path):
    hour = make_hour()
    opened.drop(hour)
    opened.until(lambda: float(opened.tab.get_attribute("#timeline", "max")) == HOUR)
    assert opened.read_run() == hour
    saved = opened.save("This run as a page", tmp_path)
    assert saved.stat().st_size - len(write_file().encode()) < LARGEST
    moment = 1234.567
    opened.seek(moment)
    place = int(moment / (HOUR / ACTS))
    event = hour["events"][place]
    state = read_motion(event).at(find_time(event, {"time": moment}))
    opened.until(lambda: float(opened.tab.get_attribute("body", "data-time")) == moment)
    assert float(opened.tab.get_attribute("body", "data-theta")) == state.euler_angles.theta
    opened.tab.click("#hurry")
    events = opened.read_events()
    assert events[:-1] == hour["events"][: place + 1]
    after = hurry(state, 1.4)
    assert read_state(events[-1]).angular_velocity.tolist() == after.angular_velocity.tolist()
