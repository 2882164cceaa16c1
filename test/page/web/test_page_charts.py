"""Charts of the page: what they show is what the library computes."""

import math
import re

import numpy as np
import pytest
from page.web.opened import FEW_FRAMES, USUAL, read_motion, read_state
from page.web.test_page_numbers import NUMBER, Shown, is_rounded
from trials import choose

from symtop_ros.physics import Motion, State, Top, regular_precession_rates, theta_acceleration
from workshop.article.answers.impulses import find_impulses
from workshop.article.answers.ledger import KickLedger
from workshop.article.answers.starts import find_boundaries, find_curves, loops

HEIGHT = 70.0  # of a chart of a series between its axes, in units of its drawing
LEAST = 0.019  # of a quantity; its chart spans 2 % of it at least, and its ticks are rounded
ARTICLE = Top(Ix=0.000228, Iz=0.0000572, Mgl=0.068)


def read_axis(page, name):
    """A value of the vertical axis of a chart, its height, and the change by a unit of height."""
    ticks = page.tab.locator(f"#{name} text.tick[text-anchor=end]").evaluate_all(
        "all => all.map(e => [e.textContent, e.getAttribute('y') - 3])"
    )
    (first, lowest), (last, highest) = (
        (float(text.replace("\N{MINUS SIGN}", "-")), y) for text, y in (ticks[0], ticks[-1])
    )
    assert lowest != highest
    return first, lowest, (last - first) / (highest - lowest)


def read_chart(page, name):
    """Values of the curve of a chart, and the span of its axis."""
    first, lowest, scale = read_axis(page, name)
    curve = page.tab.locator(f"#{name} path[stroke-width='1.8']").first.get_attribute("d")
    heights = np.array([float(y) for y in re.findall(r"[ML][-\d.]+ ([-\d.]+)", curve)])
    return first + scale * (heights - lowest), abs(scale) * HEIGHT


@pytest.mark.slow
@pytest.mark.parametrize("root", choose(("slow", "fast"), ("slow",)))
def test_in_regular_precession_every_chart_spans_a_part_of_its_quantity(open_page, root):
    page = open_page(f"#theta=0.5&psi_dot=200&precession={root}")
    page.open_charts("phi_dot", "psi_dot")
    page.wait_for_time(0.03)
    page.tab.click("#pause")
    page.tab.locator("#psi_dot").scroll_into_view_if_needed()
    page.wait_for_frames()
    rates = regular_precession_rates(ARTICLE, 0.5, 200.0)
    sizes = {"theta": 0.5, "phi_dot": rates[root == "fast"], "psi_dot": 200.0}
    for name, size in sizes.items():
        values, span = read_chart(page, name)
        tenth = 0.1001 * span / HEIGHT  # coordinates are written in tenths
        assert np.ptp(values) <= tenth
        assert values[-1] == pytest.approx(size, abs=tenth)
        assert span > LEAST * size


def test_the_energy_of_a_kick_is_that_of_the_article(opened):
    assert not opened.tab.is_visible("#ledger-chart")
    opened.open_tab("push")
    opened.tab.click("[data-act=hurry_held]")
    _, kick = opened.read_events()
    slow = regular_precession_rates(ARTICLE, 0.5, 200.0)[0]
    before = State.from_euler(theta=0.5, phi_dot=slow, psi_dot=200.0)
    ledger = KickLedger.of(ARTICLE, before, read_state(kick))
    assert opened.say("ledger-text") == (
        f"The push changed E' by {ledger.kick.rest:.3g} mJ and the energy of the spin by "
        f"{ledger.kick.spin:.3g} mJ. At its highest point the weight has gained "
        f"{ledger.far.weight:.3g} mJ since before the push, and the precession has lost "
        f"{-ledger.far.precession:.3g} mJ."
    )
    assert "1.93 mJ" in opened.say("ledger-text")
    bars = opened.tab.locator("#ledger text.tick[text-anchor=middle]").all_text_contents()
    assert bars[:8] == ["0", "+1.06", "0", "+1.06", "+1.93", "\u22120.871", "0", "+1.06"]


@pytest.mark.slow
@pytest.mark.parametrize("act", ["hurry", "delay"])
def test_the_highest_point_of_the_energies_is_that_of_the_weight(open_page, act):
    """If Mgl < 0 the weight is lowest where the axis is highest, and it has lost energy there."""
    page = open_page("#scene=perry_fails")
    page.press("Space")
    page.tab.click(f"[data-act={act}]")
    page.wait_for_texts()
    point, gain = re.search(
        r"At its (\w+) point the weight has (\w+)", page.say("ledger-text")
    ).groups()
    assert (point, gain) in {("highest", "gained"), ("lowest", "lost")}
    bars = page.tab.locator("#ledger text.tick[text-anchor=middle]").all_text_contents()
    assert bars[-1] == f"at its {point} point"


def read_constants(page):
    rows = page.tab.locator("#constants tr").evaluate_all(
        "all => all.map(e => [...e.children].map(each => each.textContent))"
    )
    return dict(rows)


@pytest.mark.slow
@pytest.mark.parametrize(
    "start",
    ["psi_dot=200", "psi_dot=-150&theta_dot=2", "psi_dot=0&theta_dot=3"],
)
def test_a_constant_that_is_nearly_zero_is_constant(open_page, start):
    """cos(pi/2) is 6e-17 in doubles: of a sum of parts that cancel nothing but rounding is left."""
    page = open_page(f"#theta={np.pi / 2}&phi_dot=0&{start}")
    for time in (0.05, 0.11, 0.17):
        page.wait_for_time(time)
        page.wait_for_texts()
        rows = read_constants(page)
        assert rows["Lz\u2032, about the vertical"] == "0 N m s, constant"
        assert rows["energy E"].endswith(" J, constant")


@pytest.mark.slow
def test_rates_without_friction_are_told_as_such(open_page):
    page = open_page("#scene=friction")
    page.until(lambda: "changed by" in read_constants(page).get("energy E", ""))
    rows = read_constants(page)
    for name in ("motion", "nutation period", "time of one turn"):
        assert rows[name].endswith(" (apart from friction)"), rows
    page.follow("scene=cusps")
    page.until(lambda: read_constants(page)["motion"] == "cusps")


def test_what_is_of_gravity_alone_is_said_to_be_or_is_not_shown(open_page):
    page = open_page("#scene=friction")
    page.until(lambda: page.say("rule-apart") == "(apart from friction)")
    assert page.tab.is_hidden("#impulses-chart")
    page.follow("scene=cusps")
    page.until(lambda: page.tab.is_visible("#impulses-chart"))
    assert page.say("rule-apart") == ""


@pytest.mark.slow
def test_the_time_at_which_rounding_decides_is_one_of_the_run(open_page):
    page = open_page("#scene=separatrix")
    run = page.read_run()
    start = {**run["events"][-1], "time": 0.0}
    shows_at = read_motion(start).rounding_shows_at
    page.drop({**run, "events": [start, {**start, "time": 5.0}], "end": 6.0})
    page.until(lambda: [each["time"] for each in page.read_events()] == [0, 5])
    page.until(lambda: page.tab.get_attribute("#timeline", "max") == "6")
    for time, began in ((5.5, 5.0), (1.0, 0.0)):
        page.seek(time)
        said = f"from {began + shows_at:.3g} s on"
        row = "rounding of the start decides the motion"
        page.until(lambda: read_constants(page).get(row, "").startswith(said))  # noqa: B023


def test_the_map_of_kinds_has_the_exact_curve_and_the_present_motion(open_page):
    page = open_page("#theta=0.5&psi_dot=200&phi_dot=11.325")
    dot = page.tab.locator("#kinds #present")
    x, y = (float(dot.get_attribute(name)) for name in ("cx", "cy"))
    read = "all => all.map(e => e.getAttribute('d'))"
    curve = page.tab.locator("#kinds path.cusps").evaluate_all(read)
    pairs = re.findall(r"[ML]([-\d.]+) ([-\d.]+)", " ".join(curve))
    points = np.array(pairs, float)
    assert np.hypot(*(points - (x, y)).T).min() < 3  # 11.325 rad/s is the second cusp
    assert find_boundaries(ARTICLE)[0] == pytest.approx(11.325, abs=1e-3)


def test_kinds_are_decided_as_in_the_article(tab):
    """The module of the page agrees with the article's answer, and that with the motions."""
    random = np.random.default_rng(20210330)
    cases = []
    for _ in range(200):
        Ix = 10 ** random.uniform(-4, 0)
        top = {"Ix": Ix, "Iz": random.uniform(0.1, 1.9) * Ix, "Mgl": random.normal() * 100 * Ix}
        cases.append([top, random.uniform(0.2, 2.9), *random.normal(scale=(20, 100)).tolist()])
    found = zip(cases, tab.evaluate("decideKinds", cases), strict=True)
    for (values, theta, phi_dot, psi_dot), (is_looping, boundaries) in found:
        top = Top(**values)
        assert is_looping == bool(loops(top, theta, phi_dot, psi_dot))
        state = State.from_euler(theta=theta, phi_dot=phi_dot, psi_dot=psi_dot)
        assert Motion(top, state).kind == ("looping" if is_looping else "unidirectional")
        slow_or_fast = regular_precession_rates(top, theta=theta, psi_dot=boundaries["regular"])
        assert min(abs(rate / phi_dot - 1) for rate in slow_or_fast) < 1e-9
    article = dict(zip(("Ix", "Iz", "Mgl"), ARTICLE.moments, strict=True))
    for rate in (-30.0, 11.0, 60.0):
        expected = find_curves(ARTICLE, np.array([rate]))
        ((_, boundaries),) = tab.evaluate("decideKinds", [[article, 0.5, rate, 0.0]])
        cusps = math.nan if boundaries["cusps"] is None else boundaries["cusps"]
        assert cusps == pytest.approx(expected["cusps"][0][0], nan_ok=True)
        assert boundaries["upper"] == pytest.approx(expected["through the vertical"][0][0])


@pytest.mark.slow
def test_a_chart_shows_the_quantities_that_are_chosen_and_a_run_kept_for_comparison(opened):
    opened.open_charts("free")
    opened.tab.select_option("#free-x", "time")
    opened.tab.select_option("#free-y", "theta_ddot")
    opened.tab.click("#hurry")
    opened.wait_for_time(0.05)
    opened.tab.click("#pause")
    _, kick = opened.read_events()
    opened.tab.locator("#free").scroll_into_view_if_needed()
    opened.tab.evaluate("document.getElementById('free-place').value = 1")
    opened.wait_for_frames()
    time = float(opened.tab.get_attribute("body", "data-time"))
    state = read_motion(kick).at(time - kick["time"])
    rates = state.euler_rates
    acceleration = theta_acceleration(
        ARTICLE, state.euler_angles.theta, rates.phi_dot, rates.psi_dot
    )
    form = r"time (\S+) s, tilt acceleration theta'' (\S+) rad/s²"
    shown = re.fullmatch(form, opened.say("free-values"))
    assert float(shown[1]) == pytest.approx(time, rel=1e-4)
    assert float(shown[2]) == pytest.approx(acceleration, rel=1e-3)
    name = "tilt acceleration theta double dot over time"  # of the picture, for a screen reader
    opened.until(lambda: opened.tab.get_attribute("#free svg", "aria-label") == name)
    box = opened.tab.locator("#free svg").bounding_box()
    opened.tab.locator("#free svg").hover(position={"x": 50, "y": box["height"] / 2})
    opened.until(lambda: float(opened.tab.input_value("#free-place")) < 0.2)
    opened.tab.click("#free-keep")
    assert opened.say("free-keep") == "Discard the kept run"
    opened.press("Space")
    opened.enter("theta", "0.6")
    opened.wait_for_time(0.07)
    read = "e => e.getAttribute('d')"
    opened.until(lambda: len(opened.tab.locator("#kept").evaluate(read)) > 50)
    kept, own = (opened.tab.locator(name).evaluate(read) for name in ("#kept", "#chosen"))
    assert kept != own
    opened.tab.click("#free-keep")
    opened.until(lambda: not opened.tab.locator("#kept").evaluate(read))
    opened.reload()
    assert opened.tab.input_value("#free-y") == "theta_ddot"  # the choice is kept


@pytest.mark.slow
def test_the_axle_of_a_top_that_waits_sets_its_tilt_and_of_one_that_runs_is_pushed(open_page):
    opened = open_page(script=FEW_FRAMES)  # drawn: the ball is found by its colour
    opened.open_tab("view")
    for name in ("trace", "turning circles"):
        opened.tab.get_by_label(name).uncheck()
    opened.tab.click("#pause")
    opened.wait_for_frames()
    opened.drag(*opened.tab.evaluate("looks.findBall"), 0, 60)
    opened.wait_for_frames()
    assert len(opened.read_events()) == 1  # nothing has happened yet
    opened.tab.mouse.up()
    first, tilted = opened.read_events()
    assert tilted["kind"] == "start"
    before, after = read_state(first), read_state(tilted)
    assert abs(after.euler_angles.theta - before.euler_angles.theta) > 0.05
    assert after.euler_rates.psi_dot == pytest.approx(200)
    opened.wait_for_frames()
    opened.tab.click("#pause")
    opened.wait_for_frames()
    opened.tab.click("#pause")
    opened.tab.keyboard.down("Shift")
    opened.drag(*opened.tab.evaluate("looks.findBall"), 60, 0)
    opened.tab.mouse.up()
    opened.tab.keyboard.up("Shift")
    kick = opened.read_events()[-1]
    assert kick["kind"] == "kick"
    assert kick["made_by"] == {"kind": "pull"}


@pytest.mark.slow
def test_the_impulses_of_one_fall_are_those_of_the_article(open_page):
    page = open_page("#theta=0.5&psi_dot=200&phi_dot=0")
    page.open_charts("impulses")
    event = page.read_events()[-1]
    motion = read_motion(event)
    half = motion.nutation_period / 2

    def read():
        names = ("gravity", "coriolis", "centrifugal", "total")
        return [float(page.tab.text_content(f"#impulse-{name}")) for name in names]

    def is_shown_up_to_now():
        passed = float(page.tab.get_attribute("body", "data-time")) - event["time"]
        wanted = [1e3 * each for each in find_impulses(motion, passed)]
        return read()[:3] == pytest.approx(wanted, rel=6e-4, abs=1e-9)  # four digits are shown

    def is_shown_whole():
        *parts, total = read()
        wanted = [1e3 * each for each in find_impulses(motion, half)]
        return total == 0 and parts == pytest.approx(wanted, abs=6e-4)  # four digits

    # numbers follow the motion four times a second, and later on a busy machine
    page.wait_for_time(event["time"] + 0.02)
    page.seek(event["time"] + 0.02)  # which pauses: a click comes at a time of its own
    page.until(is_shown_up_to_now)
    page.tab.click("#pause")
    page.wait_for_time(event["time"] + half)
    page.until(is_shown_whole)
    areas = page.tab.locator("#impulses path[fill-opacity]")
    assert areas.count() == 3
    page.follow("scene=friction")  # which has no such fall
    page.until(lambda: not page.tab.is_visible("#impulses"))


SINGLE = 2.0**-23  # a coordinate of the scene, rounded
TENTH = 0.1001  # units of a chart: two coordinates are written in tenths, of a level and of a tick


def is_right(page, seconds):
    """Return True if all that is shown is that of a time, circles of the state at it included."""
    shown = Shown(page)
    try:
        shown.check(page)
    except AssertionError:
        return False
    circles = page.tab.evaluate("window.circles")
    cosines = np.cos(shown.free.turning_angles)
    are_right = len(circles) == 2 and np.abs(circles - cosines).max() <= SINGLE
    return are_right and float(page.tab.get_attribute("body", "data-time")) == seconds


def read_well(page):
    """The chart of the well: the energy of the state but for its spin, and the turning angles."""
    *heights, names, curve = page.tab.evaluate("looks.readWell")
    shown = Shown(page)
    first, lowest, scale = read_axis(page, "well")
    spin = shown.top.Iz * shown.state.angular_velocity[2] ** 2 / 2
    found = first + scale * (np.array(heights) - lowest)
    assert np.abs(found - (shown.top.energy(shown.state) - spin)).max() <= 2 * TENTH * abs(scale)
    angles = shown.free.turning_angles
    angles = angles if len(names) == 2 else [sum(angles) / 2]  # one name stands for both
    for name, angle in zip(names, angles, strict=True):
        assert is_rounded(re.match(NUMBER, name)[0], angle)
    return [*heights, curve]


@pytest.mark.slow
@pytest.mark.parametrize("scene", choose(("friction", "vertical_torque"), ("friction",)))
def test_circles_and_energy_are_those_of_a_driven_state_after_waiting_and_a_seek(open_page, scene):
    page = open_page(f"#scene={scene}", script=USUAL + "patches.keepCircles();")
    page.open_charts("well")
    page.tab.locator("#well > svg").scroll_into_view_if_needed()
    page.tab.select_option("#speed", "1")
    page.wait_for_time(1.0)
    page.press("Space")
    end = page.read_run()["end"]
    wells = []
    for time in (end, 0.3, end):
        page.seek(time)
        page.until(lambda time=time: is_right(page, time))
        page.wait_for_frames()
        wells.append(read_well(page))
    first, early, last = wells
    assert first == last != early


@pytest.mark.parametrize("scene", choose(("cusps", "hanging"), ("cusps",)))
def test_the_curve_of_the_well_begins_and_ends_beyond_the_turning_angles(open_page, scene):
    page = open_page(f"#scene={scene}")
    page.open_charts("well")
    names = page.tab.locator("#well text.tick[text-anchor=middle]")
    page.until(lambda: names.count() == 2)
    low, high = names.evaluate_all("all => all.map(e => Number(e.getAttribute('x')))")
    places = [
        float(x) for x in re.findall(r"[ML]([-\d.]+) ", page.tab.evaluate("looks.readWell")[-1])
    ]
    assert min(places) < low - 1  # of a chart some hundred units wide
    assert low < high
    assert max(places) > high + 1
