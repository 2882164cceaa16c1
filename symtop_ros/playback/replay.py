"""A log as a Rerun recording."""

from __future__ import annotations

import sys
from pathlib import Path

import rerun as rr

from symtop_ros.playback.mcap_file import LogError, told
from symtop_ros.playback.scene.scene import Scene
from symtop_ros.playback.top_log import TopLog

APPLICATION = "symtop_ros"
LONG = 20 * 2**20  # bytes; below, a bar would only flash
BAR = 40


def replay(log: TopLog, target: Path) -> None:
    """Write the recording of a log; what is missing in it stands among its events.

    Raises
    ------
    LogError
        Where the log holds no top, or the target cannot be written.
    """
    recording = rr.RecordingStream(APPLICATION, recording_id=log.file.path.stem)
    try:
        target.open("wb").close()  # Rerun would only warn
        recording.save(target)
    except (OSError, RuntimeError) as error:
        msg = f"{target}: {getattr(error, 'strerror', None) or error}"
        raise LogError(msg) from None
    scene = Scene(recording)
    for batch in log.batches():
        scene.send(batch)
        _progress(log.file.offset, log.file.size)
    for problem in told(log.problems):
        scene.tell(problem)
    recording.flush()
    recording.disconnect()


def _progress(done: int, size: int) -> None:
    if size > LONG and sys.stderr.isatty():
        filled = round(BAR * done / size)
        bar = "#" * filled + "." * (BAR - filled)
        end = "\n" if done == size else "\r"
        print(f"[{bar}] {done / 2**20:.0f} of {size / 2**20:.0f} MiB", end=end, file=sys.stderr)
