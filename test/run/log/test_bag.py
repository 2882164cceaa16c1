"""Recordings of other programs: several files, rosbag2, other orders, and time that goes back."""

import gc
import itertools
import shutil
import sqlite3
import tempfile
from contextlib import closing
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
import yaml
import zstandard
from exact_log import assert_agrees, compare_samples
from log_files import BEGIN, Run, topic, write_mcap
from rosbags.highlevel import AnyReader
from rosbags.rosbag2 import CompressionFormat, CompressionMode, StoragePlugin, Writer
from rosbags.typesys import Stores, get_typestore
from run.session.test_outputs import SECOND, Program, advance, start

from symtop_ros.replay import main as module
from symtop_ros.run.check.run import check_run
from symtop_ros.run.log.bags import open_run
from symtop_ros.run.log.reader import LogError
from symtop_ros.run.log.top_log import TopLog
from symtop_ros.run.simulation.topics import EVENTS, STATE_TOPICS

RUN = Run(seconds=1.5)
TYPES = {each.name: each.type for each in (EVENTS, *STATE_TOPICS.values())}
STORAGES = [StoragePlugin.MCAP, StoragePlugin.SQLITE3]
MODES = [CompressionMode.NONE, CompressionMode.FILE, CompressionMode.MESSAGE]
STORE = get_typestore(Stores.ROS2_JAZZY)


def write(folder, messages, storage=StoragePlugin.MCAP, node="/top", mode=CompressionMode.NONE):
    """A folder as `ros2 bag record` leaves it, by an independent writer."""
    written = Writer(folder, version=9, storage_plugin=storage)
    written.set_compression(mode, CompressionFormat.ZSTD)
    with written as writer:
        channels = {
            name: writer.add_connection(topic(name, node), kind, typestore=STORE)
            for name, kind in TYPES.items()
        }
        for name, stamp, data in messages:
            writer.write(channels[name], stamp + 1234, data)
    return folder


def parts(folder, count, storage=StoragePlugin.MCAP):
    """The files of a run that was split; the last file of rosbag2 has the last messages."""
    cuts = np.linspace(0, len(RUN.messages), count + 1).astype(int)
    folders = [
        write(folder / f"part_{k}", RUN.messages[begin:end], storage)
        for k, (begin, end) in enumerate(itertools.pairwise(cuts))
    ]
    return [file for each in folders for file in each.glob("part_*")]


def compressed():
    """The messages of the run, each compressed."""
    pack = zstandard.ZstdCompressor().compress
    return [(name, stamp, pack(data)) for name, stamp, data in RUN.messages]


def assert_complete(paths, samples=300):
    """All samples of the run are there and agree exactly with its events."""
    assert_agrees(TopLog(open_run(paths)), samples)


@pytest.mark.parametrize("storage", STORAGES)
def test_files_in_any_order_are_one_run(storage, tmp_path):
    files = parts(tmp_path, 3, storage)
    assert len(files) == 3
    for order in itertools.permutations(files):
        assert_complete(order)


def test_the_default_node_does_not_depend_on_the_order_of_files(tmp_path):
    files = [write(tmp_path / name, RUN.messages, node=f"/{name}") for name in ("b", "a")]
    for order in itertools.permutations(files):
        log = TopLog(open_run(order))
        assert all(each.largest == 0.0 for each in compare_samples(log).values())
        assert log.catalog.node == "/a"
        (note,) = log.catalog.notes
        assert note.endswith(": /b")


def test_topics_that_were_never_recorded_are_named_and_only_strict_readers_mind(tmp_path, capsys):
    some = [each for each in RUN.messages if each[0] in ("events", "orientation")]
    folder = str(write(tmp_path / "bag", some))
    assert module.main([folder, "--check"]) == 0
    assert module.main([folder, "--check", "--strict"]) == 1
    out, err = capsys.readouterr()
    assert "/top/torque                  not compared: it has no messages\n" in out
    assert "/diagnostics                 not compared: it is not in the log\n" in out
    said = "topics are recognised by their types and the ends of their names: "
    assert f"top_replay: {said}" in err


def test_a_topic_of_which_a_cut_log_has_nothing_is_not_said_to_be_never_recorded(tmp_path, capsys):
    topics = [(topic(n), TYPES[n], [m[1:] for m in RUN.messages if m[0] == n]) for n in TYPES]
    path = write_mcap(tmp_path / "run.mcap", topics, chunk_size=20_000)
    path.write_bytes(path.read_bytes()[: path.stat().st_size // 2])
    assert module.main([str(path), "--check"]) == 1
    out, _ = capsys.readouterr()
    assert "the log ends early\n" in out
    assert (
        "/diagnostics                 not compared: it is not in what is left of the log\n" in out
    )


def test_damage_is_reported_with_the_name_of_its_file(tmp_path):
    first, second = parts(tmp_path, 2)
    second.write_bytes(second.read_bytes()[: second.stat().st_size // 2])
    log = TopLog(open_run([first, second]))
    assert all(each.largest == 0.0 for each in compare_samples(log).values())
    assert any(text.startswith(f"{second.name}: the file ends") for text in log.catalog.problems)


def test_a_damaged_database_is_read_up_to_the_damage(tmp_path):
    (file,) = parts(tmp_path, 1, StoragePlugin.SQLITE3)
    data = bytearray(file.read_bytes())
    data[len(data) // 2 : len(data) // 2 + 40_000] = bytes(40_000)
    file.write_bytes(data)
    problems = TopLog(open_run([file])).catalog.problems
    assert any("damaged" in each for each in problems)


NO_BAGS = [
    ("empty.db3", b"", "not a bag of rosbag2 \\(no such table: topics\\)"),
    ("text.db3", b"some text" * 100, "not a bag of rosbag2 \\(file is not a database\\)"),
]


@pytest.mark.parametrize(("name", "content", "sentence"), NO_BAGS)
def test_a_file_of_another_kind_is_refused(name, content, sentence, tmp_path):
    (tmp_path / name).write_bytes(content)
    for path in (tmp_path, tmp_path / name):
        with pytest.raises(LogError, match=f"cannot open \\S+{name}: {sentence}"):
            open_run([path])


COUNTS = [(10_000, "cannot open 0.mcap"), (10_001, "must have at most 10000 files")]


@pytest.mark.parametrize(("count", "reason"), COUNTS)
def test_a_run_has_at_most_ten_thousand_files(count, reason):
    with pytest.raises(LogError, match=reason):
        open_run([Path(f"{number}.mcap") for number in range(count)])


def test_a_folder_without_files_is_refused(tmp_path):
    with pytest.raises(LogError, match=r"cannot open \S+: no .mcap or .db3 file in it"):
        open_run([tmp_path])


def test_messages_that_a_killed_recorder_left_in_the_write_ahead_log_are_read(tmp_path):
    (file,) = parts(tmp_path / "written", 1, StoragePlugin.SQLITE3)
    killed = tmp_path / "killed.db3"
    database = sqlite3.connect(file)
    database.execute("PRAGMA journal_mode=WAL")
    database.execute("UPDATE messages SET timestamp = timestamp + 1")
    database.commit()
    for suffix in ("", "-wal"):
        shutil.copy(f"{file}{suffix}", f"{killed}{suffix}")
    database.close()
    times = [
        [each.log_time for chunk in open_run([path]).chunks() for each in chunk]
        for path in (killed, file)
    ]
    assert len(times[0]) == len(RUN.messages)
    assert times[0] == times[1]


@pytest.mark.parametrize("storage", STORAGES)
def test_a_bag_of_compressed_messages_is_read(storage, tmp_path):
    """As `ros2 bag record --compression-mode message --compression-format zstd` writes it."""
    log = TopLog(open_run([write(tmp_path / "bag", compressed(), storage)]))
    findings = check_run(log)
    assert (findings.mismatches, log.catalog.problems) == ([], ())
    found = {(each.samples, each.largest) for each in findings.deviations.values()}
    assert found == {(300, 0.0)}


def restarted(pause, first=RUN.messages):
    """The messages of a recorder that keeps running while the node is ended and started again."""
    later = round(RUN.seconds * SECOND) + pause
    second = Run(seconds=RUN.seconds, begin=BEGIN + later)
    return [*first, *second.messages]


@pytest.mark.parametrize("pause", [0, 20_000_000, 3 * SECOND])
@pytest.mark.parametrize("storage", STORAGES)
def test_a_bag_in_which_the_node_was_started_again_is_complete(storage, pause, tmp_path):
    assert_complete([write(tmp_path / "bag", restarted(pause), storage)], 600)


def test_two_logs_of_the_node_are_read_as_two_runs(tmp_path):
    later = Run(seconds=1.0, begin=BEGIN + 100 * SECOND)
    logs = [RUN.write(tmp_path / "one"), later.write(tmp_path / "two")]
    for order in itertools.permutations(logs):
        assert_complete(order, 500)


@pytest.mark.parametrize(
    ("first", "said"), [(50, "20 samples are missing"), (200, "an event may be lost")]
)
def test_what_is_lost_before_the_node_is_started_again_is_told(first, said, tmp_path):
    """After the kick, at sample 150, nothing of that run proves that no other event followed."""
    begin, end = (RUN.places("orientation")[k] for k in (first, first + 20))
    kept = [*RUN.messages[:begin], *RUN.messages[end:]]
    log = TopLog(open_run([write(tmp_path / "bag", restarted(3 * SECOND, kept))]))
    assert log.catalog.problems == ()
    assert any(said in each for each in log.catalog.doubts)


@pytest.fixture(name="copies")
def _copies(tmp_path, monkeypatch):
    """The folder in which temporary folders are made."""
    folder = tmp_path / "copies"
    folder.mkdir()
    monkeypatch.setattr(tempfile, "tempdir", str(folder))
    return folder


@pytest.mark.parametrize("storage", STORAGES)
def test_a_bag_of_compressed_files_is_read_and_leaves_no_copy(storage, tmp_path, copies):
    """As `--compression-mode file` leaves it."""
    folder = tmp_path / "bag"
    folder.mkdir()
    for file in parts(tmp_path / "written", 2, storage):
        packed = zstandard.ZstdCompressor().compress(file.read_bytes())
        (folder / f"{file.name}.zstd").write_bytes(packed)
    assert_complete([folder])
    gc.collect()
    assert list(copies.iterdir()) == []


@pytest.mark.parametrize("is_whole", [True, False])
@pytest.mark.parametrize("storage", STORAGES)
def test_a_bag_whose_files_a_player_has_unpacked_next_to_them_has_them_once(
    storage, is_whole, tmp_path
):
    """As `ros2 bag play` leaves a bag of compressed files; if killed, the copy is in part."""
    bag = write(tmp_path / "bag", RUN.messages, storage, mode=CompressionMode.FILE)
    (packed,) = bag.glob("*.zstd")
    with packed.open("rb") as stream:
        copy = zstandard.ZstdDecompressor().stream_reader(stream).read()
    packed.with_suffix("").write_bytes(copy if is_whole else copy[: len(copy) // 2])
    assert_complete([bag])


def test_a_file_that_a_killed_recorder_has_compressed_in_part_is_read_as_it_was(tmp_path):
    bag = write(tmp_path / "bag", RUN.messages)
    (bag / "metadata.yaml").unlink()
    (bag / "bag.mcap.zstd").write_bytes(zstandard.ZstdCompressor().compress(b"a part"))
    assert_complete([bag])


@pytest.mark.parametrize("mode", MODES, ids=lambda mode: mode.name)
@pytest.mark.parametrize("storage", STORAGES)
def test_a_split_bag_with_latched_messages_at_each_head_is_read_as_rosbags_reads_it(
    storage, mode, tmp_path
):
    bag = split_with_heads(tmp_path, storage, mode)
    assert_complete([bag])
    with AnyReader([bag]) as reader:
        found = [(each.topic, data) for each, _, data in reader.messages()]
    assert {*found} == {(topic(name), data) for name, _, data in RUN.messages}
    assert len(found) == len(RUN.messages) + 3  # the start twice, the kick once


def split_with_heads(folder, storage=StoragePlugin.MCAP, mode=CompressionMode.NONE):
    """A bag as `ros2 bag record -a --max-bag-duration 1 --repeat-transient-local ...` leaves it."""
    cuts = np.linspace(0, len(RUN.messages), 4).astype(int)
    folders = []
    for begin, end in itertools.pairwise(cuts):
        part = RUN.messages[begin:end]
        before = RUN.messages[:begin]
        head = [(name, part[0][1], data) for name, _, data in before if name == EVENTS.name]
        folders.append(write(folder / f"bag_{begin}", head + part, storage, mode=mode))
    return join(folders, folder / "bag")


def join(folders, target):
    """One bag of several, with the metadata that rosbag2 writes for split files."""
    target.mkdir()
    parts = [yaml.safe_load((each / "metadata.yaml").read_text()) for each in folders]
    about, *others = (each["rosbag2_bagfile_information"] for each in parts)
    for folder in folders:
        for file in folder.glob("bag_*"):
            file.rename(target / file.name)
    for each in others:
        for name in ("relative_file_paths", "files"):
            about[name] += each[name]
        about["message_count"] += each["message_count"]
        topics = each["topics_with_message_count"]
        for mine, other in zip(about["topics_with_message_count"], topics, strict=True):
            assert mine["topic_metadata"]["name"] == other["topic_metadata"]["name"]
            mine["message_count"] += other["message_count"]
        begin, later = (part["starting_time"]["nanoseconds_since_epoch"] for part in (about, each))
        about["duration"]["nanoseconds"] = later + each["duration"]["nanoseconds"] - begin
    (target / "metadata.yaml").write_text(yaml.safe_dump(parts[0]))
    return target


def test_compressed_messages_that_are_damaged_are_counted(tmp_path):
    messages = compressed()
    name, stamp, data = messages[40]
    messages[40] = name, stamp, data[:8] + b"\xff" * 8
    log = TopLog(open_run([write(tmp_path / "bag", messages)]))
    first, _ = log.catalog.problems
    assert first == "messages that cannot be decompressed: 1"


def test_a_compressed_file_that_is_none_is_refused_and_leaves_no_copy(tmp_path, copies):
    (tmp_path / "bag_0.mcap.zstd").write_bytes(b"nothing of the kind")
    with pytest.raises(LogError, match=r"cannot open \S+: it cannot be decompressed") as refused:
        open_run([tmp_path])
    # While the traceback holds it, Python does not remove the folder of the copy by itself.
    assert refused.tb
    assert list(copies.iterdir()) == []


class Recorder(Program):
    """A host whose messages are recorded with the times of its clock, as `ros2 bag` does it."""

    def __init__(self):
        super().__init__()
        self.session = None
        self.messages = []  # name of the topic, time of the clock, bytes
        self.session, self.clock = start(self, "hurry_slow", publish_rate=100.0)

    def create_publisher_of(self, topic):
        def keep(data):
            self.messages.append((topic.name, self.clock.now if self.session else 0, data))

        return SimpleNamespace(has_subscriber=True, publish=keep) if topic.name in TYPES else None

    def run(self, begin, end):
        """Set the clock to a time in s, and let it run to a later time."""
        for time in range(round(begin * SECOND), round(end * SECOND), SECOND // 100):
            jumped = not 0 <= time - self.clock.now < SECOND
            self.session.simulation.begin_jump()
            self.clock.now = time
            self.session.simulation.end_jump(jumped)
            advance(self.session, self.clock, 0.0)

    def kick(self):
        assert self.session.answer("hurry_precession", dict)[0]


def delay(messages, name, count):
    """Each message of a topic arrives after `count` others."""
    arrivals = sorted((k + (count + 0.5) * (m[0] == name), m) for k, m in enumerate(messages))
    return [each for _, each in arrivals]


def late_subscription():
    """A node that waited for /clock; the recorder gets its latched events after some samples."""
    recorder = Recorder()
    recorder.run(100.0, 101.0)
    recorder.kick()
    recorder.run(101.0, 102.0)
    latched = [each for each in recorder.messages if each[0] == "events"][:2]  # start, clock
    # the sample of time 0 was not heard
    others = [each for each in recorder.messages if each[1] and each not in latched]
    return [*others[:40], *latched, *others[40:]]


def jump_back():
    """A clock that goes back to a time that was there before, and a kick in each part."""
    recorder = Recorder()
    for begin in (100.0, 99.0, 99.5):
        recorder.run(begin, begin + 1.0)
        recorder.kick()
        recorder.run(begin + 1.0, begin + 2.0)
    return [each for each in recorder.messages if each[1] or each[0] == "events"]


@pytest.mark.parametrize("storage", STORAGES)
def test_late_events_govern_the_first_samples_of_simulated_time(storage, tmp_path):
    assert_complete([write(tmp_path / "bag", late_subscription(), storage)], 200)


MCAP, SQLITE3 = STORAGES
LATE = [("events", 0, MCAP), ("events", 45, SQLITE3), ("events", 900, MCAP), ("torque", 45, MCAP)]


@pytest.mark.parametrize(("topic", "late", "storage"), LATE)
def test_after_a_clock_went_back_messages_may_be_late(topic, late, storage, tmp_path):
    messages = delay(jump_back(), topic, late)
    assert_complete([write(tmp_path / "bag", messages, storage)], 600)


def test_an_order_that_is_lost_is_found_by_the_numbers_of_the_events(tmp_path, capsys):
    # A bag that was converted is sorted by its times, in which both parts are mixed.
    messages = sorted(jump_back(), key=lambda each: each[1])
    folder = write(tmp_path / "bag", messages)
    assert module.main([str(folder), "--check"]) == 0
    verdict, *rows = capsys.readouterr().out.splitlines()
    assert verdict == "the samples agree with the events"
    exact = [row for row in rows if row.endswith(" 600 samples, largest difference 0")]
    assert len(exact) == len(STATE_TOPICS)


@pytest.mark.parametrize("late", [0, 45])
def test_a_wrong_number_is_found_although_the_clock_went_back(late, tmp_path, capsys):
    messages = delay(jump_back(), "events", late)
    places = [k for k, each in enumerate(messages) if each[0] == "orientation"]
    k = places[350]
    name, time, data = messages[k]
    messages[k] = name, time, data[:-4] + bytes([data[-4] ^ 1]) + data[-3:]
    folder = write(tmp_path / "bag", messages)
    assert module.main([str(folder), "--check"]) == 1
    assert "the samples DO NOT agree" in capsys.readouterr().out
    deviations = compare_samples(TopLog(open_run([folder])))
    assert [name for name, each in deviations.items() if each.differing] == ["orientation"]


def test_rows_of_a_bag_without_a_message_lose_those_messages_and_no_others(tmp_path):
    (file,) = parts(tmp_path, 1, StoragePlugin.SQLITE3)
    whole = TopLog(open_run([file])).file
    count = sum(map(len, whole.chunks()))
    with closing(sqlite3.connect(file)) as database:
        database.execute("UPDATE messages SET data = 'text' WHERE id IN (100, 101, 300)")
        database.commit()
    damaged = open_run([file])
    assert sum(map(len, damaged.chunks())) == count - 3
    said = [(each.text, each.place) for each in damaged.losses]
    assert said == [
        ("2 rows without a message: the bag is damaged", 99),
        ("1 row without a message: the bag is damaged", 297),
    ]


def test_a_bag_of_which_the_end_is_cut_is_damaged(tmp_path):
    (file,) = parts(tmp_path, 1, StoragePlugin.SQLITE3)
    file.write_bytes(file.read_bytes()[: file.stat().st_size // 2])
    with pytest.raises(LogError, match=f"cannot open {file}: the bag is damaged"):
        open_run([file])
