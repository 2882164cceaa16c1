"""Chromium without a screen: the one of the system, or the one that `make test` has unpacked."""

from __future__ import annotations

import contextlib
import os
import shutil
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Any

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
    with api.sync_playwright() as playwright:
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
            yield browser
        finally:
            browser.close()


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
