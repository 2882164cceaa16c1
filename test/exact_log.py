"""A log computed again from its events."""

from __future__ import annotations

from pathlib import Path

from symtop_ros.playback.check import check
from symtop_ros.playback.mcap_file import McapFile
from symtop_ros.playback.top_log import TopLog

STATES = ("orientation", "angular_velocity", "angular_momentum", "torque", "euler_angles", "tf")


def assert_exact(path: Path) -> int:
    """Every sample is the one that its event says, to the last bit; return how many are complete.

    All are in a log that was ended; where it was cut, the last one may not be.
    """
    log = TopLog(McapFile(path))
    deviations = check(log)
    assert set(deviations) == set(STATES)
    for each in deviations.values():
        assert (each.largest, each.unchecked, each.unreached) == (0.0, 0, 0)
    counts = [each.samples for each in deviations.values()]
    assert max(counts) - min(counts) <= ("symtop_ros.end" not in log.file.metadata)
    assert min(counts) > 0
    return min(counts)


def stamps_of(path: Path) -> list[int]:
    """Log times of the orientations, in the order of the file."""
    file = McapFile(path)
    return [
        message.log_time
        for chunk in file.chunks()
        for message in chunk
        if file.channels[message.channel_id].topic.endswith("/orientation")
    ]
