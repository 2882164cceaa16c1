"""Questions of a class on the page: a body of parts, a start from what is seen, the pivot."""

import itertools
import math
import re

import pytest
from page.web.opened import read_motion
from physics.tops import ARTICLE

from symtop_ros.physics import (
    BODIES,
    Body,
    ExactTimes,
    Motion,
    Part,
    State,
    Top,
    regular_precession_rates,
    solve_start,
)


def fill_part(opened, row, kind, *texts):
    """Type a part into a row of the list."""
    place = opened.tab.locator("#parts .part").nth(row)
    place.locator("select").select_option(kind)
    inputs = [place.locator("input").nth(k) for k in range(3)]
    for each, text in zip([each for each in inputs if each.is_enabled()], texts, strict=True):
        each.fill(text)


def read_top(opened):
    return opened.read_events()[-1]["top"]


def wait_for_table(opened, words):
    """The table of constants is written in a frame."""
    opened.until(lambda: words in opened.say("constants"))


@pytest.mark.slow
def test_the_list_shows_the_disc_that_moves_as_the_top_does(opened):
    opened.open_tab("start")
    shown = opened.tab.locator("#parts .part input")
    numbers = [float(shown.nth(k).input_value()) for k in range(3)]
    article = Body.from_disc(*numbers).top
    assert article.moments == pytest.approx((0.000228, 0.0000572, 0.068), rel=1e-5)  # six digits


def test_a_body_of_parts_is_that_of_python(opened):
    opened.open_tab("start")
    fill_part(opened, 0, "disc", "170 g", "5.5cm", "0,105")
    opened.tab.click("#use-body")
    assert read_top(opened) == list(Body.from_disc(0.17, 0.055, 0.105).top.moments)
    opened.tab.click("#add-part")
    fill_part(opened, 1, "point", "50 g", "-8 cm")
    opened.tab.click("#use-body")
    parts = [Part("disc", 0.17, 0.105, 0.055), Part("point", 0.05, -0.08)]
    assert read_top(opened) == list(Body.from_parts(parts).top.moments)
    assert (opened.read_events()[-1]["mass"], opened.read_run()["format"]) == (0.17 + 0.05, 4)
    wait_for_table(opened, "(0.22 kg)")
    opened.tab.locator("#parts .part button").nth(1).click()
    opened.tab.click("#use-body")
    assert read_top(opened) == list(Body.from_disc(0.17, 0.055, 0.105).top.moments)


def test_a_list_that_is_typed_is_not_said_to_move_as_the_top_does_until_it_is_used(opened):
    opened.open_tab("start")
    opened.until(lambda: "moves in the same way" in opened.say("parts-text"))
    fill_part(opened, 0, "ball", "1 kg", "1 m", "2 m")
    assert opened.say("parts-text") == "This list is not used yet:"
    opened.tab.click("#hurry")  # an act changes nothing of it
    assert opened.say("parts-text") == "This list is not used yet:"
    opened.tab.click("#use-body")
    opened.until(lambda: opened.say("parts-text").startswith("This top is a body of parts"))


@pytest.mark.slow
def test_a_run_of_a_body_that_was_weighed_names_its_mass_and_has_its_force(opened):
    opened.open_tab("start")
    opened.tab.select_option("#bodies", "balanced_gyroscope")
    run = opened.read_run()
    opened.reload()
    opened.drop(run)
    opened.until(lambda: opened.read_events() == run["events"])
    opened.open_tab("start")
    opened.until(lambda: "2.6 kg" in opened.say("parts-text"))
    wait_for_table(opened, "(2.6 kg)")


def test_a_scene_that_says_a_mass_has_the_force_of_it(opened):
    opened.follow("scene=toy_gyroscope")
    assert opened.read_events()[-1]["mass"] == 0.06
    wait_for_table(opened, "(0.06 kg)")
    opened.follow("scene=cusps")
    assert "mass" not in opened.read_events()[-1]


@pytest.mark.parametrize("name", BODIES)
def test_bodies_of_the_classroom_are_those_of_python(shared, name):
    shared.open_tab("start")
    shared.tab.select_option("#bodies", name)
    assert read_top(shared) == list(Body.from_parts(BODIES[name]).top.moments)
    assert shared.tab.locator("#parts .part").count() == len(BODIES[name])


def test_a_part_that_is_refused_loses_nothing(shared):
    shared.open_tab("start")
    events = shared.read_events()
    for texts, refusal in (
        (("0", "1", "1"), "mass (kg) must be positive, got 0"),
        (("1", "5 in", "1"), "radius, length (m) must be a number, got 5 in"),
        (("1", "1", ""), "distance (m) must be a number, got nothing"),
    ):
        fill_part(shared, 0, "disc", *texts)
        shared.tab.click("#use-body")
        assert shared.say("refusal") == refusal
        assert shared.tab.locator("#parts input[aria-invalid=true]").count() >= 1
    assert shared.read_events() == events


QUESTIONS = {
    "theta precession_period": (("90°", "2.2 s"), (math.pi / 2, 2.2)),
    "theta psi_dot": (("0.5", "1910 rpm"), (0.5, 1910 * (math.pi / 30))),
    "psi_dot precession_period": (("300", "1.55"), (300.0, 1.55)),
    "theta dip": (("60 deg", "0.2"), (60 * (math.pi / 180), 0.2)),
    "theta nutation_period": (("0.5", "150 ms"), (0.5, 0.15)),
    "energy p_phi p_psi": (("1.21", "0.01004", "0.01144"), (1.21, 0.01004, 0.01144)),
    "alpha a b": (("600", "50", "44"), (600.0, 50.0, 44.0)),
}


@pytest.mark.parametrize("question", QUESTIONS)
def test_starts_from_what_is_seen_are_those_of_python(shared, question):
    shared.open_tab("start")
    texts, numbers = QUESTIONS[question]
    shared.ask(question, *texts)
    top = Top(*read_top(shared))
    expected = solve_start(top, **dict(zip(question.split(), numbers, strict=True)))
    assert len(shared.list_solutions()) == len(expected)
    for k, solution in enumerate(expected):
        shared.tab.locator("#solutions button").nth(k).click()
        start = shared.read_last()
        assert start.orientation.tolist() == solution.state.orientation.tolist()
        assert start.angular_velocity.tolist() == solution.state.angular_velocity.tolist()


NUMBERS = "theta", "phi_dot", "psi_dot"  # theta, phi and psi are shown as letters of mathematics
TYPED = {  # as typed, and the half of a unit of the last digit of each
    "theta precession_period": (("90\u00b0", "2.2 s"), (math.pi / 360, 0.05)),
    "theta psi_dot": (("pi/4", "1910 rpm"), (0.0, 0.5 * (math.pi / 30))),
    "psi_dot precession_period": (("3.00e2", "1.55"), (0.5, 0.005)),
    "theta dip": (("60 deg", "200e-3"), (math.pi / 360, 0.0005)),
}


def list_corners(known, half_widths):
    """The starts of all ends of what is known: between them the numbers of these are monotone."""
    ends = [
        (value - half, value + half)
        for value, half in zip(known.values(), half_widths, strict=True)
    ]
    return [
        solve_start(ARTICLE, **dict(zip(known, each, strict=True)))
        for each in itertools.product(*ends)
    ]


@pytest.mark.parametrize("question", TYPED)
def test_the_page_says_how_far_a_start_moves_for_the_last_digits_that_were_typed(shared, question):
    shared.open_tab("start")
    texts, half_widths = TYPED[question]
    shared.ask(question, *texts)
    names = question.split()
    numbers = {"90\u00b0": math.pi / 2, "pi/4": math.pi / 4, "60 deg": math.pi / 3}
    values = {"2.2 s": 2.2, "1910 rpm": 1910 * math.pi / 30, "3.00e2": 300.0, "200e-3": 0.2}
    known = dict(zip(names, [(numbers | values).get(each, 1.55) for each in texts], strict=True))
    starts = solve_start(ARTICLE, **known)
    corners = list_corners(known, half_widths)
    said = shared.tab.locator("#solutions .spread").all_inner_texts()
    assert len(said) == len(starts)
    for k, text in enumerate(each.replace("\n", "") for each in said):
        assert text.startswith("within the rounding of the typed digits: ")
        found = re.findall(r"([\U0001d703\U0001d711\U0001d713])\u02d9? (\S+) to (\S+) rad", text)
        assert found, text
        for symbol, *ends in found:
            name = dict(zip("\U0001d703\U0001d711\U0001d713", NUMBERS, strict=True))[symbol]
            low, high = (float(each.replace("\u2212", "-")) for each in ends)
            exact = [getattr(each[k], name) for each in corners]
            width = max(exact) - min(exact)  # its second digit is at most a tenth
            assert low <= min(exact) <= low + width / 10
            assert high >= max(exact) >= high - width / 10


def test_where_the_last_digits_decide_whether_there_is_a_start_the_page_says_so(shared):
    shared.open_tab("start")
    shared.ask("theta psi_dot", "0.500", "112")  # none below 111.6 rad/s
    said = shared.tab.locator("#solutions .spread").all_inner_texts()
    unknown = "within the rounding of the typed digits there may be more or fewer such starts"
    assert said == [unknown] * len(shared.list_solutions())
    shared.ask("alpha a b", "600.0 1/s^2", "50.00 1/s", "44.00 1/s")
    said = shared.tab.locator("#solutions .spread").all_inner_texts()
    assert {each.partition(":")[0] for each in said} == {"within the rounding of the typed digits"}
    assert len(said) == 2
    shared.ask("theta psi_dot", "pi/6", "pi*50")
    said = shared.tab.locator("#solutions .spread").all_inner_texts()
    assert said == [""] * len(shared.list_solutions())


def test_what_no_motion_has_is_refused_in_words(shared):
    shared.open_tab("start")
    events = shared.read_events()
    for question, texts, refusal in (
        ("theta dip", ("0.5", "3"), "dip must be positive and at most 2.6415 rad, got 3"),
        ("theta psi_dot", ("0.5", "9"), "spin psi' (rad/s) must be at least 111.63 rad/s in size"),
        (
            "psi_dot precession_period",
            ("200", "0.5"),
            "spin psi' (rad/s) must lie above 57.08 rad/s and below 132.12 rad/s in size, got 200",
        ),
        (
            "psi_dot precession_period",
            ("-2e3", "0.2"),
            "spin psi' (rad/s) must be below",
        ),
        (
            "theta psi_dot",
            ("0", "9"),
            "tilt theta must lie above 0 rad and below 3.1415 rad, got 0",
        ),
        ("theta dip", ("0.5", "x"), "dip (rad) must be a number, got x"),
    ):
        shared.ask(question, *texts)
        assert shared.say("refusal").startswith(refusal)
        assert not shared.list_solutions()
    assert shared.read_events() == events


def test_the_table_says_which_way_round_and_from_which_spin_the_top_sleeps(shared):
    shared.follow("theta=0.5&psi_dot=200")
    wait_for_table(shared, "counterclockwise from above")
    wait_for_table(shared, "137.7 rad/s")
    shared.follow("theta=0.5&psi_dot=-200")
    wait_for_table(shared, ", clockwise from above")


def test_where_rounding_decides_the_table_says_from_when_on(opened):
    rate = 2 / math.sqrt(3)
    opened.follow(f"Ix=1&Iz=1&Mgl=1&theta={math.pi / 3!r}&phi_dot={rate!r}&psi_dot={rate!r}")
    start = State.from_euler(theta=math.pi / 3, phi_dot=rate, psi_dot=rate)
    shows_at = Motion(Top(1.0, 1.0, 1.0), start).rounding_shows_at
    began = opened.read_events()[-1]["time"]  # s of the run, of which the table speaks
    wait_for_table(opened, f"from {began + shows_at:.3g} s on")


def read_start(opened):
    start = read_motion(opened.read_events()[-1]).start
    return [start.orientation.tolist(), start.angular_velocity.tolist()]


@pytest.mark.slow
def test_a_moment_is_kept_by_its_name_and_starts_with_its_doubles(opened):
    opened.open_tab("history")
    opened.wait_for_time(0.03)
    opened.press("Space")
    opened.wait_for_frames(2)
    opened.tab.fill("#moment-name", "my <b>fast</b> top")
    opened.tab.click("#keep-moment")
    time = float(opened.tab.get_attribute("body", "data-time"))
    kept = read_motion(opened.read_events()[-1]).at(ExactTimes(round(1e9 * time)))
    opened.reload()
    opened.follow("scene=looping")
    opened.open_tab("history")
    moment = opened.tab.locator("#moments button").first
    assert moment.text_content() == "my <b>fast</b> top"
    moment.click()
    doubles = [kept.orientation.tolist(), kept.angular_velocity.tolist()]
    opened.until(lambda: read_start(opened) == doubles)
    opened.tab.fill("#moment-name", " ")
    opened.tab.keyboard.press("Enter")  # it has the name of its time
    assert opened.tab.locator("#moments button").nth(2).text_content().endswith(" s")
    opened.tab.locator("#moments .remove").first.click()
    assert opened.tab.locator("#moments .row").count() == 1


def test_the_page_takes_the_full_screen_and_leaves_it(opened):
    opened.tab.click("#full")
    opened.until(lambda: opened.tab.evaluate("document.fullscreenElement !== null"))
    opened.tab.click("#full")
    opened.until(lambda: opened.tab.evaluate("document.fullscreenElement === null"))


def test_a_projector_leaves_three_fifths_for_the_scene_of_the_lesson(open_page):
    page = open_page("#lesson=3", viewport={"width": 1366, "height": 768})
    page.press("p")
    assert page.tab.locator("#scene").bounding_box()["width"] >= 0.6 * 1366 - 1  # px
    page.tab.locator("#lesson-predict").wait_for()
    assert page.tab.evaluate("looks.findCut") == []


def list_rows(page):
    return dict(page.tab.evaluate("looks.readNumbers")["rows"])


@pytest.mark.wording
def test_the_moment_of_gravity_is_found_from_tilt_spin_and_the_time_of_one_turn(shared):
    """Of the Earth: a turn in a sidereal day, and one of the axis in 25772 years."""
    shared.open_tab("start")
    shared.enter("top.Ix", "8.0101e37")
    shared.enter("top.Iz", "8.0365e37")
    year, day = 365.25 * 86400, 86164.1
    tilt, spin, rate = math.radians(23.44), 2 * math.pi / day, 2 * math.pi / (25772 * year)
    shared.ask("theta psi_dot precession_period", "23.44\u00b0", repr(spin), repr(25772 * year))
    assert len(shared.list_solutions()) == 2
    shared.tab.locator("#solutions button").nth(1).click()  # backwards, as the Earth's axis goes
    start = shared.read_events()[-1]
    top = Top(*start["top"])
    slow = regular_precession_rates(top, theta=tilt, psi_dot=spin)[0]
    assert slow == pytest.approx(-rate, rel=1e-9)
    assert shared.read_last().euler_rates.phi_dot == pytest.approx(-rate, rel=1e-9)
    assert -top.Mgl * math.sin(tilt) == pytest.approx(1.8e22, rel=0.02)  # of the Sun and the Moon


@pytest.mark.wording
@pytest.mark.parametrize(
    ("texts", "refusal"),
    [
        (("0", "200", "1"), "tilt theta must lie above 0 rad and below 3.1415 rad, got 0"),
        (("0.5", "200", "-1"), "time of one turn (s) must be positive, got -1"),
        (("0.5", "1e80", "1e-30"), "time of one turn (s) must be such that no rate exceeds"),
    ],
)
def test_a_balance_that_cannot_be_is_refused(shared, texts, refusal):
    shared.ask("theta psi_dot precession_period", *texts)
    assert shared.say("refusal").startswith(refusal)
    assert not shared.list_solutions()


def test_the_last_digits_of_a_balance_bound_its_moment_of_gravity(shared):
    shared.ask("theta psi_dot precession_period", "0.50 rad", "200.0", "0.966")
    said = shared.tab.locator("#solutions .spread").nth(0).get_attribute("data-text")
    low, high = map(float, re.findall(r"Mgl (\S+) to (\S+) J", said)[0])
    Ix, Iz, _ = read_top(shared)
    ends = itertools.product((0.495, 0.505), (199.95, 200.05), (0.9655, 0.9665))
    found = [
        (2 * math.pi / t) * (Iz * psi - (Ix - Iz) * (2 * math.pi / t) * math.cos(theta))
        for theta, psi, t in ends
    ]
    width = max(found) - min(found)  # its second digit is at most a tenth
    assert low <= min(found) <= low + width / 10
    assert high >= max(found) >= high - width / 10


@pytest.mark.wording
def test_the_page_says_how_much_the_slow_rate_depends_on_the_tilt(shared):
    shared.follow("theta=0.5&psi_dot=200&precession=slow")
    shared.open_tab("start")
    here = regular_precession_rates(ARTICLE, theta=0.5, psi_dot=200.0)[0]
    level = ARTICLE.Mgl / (ARTICLE.Iz * 200)
    share = 100 * (1 - level / here)
    said = shared.say("roots-elsewhere")
    assert f"At 90\u00b0 and the same psi' it is {level:.4g} rad/s" in said
    assert f"{share:.2g} % less" in said
    shared.enter("psi_dot", "2000")
    shared.until(lambda: "0.078 % less" in shared.say("roots-elsewhere"))  # the square of a tenth
    shared.enter("theta", "pi/2")
    shared.until(lambda: "At 45\u00b0" in shared.say("roots-elsewhere"))
    shared.enter("psi_dot", "1")
    shared.until(lambda: shared.say("roots-elsewhere") == "")


@pytest.mark.wording
def test_a_plate_that_is_thrown_up_wobbles_twice_in_a_turn_of_omega_z(shared):
    shared.open_tab("start")
    shared.follow("theta=0.02&psi_dot=-10&phi_dot=20&Ix=0.001&Iz=0.002&Mgl=0")
    state = shared.read_last()
    wait_for_table(shared, f"{state.angular_velocity[2]:.6g} rad/s (")
    (row,) = [text for name, text in list_rows(shared).items() if "constant under gravity" in name]
    motion = Motion(Top(0.001, 0.002, 0.0), state)
    times = motion.mean_precession_rate / state.angular_velocity[2]
    assert times == pytest.approx(2.0, abs=0.01)
    assert f"{times:.4g} times" in row


@pytest.mark.wording
def test_in_the_mean_the_pivot_carries_the_weight(shared):
    shared.follow("scene=looping")

    def read_forces():
        """Return the force of now and the mean one with its text; none of another table."""
        rows = list_rows(shared).items()
        texts = [
            next((text for name, text in rows if name.startswith(begin)), "")
            for begin in ("force of the pivot", "its mean")
        ]
        found = [re.findall(r"ard ([\d.]+) N", each) for each in texts]
        return ([float(each[0]) for each in found], texts[1]) if all(found) else None

    def differ():
        read = read_forces()
        return read and read[0][0] != read[0][1]

    shared.until(differ)  # the height of this motion is accelerated, that of the one before not
    (_, mean), row = read_forces()
    assert f"the top weighs {mean:.4g} N" in row
