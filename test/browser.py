"""Chromium for tests, with few frames, and with the lines counted that its pages run."""

from __future__ import annotations

import contextlib
import os
from collections.abc import Callable, Iterator
from typing import TYPE_CHECKING, Any

import pytest

from workshop import page_coverage
from workshop.browser import launch

if TYPE_CHECKING:
    from playwright.sync_api import Browser, Page

SLOWED = "SLOWED_PAGES"  # a variable: how many times slower than the processor pages are
# Software takes all the time of a processor for sixty frames a second; a test needs few: four.
FEW_FRAMES = """
window.requestAnimationFrame = (draw) => setTimeout(() => draw(performance.now()), 250);
window.cancelAnimationFrame = clearTimeout;
"""


@contextlib.contextmanager
def running_browser() -> Iterator[Browser]:
    """Run a browser; the test is skipped without one."""
    api = pytest.importorskip(
        "playwright.sync_api", reason="no playwright: pip install -e '.[test]' in the checkout"
    )
    with _playwright(api) as playwright:
        try:
            browser = launch(playwright)
        except FileNotFoundError as error:
            pytest.skip(str(error))
        new_page = browser.new_page

        def open_page(**options: Any) -> Page:
            tab = new_page(**{"locale": "en-US", **options})  # else that of the machine
            tab.add_init_script(FEW_FRAMES)
            return tab

        browser.new_page = open_page  # type: ignore[method-assign]
        if rate := os.environ.get(SLOWED):
            _slow(browser, float(rate))
        try:
            with _counting(browser) if page_coverage.FOLDER else contextlib.nullcontext():
                yield browser
        finally:
            browser.close()


def _watch_tabs(browser: Browser, watch: Callable[[Any], None]) -> None:
    """Watch the tabs that a browser opens, and those of its contexts."""
    new_context = browser.new_context

    def open_context(**options: Any) -> Any:
        context = new_context(**options)
        watch(context)
        return context

    watch(browser)
    browser.new_context = open_context  # type: ignore[method-assign]


def _slow(browser: Browser, rate: float) -> None:
    """Slow down the tabs that a browser opens, and those of its contexts."""

    def watch(owner: Any) -> None:
        new_page = owner.new_page

        def open_page(**options: Any) -> Page:
            tab = new_page(**options)
            session = tab.context.new_cdp_session(tab)
            session.send("Emulation.setCPUThrottlingRate", {"rate": rate})
            return tab

        owner.new_page = open_page

    _watch_tabs(browser, watch)


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

    _watch_tabs(browser, watch)
    yield
    counter.take()
    counter.write(str(page_coverage.FOLDER))
