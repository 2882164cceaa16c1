"""The page as one file, opened from a disk without a network, in Chromium."""

import json
import math
import time

import numpy as np
import pytest
from browser import running_browser

from symtop_ros.physics import (
    Motion,
    State,
    Top,
    apply_impulse,
    hurry,
    kick_verdict,
    perrys_rule,
)
from symtop_ros.simulation.changes.initial import start_motion
from symtop_ros.simulation.presets import scene_names
from symtop_ros.simulation.settings import Settings
from symtop_ros.web.join import write_file
from symtop_ros.web.lesson import read_lesson
from symtop_ros.wording import write

LARGEST = 700_000  # bytes, so that it can be sent by mail and opened on a phone
TIMEOUT = 20.0  # s
NO_REQUESTS = "file:", "blob:", "data:"


@pytest.fixture(scope="module")
def browser():
    with running_browser() as running:
        yield running


@pytest.fixture(scope="module")
def path(tmp_path_factory):
    path = tmp_path_factory.mktemp("file") / "top.html"
    path.write_text(write_file(), encoding="utf-8")
    return path


class Opened:
    """The file in a tab, with what went wrong."""

    def __init__(self, browser, path, fragment="", **options):
        self.context = browser.new_context(offline=True, accept_downloads=True, **options)
        self.tab = self.context.new_page()
        self.problems, self.requests = [], []
        self.tab.on("console", lambda message: self.problems.append(message.text))
        self.tab.on("pageerror", lambda error: self.problems.append(str(error)))
        self.tab.on("request", lambda request: self.requests.append(request.url))
        self.tab.goto(path.as_uri() + fragment)
        self.tab.wait_for_selector("#headline:not(:empty)")

    def say(self, name):
        return self.tab.text_content(f"#{name}")

    def save(self, text, folder):
        """Download what a button of the tab Save gives; return its path."""
        self.tab.click("#tab-save")
        with self.tab.expect_download() as download:
            self.tab.click(f"text={text}")
        target = folder / download.value.suggested_filename
        download.value.save_as(target)
        return target

    def read_run(self, folder):
        return json.loads(self.save("This run (JSON)", folder).read_text())

    def until(self, condition):
        """Wait, while the browser works; its own way would need what the page forbids."""
        deadline = time.monotonic() + TIMEOUT
        while not condition():
            assert time.monotonic() < deadline
            self.tab.wait_for_timeout(20)

    def wait_for_time(self, seconds):
        self.until(lambda: float(self.tab.get_attribute("#timeline", "max")) > seconds)


@pytest.fixture
def opened(browser, path):
    page = Opened(browser, path)
    yield page
    page.context.close()
    assert page.problems == []
    assert all(request.startswith(NO_REQUESTS) for request in page.requests)


def read_state(event):
    return State(event["orientation"], event["angular_velocity"])


def read_motion(event):
    return Motion(Top(*event["top"]), read_state(event))


def test_the_file_is_small(path):
    assert path.stat().st_size < LARGEST


def test_a_hurry_is_that_of_python_to_the_last_bit_and_letter(opened, tmp_path):
    opened.wait_for_time(0.05)
    opened.tab.click("#hurry")
    why = opened.say("why")
    start, kick = opened.read_run(tmp_path)["events"]
    before = read_motion(start).at(kick["time"] - start["time"])
    after = hurry(before, 1.4)
    assert kick["orientation"] == after.given_orientation.tolist()
    assert kick["angular_velocity"] == after.angular_velocity.tolist()
    verdict = kick_verdict(Motion(Top(*kick["top"]), after), before, "spin_rate")
    assert why == write("kick", verdict)
    assert opened.say("headline").startswith("The top moves higher than without the kick, by 0.063")


def test_a_start_is_judged_as_by_python(opened, tmp_path):
    opened.tab.fill("#field-theta", "1.1")
    opened.tab.press("#field-theta", "Enter")
    start = opened.read_run(tmp_path)["events"][-1]
    motion = read_motion(start)
    outcome = {"motion": motion.kind, "verdict": perrys_rule(motion.top, motion.start)}
    assert motion.start.euler_angles.theta == pytest.approx(1.1, rel=1e-15)
    assert opened.say("why").startswith(f"{motion.kind}: {write('verdict', outcome['verdict'])}")


def test_every_scene_starts_with_the_doubles_of_a_node(opened, tmp_path):
    for name in scene_names():
        opened.tab.click("#tab-start")
        opened.tab.select_option("#scenes", name)
        assert opened.say("refusal") == ""
        event, motion = (
            opened.read_run(tmp_path)["events"][-1],
            start_motion(Settings.from_scene(name)),
        )
        assert event["orientation"] == motion.start.given_orientation.tolist()
        assert event["angular_velocity"] == motion.start.angular_velocity.tolist()
        assert event["top"] == list(motion.top.moments)
        assert event["friction"] == [motion.friction.axial, motion.friction.transverse]
        assert event["torque"] == list(motion.applied_torque)


def test_each_button_of_the_lesson_makes_its_motion(browser, path):
    page = Opened(browser, path, "#lesson=1")
    for number, step in enumerate(read_lesson(), 1):
        assert page.tab.input_value("#steps") == f"{number}. {step.title}"
        for button in page.tab.locator("#lesson-acts button").all():
            before = page.say("why")
            button.click()
            assert page.say("refusal") == ""
            assert page.say("why")
            assert page.say("why") != before or "hold" not in button.text_content()
        if number < len(read_lesson()):
            page.tab.click("#step-next")
    assert page.problems == []
    page.context.close()


def test_a_saved_page_holds_the_run_and_goes_on(opened, browser, tmp_path):
    opened.wait_for_time(0.03)
    opened.tab.click("#hurry")
    wanted = opened.read_run(tmp_path)
    saved = opened.save("This run as a page", tmp_path)
    grown = saved.stat().st_size - len(write_file().encode())
    assert grown < 20_000
    other = Opened(browser, saved)
    assert other.read_run(tmp_path) == wanted
    other.tab.click("#hurry")
    events = other.read_run(tmp_path)["events"]
    assert events[:-1] == wanted["events"]
    assert events[-1]["kind"] == "kick"
    assert other.problems == []
    other.context.close()


def test_a_run_that_is_dropped_is_opened(opened, tmp_path):
    opened.tab.click("#hurry")
    run = opened.read_run(tmp_path)
    opened.tab.click("text=Reset")
    opened.tab.evaluate(
        """(text) => {
            const dataTransfer = new DataTransfer();
            dataTransfer.items.add(new File([text], "run.json"));
            document.dispatchEvent(new DragEvent("drop", {dataTransfer, cancelable: true}));
        }""",
        json.dumps(run),
    )
    opened.until(lambda: "higher" in opened.say("headline"))
    assert opened.read_run(tmp_path) == run


def test_somebody_goes_on_from_an_earlier_moment(opened, tmp_path):
    opened.wait_for_time(0.03)
    opened.tab.click("#hurry")
    first, kick = opened.read_run(tmp_path)["events"]
    opened.wait_for_time(kick["time"] + 0.02)
    opened.tab.evaluate(
        """(time) => {
            const line = document.getElementById("timeline");
            line.value = time;
            line.dispatchEvent(new Event("input"));
            line.dispatchEvent(new Event("change"));
        }""",
        kick["time"] / 2,
    )
    assert opened.say("headline").startswith("The top precesses steadily")
    opened.tab.click("text=Delay")
    events = opened.read_run(tmp_path)["events"]
    assert events[0] == first
    assert len(events) == 2
    assert events[1]["time"] == pytest.approx(kick["time"] / 2, rel=1e-12)


def test_the_series_are_those_of_the_motion(opened, tmp_path):
    opened.wait_for_time(0.03)
    opened.tab.click("text=Pause")
    event = opened.read_run(tmp_path)["events"][0]
    head, *rows = opened.save("Series (CSV)", tmp_path).read_text().splitlines()
    assert head == "time (s),theta (rad),phi_dot (rad/s),psi_dot (rad/s)"
    table = np.array([row.split(",") for row in rows], float)
    states = read_motion(event).at(table[:, 0] - event["time"])
    assert table[:, 1].tolist() == states.euler_angles.theta.tolist()
    assert table[:, 2] == pytest.approx(states.euler_rates.phi, rel=1e-14)


def test_a_refusal_says_what_was_wrong_and_loses_nothing(opened, tmp_path):
    run = opened.read_run(tmp_path)
    opened.tab.click("#tab-start")
    for field, text, refusal in (
        ("theta", "4", "tilt theta must be 0 to pi rad, got 4"),
        ("theta", "abc", "tilt theta must be a number, got abc"),
        ("top\\.Iz", "1", "Ix, Iz and Mgl must be finite"),
        ("friction\\.axial", "-1", "friction.axial must be >= 0 N m s, got -1"),
    ):
        opened.tab.fill(f"#field-{field}", text)
        opened.tab.press(f"#field-{field}", "Enter")
        assert opened.say("refusal").startswith(refusal)
    assert opened.read_run(tmp_path) == run


def test_a_frame_of_another_site_shows_the_top(browser, path):
    tab = browser.new_context(offline=True).new_page()
    tab.set_content("<iframe sandbox='allow-scripts' style='width: 900px; height: 700px'></iframe>")
    tab.evaluate("(page) => { document.querySelector('iframe').srcdoc = page; }", path.read_text())
    frame = tab.frame_locator("iframe")
    frame.locator("#headline:not(:empty)").wait_for()
    frame.locator("#hurry").click()
    assert "higher" in frame.locator("#headline").text_content()
    tab.context.close()


@pytest.mark.parametrize(
    ("missing", "said"),
    [
        ("HTMLCanvasElement.prototype.getContext = () => null", "has no WebGL 2"),
        ("WebAssembly.instantiate = () => Promise.reject(new Error('forbidden'))", "forbidden"),
    ],
)
def test_a_browser_that_cannot_show_it_says_so(browser, path, missing, said):
    tab = browser.new_context(offline=True).new_page()
    tab.add_init_script(missing)
    tab.goto(path.as_uri())
    tab.wait_for_selector("#refusal:not([hidden])")
    assert said in tab.text_content("#refusal")
    tab.context.close()


def test_scripts_find_the_motions_of_python(opened):
    top, angular_velocity = {"Ix": 0.000228, "Iz": 0.0000572, "Mgl": 0.068}, [1.0, 2.0, 200.0]
    start = {**top, "orientation": [0.8, 0.6, 0, 0], "angular_velocity": angular_velocity}
    found = opened.tab.evaluate(
        """(start) => {
            const motion = window.symtop.motion(start);
            return [motion.at(3.7), motion.kind, motion.turning_angles, motion.nutation_period];
        }""",
        start,
    )
    motion = Motion(Top(**top), State(start["orientation"], angular_velocity))
    state = np.concatenate(motion.at(3.7).parts).tolist()
    assert found == [state, motion.kind, list(motion.turning_angles), motion.nutation_period]


def test_the_picture_moves_and_can_be_saved(opened, tmp_path):
    pictures = set()
    for _ in range(2):
        pictures.add(opened.save("Picture (PNG)", tmp_path).read_bytes())
        opened.tab.click("text=Step")
    assert len(pictures) == 2
    assert all(len(picture) > 5000 for picture in pictures)


def test_a_torque_acts_while_its_button_is_held(opened, tmp_path):
    opened.tab.click("#tab-push")
    button = opened.tab.locator("[data-hold='1']")
    button.dispatch_event("pointerdown")
    opened.tab.wait_for_timeout(200)
    button.dispatch_event("pointerup")
    opened.tab.wait_for_timeout(700)
    events = opened.read_run(tmp_path)["events"]
    torques = [event["torque"] for event in events if event["kind"] == "torque"]
    assert torques == [[0, 0, pytest.approx(0.0075 * 0.068)], [0, 0, 0]]


def test_a_push_changes_the_rates_as_it_says(opened, tmp_path):
    opened.tab.click("text=Pause")
    opened.tab.click("#tab-push")
    before = opened.read_run(tmp_path)["events"][-1]
    opened.tab.click("#tab-push")
    for way in ("up", "along"):
        opened.tab.click(f"[data-push={way}]")
    *_, up, along = opened.read_run(tmp_path)["events"]
    rates = [read_state(event).euler_rates for event in (before, up, along)]
    assert rates[1].theta - rates[0].theta == pytest.approx(-1.0, rel=1e-12)
    assert rates[2].phi - rates[1].phi == pytest.approx(1.0, rel=1e-12)
    assert math.isclose(along["angular_velocity"][2], up["angular_velocity"][2], rel_tol=1e-15)


@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_there_is_no_finding_of_axe(browser, path, scheme):
    axe = pytest.importorskip("axe_playwright_python.sync_playwright").Axe()
    page = Opened(browser, path, color_scheme=scheme)
    for name in ("start", "push", "history", "view", "save", "lesson"):
        page.tab.click(f"#tab-{name}")
        found = axe.run(page.tab).response["violations"]
        assert [(each["id"], [n["html"][:120] for n in each["nodes"]]) for each in found] == []
    page.context.close()


def test_an_angle_is_understood_with_its_unit(opened, tmp_path):
    angles = {
        "pi/4": math.pi / 4,
        "π/3": math.pi / 3,
        "30°": math.pi / 6,
        "45 deg": math.pi / 4,
        "0.6 rad": 0.6,
        "0,7": 0.7,
        "2*pi/5": 2 * math.pi / 5,
        "1e-3": 1e-3,
        "pi": math.pi,
    }
    for text, theta in angles.items():
        opened.tab.click("#tab-start")
        opened.tab.fill("#field-theta", text)
        opened.tab.press("#field-theta", "Enter")
        assert opened.say("refusal") == ""
        state = read_state(opened.read_run(tmp_path)["events"][-1])
        assert state.euler_angles.theta == pytest.approx(theta, rel=1e-15)


def test_in_degrees_numbers_and_refusals_are_in_degrees(opened, tmp_path):
    opened.tab.click("#tab-view")
    opened.tab.select_option("#unit", "deg")
    opened.tab.click("#tab-start")
    opened.tab.fill("#field-theta", "200")
    opened.tab.press("#field-theta", "Enter")
    assert opened.say("refusal") == "tilt theta must be 0 to 180°, got 200"
    opened.tab.press("#field-theta", "Escape")
    assert opened.say("refusal") == ""
    opened.tab.fill("#field-theta", "60")
    opened.tab.press("#field-theta", "Enter")
    state = read_state(opened.read_run(tmp_path)["events"][-1])
    assert state.euler_angles.theta == pytest.approx(math.pi / 3, rel=1e-15)
    opened.tab.reload()
    opened.tab.wait_for_selector("#headline:not(:empty)")
    assert opened.tab.input_value("#unit") == "deg"  # the choice is kept
    assert "°" in opened.say("headline")


def test_the_slider_reaches_the_lower_vertical(opened, tmp_path):
    slider = opened.tab.get_by_label("tilt theta").locator("visible=true").last
    slider.evaluate("(each) => { each.value = 3.15; each.dispatchEvent(new Event('input')); }")
    opened.until(lambda: "3.142" in opened.say("headline"))
    assert opened.say("refusal") == ""
    state = read_state(opened.read_run(tmp_path)["events"][-1])
    assert state.euler_angles.theta == math.pi


def test_caps_lock_disables_no_key(opened):
    opened.tab.keyboard.press("H")
    assert "higher" in opened.say("headline")


def test_back_is_the_step_before(browser, path):
    page = Opened(browser, path, "#lesson=2")
    page.tab.fill("#prediction", "it falls")
    page.tab.click("#step-next")
    assert page.tab.input_value("#steps").startswith("3.")
    page.tab.go_back()
    page.until(lambda: page.tab.input_value("#steps").startswith("2."))
    assert page.tab.input_value("#prediction") == "it falls"
    assert page.problems == []
    page.context.close()


def test_an_event_keeps_its_nanosecond_and_what_was_asked(opened, tmp_path):
    opened.wait_for_time(0.01)
    opened.tab.click("#hurry")
    opened.tab.click("#tab-push")
    for way in ("up", "along"):
        opened.tab.click(f"[data-push={way}]")
    _, kick, up, along = opened.read_run(tmp_path)["events"]
    for event in (kick, up, along):
        assert round(event["time"] * 1e9) / 1e9 == event["time"]
    assert kick["act"] == {"precession_rate_factor": 1.4, "hold": "spin_rate"}
    assert along["act"] == {"precession_rate_change": 1, "hold": "spin_momentum"}
    before = read_motion(kick).at(round((up["time"] - kick["time"]) * 1e9) / 1e9)
    after = apply_impulse(Top(*up["top"]), before, up["act"]["angular_impulse"])
    assert up["angular_velocity"] == after.angular_velocity.tolist()
