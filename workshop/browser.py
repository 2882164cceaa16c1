"""Chromium without a screen: the one of the system, or the one that `make test` has unpacked."""

from __future__ import annotations

import os
import shutil
import sys
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from playwright.sync_api import Browser, Playwright

UNPACKED = Path(sys.prefix, "chromium")
# If it is set, the shell without windows is used, which is the same browser and opens pages with
# less work; without it, the whole one.
SHELL = "HEADLESS_SHELL"
NAMES = ("chromium", "chromium-browser", "google-chrome")
# Software rendering works on machines without a GPU, and gives the same pictures on all others.
# The layers of a page are joined without OpenGL: that takes a tenth of the time in software. One
# process draws all pages, and functions of the kernel are compiled when they are called: a page is
# opened with a fifth less work.
OPTIONS = (
    "--no-sandbox",
    "--use-angle=swiftshader",
    "--enable-unsafe-swiftshader",
    "--ignore-gpu-blocklist",
    "--disable-dev-shm-usage",
    "--disable-gpu-rasterization",
    "--disable-gpu-compositing",
    "--in-process-gpu",
    "--renderer-process-limit=1",
    "--disable-site-isolation-trials",
    "--js-flags=--wasm-lazy-compilation",
)


def launch(playwright: Playwright) -> Browser:
    """Start a browser; FileNotFoundError says how to get one."""
    program, environment = _find()
    return playwright.chromium.launch(executable_path=program, args=list(OPTIONS), env=environment)


def _find() -> tuple[str, dict[str, str | float | bool]]:
    """Path of the program, and its environment."""
    environment: dict[str, str | float | bool] = {**os.environ}
    wanted = ("chromium-headless-shell", "chromium") if os.environ.get(SHELL) else ("chromium",)
    unpacked = [UNPACKED / "usr/lib/chromium" / name for name in wanted]
    if found := [path for path in unpacked if path.is_file()]:
        # Debian puts some libraries into subfolders, such as that of pulseaudio.
        libraries = {str(path.parent) for path in UNPACKED.glob("usr/lib/*-linux-gnu/**/*.so*")}
        environment["LD_LIBRARY_PATH"] = os.pathsep.join(sorted(libraries))
        return str(found[0]), environment
    for name in NAMES:
        if path := shutil.which(name):
            return path, environment
    raise FileNotFoundError("no Chromium: sh test/get_chromium.sh .venv/chromium, or install it")
