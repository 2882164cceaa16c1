"""A limit is said in the unit of its field: typed again it is taken, and means the same.

A refusal is read as a person reads it; what it says is typed into the field, as a plain number and
with the unit that it has.
"""

import math
import re

import pytest
from trials import choose

UNITS = "rad", "deg"
NUMBER = r"(-?[\d.]+(?:e[+-]?\d+)?)"
LIMIT = re.compile(rf"(above|below|most|least) {NUMBER}(°| rad/s| rad| s| J| 1/s\^2)")

# A question, what is known in SI, which of it is refused, and the value that is.
REFUSED = [
    ("theta precession_period", (0.5, 1.0), 0, 3.5),
    ("theta precession_period", (0.5, 1.0), 0, -0.5),
    ("theta psi_dot", (0.5, 200.0), 0, 0.0),
    ("theta psi_dot", (0.5, 200.0), 1, 9.0),
    ("theta dip", (100 * math.pi / 180, 0.2), 1, math.pi / 2),
    ("theta dip", (0.5, 0.2), 1, 3.0),
    ("theta nutation_period", (0.5, 0.15), 0, 4.0),
    ("theta nutation_period", (0.5, 0.15), 1, 9.0),
    ("energy p_phi p_psi", (1.21, 0.01004, 0.01144), 0, -3.0),
    ("alpha a b", (600.0, 50.0, 44.0), 0, -3000.0),
]
ANGLES = "theta", "dip"
INSIDE = {"above": 1.001, "below": 0.999, "most": 1.0, "least": 1.0}  # of what is excluded itself


def show(name, value, unit):
    return repr(value * 180 / math.pi if unit == "deg" and name in ANGLES else value)


@pytest.mark.parametrize("unit", UNITS)
@pytest.mark.parametrize("case", choose(REFUSED, REFUSED[::4]))
def test_a_limit_that_is_typed_again_is_taken_and_means_the_same(shared, case, unit):
    question, known, place, refused = case
    names = question.split()
    shared.choose_unit(unit)
    texts = [show(name, value, unit) for name, value in zip(names, known, strict=True)]
    texts[place] = show(names[place], refused, unit)
    shared.ask(question, *texts)
    said = shared.say("refusal")
    field = shared.tab.locator(f"#known-{names[place]}")
    assert field.get_attribute("aria-invalid") == "true"
    found = LIMIT.findall(said)
    assert found, said
    for word, limit, suffix in found:
        value = float(limit) * INSIDE[word] or 0.01  # above 0
        starts = []
        for ending in ("", suffix):
            texts[place] = f"{value!r}{ending}"
            shared.ask(question, *texts)
            assert shared.say("refusal") == "", (said, texts)
            starts.append(shared.list_solutions())
        assert starts[0] == starts[1] != [], (said, starts)
        label = shared.tab.text_content(f"label[for=known-{names[place]}]")
        assert f"({suffix.strip()})" in label, (label, said)


@pytest.mark.parametrize("unit", UNITS)
def test_the_largest_tilt_of_a_field_is_in_its_unit(shared, unit):
    shared.choose_unit(unit)
    shared.enter("theta", "200")
    _, limit, suffix = re.search(
        rf"(must be 0 to) {NUMBER}(°| rad), got 200", shared.say("refusal")
    ).groups()
    for text in (limit, limit + suffix):
        shared.enter("theta", text)
        assert shared.say("refusal") == ""
        size = math.pi / 180 if unit == "deg" else 1.0
        # angles of a state are exact to 2 eps of pi (docs/accuracy.md)
        assert shared.read_last().euler_angles.theta == pytest.approx(
            float(limit) * size, abs=1e-15
        )


@pytest.mark.slow
@pytest.mark.parametrize("number", [3, 13])
def test_a_question_of_the_lesson_is_asked_and_checked_in_the_unit_of_the_page(open_page, number):
    page = open_page(f"#lesson={number}")
    answers = {3: 0.66383, 13: 0.3904}
    for unit, size in (("rad", 1.0), ("deg", 180 / math.pi)):
        page.choose_unit(unit)
        page.open_tab("lesson")
        within = re.search(rf"within {NUMBER}(°| rad)\)$", page.say("lesson-ask"))
        assert (within[2] == "°") == (unit == "deg")
        for share, word in ((0.98, "Right"), (1.02, "Not")):
            typed = answers[number] * size + share * float(within[1])
            page.tab.fill("#predicted-number", repr(typed))
            page.tab.locator("#predicted-number").press("Enter")
            said = page.say("lesson-checked")
            assert said.startswith(word)
            assert f"within {within[1]}{within[2]}" in said


def test_an_angle_that_is_typed_is_the_same_after_the_unit_has_changed(opened):
    opened.ask("theta dip", "1", "10°")
    opened.choose_unit("deg")
    shown = float(opened.tab.input_value("#known-theta"))
    assert shown == pytest.approx(180 / math.pi, rel=1e-14)  # 15 digits are shown
    assert opened.tab.input_value("#known-dip") == "10°"
    assert opened.tab.text_content("label[for=known-dip]") == "dip (°)"


def test_a_field_that_becomes_good_clears_its_own_refusal_and_no_other(shared):
    shared.enter("factor", "ten")
    assert "got ten" in shared.say("refusal")
    shared.enter("top.Ix", "0/0")
    assert "got 0/0" in shared.say("refusal")
    shared.enter("factor", "2")
    assert "got 0/0" in shared.say("refusal")
    shared.enter("factor", "0/0")
    shared.enter("factor", "pi*pi")
    assert shared.say("refusal") == ""
    shared.ask("theta precession_period", "0.5", "x")
    assert "got x" in shared.say("refusal")
    shared.tab.fill("#known-theta", "0.6")
    assert "got x" in shared.say("refusal")
    shared.tab.fill("#known-precession_period", "2")
    assert shared.say("refusal") == ""
