"""Fields, sliders and keys of the page: what is typed, and what is refused."""

import math
from functools import partial

import pytest
from trials import choose

from symtop_ros.page.web.join import LANGUAGES


@pytest.mark.slow
def test_an_angle_is_understood_with_its_unit(shared):
    angles = {"pi/4": math.pi / 4, "π/3": math.pi / 3, "2*pi/5": 2 * math.pi / 5, "pi": math.pi}
    angles |= {"30°": math.pi / 6, "45 deg": math.pi / 4, "0.6 rad": 0.6, "0,7": 0.7, "1e-3": 1e-3}
    for text, theta in angles.items():
        shared.enter("theta", text)
        assert shared.say("refusal") == ""
        assert shared.read_last().euler_angles.theta == pytest.approx(theta, rel=1e-15)


@pytest.mark.slow
def test_in_degrees_numbers_and_refusals_are_in_degrees(opened):
    opened.open_tab("view")
    opened.tab.select_option("#unit", "deg")
    opened.enter("theta", "200")
    assert opened.say("refusal") == "tilt theta must be 0 to 180°, got 200"
    opened.tab.press("#field-theta", "Escape")
    assert opened.say("refusal") == ""
    opened.enter("theta", "60")
    assert opened.read_last().euler_angles.theta == pytest.approx(math.pi / 3, rel=1e-15)
    opened.until(lambda: opened.is_stored("unit", "deg"))
    opened.reload()
    assert opened.tab.input_value("#unit") == "deg"  # the choice is kept
    assert "°" in opened.say("headline")


def test_a_refusal_says_what_was_wrong_and_loses_nothing(shared):
    events = shared.read_events()
    for field, text, refusal in (
        ("theta", "4", "tilt theta must be 0 to 3.1415 rad, got 4"),
        ("theta", "abc", "tilt theta must be a number, got abc"),
        ("top.Iz", "1", "Iz, about the axis (kg m²) must be at most 0.000456 kg m^2 (2 Ix), got 1"),
        (
            "top.Ix",
            "1e-5",
            "Ix, across the axis (kg m²) must be at least 0.0000286 kg m^2 (Iz/2), got",
        ),
        ("top.Ix", "1e-200", "Ix, across the axis (kg m²) must be at least 1e-100 kg m^2, got"),
        ("top.Mgl", "-1e101", "Mgl, moment of gravity (J) must be at most 1e+100 J in size, got"),
        ("psi_dot", "1e101", "spin rate psi' (rad/s) must be at most 1e+100 rad/s in size, got"),
        ("top.Ix", "0", "Ix, across the axis (kg m²) must be positive, got 0"),
        ("friction.axial", "-1", "friction, axial (N m s) must be 0 or more, got -1"),
    ):
        shared.enter(field, text)
        assert shared.say("refusal").startswith(refusal)
    assert shared.read_events() == events


@pytest.mark.slow
def test_a_bound_that_is_typed_in_again_is_granted(opened):
    events = opened.read_events()
    for field, wrong in (("top.Ix", "1e-5"), ("top.Iz", "1")):
        opened.enter(field, wrong)
        bound = opened.say("refusal").split("kg m^2")[0].split()[-1]
        opened.enter(field, bound)
        assert opened.say("refusal") == ""
        opened.enter(field, {"top.Ix": "0.000228", "top.Iz": "0.0000572"}[field])
    assert len(opened.read_events()) == len(events) + 4


def test_all_numbers_of_a_refusal_have_one_notation(opened):
    for typed in ("1e101", "-1e+101"):
        opened.enter("top.Mgl", typed)
        shown = opened.tab.inner_text("#refusal")
        assert "at most 1\u00b710\u00b9\u2070\u2070 J in size, got" in shown
        assert "1\u00b710\u00b9\u2070\u00b9" in shown
        assert "e" not in shown.split("got")[1]


def test_the_slider_reaches_the_lower_vertical(opened):
    slider = opened.tab.locator("[data-field=theta] input[type=range]")
    slider.evaluate("(each) => { each.value = 3.15; each.dispatchEvent(new Event('input')); }")
    opened.until(lambda: "3.142" in opened.say("headline"))
    assert opened.say("refusal") == ""
    assert opened.read_last().euler_angles.theta == math.pi


@pytest.mark.slow
def test_keys_that_move_through_the_list_of_scenes_start_none_but_a_pointer_does(opened):
    events = opened.read_events()
    opened.open_tab("start")
    opened.tab.focus("#scenes")
    opened.tab.keyboard.press("L")
    assert opened.tab.input_value("#scenes") == "looping"
    assert "phi' changes sign" in opened.say("story")
    assert opened.read_events() == events
    opened.tab.keyboard.press("Enter")
    assert opened.say("headline").startswith("The top precesses in loops")
    opened.tab.wait_for_timeout(1200)  # the browser takes letters that follow at once for one word
    opened.tab.keyboard.press("W")
    assert opened.say("headline").startswith("The top precesses in loops")
    opened.tab.click("#start-scene")
    assert not opened.say("headline").startswith("The top precesses in loops")
    opened.tab.dispatch_event("#scenes", "pointerdown")
    opened.tab.select_option("#scenes", "looping")
    assert opened.say("headline").startswith("The top precesses in loops")
    assert not opened.tab.is_visible("#start-scene")


@pytest.mark.slow
def test_keys_drags_and_the_wheel_turn_and_move_the_view_and_do_not_touch_the_top(opened):
    opened.press("Space")
    opened.show_arrows("torque")
    box = opened.tab.locator("#picture").bounding_box()

    def drag():
        opened.drag(box["x"] + 60, box["y"] + 60, 80, 20)
        opened.tab.mouse.up()

    keys = [partial(opened.press, key) for key in ("Shift+ArrowLeft", "Shift+ArrowUp", "+", "-")]
    for act in (*keys, drag, partial(opened.tab.mouse.wheel, 0, 300)):
        before = opened.read_labels()
        act()
        opened.until(lambda before=before: opened.read_labels() != before)
    assert len(opened.read_events()) == 1
    opened.press("ArrowLeft")
    assert len(opened.read_events()) == 2


@pytest.mark.parametrize(
    ("typed", "rate"),
    [
        ("200 rad/s", 200.0),
        ("45*2*pi", 90 * math.pi),
        ("2700 rpm", 90 * math.pi),
        ("45 rev/s", 90 * math.pi),
        ("90°/s", math.pi / 2),
        ("0,500", 0.5),
        ("0.500", 0.5),
        ("1000", 1000.0),
    ],
)
def test_a_rate_is_understood_with_its_unit(shared, typed, rate):
    shared.enter("psi_dot", typed)
    assert shared.say("refusal") == ""
    assert shared.read_last().euler_rates.psi_dot == pytest.approx(rate, rel=1e-12)


@pytest.mark.slow
def test_a_moment_is_understood_with_the_unit_of_its_field_and_no_other(opened):
    for text in ("3e-4 kg m^2", "0.0003 kg m²", "3e-4"):
        opened.enter("top.Ix", text)
        assert opened.say("refusal") == ""
        assert opened.read_events()[-1]["top"][0] == 3e-4
    for text, weight in (("0.05 J", 0.05), ("0.068 N m", 0.068), ("70 mJ", 0.07)):
        opened.enter("top.Mgl", text)
        assert opened.read_events()[-1]["top"][2] == weight
    for text in ("3e-4 kg", "3e-4 J", "3 rad"):
        opened.enter("top.Ix", text)
        assert opened.say("refusal").endswith(f"must be a number, got {text}")


@pytest.mark.slow
def test_a_separator_of_thousands_is_refused_with_both_readings(opened):
    events = opened.read_events()
    for text, whole, part in (("1,000", "1000", "1.000"), ("12,000 rpm", "12000", "12.000")):
        opened.enter("psi_dot", text)
        refusal = f"must be clear: {text} can mean {whole} or {part}"
        assert opened.say("refusal").endswith(refusal)
    for text in ("1,000,000", "2 rad", "3 kg", "1 ** 2", "rad/s"):
        opened.enter("psi_dot", text)
        assert opened.say("refusal").endswith(f"must be a number, got {text}")
    assert opened.read_events() == events


@pytest.mark.parametrize(
    "language", choose([each for each in LANGUAGES if each != "en"], ["de"], "slow")
)
def test_where_numbers_have_a_comma_the_point_separates_thousands(open_page, language):
    opened = open_page(locale=language)
    opened.enter("psi_dot", "1.000")
    said = opened.say("refusal")
    assert "1000" in said
    assert "1,000" in said
    opened.enter("psi_dot", "1,000")
    assert opened.say("refusal") == ""
    assert opened.read_last().euler_rates.psi_dot == pytest.approx(1.0, rel=1e-12)
