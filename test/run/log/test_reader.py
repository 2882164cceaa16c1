"""Reading of complete, cut, damaged and hostile files, and of tops in logs of all kinds."""

import errno
import os
import random
import resource
import zlib

import lz4.frame
import numpy as np
import pytest
import zstandard
from exact_log import STATES, compare_samples
from hypothesis import given, settings
from hypothesis import strategies as st
from log_files import Run, topic, write_mcap
from mcap.data_stream import RecordBuilder
from mcap.records import Chunk
from mcap.writer import CompressionType
from trials import seeds

from symtop_ros.base.counts import write_count
from symtop_ros.run.log import reader
from symtop_ros.run.log.checksums import read_damage
from symtop_ros.run.log.reader import LogError, McapFile
from symtop_ros.run.log.top_log import TopLog
from symtop_ros.run.simulation.topics import EVENTS, STATE_TOPICS

RUN = Run(seconds=2.0, rate=100.0)


@pytest.fixture(scope="module")
def good(tmp_path_factory):
    return RUN.write(tmp_path_factory.mktemp("logs"))


def save(folder, data):
    """A file of these bytes."""
    path = folder / "odd.mcap"
    path.write_bytes(data)
    return path


def read(path):
    file = McapFile(path)
    return file, [
        (file.channels[message.channel_id].topic.rpartition("/")[2], message.log_time, message.data)
        for chunk in file.chunks()
        for message in chunk
    ]


def read_raw(path):
    """A file and its messages, whether or not their channels are known."""
    file = McapFile(path)
    return file, [message for chunk in file.chunks() for message in chunk]


@settings(max_examples=100)
@given(st.data())
def test_a_file_cut_at_any_byte_gives_all_whole_chunks_and_says_so(good, tmp_path_factory, data):
    whole = good.read_bytes()
    size = data.draw(st.integers(8, len(whole) - 1))
    file, messages = read(save(tmp_path_factory.mktemp("cut"), whole[:size]))
    assert messages == RUN.messages[: len(messages)]
    missing = len(messages) < len(RUN.messages)
    end = whole.rindex(b"symtop_ros.end", 0, len(whole) - 200)  # of the data
    assert len(file.problems) == (1 if missing or size < end else 0)
    if missing:
        assert f"of {size}: " in file.problems[0]
        assert file.problems[0].endswith(" may be lost")


def damage(data, rng):
    """The bytes of a file, some of them flipped, lost or replaced; its first bytes are whole."""
    for _ in range(rng.randrange(1, 4)):
        place = rng.randrange(8, len(data))
        flipped = bytes([data[place] ^ 1 << rng.randrange(8)])
        instead = rng.choice([flipped, flipped, b"", rng.randbytes(rng.randrange(1, 200))])
        lost = 1 if instead == flipped else rng.randrange(1, 300)
        data = data[:place] + instead + data[place + lost :]
    return data


@pytest.mark.parametrize("seed", seeds(3, 200))
def test_no_message_is_lost_without_a_word(good, tmp_path, seed):
    rng = random.Random(seed)
    whole, (_, messages) = good.read_bytes(), read_raw(good)
    for _ in range(20):
        file, found = read_raw(save(tmp_path, damage(whole, rng)))
        assert found == messages or file.problems


@pytest.mark.parametrize("data", [b"", b"\x89MCAP", b"PK\3\4" + bytes(100), b"\0" * 1000])
def test_other_files_are_refused(data, tmp_path):
    with pytest.raises(LogError, match=r"cannot open \S+odd\.mcap: not an MCAP file"):
        McapFile(save(tmp_path, data))


def test_a_file_that_is_not_there_and_a_folder_are_refused(tmp_path):
    with pytest.raises(LogError, match=os.strerror(errno.ENOENT)):
        McapFile(tmp_path / "none.mcap")
    with pytest.raises(LogError, match=os.strerror(errno.EISDIR)):
        McapFile(tmp_path)


@pytest.mark.parametrize("compression", ["zstd", "lz4"])
def test_a_chunk_that_unpacks_to_far_more_than_it_says_is_damaged(compression, tmp_path):
    pack = zstandard.compress if compression == "zstd" else lz4.frame.compress
    builder = RecordBuilder()
    Chunk(compression, pack(bytes(2**28)), 0, 1, zlib.crc32(b""), 1000).write(builder)
    path = save(tmp_path, reader.MAGIC + builder.end())
    before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    file, messages = read(path)
    grown = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before  # KiB
    assert grown < 100 * 1024
    assert messages == []
    assert any("a chunk is damaged" in problem for problem in file.problems)


@pytest.mark.parametrize("chunked", [True, False])
@pytest.mark.parametrize("compression", list(CompressionType))
def test_files_of_other_writers_are_read(chunked, compression, tmp_path):
    words = [(k, b"%d" % k) for k in range(100)]
    options = {"compression": compression, "use_chunking": chunked, "chunk_size": 500}
    topics = [("/a/words", "std_msgs/msg/String", words)]
    path = write_mcap(tmp_path / "other.mcap", topics, enable_data_crcs=True, **options)
    file, messages = read(path)
    assert messages == [("words", k, b"%d" % k) for k in range(100)]
    assert file.problems == read_damage(path) == []


@settings(max_examples=200)
@given(st.binary(max_size=300))
def test_any_bytes_behind_the_magic_are_read_or_told(tmp_path_factory, data):
    file = McapFile(save(tmp_path_factory.mktemp("any"), reader.MAGIC + data))
    list(file.chunks())
    assert all(problem for problem in file.problems)


SECOND_RUN = Run(seconds=1.0)
TYPES = {each.name: each.type for each in (EVENTS, *STATE_TOPICS.values())}


def write(folder, runs, node=None, others=()):
    """A log by another program: tops by the names of their nodes, and other messages between."""
    kinds = [(place, name, kind) for place in runs for name, kind in TYPES.items()]
    topics = [
        (topic(name, place), kind, [(t + 1234, d) for n, t, d in runs[place].messages if n == name])
        for place, name, kind in kinds
    ]
    stamps = {stamp + 2000 for run in runs.values() for _, stamp, _ in run.messages}
    topics += [(name, kind, [(stamp, noise) for stamp in stamps]) for name, kind, noise in others]
    return TopLog(McapFile(write_mcap(folder / "a.mcap", topics)), node)


def columns_of(log):
    batches = list(log.batches())
    return {
        name: np.concatenate([b.columns[name].numbers for b in batches if name in b.columns])
        for name in {name for batch in batches for name in batch.columns}
    }


def test_topics_are_found_in_any_namespace_and_between_others(tmp_path):
    others = [
        ("/camera/image", "sensor_msgs/msg/Image", b"noise"),
        ("/other/orientation", "geometry_msgs/msg/PoseStamped", b"another type"),
    ]
    log = write(tmp_path, {"/lab/one/top": SECOND_RUN}, others=others)
    columns = columns_of(log)
    assert log.catalog.node == "/lab/one/top"
    assert len(columns["orientation"]) == 200
    assert (log.catalog.problems, log.catalog.notes) == ((), ())


def test_of_several_tops_one_is_chosen_and_the_others_are_listed(tmp_path):
    slow = Run(seconds=1.0, rate=50.0)
    log = write(tmp_path, {"/a": SECOND_RUN, "/b": slow})
    assert len(columns_of(log)["torque"]) == 200
    (note,) = log.catalog.notes
    assert "/a;" in note
    assert note.endswith("--node: /b")
    assert len(columns_of(TopLog(log.file, "b"))["torque"]) == 50  # the slash may be left out


def test_the_top_of_a_file_that_has_lost_its_index_is_found_in_its_chunks(good, tmp_path):
    log = TopLog(McapFile(save(tmp_path, good.read_bytes()[:-20])))
    assert len(columns_of(log)["torque"]) == 200
    assert log.catalog.node == "/top"


def test_of_several_tops_that_of_the_default_name_is_chosen(tmp_path):
    log = write(tmp_path, {"/a": SECOND_RUN, "/top": SECOND_RUN})
    assert log.catalog.node == "/top"


@pytest.mark.parametrize("shift", [1, 60, -60])
def test_a_sample_belongs_to_an_event_by_its_stamp_wherever_it_was_logged(shift, tmp_path):
    run = Run(seconds=1.0)
    place = run.places("events")[1]
    run.messages.insert(place + shift, run.messages.pop(place))
    intervals = [each for b in run.open(tmp_path).batches() for each in b.intervals() if each[0]]
    (_, before), (event, after) = intervals[-2:]
    for name in STATES:
        assert max(before[name].stamps) < event.stamp == min(after[name].stamps)
        assert sum(len(columns[name].stamps) for _, columns in intervals) == len(run.places(name))


def test_missing_topics_are_listed(tmp_path):
    part = Run(seconds=1.0)
    part.messages = [each for each in part.messages if each[0] in ("orientation", "events")]
    log = write(tmp_path, {"/top": part})
    assert set(columns_of(log)) == {"orientation"}
    missing = ", ".join(f"no {name}" for name in STATES[1:])
    assert log.catalog.notes == (f"the log has {missing}",)


def test_a_log_without_a_top_is_refused_with_a_list_of_its_topics(tmp_path):
    others = [("/camera/image", "sensor_msgs/msg/Image", b"noise")]
    empty = Run(seconds=1.0)
    empty.messages = []
    log = write(tmp_path, {"/top": empty}, others=others)
    with pytest.raises(LogError, match=r"no run of a top in \S+a\.mcap: topics "):
        list(log.batches())
    log = write(tmp_path, {"/top": SECOND_RUN}, "/missing")
    with pytest.raises(LogError, match=r"no run of a top /missing in \S+: topics /tf, /top/"):
        list(log.batches())


@pytest.mark.parametrize("cut", [1, 100])
def test_messages_that_cannot_be_decoded_are_reported_and_the_others_used(cut, tmp_path):
    run = Run(seconds=1.0)
    for place in run.places("torque")[:cut]:
        name, stamp, data = run.messages[place]
        run.messages[place] = name, stamp, data[:-3]
    log = write(tmp_path, {"/top": run})
    assert len(columns_of(log)["torque"]) == 200 - cut
    (problem,) = log.catalog.problems
    assert problem.startswith(f"torque: {write_count(cut, 'message')}: ")
    assert "are not a geometry_msgs/msg/WrenchStamped" in problem


@pytest.mark.slow
def test_samples_of_one_stamp_are_never_parted(tmp_path):
    run = Run(seconds=6.0, rate=1000.0)
    log = run.open(tmp_path)
    for batch in log.batches():
        stamps = [columns.stamps.tolist() for columns in batch.columns.values()]
        assert all(each == stamps[0] for each in stamps)
        assert len(stamps[0]) < 5000


def test_two_tops_that_share_tf_are_told_apart_by_the_frames_in_their_events(tmp_path):
    one = Run(seconds=1.0)
    other = Run(seconds=1.0, rate=50.0, frame="gyro")
    for node, count in (("/a", 200), ("/b", 50)):
        columns = columns_of(write(tmp_path, {"/a": one, "/b": other}, node))
        assert len(columns["tf"]) == count
        assert columns["tf"][:, 3:].tolist() == columns["orientation"].tolist()


def test_without_events_the_transforms_are_those_of_the_frame_of_a_node_as_it_is(tmp_path):
    one = Run(seconds=1.0, rate=50.0, frame="gyro")
    other = Run(seconds=1.0)
    log = write(tmp_path, {"/a": one.without("events"), "/b": other.without("events")}, "/b")
    assert len(columns_of(log)["tf"]) == 200


def test_transforms_of_another_top_before_the_first_event_are_not_those_of_this_one(tmp_path):
    one = Run(seconds=1.0)
    other = Run(seconds=1.0, rate=2000.0, frame="gyro")
    one.messages = [each for each in one.messages if each[1] >= one.messages[0][1] + 5 * 10**8]
    assert one.messages[0][0] == "events"  # the kick
    deviations = compare_samples(write(tmp_path, {"/top": other, "/one": one}, "/one"))
    for each in deviations.values():
        assert (each.samples, each.largest, each.unchecked) == (100, 0.0, 0)
