"""Chromium without a screen: the one of the system, or the one that `make test` has unpacked."""

from __future__ import annotations

import contextlib
import os
import shutil
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Any

import page_coverage
import pytest

if TYPE_CHECKING:
    from playwright.sync_api import Browser, Page

UNPACKED = Path(sys.prefix, "chromium")
NAMES = ("chromium", "chromium-browser", "google-chrome")
# Software rendering works on machines without a GPU, and gives the same pictures on all others.
OPTIONS = (
    *("--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"),
    *("--ignore-gpu-blocklist", "--disable-dev-shm-usage", "--disable-gpu-rasterization"),
)
# Software takes all the time of a processor for sixty frames a second; a test needs few: four.
FEW_FRAMES = """
window.requestAnimationFrame = (draw) => setTimeout(() => draw(performance.now()), 250);
window.cancelAnimationFrame = clearTimeout;
"""


@contextlib.contextmanager
def running_browser() -> Iterator[Browser]:
    """Run a browser; the test is skipped without one."""
    api = pytest.importorskip(
        "playwright.sync_api", reason="no playwright: pip install '.[test]' in the checkout"
    )
    program, environment = _find()
    with _playwright(api) as playwright:
        browser = playwright.chromium.launch(
            executable_path=program, args=list(OPTIONS), env=environment
        )
        new_page = browser.new_page

        def open_page(**options: Any) -> Page:
            tab = new_page(**options)
            tab.add_init_script(FEW_FRAMES)
            return tab

        browser.new_page = open_page  # type: ignore[method-assign]
        try:
            with _counting(browser) if page_coverage.FOLDER else contextlib.nullcontext():
                yield browser
        finally:
            browser.close()


_RUNNING: list[Any] = []


@contextlib.contextmanager
def _playwright(api: Any) -> Iterator[Any]:
    """Run Playwright, which a process can do once: browsers within another share its own."""
    if _RUNNING:
        yield _RUNNING[0]
        return
    with api.sync_playwright() as playwright:
        _RUNNING.append(playwright)
        yield playwright
        _RUNNING.clear()


@contextlib.contextmanager
def _counting(browser: Browser) -> Iterator[None]:
    """Count the lines that pages run, until they are closed."""
    counter = page_coverage.Counter()

    def watch(owner: Any) -> None:
        """Count in the tabs that a browser or a context opens."""
        new_page, close = owner.new_page, owner.close

        def open_page(**options: Any) -> Page:
            tab = new_page(**options)
            counter.watch(tab)
            return tab

        def take_and_close() -> None:
            counter.take()
            close()

        owner.new_page, owner.close = open_page, take_and_close

    new_context = browser.new_context

    def open_context(**options: Any) -> Any:
        context = new_context(**options)
        watch(context)
        return context

    watch(browser)
    browser.new_context = open_context  # type: ignore[method-assign]
    yield
    counter.take()
    counter.write(str(page_coverage.FOLDER))


def _find() -> tuple[str, dict[str, str | float | bool]]:
    """Path of the program, and its environment."""
    environment: dict[str, str | float | bool] = {**os.environ}
    unpacked = UNPACKED / "usr/lib/chromium/chromium"
    if unpacked.is_file():
        # Debian puts some libraries into subfolders, such as that of pulseaudio.
        libraries = {str(path.parent) for path in UNPACKED.glob("usr/lib/*-linux-gnu/**/*.so*")}
        environment["LD_LIBRARY_PATH"] = os.pathsep.join(sorted(libraries))
        return str(unpacked), environment
    for name in NAMES:
        if path := shutil.which(name):
            return path, environment
    pytest.skip("no Chromium: sh test/get_chromium.sh .venv/chromium, or install chromium")
