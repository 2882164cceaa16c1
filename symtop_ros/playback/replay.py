"""Conversion of a log into a Rerun recording."""

import errno
import os
import shutil
import sys
from pathlib import Path

import rerun as rr

from symtop_ros.log.reader import LogError, list_problems
from symtop_ros.log.top_log import TopLog
from symtop_ros.playback.view.view import DEFAULT_OPTIONS, View, ViewOptions

APPLICATION = "symtop_ros"
MIN_SIZE_FOR_BAR = 20 * 2**20  # bytes; smaller files take less than a second
BAR_LENGTH = 40  # characters
GROWTH = 8  # a recording has five times the size of its log


def replay(log: TopLog, target: Path, options: ViewOptions = DEFAULT_OPTIONS) -> None:
    """Write a log as a Rerun recording; problems of the log are listed with its events."""
    try:
        _require_space(target, GROWTH * log.file.size)
        recording = create_recording(target, log.file.path.stem)
    except (OSError, RuntimeError) as error:
        raise LogError(
            f"cannot write {target}: {getattr(error, 'strerror', None) or error}"
        ) from None
    view = View(recording, options=options)
    for batch in log.batches():
        view.send(batch)
        _show_progress(log.file.offset, log.file.size)
    for problem in list_problems(log.problems):
        view.log_text(problem)
    recording.flush()
    view.close()


def _require_space(target: Path, size: int) -> None:
    """Raise OSError if the disk has fewer bytes left: on a full disk Rerun waits for ever."""
    if shutil.disk_usage(target.parent).free < size:
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))


def create_recording(file: Path, name: str) -> rr.RecordingStream:
    """Return a recording that is written to a file; OSError if that is not possible."""
    file.open("wb").close()  # Rerun itself only warns if it cannot write
    recording = rr.RecordingStream(APPLICATION, recording_id=name)
    recording.save(file)
    return recording


def _show_progress(done: int, size: int) -> None:
    if size > MIN_SIZE_FOR_BAR and sys.stderr.isatty():
        filled = round(BAR_LENGTH * done / size)
        bar = "#" * filled + "." * (BAR_LENGTH - filled)
        end = "\n" if done == size else "\r"
        print(f"[{bar}] {done / 2**20:.0f} of {size / 2**20:.0f} MiB", end=end, file=sys.stderr)
