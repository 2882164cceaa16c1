"""The pictures of the page in the docs: each is a run that the page opens, at its end.

python -m workshop.pictures.page [FOLDER]
"""

import io
import sys
import tempfile
from collections.abc import Mapping
from pathlib import Path
from typing import Any, Literal, NamedTuple

import yaml
from PIL import Image
from playwright.sync_api import Browser, Page, sync_playwright

from symtop_ros.page.web.join import read_record, write_file
from symtop_ros.physics import ExactTimes, Motion
from symtop_ros.run.simulation.changes.requests import plan_kick, start_motion
from symtop_ros.run.simulation.run_file import RunEvent, write_run
from symtop_ros.run.simulation.settings import Settings
from workshop.browser import launch
from workshop.pictures.pack import pack_shaded

ROOT = Path(__file__).parents[2]
DOCS = ROOT / "docs"
EXAMPLE = ROOT / "symtop_ros/truth/fit/example.csv"
TIMEOUT = 60_000  # ms
# The canvas is drawn twice as large and shrunk: its edges are smooth, as with a graphics card.
SMOOTH = "Object.defineProperty(window, 'devicePixelRatio', {value: 2})"


class Picture(NamedTuple):
    """A picture; `page.yaml` says what the fields are."""

    name: str
    window: tuple[int, int]
    scene: str
    act: Mapping[str, Any] = {}
    nutations: tuple[float, float] = (0.0, 0.0)
    scheme: Literal["light", "dark"] = "light"
    tab: str = ""
    step: int = 0
    prediction: str = ""
    record: bool = False
    fitted: bool = False


TABLE = Path(__file__).with_suffix(".yaml").read_text(encoding="utf-8")
PICTURES = [Picture(name, **facts) for name, facts in yaml.safe_load(TABLE).items()]


def main(folder: Path) -> None:
    """Draw all pictures into a folder."""
    with sync_playwright() as playwright:
        browser = launch(playwright)
        for picture in PICTURES:
            print(f"wrote {draw(browser, picture, folder)}")
        browser.close()


def draw(browser: Browser, picture: Picture, folder: Path) -> Path:
    """Draw a picture."""
    path = folder / f"{picture.name}.png"
    width, height = picture.window
    with tempfile.TemporaryDirectory() as place:
        file = Path(place, "top.html")
        is_played = picture.record or any(picture.nutations)
        run = play(picture) if is_played else None  # without one it asks its question
        file.write_text(write_file(run=run), encoding="utf-8")
        tab = browser.new_page(
            viewport={"width": width, "height": height},
            color_scheme=picture.scheme,
            reduced_motion="reduce",  # it begins at rest
        )
        tab.add_init_script(SMOOTH)
        tab.goto(file.as_uri() + (f"#lesson={picture.step}" if picture.step else ""))
        tab.wait_for_selector("#headline:not(:empty)", state="attached", timeout=TIMEOUT)
        if picture.prediction:
            tab.get_by_label("Your prediction").fill(picture.prediction)
        elif picture.tab:
            tab.get_by_role("tab", name=picture.tab).click()
        if picture.fitted:
            fit(tab)
        tab.mouse.move(width / 2, 5)
        tab.wait_for_timeout(3000)  # the browser may be some frames behind
        with Image.open(io.BytesIO(tab.screenshot())) as shot:
            path.write_bytes(pack_shaded(shot))
        tab.close()
    return path


def fit(tab: Page) -> None:
    """Fit the example of `top_fit` on the page."""
    tab.set_input_files("#measured-file", EXAMPLE)
    tab.get_by_role("button", name="Fit", exact=True).click()
    tab.wait_for_selector("#fitted:not(:empty)", timeout=TIMEOUT)
    tab.evaluate("document.querySelector('#fitted').scrollIntoView()")


def play(picture: Picture) -> dict[str, Any]:
    """Return the run of a picture."""
    if picture.record:
        return read_record(1)
    motion = start_motion(Settings.from_scene(picture.scene))
    before, after = picture.nutations
    events = [RunEvent("start", 0, motion, {})]
    now = to_nanoseconds(before, motion)
    if picture.act:
        kicked, _ = plan_kick(motion, motion.at(ExactTimes(now)), picture.act)
        events.append(RunEvent("kick", now, kicked, picture.act))
        now += to_nanoseconds(after, kicked)
    return write_run(events, now)


def to_nanoseconds(nutations: float, motion: Motion) -> int:
    """Return the time of some nutations in ns."""
    return round(nutations * motion.nutation_period * 1e9)


if __name__ == "__main__":
    main(Path(sys.argv[1]) if sys.argv[1:] else DOCS)
