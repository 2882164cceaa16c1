"""The recorder and its files: all messages in order, whatever happens to the disk, and repair."""

import errno
import json
import os
import re
import threading
import time
from dataclasses import replace

import pytest
from disks import mounted
from exact_log import stamps_of
from log_files import LAYOUTS, Run
from mcap.reader import make_reader
from mcap.records import DataEnd, Footer
from mcap.stream_reader import StreamReader
from mcap.writer import Writer
from rosbags.highlevel import AnyReader
from rosbags.interfaces import QosDurability, QosReliability
from waiting import TIMEOUT, until

from symtop_ros.run.log import recorder as module
from symtop_ros.run.log.catalog import read_catalog
from symtop_ros.run.log.names import Names
from symtop_ros.run.log.reader import LOST_BEFORE, LogError, McapFile
from symtop_ros.run.log.recorder import Recorder
from symtop_ros.run.log.repair import repair
from symtop_ros.run.log.source import Loss
from symtop_ros.run.log.writer import MAGIC, REPAIR, REPAIR_LOSSES, LogFile
from symtop_ros.run.simulation.settings import RecordSettings
from symtop_ros.run.simulation.topics import EVENTS, TOPICS, Topic

LATCHED = Topic("/latched", "std_msgs/msg/String", latched=True)
PLAIN = Topic("/plain", "std_msgs/msg/String")


def create(folder, clock=time.monotonic, **limits):
    unlimited = {"max_size": 0.0, "max_duration": 0.0}
    recorder = Recorder(RecordSettings(True, str(folder), **{**unlimited, **limits}), clock)
    recorder.add_channel("/latched", LATCHED)
    recorder.add_channel("/plain", PLAIN)
    return recorder


def contents(path):
    """Topic, log time and bytes of all messages, by mcap's own reader, with CRCs."""
    with path.open("rb") as file:
        reader = make_reader(file, validate_crcs=True)
        messages = reader.iter_messages(log_time_order=False)
        return [(channel.topic, each.log_time, each.data) for _, channel, each in messages]


def read_whole(path):
    """A file whose problems are known."""
    file = McapFile(path)
    list(file.chunks())
    return file


def test_a_file_begins_with_the_current_latched_messages(tmp_path):
    recorder = create(tmp_path)
    recorder.latched[0] = b"holds"
    path = recorder.start({})
    recorder.add(1, 7, b"first")
    assert recorder.path == path
    recorder.stop()
    assert recorder.path is None
    assert contents(path) == [("/latched", 7, b"holds"), ("/plain", 7, b"first")]


def test_what_is_old_enough_is_written_whatever_comes_after_it(tmp_path):
    now = [0.0]
    recorder = create(tmp_path, clock=lambda: now[0])
    path = recorder.start({})
    recorder.add(1, 7, b"first")
    now[0] = module.LONGEST_AGE  # not older than that
    until(lambda: not recorder._queue)
    assert [each for chunk in read_whole(path).chunks() for each in chunk] == []
    now[0] += 0.001
    until(lambda: [each for chunk in McapFile(path).chunks() for each in chunk])
    recorder.add(1, 8, b"second")  # its age begins now
    until(lambda: not recorder._queue)
    assert [each.data for chunk in read_whole(path).chunks() for each in chunk] == [b"first"]
    recorder.stop()
    assert [data for *_, data in contents(path)] == [b"first", b"second"]


def test_a_file_that_is_long_enough_is_followed_by_another_that_stands_alone(tmp_path):
    recorder = create(tmp_path, max_duration=1.0)
    path = recorder.start({"scene": "x"})
    recorder.add(0, 0, b"latched")
    for stamp in (0, 1_100_000_000):
        recorder.add(1, stamp, b"one")
    until(lambda: is_finished(path))
    assert list(tmp_path.iterdir()) == [path]  # the next one begins with its first message
    recorder.add(1, 1_200_000_000, b"two")
    recorder.stop()
    first, second = sorted(tmp_path.iterdir(), key=lambda path: path.stat().st_mtime_ns)
    assert [data for _, _, data in contents(first)] == [b"latched", b"one", b"one"]
    begin = 1_200_000_000
    assert contents(second) == [("/latched", begin, b"latched"), ("/plain", begin, b"two")]


def is_finished(path):
    """Return True if a file has its index."""
    with path.open("rb") as file:
        return file.read()[8:].endswith(MAGIC)


def test_a_limit_below_the_size_of_an_empty_file_loses_nothing_and_ends(tmp_path):
    recorder = create(tmp_path, max_size=1)
    recorder.start({})
    for stamp in range(100):
        recorder.add(1, stamp, b"x")
    stopping = threading.Thread(target=recorder.stop, daemon=True)
    stopping.start()
    stopping.join(TIMEOUT)
    assert not stopping.is_alive()
    files = list(tmp_path.iterdir())
    found = [stamp for path in files for _, stamp, _ in contents(path)]
    assert sorted(found) == list(range(100))
    assert all(map(contents, files))


def test_names_in_one_second_differ_and_nothing_is_overwritten(tmp_path):
    recorder = create(tmp_path)
    paths = set()
    for stamp in range(3):
        paths.add(recorder.start({}))
        recorder.add(1, stamp, b"%d" % stamp)
        recorder.stop()
    assert len(paths) == 3
    assert sorted(data for path in paths for _, _, data in contents(path)) == [b"0", b"1", b"2"]


def test_messages_that_do_not_fit_into_the_queue_are_counted_in_the_file(tmp_path, monkeypatch):
    monkeypatch.setattr(module, "QUEUE_LENGTH", 10)
    hold = threading.Event()
    drain = Recorder._drain
    monkeypatch.setattr(Recorder, "_drain", lambda *given: hold.wait(TIMEOUT) and drain(*given))
    recorder = create(tmp_path)
    path = recorder.start({})
    for stamp in range(25):
        recorder.add(1, stamp, b"x")
    assert recorder.dropped == 15
    hold.set()
    recorder.stop()
    assert len(contents(path)) == 10
    (problem,) = read_whole(path).problems
    assert problem.startswith("15 messages ")


def test_what_was_flushed_is_readable_while_the_recording_goes_on(tmp_path):
    recorder = create(tmp_path)
    path = recorder.start({})
    recorder.add(1, 5, b"x")
    until(lambda: stamps_of(path, "/plain") == [5])
    recorder.stop()


def test_a_full_disk_stops_the_recording_and_what_was_written_opens(tmp_path):
    with mounted(tmp_path / "small", "size=300k") as folder:
        recorder = create(folder)
        path = recorder.start({})
        stamp = 0
        while not recorder.failure:
            recorder.add(1, stamp, os.urandom(400))
            stamp += 1
            time.sleep(0.0005)
            assert stamp < 100_000
        assert recorder.failure == f"{path}: {os.strerror(errno.ENOSPC)}"
        assert recorder.path is None
        (problem,) = read_whole(path).problems
        assert "not finished" in problem
        found = [log_time for _, log_time, _ in contents(path)]  # a whole file for others
        assert found == list(range(len(found)))
        assert len(found) > 100
        assert stamps_of(path, "/plain") == found
    recorder.settings = replace(recorder.settings, directory=str(tmp_path))
    path = recorder.start({})  # nothing of what was left
    recorder.add(1, stamp, b"new")
    recorder.stop()
    assert stamps_of(path, "/plain") == [stamp]


def test_a_full_disk_is_left_without_an_empty_log(tmp_path):
    with mounted(tmp_path / "small", "size=300k") as folder:
        (folder / "other").write_bytes(bytes(292 * 1024))  # two pages are left
        recorder = create(folder)
        recorder.start({})
        for stamp in range(100):
            recorder.add(1, stamp, os.urandom(400))
        until(lambda: recorder.failure)
        assert os.strerror(errno.ENOSPC) in recorder.failure
        assert [each.name for each in folder.iterdir()] == ["other"]


def test_messages_of_the_first_channel_are_written_before_the_others(tmp_path):
    recorder = create(tmp_path)
    path = recorder.start({})
    recorder.add(1, 1, b"first")
    with recorder.put_first(0):
        recorder.add(1, 2, b"sample")
        recorder.add(0, 2, b"event")
        recorder.add(1, 3, b"another")
    recorder.add(1, 4, b"last")
    recorder.stop()
    words = [data.decode() for _, _, data in contents(path)]
    assert words == ["first", "event", "sample", "another", "last"]


def test_channels_store_the_quality_of_service_that_the_node_offers(tmp_path):
    path = Run(seconds=0.1).write(tmp_path)
    with AnyReader([path]) as reader:
        profiles = {each.topic: each.ext.offered_qos_profiles for each in reader.connections}
    assert len(profiles) == len(LAYOUTS) + 2
    for name, (profile,) in profiles.items():
        topic = TOPICS[name.rpartition("/")[2]]
        assert profile.depth == topic.depth
        assert profile.reliability == QosReliability.RELIABLE
        latched, volatile = QosDurability.TRANSIENT_LOCAL, QosDurability.VOLATILE
        assert profile.durability == (latched if topic.latched else volatile)


def test_the_distribution_is_written_where_ros2_bag_info_reads_it(tmp_path):
    """rosbag2_storage_mcap: record "rosbag2", an empty text for no further metadata."""
    log = LogFile(tmp_path, [EVENTS], {"ros_distro": "jazzy"}, {})
    log.write(0, 0, b"")
    log.finish({})
    with log.path.open("rb") as stream:
        found = {each.name: each.metadata for each in make_reader(stream).iter_metadata()}
    assert found["rosbag2"] == {"serialized_metadata": "", "ROS_DISTRO": "jazzy"}


def test_a_log_without_any_message_is_removed(tmp_path):
    """As of a node that is ended before its first sample."""
    log = LogFile(tmp_path, [EVENTS], {}, {0: b"latched"})
    log.finish({})
    assert list(tmp_path.iterdir()) == []


def test_a_log_that_was_given_up_ends_as_a_file_without_checksum_and_index(tmp_path):
    log = LogFile(tmp_path, [EVENTS], {}, {})
    log.write(0, 5, b"flushed")
    log.flush()
    log.write(0, 6, b"lost")
    log.abandon()
    assert [(time, data) for _, time, data in contents(log.path)] == [(5, b"flushed")]
    with log.path.open("rb") as file:
        # In the specification of MCAP each 0 says "not there".
        assert [*StreamReader(file, validate_crcs=True).records][-2:] == [
            DataEnd(data_section_crc=0),
            Footer(summary_start=0, summary_offset_start=0, summary_crc=0),
        ]


RUN = Run()


def catalog_of(file):
    return read_catalog(file, Names(file))


@pytest.fixture
def cut(tmp_path):
    whole = RUN.write(tmp_path / "logs").read_bytes()
    path = tmp_path / "cut.mcap"
    path.write_bytes(whole[: len(whole) * 2 // 3])
    return path


def test_the_readable_messages_become_a_complete_file_for_every_reader(cut, tmp_path):
    target = tmp_path / "whole.mcap"
    file = McapFile(cut)
    count = repair(file, target, catalog_of(file)).messages
    assert 0 < count < len(RUN.messages)
    assert "messages after" in file.problems[0]
    assert [data for *_, data in contents(target)] == [data for *_, data in RUN.messages[:count]]
    repaired = read_whole(target)
    assert repaired.metadata["symtop_ros"] == file.metadata["symtop_ros"]
    hashes = {each.metadata["topic_type_hash"][:7] for each in repaired.channels.values()}
    assert hashes == {"RIHS01_"}
    with AnyReader([target]) as other:
        assert sum(1 for _ in other.messages()) == count


NO_LOSSES = [
    "",
    "[",
    "7",
    '[{"text": 5, "place": 0}]',
    '[{"text": "lost", "place": true}]',
    '[{"text": "lost", "place": "0"}]',
    '[{"text": "lost", "place": 0, "more": 0}]',
    "[" * 100_000,
]


@pytest.mark.parametrize("text", NO_LOSSES)
def test_what_is_no_list_of_losses_is_not_taken_for_one(text, tmp_path):
    assert read_losses(tmp_path, text) == []


def test_losses_that_a_repair_has_noted_are_read(tmp_path):
    noted = [{"text": "3 messages", "place": 7}, {"text": "a chunk"}]
    assert read_losses(tmp_path, json.dumps(noted)) == [
        Loss(f"{LOST_BEFORE}3 messages", 7),
        Loss(f"{LOST_BEFORE}a chunk", None),
    ]


def read_losses(folder, text):
    """The losses that a file has by its metadata."""
    path = folder / "repaired.mcap"
    with path.open("wb") as file:
        writer = Writer(file)
        writer.start("ros2")
        writer.add_metadata(REPAIR, {REPAIR_LOSSES: text})
        writer.finish()
    return read_whole(path).losses


def test_the_target_is_never_overwritten(cut, tmp_path):
    target = tmp_path / "there.mcap"
    target.write_text("mine")
    with pytest.raises(LogError, match=r"there\.mcap must not exist \(nothing is overwritten\)"):
        repair(file := McapFile(cut), target, catalog_of(file))
    assert target.read_text() == "mine"


def test_a_target_that_cannot_be_written_is_reported(cut, tmp_path):
    with pytest.raises(LogError, match=os.strerror(errno.ENOENT)):
        repair(file := McapFile(cut), tmp_path / "none" / "whole.mcap", catalog_of(file))


def test_messages_of_a_channel_without_a_description_are_omitted_and_reported(tmp_path):
    path = tmp_path / "odd.mcap"
    with path.open("wb") as stream:
        writer = Writer(stream)
        writer.start("ros2")
        known = writer.register_channel("/known", "cdr", 0)
        writer.add_message(known, 1, b"mine", 1)
        writer.add_message(known + 1, 2, b"whose", 2)
        writer.finish()
    file = McapFile(path)
    catalog = catalog_of(file)
    assert str(repair(file, tmp_path / "whole.mcap", catalog)) == "1 message"
    assert catalog.problems == (f"channel {known + 1} is not described: its messages are lost",)
    assert [data for *_, data in contents(tmp_path / "whole.mcap")] == [b"mine"]


@pytest.mark.parametrize(
    ("metadata", "owner"),
    [
        ({}, "top"),
        ({"node": "/top"}, "top"),
        ({"node": "/a/disc"}, "a_disc"),
        ({"node": f"/{'n' * 250}"}, "n" * 200),
    ],
)
def test_the_name_of_a_log_begins_with_that_of_its_node_and_is_not_taken_twice(
    metadata, owner, tmp_path
):
    logs = [LogFile(tmp_path, [EVENTS], metadata, {}) for _ in range(2)]
    paths = [each.path for each in logs]
    for each in logs:
        each.finish({})
    assert len(set(paths)) == 2
    time = r"_\d{4}-\d\d-\d\dT\d\d-\d\d-\d\dZ(_2)?\.mcap"
    assert all(re.fullmatch(owner + time, each.name) for each in paths)
