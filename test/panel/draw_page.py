"""Draw the pictures of the page in docs/: PYTHONPATH=test python test/panel/draw_page.py.

`make pictures` runs it. A folder as argument takes the place of docs/.
"""

from __future__ import annotations

import contextlib
import io
import sys
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any, Literal, NamedTuple

from browser import running_browser
from PIL import Image

from symtop_ros.panel.actions import Actions
from symtop_ros.panel.page import Page
from symtop_ros.panel.server import LOCAL_HOST
from symtop_ros.panel.source import LocalTop
from workshop.pictures.pack import pack_shaded

DOCS = Path(__file__).parents[2] / "docs"
STEPS = 64  # of a nutation, so that the trace is smooth
TIMEOUT = 60.0  # s


class Picture(NamedTuple):
    """A picture: file, size of the window, scene, what is done, colours, and the tab."""

    name: str
    width: int
    height: int
    scene: str
    act: Callable[[Actions], Any]
    nutations: tuple[float, float]  # of the motion before and after the act
    scheme: Literal["light", "dark"] = "light"
    tab: str = "Top"


PICTURES = (
    Picture("panel", 1280, 720, "hurry_slow", lambda actions: actions.kick(1.4), (2.9, 2.5)),
    Picture(
        "panel_dark",
        1280,
        720,
        "looping",
        lambda actions: actions.push_tilt(-6.0),
        (2.2, 2.4),
        "dark",
        "History",
    ),
    Picture(
        "panel_tablet",
        820,
        1180,
        "cusps",
        lambda actions: actions.kick(1.0),
        (2.5, 0.0),
        tab="Push",
    ),
    Picture("panel_phone", 390, 844, "hurry_slow", lambda actions: actions.kick(1.4), (2.0, 2.2)),
)
LESSON = Picture("panel_lesson", 1280, 720, "cusps", lambda _: None, (4.0, 0.0))


def main(folder: Path) -> None:
    """Draw all pictures into a folder."""
    for picture in PICTURES:
        with opened(picture) as (page, tab):
            draw(picture, page, tab)
            save(picture, tab, folder)
    with opened(LESSON) as (page, tab):
        draw_lesson(page, tab)
        save(LESSON, tab, folder)


@contextlib.contextmanager
def opened(picture: Picture) -> Iterator[tuple[Page, Any]]:
    """Open a page in a browser for a picture."""
    page = Page(LocalTop(picture.scene, factor=0.1), LOCAL_HOST, 0)
    try:
        with running_browser() as browser:
            yield (
                page,
                browser.new_page(
                    viewport={"width": picture.width, "height": picture.height},
                    color_scheme=picture.scheme,
                ),
            )
    finally:
        page.close()


def draw_lesson(page: Page, tab: Any) -> None:
    """Press a button of a step of the lesson, and let some time pass."""
    tab.goto(f"{page.server.url}/#lesson=10")
    tab.frame_locator("iframe").locator("canvas").first.wait_for(timeout=TIMEOUT * 1000)
    tab.get_by_label("Your prediction").fill("The centrifugal torque lifts it, more and more.")
    tab.get_by_role("button", name="Faster: 9 rad/s").click()
    tab.locator("#headline").filter(has_text="0.439").wait_for(timeout=TIMEOUT * 1000)
    page.actions.request("pause", True)
    page.actions.request("reset")
    move(page, LESSON.nutations[0])


def draw(picture: Picture, page: Page, tab: Any) -> None:
    """Play what a picture shows."""
    tab.goto(page.server.url)
    tab.wait_for_selector("#headline:not(:empty)", timeout=TIMEOUT * 1000)
    tab.frame_locator("iframe").locator("canvas").first.wait_for(timeout=TIMEOUT * 1000)
    page.actions.request("pause", True)
    page.actions.request("reset")
    before, after = picture.nutations
    move(page, before)
    if after:
        picture.act(page.actions)
        move(page, after)
    tab.get_by_role("tab", name=picture.tab).click()


def save(picture: Picture, tab: Any, folder: Path) -> None:
    """Save what the window shows."""
    tab.mouse.move(picture.width / 2, 5)
    tab.wait_for_timeout(3000)  # the browser may be some frames behind
    path = folder / f"{picture.name}.png"
    with Image.open(io.BytesIO(tab.screenshot())) as shot:
        path.write_bytes(pack_shaded(shot))
    print(f"wrote {path}")


def move(page: Page, nutations: float) -> None:
    """Let the paused top move in steps, each of which is drawn."""
    wait_until_drawn(page)
    period = page.run.motion.nutation_period if page.run.motion else 0.0
    for _ in range(round(nutations * STEPS)):
        page.actions.request("step", {"duration": period / STEPS})
        wait_until_drawn(page)


def wait_until_drawn(page: Page) -> None:
    """Wait for a sample after the last event."""
    deadline = time.monotonic() + TIMEOUT
    frame = page.frames
    while page.frames < frame + 2 or not is_drawn(page):
        if time.monotonic() > deadline:
            msg = "the page draws nothing"
            raise TimeoutError(msg)
        time.sleep(0.005)


def is_drawn(page: Page) -> bool:
    """Return True if a sample after the last event was drawn."""
    return page.run.event is not None and page.run.stamp >= page.run.event.stamp


if __name__ == "__main__":
    main(Path(sys.argv[1]) if sys.argv[1:] else DOCS)
