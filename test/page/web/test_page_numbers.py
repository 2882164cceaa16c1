"""In random runs the page shows the state that it draws, to the digits that it shows."""

import math
import re

import pytest
from page.web.opened import read_motion
from page.web.random_acts import Trial
from physics.tops import find_roots

from symtop_ros.physics import ExactTimes, Motion

FIELDS = "theta", "phi_dot", "psi_dot"
ACTS = "run", "run", "scrub", "key", "torque", "friction"  # after which numbers may be old ones
NUMBER = r"-?[\d.]+(?:e[+-]?\d+)?"


def is_rounded(text, value, digits=None):
    """Return True if a text is a number to its last digit, or to so many digits."""
    mantissa, _, exponent = text.partition("e")
    decimals = len(mantissa.partition(".")[2]) - int(exponent or 0)
    if digits and value:  # zeros at the end are not written
        decimals = max(decimals, digits - 1 - math.floor(math.log10(abs(value))))
    # a tie, and a rounding of the number itself
    return abs(float(text) - value) <= 0.5001 * 10.0**-decimals + 1e-14 * abs(value)


class Shown:
    """The run of a page at the time that it shows, in Python."""

    def __init__(self, page):
        self.texts = page.tab.evaluate("looks.readNumbers")
        run = page.read_run()
        time = round(float(self.texts["time"]) * 1e9)
        events = [each for each in run["events"] if round(each["time"] * 1e9) <= time]
        self.event = events[-1]
        motion = read_motion(self.event)
        self.top = motion.top
        self.state = motion.at(ExactTimes(time - round(self.event["time"] * 1e9)))
        self.free = Motion(self.top, self.state)
        self.is_driven = motion.is_driven

    def check(self, page):
        theta = self.state.euler_angles.theta
        rates = self.state.euler_rates
        if self.state.is_vertical:
            return
        shown = {"theta": theta, "phi_dot": rates.phi_dot, "psi_dot": rates.psi_dot}
        for name, value in shown.items():
            assert is_rounded(self.texts["fields"][name], value, 6), (name, value, self.texts)
        roots = find_roots(self.top, theta, rates.psi_dot)
        assert len(roots) == len(self.texts["roots"])
        for text, root in zip(self.texts["roots"], roots, strict=True):
            assert is_rounded(re.findall(NUMBER, text)[0], root, 4), (text, root)
        self.check_motion(page.say("headline"))

    def check_motion(self, headline):
        kind, _, apart = self.texts["rows"]["motion"].partition(" (")
        assert kind == self.free.kind
        assert apart.startswith("apart from ") == self.is_driven
        period = self.texts["rows"].get("nutation period")
        if period:
            assert is_rounded(period.split()[0], self.free.nutation_period, 4)
        form = f"tilt (?:is between|stays at) ({NUMBER})(?: and ({NUMBER}))? rad"
        if tilts := re.search(form, headline):
            low, high = self.free.turning_angles
            assert is_rounded(tilts[1], low), (headline, low)
            assert is_rounded(tilts[2] or tilts[1], high), (headline, high)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("seed", "rounds"), [(1, 1), *(pytest.param(n, 70, marks=pytest.mark.long) for n in (2, 3))]
)
def test_every_number_shown_is_that_of_the_state_drawn(browser, tmp_path, seed, rounds):
    trial = Trial(browser, tmp_path, seed)
    trial.page.follow("scene=friction")
    trial.page.tab.select_option("#speed", "1")
    for _ in range(rounds):
        for name in trial.rng.sample(ACTS, len(ACTS)):
            trial.act([name])
            if trial.page.say("pause") == "Pause":
                trial.page.press("Space")
            trial.page.wait_for_texts()
            if trial.page.say("refusal"):
                trial.page.press("Escape")
            Shown(trial.page).check(trial.page)
    trial.page.close()


def test_the_digits_that_are_shown_start_the_motion_that_is_shown(opened):
    """Tilt, spin and the slow rate are typed again, as fields and buttons show them."""
    steady = "The top precesses steadily, with its tilt constant at 0.500 rad."
    opened.press("Space")
    for _ in range(2):
        for name, text in (("theta", "0.5"), ("psi_dot", "200"), ("phi_dot", "6.497")):
            opened.enter(name, text)
            assert (name, opened.say("headline")) == (name, steady)
    opened.tab.click("#hurry")
    assert " at first" not in opened.say("headline")
    opened.enter("phi_dot", "6.4970")  # another number than the one that is shown
    assert "with its tilt between" in opened.say("headline")


@pytest.mark.slow
def test_fields_show_the_start_while_they_are_edited(opened):
    opened.press("Space")
    opened.enter("phi_dot", "0")
    opened.press("Space")
    opened.wait_for_time(0.02)
    opened.press("Space")
    opened.wait_for_texts()
    read = [opened.tab.input_value(f"#field-{name}") for name in FIELDS]
    assert read[1] != "0"
    opened.tab.focus("#field-theta")
    opened.wait_for_texts()
    assert [opened.tab.input_value(f"#field-{name}") for name in FIELDS] == ["0.5", "0", "200"]
    opened.press("Escape")
    opened.wait_for_texts()
    assert [opened.tab.input_value(f"#field-{name}") for name in FIELDS] == read
