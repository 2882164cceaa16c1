"""Films for tests: frames with their times, as a file of WebM or MP4."""

import struct
from collections.abc import Iterable, Sequence
from fractions import Fraction
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
import pytest

SUFFIXES = {".webm": "vp8", ".mp4": "h264"}
CODECS = {"vp8": "libvpx", "vp9": "libvpx-vp9", "h264": "libx264", "hevc": "libx265"}
QUALITY = 4_000_000  # bit/s: a ball of a few pixels keeps its edge
TICKS = {".webm": 1000, ".mp4": 90_000}  # of a second; WebM has whole milliseconds
# The picture is turned clockwise by so much when it is shown: a, b, c, d of the track's matrix.
TURNS = {0: (1, 0, 0, 1), 90: (0, 1, -1, 0), 180: (-1, 0, 0, -1), 270: (0, -1, 1, 0)}
ONE, TWO = 1 << 16, 1 << 30  # fixed point of the matrix
KEYS = 30  # frames from one that needs no other to the next one


def write_film(
    path: Path,
    frames: Iterable[np.ndarray],
    times: Sequence[float],
    codec: str | None = None,
    turn: int = 0,
) -> Path:
    """Write pictures (h, w, 3) of bytes, each with its time in s, as a film; return its path.

    The sides of a picture are even. Times grow, and are rounded to the ticks of the file (`TICKS`);
    the last frame lasts as long as the shortest. A film of MP4 may be turned, as a phone
    writes it that was held upright.
    """
    av = pytest.importorskip("av", reason="no PyAV: pip install -e '.[test]' in the checkout")
    ticks = TICKS[path.suffix]
    codec = codec or SUFFIXES[path.suffix]
    # a file of WebM has random numbers by default
    with av.open(str(path), "w", options={"fflags": "+bitexact"}) as film:
        stream = None
        for picture, time in zip(frames, times, strict=True):
            if stream is None:
                stream = _add_stream(film, codec, picture.shape, ticks, _find_rate(times, ticks))
            frame = av.VideoFrame.from_ndarray(np.ascontiguousarray(picture), format="rgb24")
            frame.pts = round(time * ticks)
            frame.time_base = Fraction(1, ticks)
            film.mux(stream.encode(frame))
        if stream is not None:
            film.mux(stream.encode())
    if turn:
        _turn(path, turn)
    return path


def _find_rate(times: Sequence[float], ticks: int) -> Fraction:
    """Return the largest rate, which WebM has in its head: browsers read how long a frame lasts."""
    steps = [round(ticks * after) - round(ticks * before) for before, after in pairwise(times)]
    return Fraction(ticks, min(steps, default=ticks // 30))


def _add_stream(film: Any, codec: str, shape: Sequence[int], ticks: int, rate: Fraction) -> Any:
    """Return a stream without frames that come before others that are shown earlier."""
    stream = film.add_stream(CODECS[codec], rate=rate)
    stream.height, stream.width = shape[:2]
    stream.pix_fmt = "yuv420p"
    stream.bit_rate = QUALITY
    stream.codec_context.time_base = Fraction(1, ticks)
    stream.codec_context.gop_size = KEYS
    stream.codec_context.thread_count = 1  # the same file everywhere
    if codec.startswith("vp"):
        # VP8 with a positive speed encodes worse when the machine is busy; a negative one is fixed
        stream.options = {"deadline": "realtime", "cpu-used": "-4", "auto-alt-ref": "0"}
    else:
        stream.options = {
            "preset": "veryfast",
            "bf": "0",
            "x265-params": "log-level=none:bframes=0",
        }
    return stream


def _turn(path: Path, turn: int) -> None:
    """Write the matrix of the track, by which players turn the picture."""
    a, b, c, d = TURNS[turn]
    plain = _write_matrix(1, 0, 0, 1)
    data = path.read_bytes()
    begin = data.index(plain, data.index(b"tkhd"))
    path.write_bytes(data[:begin] + _write_matrix(a, b, c, d) + data[begin + len(plain) :])


def _write_matrix(a: int, b: int, c: int, d: int) -> bytes:
    return struct.pack(">9i", a * ONE, b * ONE, 0, c * ONE, d * ONE, 0, 0, 0, TWO)


def draw_balls(
    centres: Sequence[Sequence[float]],
    size: tuple[int, int] = (320, 240),
    radius: float = 6.0,
    colour: Sequence[int] = (230, 60, 30),
) -> Iterable[np.ndarray]:
    """Yield pictures of a ball on grey ground, at x, y from the upper left corner.

    The edge is as bright as the part of each pixel that the ball covers, so that the centroid of
    the picture is the centre.
    """
    width, height = size
    y, x = np.mgrid[:height, :width] + 0.5
    for centre in centres:
        covered = np.clip(radius + 0.5 - np.hypot(x - centre[0], y - centre[1]), 0, 1)[..., None]
        ground = np.full((height, width, 3), 200.0)
        yield np.round(ground + covered * (np.asarray(colour) - ground)).astype(np.uint8)
