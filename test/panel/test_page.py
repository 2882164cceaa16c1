"""The page in a real browser: what a user sees and does, and what pages of others cannot do."""

import contextlib
import csv
import functools
import http.server
import io
import itertools
import math
import re
import threading
import time

import numpy as np
import pytest
from browser import running_browser
from exact_log import assert_exact
from panel.slow_line import slow_line
from PIL import Image

from symtop_ros.panel.page import Page
from symtop_ros.panel.server import LOCAL_HOST
from symtop_ros.panel.source import LocalTop
from symtop_ros.physics import regular_precession_rates
from symtop_ros.web.facts import compare
from symtop_ros.web.scene import ORANGE
from symtop_ros.wording import write

TIMEOUT = 60.0  # s; ends a test that hangs, and is never waited for
SIZE = {"width": 1100, "height": 560}  # software renders slowly
LINK = "?theta=0.3&psi_dot=150&phi_dot=0"
# Viser's own listener at the end of a pull; Chromium calls it an error, and it has no effect. Viser
# makes functions from text for Gaussian splats, which this page has none of.
KNOWN = (
    "Unable to preventDefault inside passive event listener",
    "Evaluating a string as JavaScript",
)
OTHER_ORIGIN = """<!doctype html><script>
const open = (path, protocols) => new Promise((done) => {
  const socket = new WebSocket("ws://ADDRESS" + path, protocols);
  socket.onopen = () => done("connected");
  socket.onclose = () => done("refused");
});
Promise.all([open("/scene/a", ["viser-vVERSION"]), open("/controls/a", []),
  fetch("http://ADDRESS/series.csv").then(() => "read", () => "refused"),
]).then((answers) => { document.title = answers.join(" "); });
</script><a href="http://ADDRESS/?theta=1.2">see this top</a>"""


class Watched:
    """A page of a paused top, open in a browser."""

    def __init__(self, browser, page):
        self.page, self.errors, self.requests = page, [], []
        self.tab = self.open(browser, LINK)

    def open(self, browser, query=""):
        """Open the page in a new window."""
        tab = browser.new_page(viewport=SIZE)
        tab.set_default_timeout(TIMEOUT * 1000)
        tab.on(
            "console",
            lambda message: self._note(
                message.type == "error", f"{message.text} {message.location}"
            ),
        )
        tab.on("pageerror", lambda error: self._note(True, str(error)))
        tab.on("request", lambda request: self.requests.append(request.url))
        tab.goto(f"{self.page.server.url}/{query}")
        self.wait_until_ready(tab)
        return tab

    def wait_until_ready(self, tab):
        """Wait for the content of the page and of its scene."""
        tab.wait_for_selector("#headline:not(:empty)")
        tab.frame_locator("iframe").locator("canvas").first.wait_for()

    def _note(self, is_error, text):
        if is_error:
            self.errors.append(text)

    def until(self, condition):
        """Wait, while the browser works, until a condition holds."""
        deadline = time.monotonic() + TIMEOUT
        while not condition():
            assert time.monotonic() < deadline, (self.refusal, self.run.event)
            self.tab.wait_for_timeout(20)

    @property
    def run(self):
        return self.page.run

    @property
    def shown_time(self):
        """Time of the run, in s, that the page shows."""
        return float(self.tab.locator("body").get_attribute("data-time"))

    @property
    def refusal(self):
        return self.tab.locator("#refusal").inner_text()

    def field(self, label):
        return self.tab.get_by_role("textbox", name=label)

    def choose_tab(self, name):
        self.tab.get_by_role("tab", name=name).click()

    def events(self, name):
        return [event for event in self.page.seen if event.name == name]

    def catch_up(self):
        """Wait until the page has noted what its run shows already."""
        self.until(lambda: any(event is self.run.event for event in self.page.seen[-5:]))

    def act(self, act, name):
        """Do something, and wait for the event that follows; return it."""
        self.catch_up()
        before = len(self.events(name))
        act()
        self.until(lambda: len(self.events(name)) > before)
        return self.events(name)[-1]

    def press(self, label):
        self.tab.get_by_role("button", name=label, exact=True).click()

    def place(self, point):
        """Return the place of a point of the scene in the window, from the camera."""
        (client,) = list(self.page.server.get_clients().values())[:1]
        camera = client.camera
        w, x, y, z = camera.wxyz
        turn = np.array(
            [
                [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
                [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
                [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
            ]
        )
        right, down, ahead = turn.T @ (point - camera.position)
        box = self.tab.frame_locator("iframe").locator("canvas").first.bounding_box()
        scale = box["height"] / 2 / math.tan(camera.fov / 2) / ahead
        return (
            box["x"] + box["width"] / 2 + scale * right,
            box["y"] + box["height"] / 2 + scale * down,
        )

    def find_end_of_axle(self):
        return self.place(self.run.state.to_world([0.0, 0.0, 1.0]))

    def wait_for_ball(self):
        """Return the place of the end of the axle once its ball is drawn there."""
        # again each time, because the camera of a new page is told a little after the page is drawn
        self.until(lambda: self.shows_ball_at(*self.find_end_of_axle()))
        return self.find_end_of_axle()

    def picture(self):
        image = Image.open(io.BytesIO(self.tab.screenshot())).convert("RGB")
        return np.asarray(image).astype(int)

    def shows_ball_at(self, x, y):
        """Return True if the middle of the ball at the end of the axle is drawn at a pixel."""
        near = self.picture()[round(y) - 2 : round(y) + 3, round(x) - 2 : round(x) + 3].mean((0, 1))
        # Lit, the ball is brighter and darker than its colour, but its hue is that of no other part
        red, green, blue = near
        share = ORANGE[1] / ORANGE[0]
        return red > 90 and abs(green / red - share) < 0.2 and blue < 0.45 * red


class SeenPage(Page):
    """A page that remembers its events."""

    def __init__(self, *arguments):
        self.seen = []
        super().__init__(*arguments)

    def _follow(self):
        events = super()._follow()
        self.seen += events
        return events


@pytest.fixture(scope="module", name="browser")
def _browser():
    with running_browser() as browser:
        yield browser


@pytest.fixture(scope="module", name="watched")
def _watched(browser, tmp_path_factory):
    folder = tmp_path_factory.mktemp("page")
    with pytest.MonkeyPatch.context() as patch:
        patch.chdir(folder)
        page = SeenPage(LocalTop("hurry_slow", factor=0.1), LOCAL_HOST, 0)
        try:
            page.actions.request("pause", True)  # software renders a moving top slowly
            watched = Watched(browser, page)
            watched.until(
                lambda: watched.run.event and watched.run.event.request.get("theta") == "0.3"
            )
            yield watched
        finally:
            page.close()


@pytest.fixture(autouse=True)
def _as_before(watched):
    """Begin each test with the first motion, paused at its start."""
    watched.act(lambda: watched.page.actions.choose_scene("hurry_slow"), "start")
    assert not watched.run.segment.running


def test_a_link_that_a_user_types_starts_its_experiment_and_leaves_the_address(watched):
    event = watched.events("start")[1]  # after that of the scene
    assert event.request == {"theta": "0.3", "psi_dot": "150.0", "phi_dot": "0.0"}
    assert event.state().euler_angles.theta == pytest.approx(0.3, abs=1e-15)
    assert watched.tab.url == f"{watched.page.server.url}/"


def test_the_fragment_of_an_open_page_starts_its_experiment_too(watched):
    event = watched.act(
        lambda: watched.tab.evaluate("location.hash = 'theta=0.7&psi_dot=120'"), "start"
    )
    assert event.state().euler_angles.theta == pytest.approx(0.7, abs=1e-15)
    watched.until(lambda: watched.tab.url == f"{watched.page.server.url}/")


@pytest.mark.parametrize("length", [2000, 20_000])
def test_a_link_with_too_much_text_is_refused_in_a_line(watched, length):
    starts = len(watched.events("start"))
    watched.tab.evaluate(f"location.hash = 'theta=0.7' + 'x'.repeat({length})")
    watched.until(lambda: watched.refusal)
    assert "theta must be a" in watched.refusal
    assert len(watched.refusal) < 300
    assert len(watched.events("start")) == starts


def test_a_link_of_another_site_is_offered_and_starts_nothing(watched, browser, tmp_path):
    with other_site(watched, tmp_path) as url:
        tab = browser.new_page(viewport={"width": 600, "height": 300})
        tab.route("**/scene?*", lambda route: route.fulfill(body="<!doctype html>"))  # one is drawn
        tab.goto(url)
        starts = len(watched.events("start"))
        tab.get_by_role("link", name="see this top").click()
        offer = tab.locator("#offer")
        offer.wait_for()
        assert "theta = 1.2" in offer.inner_text()
        # requests of one page keep their order: a start would have come before the step
        watched.act(lambda: tab.get_by_role("button", name="Step", exact=True).click(), "step")
        assert len(watched.events("start")) == starts
        watched.act(lambda: tab.get_by_role("button", name="Start it").click(), "start")
        assert watched.run.motion.start.euler_angles.theta == pytest.approx(1.2, abs=1e-15)
        assert not offer.is_visible()
        tab.close()


# Numbers as they are typed, and the value that must hold afterwards.
TYPED = {
    "tilt theta": ("0,69", "theta", 0.69),
    "spin psi'": ("69.8", "psi_dot", 69.8),
    "precession phi'": ("-0.05", "phi_dot", -0.05),
    "Ix": ("0.0003", "top.Ix", 0.0003),
    "Iz": ("6.1e-5", "top.Iz", 6.1e-5),
    "Mgl": ("6.8e-2", "top.Mgl", 0.068),
    "friction, axial": ("2E-7", "friction.axial", 2e-7),
    "friction, transverse": ("3e-7", "friction.transverse", 3e-7),
}


def type_into(watched, label, text, delay):
    """Replace the content of a field key by key, and leave it by Enter."""
    field = watched.field(label)
    field.click()
    field.press("Control+a")
    field.press("Delete")
    seen = ""
    for key in text:
        field.press(key)
        watched.tab.wait_for_timeout(delay)
        seen += key
        assert field.input_value() == seen  # nothing is written into a field that is typed into
    field.press("Enter")


def value_of(watched, name):
    motion, rates = watched.run.motion, watched.run.motion.start.euler_rates
    values = {
        "theta": motion.start.euler_angles.theta,
        "phi_dot": rates.phi,
        "psi_dot": rates.psi,
        "top.Ix": motion.top.Ix,
        "top.Iz": motion.top.Iz,
        "top.Mgl": motion.top.Mgl,
        "friction.axial": motion.friction.axial,
        "friction.transverse": motion.friction.transverse,
    }
    return float(values[name])


@pytest.mark.parametrize("label", TYPED)
def test_a_number_is_taken_over_as_it_was_typed(watched, label):
    text, name, expected = TYPED[label]
    watched.catch_up()
    before = len(watched.page.seen)
    type_into(watched, label, text, 80)
    # 1e-12: rates are recomputed from the angular velocity of the start
    watched.until(lambda: value_of(watched, name) == pytest.approx(expected, abs=1e-12))
    watched.catch_up()
    acts = [event.name for event in watched.page.seen[before:]]
    assert acts in (["start"], ["parameters"], [])  # one act at the end; none if nothing changed


@pytest.mark.long
@pytest.mark.parametrize("delay", [250, 600])
def test_a_slow_typist_gets_the_number_too(watched, delay):
    type_into(watched, "Ix", "0.000312", delay)
    watched.until(lambda: watched.run.motion.top.Ix == 0.000312)


def test_a_field_that_is_left_is_taken_over_and_one_that_is_escaped_is_not(watched):
    watched.field("Mgl").fill("0.05")
    watched.act(lambda: watched.field("Iz").click(), "parameters")
    assert watched.run.motion.top.Mgl == 0.05
    field = watched.field("Iz")
    field.press("1")
    field.press("Escape")
    watched.until(lambda: field.input_value() == "0.0000572")
    assert watched.run.motion.top.Iz == 5.72e-5


def test_a_slider_starts_the_motion_that_it_shows(watched):
    slider = watched.tab.get_by_role("slider", name="tilt theta")
    watched.until(lambda: slider.get_attribute("aria-valuetext") == "0.5")
    event = watched.act(lambda: slider.press("ArrowRight"), "start")
    assert event.state().euler_angles.theta == pytest.approx(0.51, abs=1e-12)


def test_sliders_show_a_motion_through_the_vertical(watched):
    watched.act(lambda: watched.page.actions.choose_scene("separatrix"), "start")
    watched.act(lambda: watched.page.actions.choose_scene("sleeping"), "start")
    watched.until(lambda: watched.field("tilt theta").input_value() == "0")
    spin = watched.run.motion.start.angular_velocity[2]
    watched.until(lambda: float(watched.field("spin psi'").input_value()) == pytest.approx(spin))


@pytest.mark.parametrize("size", [(1280, 720), (390, 844)])
def test_a_refusal_is_seen_and_announced_in_the_part_that_never_scrolls(watched, size):
    watched.tab.set_viewport_size(dict(zip(("width", "height"), size, strict=True)))
    try:
        field = watched.field("Ix")
        field.fill("0")
        field.press("Enter")
        alert = watched.tab.get_by_role("alert").filter(has_text="top.Ix must be")
        watched.until(alert.is_visible)
        box = alert.bounding_box()
        assert box["y"] >= 0
        assert box["y"] + box["height"] <= size[1]
        assert field.get_attribute("aria-invalid") == "true"
        field.blur()
        watched.until(lambda: float(field.input_value()) == 0.000228)
        assert watched.run.motion.top.Ix == 0.000228
        watched.act(lambda: watched.press("Hurry the precession"), "kick")
        watched.until(lambda: not alert.is_visible())
    finally:
        watched.tab.set_viewport_size(SIZE)


def test_the_headline_compares_with_the_top_that_was_not_kicked(watched):
    headline = watched.tab.locator("#headline")
    assert headline.locator("..").get_attribute("aria-live") == "polite"
    watched.act(lambda: watched.press("Hurry the precession"), "kick")
    low, high = watched.run.motion.turning_angles
    shown = compare(watched.run.announced)
    assert (shown.kind, shown.most) == ("higher", pytest.approx(0.5 - low, abs=1e-12))
    watched.until(lambda: headline.inner_text() == write("headline", shown))
    # Hurried again near the lower end of the nutation it falls on, and yet both limits rise.
    for _ in range(8):
        watched.act(lambda: watched.press("Step"), "step")
    second = watched.act(lambda: watched.press("Hurry the precession"), "kick")
    after = watched.run.motion.turning_angles
    higher = [now < was - 1e-6 for was, now in zip((low, high), after, strict=True)]
    kinds = {(True, True): "higher", (False, False): "lower", (True, False): "wider"}
    shown = compare(watched.run.announced)
    assert shown.kind == kinds[tuple(higher)]
    watched.until(lambda: headline.inner_text() == write("headline", shown))
    watched.tab.get_by_text("why", exact=True).click()
    assert watched.tab.locator("#why").inner_text() == second.verdict
    watched.tab.get_by_text("why", exact=True).click()


def test_speed_and_torque_leave_the_headline(watched):
    watched.act(lambda: watched.press("Hurry the precession"), "kick")
    headline = watched.tab.locator("#headline")
    kicked = write("headline", compare(watched.run.announced))
    watched.until(lambda: headline.inner_text() == kicked)
    watched.act(
        lambda: watched.tab.get_by_label("speed").select_option("1/20 of real time"), "parameters"
    )
    watched.act(lambda: watched.page.actions.hold_torque(1.0), "torque")
    watched.until(lambda: watched.run.event.name == "torque")
    before = watched.shown_time
    watched.act(watched.page.actions.step, "step")
    watched.until(lambda: watched.shown_time > before)  # the page has what came before it, too
    assert headline.inner_text() == kicked


def test_the_drawn_attitude_is_that_of_the_state(watched):
    for _ in range(2):
        for _ in range(6):
            watched.act(watched.page.actions.step, "step")
        watched.until(lambda: watched.run.stamp > watched.run.event.stamp)
        watched.wait_for_ball()
        tilt = f"{watched.run.state.euler_angles.theta:.6g}"
        watched.until(
            lambda tilt=tilt: watched.tab.locator("body").get_attribute("data-theta") == tilt
        )


def points_of(watched, name):
    """The points (n, 2) of a curve of the page, in the units of its picture."""
    path = watched.tab.locator(f"#{name}").get_attribute("d")
    return np.array([part.split() for part in re.split("[ML]", path) if part], dtype=float)


def test_the_chart_of_the_rule_shows_both_roots_and_the_hurried_top_above_the_line(watched):
    theta, phi_dot, psi_dot = (
        watched.run.motion.start.euler_angles.theta,
        watched.run.motion.start.euler_rates.phi,
        watched.run.motion.start.euler_rates.psi,
    )
    shown = watched.tab.evaluate(
        """() => {
          const all = (selector) => [...document.querySelectorAll("#rule " + selector)];
          const circle = (id) => { const [c] = all("#" + id);
            return [c.getAttribute("cx"), c.getAttribute("cy")].map(Number); };
          return {
            ticks: all(".tick").filter((each) => !isNaN(each.textContent))
              .map((each) => [+each.getAttribute("y"), +each.getAttribute("x"), +each.textContent]),
            roots: all(".root").map((each) => each.getAttribute("d").match(/[0-9.]+/g).map(Number)),
            now: circle("now"), hurried: circle("hurried"),
          };
        }"""
    )
    below = sorted(tick[1:] for tick in shown["ticks"] if tick[0] == max(shown["ticks"])[0])
    (x0, low), (x1, high) = below[0], below[-1]
    pixel = (high - low) / (x1 - x0)  # rad/s

    def rate_at(x):
        return low + (x - x0) * pixel

    rates = sorted(regular_precession_rates(watched.run.motion.top, theta, psi_dot))
    assert sorted(rate_at(x) for x, *_ in shown["roots"]) == pytest.approx(rates, abs=pixel)
    assert rate_at(shown["now"][0]) == pytest.approx(phi_dot, abs=pixel)
    line = shown["roots"][0][1] + 6  # marks begin 6 pixels above it
    assert shown["now"][1] == pytest.approx(line, abs=1.0)  # regular precession
    assert shown["hurried"][0] > shown["now"][0]
    assert shown["hurried"][1] < line - 5  # the tilt accelerates upwards


def test_the_potential_is_below_the_energy_where_the_motion_is_allowed(watched):
    watched.act(lambda: watched.page.actions.choose_scene("perry_fails"), "start")
    watched.act(lambda: watched.page.actions.kick(1.4), "kick")
    watched.until(lambda: watched.tab.locator("#before").count() == 1)
    facts = watched.page.pages.facts["potential"]
    low, high = facts["angles"]
    inside = [
        height
        for tilt, height in zip(facts["theta"], facts["height"], strict=True)
        if low <= tilt <= high
    ]
    assert len(inside) >= 10
    assert max(inside) <= facts["energy"] * (1 - 1e-12)  # the energy is negative; seen 1e-15
    assert len(points_of(watched, "potential")) > 100
    watched.act(lambda: watched.press("Step"), "step")  # a pause or a step leaves the old curve
    assert watched.tab.locator("#before").count() == 1


def test_the_whole_top_and_its_arrows_are_in_the_picture(watched):
    watched.act(lambda: watched.page.actions.choose_scene("perry_fails"), "start")
    watched.until(lambda: watched.run.stamp >= watched.run.event.stamp)
    canvas = watched.tab.frame_locator("iframe").locator("canvas").first
    corners = np.array([*itertools.product((-0.75, 0.75), (-0.75, 0.75), (-0.75, 1.0))])
    (client,) = watched.page.server.get_clients().values()
    momentum = watched.run.motion.top.angular_momentum(watched.run.state)

    def shows_all():
        box = canvas.bounding_box()  # a headline of two lines moves it
        places = [watched.place(point) for point in corners]
        inside = all(
            box["x"] < x < box["x"] + box["width"] and box["y"] < y < box["y"] + box["height"]
            for x, y in places
        )
        # L points down, on the far side of the rotor from above: the camera is below.
        return inside and momentum[2] * (client.camera.position - client.camera.look_at)[2] > 0

    watched.until(shows_all)  # the browser moves its camera, and reports where it is


def test_labels_stand_at_the_ends_of_their_arrows(watched):
    for _ in range(5):
        watched.act(watched.page.actions.step, "step")
        watched.until(lambda: watched.run.stamp > watched.run.event.stamp)
    scene = watched.page._scene
    for name in ("L", "omega", "torque"):
        arrow, label = scene._arrows[name].handle, scene._arrows[name].label
        w, x, y, z = arrow.wxyz
        direction = np.array(
            [2 * (x * z + w * y), 2 * (y * z - w * x), w * w + z * z - x * x - y * y]
        )
        gap = np.array(label.position) - arrow.points[0, 1, 2] * direction
        assert np.linalg.norm(gap) < 0.08  # scene units, less than two heads of an arrow
    dark = [watched.place(np.array(scene._arrows[name].label.position)) for name in ("L", "omega")]
    for x, y in dark:  # a label is black on white
        place = slice(round(y) - 12, round(y) + 12), slice(round(x) - 40, round(x) + 40)
        watched.until(lambda place=place: (watched.picture()[place].max(axis=2) < 90).sum() > 5)
    assert math.dist(*dark) > 15  # px


def test_a_recording_and_a_parameter_leave_the_time_of_the_series(watched, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    watched.act(lambda: watched.press("Step"), "step")
    watched.act(lambda: watched.press("Run"), "resume")
    for _ in range(2):
        watched.act(watched.page.actions.switch_recording, "record")
    watched.act(lambda: watched.page.actions.set_parameters({"hurry_factor": 1.7}), "parameters")
    window = watched.run.window
    watched.act(lambda: watched.press("Pause"), "pause")
    watched.act(lambda: watched.press("Step"), "step")
    watched.until(lambda: watched.run.stamp > watched.run.event.stamp)
    times = watched.run.series()[:, 0]
    segment = watched.run.segment
    since = watched.page.pages.facts["since"]
    # The time of the run since the start is the time of the motion: nothing is added to it.
    assert times[-1] - since == pytest.approx(segment.time_at(watched.run.stamp), abs=1e-9)
    assert np.all(np.diff(times) > 0)
    assert watched.run.window == window


@pytest.mark.long
def test_a_page_behind_a_slow_line_is_not_late(watched, browser):
    with slow_line(watched.page.server.url, 300e3) as url:
        tab = browser.new_page(viewport={"width": 320, "height": 320})
        tab.goto(url)
        tab.wait_for_selector("#headline:not(:empty)", timeout=TIMEOUT * 1000)
        watched.act(lambda: watched.page.actions.request("pause", False), "resume")
        late = []
        tab.wait_for_timeout(4000)
        for _ in range(20):
            tab.wait_for_timeout(100)
            shown = float(tab.locator("body").get_attribute("data-time"))
            late.append((watched.run.time - shown) / watched.run.segment.factor)
        watched.act(lambda: watched.page.actions.request("pause", True), "pause")
        tab.close()
    watched.until(lambda: len(watched.page.server.get_clients()) == 1)
    assert np.median(late) < 0.3  # s; software rendering of two scenes delays some


def test_the_ball_on_the_axle_is_pulled(watched):
    mouse = watched.tab.mouse
    watched.until(lambda: watched.run.stamp > watched.run.event.stamp)
    x, y = watched.wait_for_ball()
    before = watched.run.motion.top.angular_momentum(watched.run.state)

    def pull():
        mouse.move(x, y)
        mouse.down()
        for k in range(1, 7):
            mouse.move(x + 12 * k, y)
        watched.until(lambda: watched.page._pull is not None)
        mouse.up()

    event = watched.act(pull, "kick")
    assert set(event.request) == {"angular_impulse"}
    gained = watched.run.motion.top.angular_momentum(watched.run.motion.start) - before
    # To the right in the window is along the horizontal axis of the camera, (1.9, 2.2)/2.9 turned
    # by a right angle: axis x pull points down there, for the axle stands nearly upright.
    (client,) = watched.page.server.get_clients().values()
    ahead = client.camera.look_at - client.camera.position
    right = np.cross(ahead, [0.0, 0.0, 1.0])
    axis = watched.run.state.to_world([0.0, 0.0, 1.0])
    expected = np.cross(axis, right)
    cosine = gained @ expected / np.linalg.norm(gained) / np.linalg.norm(expected)
    assert cosine > 0.97  # the mouse is no finer than a pixel, and may miss the middle of the ball


@pytest.mark.long
def test_a_page_that_is_reloaded_in_the_middle_of_a_pull_neither_kicks_nor_starts(watched):
    mouse = watched.tab.mouse
    watched.until(lambda: watched.run.stamp > watched.run.event.stamp)
    x, y = watched.wait_for_ball()
    kicks, starts = len(watched.events("kick")), len(watched.events("start"))
    mouse.move(x, y)
    mouse.down()
    mouse.move(x + 20, y)
    mouse.move(x + 60, y)
    watched.until(lambda: watched.page._pull is not None)
    watched.tab.reload()
    watched.wait_until_ready(watched.tab)
    mouse.up()
    watched.until(lambda: watched.page._pull is None)
    watched.act(lambda: watched.press("Reset"), "reset")
    assert len(watched.events("kick")) == kicks
    assert len(watched.events("start")) == starts


def test_keys_play_and_do_not_move_the_camera(watched):
    keyboard = watched.tab.keyboard
    watched.wait_for_ball()  # with the camera in its place
    (client,) = watched.page.server.get_clients().values()
    position = client.camera.position.copy()
    for key, factor in (("h", "1.4"), ("d", repr(1 / 1.4))):
        event = watched.act(lambda key=key: keyboard.press(key), "kick")
        assert event.request == {"precession_rate_factor": factor}
    for key in ("ArrowUp", "ArrowDown"):
        event = watched.act(lambda key=key: keyboard.press(key), "kick")
        assert set(event.request) == {"angular_impulse"}
    for key, change in (("ArrowRight", "1.0"), ("ArrowLeft", "-1.0")):
        event = watched.act(lambda key=key: keyboard.press(key), "kick")
        assert event.request["precession_rate_change"] == change
    watched.act(lambda: keyboard.press("Space"), "resume")
    watched.act(lambda: keyboard.press("Space"), "pause")
    watched.act(lambda: keyboard.press("r"), "reset")
    x, y = watched.place(np.array([0.9, 0.9, 0.9]))
    watched.tab.mouse.click(x, y)  # the scene has the focus: its keys are those of the page
    watched.act(lambda: keyboard.press("h"), "kick")
    # viser computes it again in single precision, from the angles; a key would move it by 0.1
    assert np.allclose(client.camera.position, position, rtol=0, atol=1e-6)


def test_a_key_that_is_typed_into_a_field_does_nothing_else(watched):
    before = len(watched.page.seen)
    field = watched.field("Mgl")
    field.fill("")
    for key in ("h", "Space", "ArrowLeft", "r"):
        field.press(key)
    field.press("Escape")
    # requests of one page keep their order: what the keys ask for would come before the step
    watched.act(lambda: watched.press("Step"), "step")
    assert [event.name for event in watched.page.seen[before:]] == ["step"]


@pytest.mark.long
def test_an_entry_of_the_history_restarts_from_its_state(watched):
    kick = watched.act(lambda: watched.press("Hurry the precession"), "kick")
    watched.act(lambda: watched.page.actions.start({"theta": 1.0}), "start")
    watched.choose_tab("History")
    entry = watched.tab.get_by_role("button", name="kick: precession_rate_factor").first
    event = watched.act(entry.click, "start")
    watched.choose_tab("Top")
    assert np.array_equal(event.state().angular_velocity, kick.state().angular_velocity)


@pytest.mark.long
def test_a_torque_acts_while_its_button_is_held(watched):
    watched.act(lambda: watched.press("Run"), "resume")
    watched.choose_tab("Push")
    watched.tab.get_by_role("button", name="Torque about the vertical: hold").hover()
    event = watched.act(watched.tab.mouse.down, "torque")
    assert event.values["applied_torque"] == "0.0 0.0 0.00051"
    watched.act(watched.tab.mouse.up, "torque")
    watched.until(lambda: not any(watched.run.motion.applied_torque))
    watched.choose_tab("Top")
    watched.act(lambda: watched.press("Pause"), "pause")


def save(watched, act, folder):
    """Do something, and return the file that the browser gets."""
    with watched.tab.expect_download() as download:
        act()
    path = folder / download.value.suggested_filename
    download.value.save_as(path)
    return path


def test_the_run_is_saved_as_a_page(watched, tmp_path):
    watched.act(watched.page.actions.step, "step")
    watched.choose_tab("Save")
    link = watched.tab.get_by_role("link", name="This run as a page")
    page = save(watched, link.click, tmp_path)
    watched.choose_tab("Top")
    assert page.suffix == ".html"
    assert "SAVED_RUN = {" in page.read_text()  # what it shows is tested in test/web/test_saved.py


def test_series_and_log_are_saved(watched, tmp_path):
    watched.choose_tab("Save")
    watched.act(lambda: watched.press("Record (MCAP)"), "record")
    watched.act(watched.page.actions.step, "step")
    watched.act(lambda: watched.page.actions.kick(1.4), "kick")
    watched.until(lambda: watched.run.is_recording)
    series = save(watched, watched.tab.get_by_role("link", name="Series (CSV)").click, tmp_path)
    log = save(watched, lambda: watched.press("End the recording"), tmp_path)
    watched.choose_tab("Top")
    rows = list(csv.reader(series.read_text().splitlines()))
    assert rows[0][:2] == ["time (s)", "theta (rad)"]
    assert len(rows) > 2
    assert log.suffix == ".mcap"
    assert assert_exact(log) > 0


@pytest.mark.long
def test_a_picture_is_saved(watched, tmp_path):
    watched.choose_tab("Save")
    link = watched.tab.get_by_role("link", name="Picture (PNG)")
    picture = np.asarray(Image.open(save(watched, link.click, tmp_path)))
    watched.choose_tab("Top")
    assert min(picture.shape[:2]) > 200
    assert picture[..., :3].std() > 10  # something is drawn


@pytest.mark.long
def test_two_pages_play_with_one_top_and_choose_each_what_they_show(watched, browser):
    other = watched.open(browser)
    kicks = len(watched.events("kick"))
    for tab in (watched.tab, other):
        tab.keyboard.press("h")
    watched.until(lambda: len(watched.events("kick")) == kicks + 2)
    assert watched.run.motion.start.euler_rates.phi == pytest.approx(6.4971 * 1.96, rel=1e-4)
    headline = write("headline", compare(watched.run.announced))
    for tab in (watched.tab, other):
        watched.until(lambda tab=tab: tab.locator("#headline").inner_text() == headline)
    sent = []
    for client in watched.page.server.get_clients().values():
        queue = client._websock_connection.queue_message
        client._websock_connection.queue_message = lambda message, client=client, queue=queue: (
            sent.append((client.client_id, message)),
            queue(message),
        )
    other.get_by_role("tab", name="View").click()
    other.get_by_label("trace").uncheck()
    watched.until(lambda: bool(sent))
    ((client, message),) = sent
    assert (client, message.name, message.visible) == (
        max(watched.page.server.get_clients()),
        "/trace",
        False,
    )
    other.close()
    watched.until(lambda: len(watched.page.server.get_clients()) == 1)


@contextlib.contextmanager
def other_site(watched, folder):
    """The address of a page of another origin, which tries to reach the top."""
    import viser

    address = watched.page.server.url.removeprefix("http://")
    text = OTHER_ORIGIN.replace("ADDRESS", address).replace("VERSION", viser.__version__)
    (folder / "index.html").write_text(text)
    handler = functools.partial(http.server.SimpleHTTPRequestHandler, directory=folder)
    handler.log_message = lambda *_: None
    with http.server.ThreadingHTTPServer((LOCAL_HOST, 0), handler) as server:
        threading.Thread(target=server.serve_forever, daemon=True).start()
        yield f"http://localhost:{server.server_address[1]}/"
        server.shutdown()


def test_a_page_of_another_origin_can_neither_connect_nor_read(watched, browser, tmp_path):
    before, clients = len(watched.page.seen), len(watched.page.server.get_clients())
    with other_site(watched, tmp_path) as url:
        tab = browser.new_page()
        for address in (url, url.replace("localhost", LOCAL_HOST)):
            tab.goto(address)
            tab.wait_for_function("document.title", timeout=TIMEOUT * 1000)
            assert tab.title() == "refused refused refused"
        tab.close()
    assert len(watched.page.seen) == before
    assert len(watched.page.server.get_clients()) == clients


def test_there_was_no_error_and_no_request_beyond_this_machine(watched):
    assert [text for text in watched.errors if not any(known in text for known in KNOWN)] == []
    addresses = {re.match(r"\w+:(//[^/]*)?", url)[0] for url in watched.requests}
    assert addresses <= {watched.page.server.url, "data:", "blob:"}
