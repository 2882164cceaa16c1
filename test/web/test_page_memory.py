"""A run is kept over a reload and through a sleep of the computer."""

import pytest


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


def test_a_sleep_of_the_computer_loses_nothing(open_page):
    page = open_page()
    page.tab.click("#hurry")
    events = page.read_events()
    before, after = page.tab.evaluate("acts.sleep")
    assert page.read_events() == events
    assert before < after < before + 0.05  # s: in each frame at most a tenth of 0.1 s
    page.wait_for_time(after)
