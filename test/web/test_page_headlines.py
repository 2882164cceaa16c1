"""The headline says what is so, and agrees with the reason below it."""

import pytest


def test_a_kick_under_friction_is_judged_apart_from_friction_and_said_to_be_past(opened):
    opened.start_scene("friction")
    opened.press("h")
    headline = opened.say("headline")
    assert headline.endswith(" (apart from friction).") or "(apart from friction):" in headline
    assert "between" not in headline
    assert opened.say("why").startswith("Just after the kick: Precession ")


def test_history_is_in_the_words_of_the_user_and_the_unit_of_the_page(opened):
    opened.enter("theta", "0.6")
    opened.tab.click("#hurry")
    opened.enter("top.Mgl", "0.05")
    opened.open_tab("history")

    def read():
        entries = opened.tab.locator("#entries button")
        return entries.evaluate_all("all => all.map(e => e.dataset.text)")

    assert read() == [
        "Mgl changed to 0.05",
        "hurried: phi' times 1.4",
        "started: theta 0.6 rad, phi' 6.497, psi' 200 rad/s",
        "Perry's rule holds",
    ]
    opened.open_tab("view")
    opened.tab.select_option("#unit", "deg")
    opened.open_tab("history")
    assert "started: theta 34.38°, phi' 6.497, psi' 200 rad/s" in read()
    opened.tab.click("#entries button:text('started:')")
    assert opened.read_last().euler_angles.theta == pytest.approx(0.6)


@pytest.mark.wording
def test_a_top_that_at_first_goes_the_other_way_is_said_to_do_both(opened):
    opened.tab.click("text=Pause")
    cases = ((3, "h", "falls at first, but rises"), (9, "d", "rises at first, but"))
    for rate, key, words in cases:
        opened.follow(f"theta=2&psi_dot=200&phi_dot={rate}")
        opened.press(key)
        assert words in opened.say("headline")
