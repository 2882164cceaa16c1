"""A button that is held does one act, from its press to its end, however slowly the page draws."""

import pytest
from page.web.opened import USUAL, slow_frames
from trials import choose

LINK = "#theta=0.5&psi_dot=200&precession=slow"
ACTS = {"press": ["push"], "grasp": ["clamp", "unclamp"], "torque": ["torque", "torque"]}


def open_slow(open_page, milliseconds):
    page = open_page(LINK, script=USUAL + slow_frames(milliseconds))
    page.open_tab("push")
    return page


def press(page, hold):
    """Press the mouse on a button, and wait until its act has begun."""
    button = page.tab.locator(f"[data-hold={hold}]").first
    button.scroll_into_view_if_needed()
    box = button.bounding_box()
    page.tab.mouse.move(box["x"] + 5, box["y"] + 5)
    page.tab.mouse.down()
    page.until(lambda: list_kinds(page) == ["start", ACTS[hold][0]])


def list_kinds(page):
    """Return the kinds of the events from the last start on."""
    kinds = [event["kind"] for event in page.read_events()]
    return kinds[len(kinds) - 1 - kinds[::-1].index("start") :]


def hold_for(page, seconds):
    """Let some time of the run pass, of which the page draws a frame now and then."""
    page.wait_for_time(page.read_events()[-1]["time"] + seconds)


def check_end(page, hold):
    """The act has ended, once; pushes that were given are those up to now, and no more come."""
    expected = ["start", *ACTS[hold]]
    page.until(lambda: list_kinds(page) == expected)
    ended = page.read_events()
    hold_for(page, 0.02)
    assert page.read_events() == ended
    last = ended[-1]
    assert last["torque"] == [0.0, 0.0, 0.0]
    assert not last.get("clamped", False)
    if hold == "press":
        passed = page.read_run()["end"] - last["time"]
        assert last["act"]["number"] <= 1 + 20 * passed


@pytest.mark.slow
@pytest.mark.parametrize("milliseconds", choose([100, 350, 500], [350]))
@pytest.mark.parametrize("hold", choose(ACTS, ["press"]))
def test_a_hold_is_one_act_on_a_page_that_draws_slowly(open_page, hold, milliseconds):
    page = open_slow(open_page, milliseconds)
    press(page, hold)
    hold_for(page, 0.1)  # ten times as long for the hand: many frames
    assert list_kinds(page) == ["start", ACTS[hold][0]]
    page.tab.mouse.up()
    check_end(page, hold)


@pytest.mark.parametrize("hold", choose(ACTS, ["grasp"]))
def test_a_hold_ends_where_the_mouse_is_let_go_outside_of_the_button(opened, hold):
    opened.follow(LINK[1:])
    opened.open_tab("push")
    press(opened, hold)
    opened.tab.mouse.move(40, 300)
    opened.wait_for_frames()
    assert list_kinds(opened) == ["start", ACTS[hold][0]]  # a hand that slips is still there
    opened.tab.mouse.up()
    opened.until(lambda: list_kinds(opened) == ["start", *ACTS[hold]])


ENDS = {
    "blur": "dispatchEvent(new Event('blur'))",
    "hidden": """Object.defineProperty(document, 'hidden', {value: true, configurable: true});
        document.dispatchEvent(new Event('visibilitychange'));
        delete document.hidden""",
    "disabled": "document.querySelector('[data-hold=grasp]').disabled = true",
    "cancelled": """document.querySelector('[data-hold=grasp]')
        .dispatchEvent(new PointerEvent('pointercancel'))""",
    "left": "dispatchEvent(new Event('pagehide'))",
}


@pytest.mark.slow
@pytest.mark.parametrize("end", ENDS)
def test_a_hold_ends_when_nobody_can_hold_the_button_any_more(opened, end):
    opened.follow(LINK[1:])
    opened.open_tab("push")
    press(opened, "grasp")
    opened.tab.evaluate(f"() => {{ {ENDS[end]}; }}")
    opened.until(lambda: list_kinds(opened) == ["start", *ACTS["grasp"]])
    opened.tab.mouse.up()
    opened.wait_for_frames()
    assert list_kinds(opened) == ["start", *ACTS["grasp"]]


def test_a_start_during_a_hold_is_not_touched_by_its_end(opened):
    opened.open_tab("push")
    press(opened, "grasp")
    opened.follow("scene=perry_clamped")
    opened.until(lambda: list_kinds(opened)[-1] == "start")
    opened.tab.mouse.up()
    opened.wait_for_frames()
    assert list_kinds(opened)[-1] == "start"
    assert opened.read_events()[-1]["clamped"]


def test_enter_holds_a_button_until_it_is_released(opened):
    opened.follow(LINK[1:])
    opened.open_tab("push")
    opened.tab.locator("[data-hold=grasp]").focus()
    opened.tab.keyboard.down("Enter")
    opened.until(lambda: list_kinds(opened)[-1] == "clamp")
    opened.wait_for_frames()
    assert list_kinds(opened)[-1] == "clamp"
    opened.tab.keyboard.up("Enter")
    opened.until(lambda: list_kinds(opened)[-1] == "unclamp")
