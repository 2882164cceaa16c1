"""Rerun's viewer without a screen: renders recordings to PNG and reports what is wrong in them."""

import contextlib
import glob
import io
import json
import os
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any, TypeVar
from unittest import SkipTest  # a test that finds no driver is skipped

import numpy as np
from PIL import Image
from rerun.experimental import ViewerClient

from symtop_ros.replay import viewer
from symtop_ros.replay.viewer import HOST
from workshop.load.endings import bound

DRIVER = Path(sys.prefix, "vulkan")  # where `make test` unpacks one
TIMEOUT = 300.0  # s; ends a test that hangs, with many busy programs, too
SIZE = "1600x900"
Found = TypeVar("Found")


def _environment() -> dict[str, str]:
    """A software driver of our own, or whatever is installed."""
    libraries = glob.glob(f"{DRIVER}/usr/lib/*/libvulkan_lvp.so")
    if not libraries:
        if not glob.glob("/usr/share/vulkan/icd.d/*.json"):
            msg = "no Vulkan driver: sh test/get_vulkan.sh .venv/vulkan, or mesa-vulkan-drivers"
            raise SkipTest(msg)
        return dict(os.environ)
    manifest = DRIVER / "icd.json"
    icd = {"api_version": "1.1.230", "library_path": libraries[0]}
    manifest.write_text(json.dumps({"ICD": icd, "file_format_version": "1.0.0"}))
    folders = [str(Path(libraries[0]).parent), os.environ.get("LD_LIBRARY_PATH", "")]
    return {
        **viewer.settings(),
        "VK_ICD_FILENAMES": str(manifest),
        "LD_LIBRARY_PATH": os.pathsep.join(filter(None, folders)),
    }


@contextlib.contextmanager
def running_viewer(*files: Path, port: int | None = None) -> Iterator[tuple[ViewerClient, int]]:
    """A viewer of files, and the port it listens on; it has ended afterwards."""
    port = port or viewer.free_port()
    options = ["--bind", HOST, "--port", str(port), "--headless", "--window-size", SIZE]
    process = subprocess.Popen(
        bound([str(viewer.PROGRAM), *options, *map(str, files)]),
        env=_environment(),
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
    )
    try:
        yield _connect(port, process), port
    finally:
        process.terminate()
        process.wait()


def _wait(attempt: Callable[[], Found | None], failure: str) -> Found:
    """Return what an attempt finds at last."""
    deadline = time.monotonic() + TIMEOUT
    while (found := attempt()) is None:
        assert time.monotonic() < deadline, failure
        time.sleep(0.1)
    return found


def _connect(port: int, process: subprocess.Popen[bytes]) -> ViewerClient:
    def attempt() -> ViewerClient | None:
        assert process.poll() is None, "the viewer ended"
        with contextlib.suppress(Exception):
            client = ViewerClient.connect(f"rerun+http://{HOST}:{port}/proxy")
            client.get_state()
            return client
        return None

    return _wait(attempt, "the viewer did not answer")


def views(client: ViewerClient, count: int) -> dict[str, Any]:
    """Views by name, as soon as there are so many."""

    def attempt() -> dict[str, Any] | None:
        found = {each.name: each for each in client.get_state().views}
        return found if len(found) >= count else None

    return _wait(attempt, f"there are fewer than {count} views")


def pause_at(client: ViewerClient, timeline: str, **time_of: Any) -> None:
    """Pause at a time, as soon as the viewer has read so much that the timeline exists."""

    def attempt() -> bool | None:
        with contextlib.suppress(ConnectionError):
            client.set_time(timeline, play_state="paused", **time_of)
            return True
        return None

    _wait(attempt, f"no timeline {timeline}")


def picture(client: ViewerClient, view: Any = None) -> np.ndarray:
    """Return the picture (height, width, 3) when it no longer changes."""
    deadline = time.monotonic() + TIMEOUT
    before = None
    while (shot := _shot(client, view)) is None or shot != before:
        assert time.monotonic() < deadline, "the picture never came to rest"
        before = shot
        time.sleep(0.2)
    return np.asarray(Image.open(io.BytesIO(shot)).convert("RGB"))


def _shot(client: ViewerClient, view: Any) -> bytes | None:
    """A PNG; nothing while a view that was announced is not drawn yet."""
    try:
        return client.take_screenshot(view and view.view_id)
    except ConnectionError:
        return None
