"""The films of the tests have the same bytes in each run, however busy the machine is."""

import contextlib
import subprocess
import sys

import numpy as np
import pytest
from films import draw_balls, write_film

COUNT = 12
BUSY = 8  # programs next to this one
LOOP = [sys.executable, "-c", "print(flush=True)\nwhile True: pass"]


@contextlib.contextmanager
def busy():
    """A machine that other programs keep busy."""
    with contextlib.ExitStack() as stack:
        for _ in range(BUSY):
            loop = stack.enter_context(subprocess.Popen(LOOP, stdout=subprocess.PIPE))
            stack.callback(loop.kill)
            loop.stdout.readline()
        yield


def draw_noise():
    """Large pictures of noise, which take long to encode."""
    noise = np.random.default_rng(1).integers(-20, 20, (720, 1280, 3))
    centres = [(200 + 60 * k, 300 + 20 * k) for k in range(COUNT)]
    for picture in draw_balls(centres, (1280, 720), radius=40.0):
        yield np.clip(picture + noise, 0, 255).astype(np.uint8)


@pytest.mark.slow
def test_a_film_is_the_same_file_alone_and_on_a_busy_machine(tmp_path):
    """Of VP8, whose encoder can adapt to the time that it has; that of H.264 cannot."""
    times = [k / 60 for k in range(COUNT)]
    alone = write_film(tmp_path / "alone.webm", draw_noise(), times)
    with busy():
        other = write_film(tmp_path / "busy.webm", draw_noise(), times)
    assert alone.read_bytes() == other.read_bytes()
