"""Comparison of a log with the run computed again from its events."""

from pathlib import Path

from symtop_ros.run.check.run import check_messages, check_run
from symtop_ros.run.check.samples import Deviation
from symtop_ros.run.log.reader import McapFile
from symtop_ros.run.log.top_log import TopLog

STATES = ("orientation", "angular_velocity", "angular_momentum", "torque", "euler_angles", "tf")


def compare_samples(log: TopLog) -> dict[str, Deviation]:
    """Return the deviation of each topic of samples."""
    return check_messages(log)[0].deviations


def assert_exact(path: Path) -> int:
    """Assert that each sample agrees with its event to the last bit; return the number of samples.

    The last sample of a log that was not finished may be incomplete.
    """
    log = TopLog(McapFile(path))
    found = check_run(log)
    assert found.mismatches == []
    assert not found.foreign
    deviations = found.deviations
    assert set(deviations) == set(STATES)
    for each in deviations.values():
        assert (each.largest, each.unchecked, each.unreached) == (0.0, 0, 0)
    counts = [each.samples for each in deviations.values()]
    is_finished = "symtop_ros.end" in log.file.metadata
    assert max(counts) - min(counts) <= (not is_finished)
    assert not (is_finished and log.catalog.problems)
    assert min(counts) > 0
    return min(counts)


def assert_no_deviation(path: Path, node: str | None = None) -> TopLog:
    """Assert that a log, which may be one of several of a run, is sound and exact; return it."""
    log = TopLog(McapFile(path), node)
    found = compare_samples(log).values()
    assert all(each.samples and not (each.largest or each.unchecked) for each in found)
    assert log.catalog.problems == (), log.catalog.problems
    return log


def assert_agrees(log: TopLog, samples: int) -> None:
    """Assert that a log is sound, with so many samples of each topic, exact and in their order."""
    deviations = compare_samples(log)
    assert log.catalog.problems == (), log.catalog.problems
    assert set(deviations) == set(STATES)
    for each in deviations.values():
        found = each.samples, each.largest, each.unchecked, each.unreached
        assert found == (samples, 0.0, 0, 0)


def read_messages(path: Path) -> list[tuple[str, int, bytes]]:
    """Topic, log time and bytes of each message, in the order of the file."""
    file = McapFile(path)
    # the channels of a file that was not finished stand in its chunks
    return [
        (file.channels[each.channel_id].topic, each.log_time, bytes(each.data))
        for chunk in file.chunks()
        for each in chunk
    ]


def stamps_of(path: Path, topic: str = "/orientation") -> list[int]:
    """Log times of a topic, in the order of the file."""
    return [stamp for name, stamp, _ in read_messages(path) if name.endswith(topic)]
