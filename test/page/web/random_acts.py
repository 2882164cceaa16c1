"""Random acts on the page in Chromium: no error, no stop, and a run that Python reads."""

import json
import random
import tempfile
from collections import Counter
from pathlib import Path

from page.web.odd_tops import draw_start, write_address
from page.web.opened import UNDRAWN, Opened
from run.simulation.page_runs import find_refusal, list_hostile_runs

from symtop_ros.page.web.join import write_file
from symtop_ros.run.simulation.presets import scene_names

HOSTILE = [run for _, run in list_hostile_runs()]
KEYS = (
    *"hhhddccssr ",
    *(f"{shift}Arrow{way}" for way in ("Up", "Left") for shift in ("", "Shift+")),
)
FIELDS = ("theta", "psi_dot", "phi_dot", "factor", "top.Ix", "top.Mgl", "friction.axial")
TEXTS = ("0", "1", "pi/3", "-5", "1e-9", "1e20", "-1e99", "1e300", "abc", "")
SPEEDS = ("1", "0.1", "0.01")
SIZES = ("width", "height")
FRAMES = 2  # that follow an act


class Trial:
    """A page on which acts are drawn and done, one after the other."""

    def __init__(self, browser, folder, seed):
        self.browser = browser
        self.folder = Path(folder)
        self.rng = random.Random(seed)
        self.acts = Counter()
        path = self.folder / "top.html"
        path.write_text(write_file(), encoding="utf-8")
        self.page = self.open(path)

    def open(self, path):
        return Opened(self.browser, "patches.countFrames();" + UNDRAWN).open(path)

    def act(self, names):
        """Do one of some acts; return its name. The page runs on, and Python reads its run."""
        name = self.rng.choice(names)
        self.acts[name] += 1
        getattr(self, f"do_{name}")()
        self.wait_for_frames(FRAMES)
        assert self.page.problems == [], (name, self.page.problems[:3])
        run = self.page.read_run()
        refusal = find_refusal(run)
        assert refusal == "", (name, refusal, json.dumps(run)[-2000:])
        return name

    def wait_for_frames(self, count):
        read = "window.framesDone"
        wanted = self.page.tab.evaluate(read) + count
        self.page.until(lambda: self.page.tab.evaluate(read) >= wanted)

    # Acts, of which those that are done often stand in `ACTS` more than once

    def do_start(self):
        address = write_address(draw_start(self.rng))
        self.page.follow(address)

    def do_scene(self):
        self.page.follow(f"scene={self.rng.choice(scene_names())}")

    def do_key(self):
        for _ in range(self.rng.randint(1, 5)):
            self.page.press(self.rng.choice(KEYS).replace(" ", "Space"))

    def do_field(self):
        self.page.enter(self.rng.choice(FIELDS), self.rng.choice(TEXTS))

    def do_friction(self):
        scene = self.rng.choice(("friction", "vertical_torque", "sleeping_wakes", "cusps", "disc"))
        self.page.follow(f"scene={scene}")
        self.page.enter("friction.axial", self.rng.choice(("0", "2e-6", "1e-5")))

    def do_torque(self):
        self.page.open_tab("push")
        button = self.page.tab.locator(f"[data-sign='{self.rng.choice((1, -1))}']")
        button.dispatch_event("pointerdown")
        self.wait_for_frames(self.rng.randint(0, 10))
        button.dispatch_event("pointerup")

    def do_pull(self):
        box = self.page.tab.locator("#picture").bounding_box()
        x, y = (box[k] + self.rng.random() * box[size] for k, size in zip("xy", SIZES, strict=True))
        self.page.drag(x, y, self.rng.uniform(-90, 90), self.rng.uniform(-90, 90))
        self.page.tab.mouse.up()

    def do_scrub(self):
        end = self.page.read_run()["end"]
        for _ in range(self.rng.randint(1, 4)):
            self.page.seek(self.rng.uniform(-0.1, 1.1) * end)

    def do_speed(self):
        self.page.tab.evaluate("acts.change", ["speed", self.rng.choice(SPEEDS)])

    def do_run(self):
        if self.page.say("pause") == "Run":
            self.page.press("Space")
        self.wait_for_frames(self.rng.randint(0, 25))

    def do_restart(self):
        self.page.open_tab("history")
        buttons = self.page.tab.locator("#entries button")
        buttons.nth(self.rng.randrange(buttons.count())).click()

    def do_hostile(self):
        self.page.drop(self.rng.choice(HOSTILE))

    def do_series(self):
        self.page.save("Series (CSV)", self.folder)

    def do_reload(self):
        self.page.reload()

    def do_save_and_open(self):
        saved = self.page.save("This run as a page", self.folder)
        text = saved.read_text(encoding="utf-8").split('id="top-run">')[1]
        run = json.loads(text.split("</script>")[0])  # a torque may have ended on the way
        self.page.close()
        self.page = self.open(saved)
        if self.page.say("pause") == "Run":  # what could not be loaded would run
            assert self.page.read_events() == run["events"]

    def do_save_and_drop(self):
        saved = self.page.save("This run (JSON)", self.folder)
        self.page.drop(json.loads(saved.read_text()))

    def do_lesson(self):
        self.page.follow(f"lesson={self.rng.randint(1, 11)}")
        self.page.tab.locator("#lesson-acts button:enabled").first.click()


ACTS = (
    *Counter(start=6, key=6, field=4, scrub=4, run=3).elements(),
    "scene",
    "torque",
    "pull",
    "speed",
    "restart",
    "hostile",
    "series",
    "reload",
    "save_and_open",
    "save_and_drop",
    "lesson",
)


def run(browser, seed, count):
    """Do so many acts; return how often each was done."""
    with tempfile.TemporaryDirectory() as folder:
        trial = Trial(browser, folder, seed)
        for _ in range(count):
            try:
                trial.act(ACTS)
            except BaseException:
                print(f"seed {seed}, act {trial.acts.total()}, {trial.page.tab.url[-300:]}")
                raise
        trial.page.close()
    return trial.acts
