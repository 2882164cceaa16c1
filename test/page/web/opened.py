"""The page as one file in a tab of Chromium, without a network."""

import contextlib
import json
import os
import time
from pathlib import Path

from waiting import TIMEOUT

from symtop_ros.physics import ExactTimes, Friction, Motion, State, Top

NO_REQUESTS = "file:", "blob:", "data:"
FILES = (Path(__file__).with_name(f"{name}.js") for name in ("acts", "looks", "patches"))
FUNCTIONS = "".join(path.read_text() for path in FILES)
# Software draws the scene here: a few frames a second are enough, and leave time for the test.
FEW_FRAMES = """
const requestFrame = window.requestAnimationFrame.bind(window);
window.requestAnimationFrame = (draw) => setTimeout(() => requestFrame(draw), 120);
"""
# Most tests do not look at the scene, and software would draw it on their processors: all that a
# page asks of a graphics card is answered, and nothing is done.
UNDRAWN = """
const card = WebGL2RenderingContext.prototype;
for (const [name, { value }] of Object.entries(Object.getOwnPropertyDescriptors(card)))
    if (typeof value === "function") card[name] = () => ({});
card.isContextLost = () => false;
const getDrawnContext = HTMLCanvasElement.prototype.getContext;
HTMLCanvasElement.prototype.getContext = function (kind, ...options) {
    return kind === "webgl2" ? Object.create(card) : getDrawnContext.call(this, kind, ...options);
};
"""


# Who comes again is not asked the first question, and may have chosen rad. Nothing is written: what
# is written so early is lost now and then when the page is loaded again.
KNOWN = """
const getStored = Storage.prototype.getItem;
Storage.prototype.getItem = function (key) {
    const known = {"symtop.answer": "rises", "symtop.unit": "rad"};
    return getStored.call(this, key) ?? known[key] ?? null;
};
"""


def slow_frames(milliseconds):
    """Return a script by which each frame takes so long: timers and frames are late."""
    return f"""
const drawLate = window.requestAnimationFrame.bind(window);
window.requestAnimationFrame = (draw) => drawLate((now) => {{
    const end = performance.now() + {milliseconds};
    while (performance.now() < end);
    draw(now);
}});
"""


# Of a trial on a page that draws slowly, in ms: SLOW_FRAMES=300 pytest test/page/web
SLOW = os.environ.get("SLOW_FRAMES")
USUAL = FEW_FRAMES + UNDRAWN + (slow_frames(int(SLOW)) if SLOW else "")
PATIENCE = 5.0  # s
AS_OPENED = "theta=0.5&psi_dot=200&precession=slow"
WINDOW = {"width": 1280, "height": 720}
MEDIA = {"media": "null", "color_scheme": "light", "reduced_motion": "null"}
MEDIA |= {"forced_colors": "null"}


class Opened:
    """The file in a tab, with what went wrong; of a browser that knows the page, or does not."""

    def __init__(self, browser, script=USUAL, known=KNOWN, locale="en-US"):
        self.context = browser.new_context(offline=True, locale=locale)  # else of the machine
        self.context.add_init_script(FUNCTIONS + known + script)
        self.tab = self.context.new_page()
        self.tab.set_default_timeout(TIMEOUT * 1000)
        self.problems, self.requests = [], []
        self.tab.on("console", self._note)
        self.tab.on("pageerror", lambda error: self.problems.append(str(error)))
        self.tab.on("request", lambda request: self.requests.append(request.url))

    def open(self, path, fragment="", viewport=WINDOW, **media):
        """Open the file, in a window and for eyes of some kind."""
        self.tab.set_viewport_size(viewport)
        self.tab.emulate_media(**{**MEDIA, **media})
        self.tab.goto(path.as_uri() + fragment)
        self.wait_for_page()
        return self

    def close(self):
        """Close the tab; nothing went wrong in it, and it asked for nothing from elsewhere."""
        self.context.close()
        self.check()

    def check(self):
        assert self.problems == [], self.problems[:5]
        assert all(request.startswith(NO_REQUESTS) for request in self.requests)

    def leave(self):
        """Leave the page, as before a first visit of the browser; nothing went wrong in it."""
        for other in self.context.pages[1:]:
            other.close()
        self.tab.mouse.move(0, 0)
        self.tab.goto("about:blank")
        self.check()
        self.requests.clear()
        stored = {"origin": "file://", "storageTypes": "all"}
        self.context.new_cdp_session(self.tab).send("Storage.clearDataForOrigin", stored)

    def put_back(self):
        """Start what a page starts that is opened, with nothing stored; nothing went wrong."""
        self.check()
        self.tab.mouse.move(0, 0)
        self.choose_unit("rad")
        self.tab.evaluate("() => { localStorage.clear(); history.replaceState(null, '', '#'); }")
        self.follow(AS_OPENED)
        assert self.say("refusal") == ""

    def _note(self, message):
        """Note what is written to the console, except a driver's remark on its speed."""
        if "GL Driver Message (OpenGL, Performance" not in message.text:
            self.problems.append(message.text)

    def wait_for_page(self):
        """Wait for the page; one with a problem that is not there a while later never will be."""
        deadline = time.monotonic() + TIMEOUT
        while not self._waits_for_headline():
            assert not self.problems, f"the page does not start: {self.problems[:5]}"
            assert time.monotonic() < deadline, "the page does not start, and says nothing"

    def _waits_for_headline(self):
        """Return True as soon as there is a headline, False if there is none after a while."""
        from playwright.sync_api import TimeoutError as LateError  # where there is no browser

        with contextlib.suppress(LateError):
            self.tab.wait_for_selector(
                "#headline:not(:empty)", state="attached", timeout=PATIENCE * 1000
            )
            return True
        return False

    def reload(self):
        self.tab.reload()
        self.wait_for_page()

    def wait_for_frames(self, count=2):
        """Wait until the page has drawn: what was asked for before is then shown."""
        self.tab.evaluate("acts.waitForFrames", count)

    def wait_for_texts(self):
        """Wait until the page has written the texts that follow the motion, four times a second."""
        self.tab.evaluate("() => new Promise((done) => setTimeout(done, 250))")
        self.wait_for_frames()

    def is_stored(self, name, value, tab=None):
        """Return True if a tab, one's own or another of the browser, finds a value in the store.

        Another tab may have a separate process, which hears of changes somewhat later.
        """
        read = "(name) => localStorage.getItem(`symtop.${name}`)"
        return value in ((tab or self.tab).evaluate(read, name) or "")

    def drop(self, run):
        """Drop a file with a run."""
        self.tab.evaluate("acts.drop", ["run.json", json.dumps(run)])

    def follow(self, fragment):
        """Follow a link to this page."""
        self.tab.evaluate("(fragment) => { location.hash = fragment; }", fragment)
        self.tab.wait_for_timeout(0)

    def start_scene(self, name):
        self.open_tab("start")
        self.tab.select_option("#scenes", name)
        self.tab.click("#start-scene")

    def say(self, name):
        """Return a text before its symbols became formulas."""
        place = self.tab.locator(f"#{name}")
        return place.get_attribute("data-text") or place.text_content()

    def open_tab(self, name):
        """Open the panel of a tab, if it is not open."""
        if not self.tab.is_visible(f"#{name}"):
            self.tab.click(f"#tab-{name}")

    def show_arrows(self, *layers):
        """Click on the words of some arrows."""
        for layer in layers:
            self.tab.click(f"#legend .word[data-layer={layer}]")

    def open_charts(self, *names):
        """Open charts, or all of them."""
        self.tab.evaluate("acts.openCharts", names)

    def enter(self, name, text):
        """Type a value into a field of a tab, and take it over."""
        field = self.tab.locator(f"[id='field-{name}']")
        self.open_tab("push" if name == "factor" else "start")
        field.focus()  # a field of a moving top shows the start then, and what was selected is not
        field.fill(text)
        field.press("Enter")

    def ask(self, question, *texts):
        """Choose a question of what is seen, type what is known, and press the button."""
        self.open_tab("start")
        self.tab.evaluate("() => { document.getElementById('seen').open = true; }")
        self.tab.select_option("#questions", question)
        for name, text in zip(question.split(), texts, strict=True):
            self.tab.fill(f"#known-{name}", text)
        self.tab.click("#solve")

    def list_solutions(self):
        return self.tab.locator("#solutions button").all_inner_texts()

    def choose_unit(self, unit):
        self.open_tab("view")
        self.tab.select_option("#unit", unit)

    def drag(self, x, y, right, down):
        """Move the pointer to a place, and with its button held by some pixels."""
        self.tab.mouse.move(x, y)
        self.tab.mouse.down()
        self.tab.mouse.move(x + right, y + down)

    def press(self, key):
        """Press a key while no field has the focus."""
        self.tab.evaluate("document.activeElement.blur()")
        self.tab.keyboard.press(key)

    def save(self, text, folder):
        """Download what a button of the tab Save gives; return its path."""
        self.open_tab("save")
        with self.tab.expect_download() as download:
            self.tab.click(f"text={text}")
        target = folder / download.value.suggested_filename
        download.value.save_as(target)
        return target

    def read_labels(self):
        """Return the places of the labels, which move with the camera."""
        self.wait_for_frames()
        labels = self.tab.locator(".label:visible")
        return labels.evaluate_all("all => all.map(e => e.style.transform)")

    def read_run(self):
        return self.tab.evaluate("window.symtop.run()")

    def read_events(self):
        return self.read_run()["events"]

    def read_last(self):
        """Return the state after the last event."""
        return read_state(self.read_events()[-1])

    def until(self, condition):
        """Wait, while the browser works; its own way would need what the page forbids."""
        deadline = time.monotonic() + TIMEOUT
        while not condition():
            assert time.monotonic() < deadline, (self.say("headline"), self.say("refusal"))
            self.tab.wait_for_timeout(40)

    def wait_for_time(self, seconds):
        """Wait until the run is longer than some seconds."""
        assert self.tab.evaluate("acts.waitForTime", [seconds, TIMEOUT]), self.say("refusal")

    def seek(self, seconds):
        """Move the slider of the run to a time."""
        self.tab.evaluate("acts.change", ["timeline", seconds])


def read_state(event):
    return State(event["orientation"], event["angular_velocity"])


def read_motion(event):
    acting = Friction(*event["friction"]), event["torque"]
    clamped = event.get("clamped", False)
    return Motion(Top(*event["top"]), read_state(event), *acting, clamped=clamped)


def find_time(before, event):
    """Return the exact time between two events, which is a whole number of nanoseconds."""
    return ExactTimes(round(event["time"] * 1e9) - round(before["time"] * 1e9))
