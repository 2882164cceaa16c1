"""Logs that are sound as files and absurd in what they say: one sentence, soon and cheaply."""

import itertools
import resource
import struct
import time
import zlib

import numpy as np
import pytest
import zstandard
from hypothesis import given
from hypothesis import strategies as st
from log_files import LAYOUTS, Run
from mcap.writer import Writer
from odd_values import CONTROL, assert_one_sentence, deterministic

from symtop_ros.physics import Friction
from symtop_ros.playback import main as module
from symtop_ros.playback import mcap_file
from symtop_ros.playback.check import check
from symtop_ros.playback.mcap_file import LARGEST, MAGIC, LogError, McapFile
from symtop_ros.playback.patience import Patience
from symtop_ros.playback.top_log import TopLog
from symtop_ros.wire import messages
from symtop_ros.wire.diagnostics import DIAGNOSTICS, packed, statuses

FRICTION = Friction(1e-6, 1e-5)
SOON = 5.0  # s of processor time; all but some take milliseconds
NUMBERS = st.floats().map(repr) | st.sampled_from(["1e12", "-1e18", "1e150", "9" * 5000, "0", ""])
KEYS = ("top", "friction", "applied_torque", "after.orientation", "after.angular_velocity")
MOTION = ("orientation", "angular_velocity", "stamp", "elapsed", "real_time_factor", "running")
ALL_KEYS = (*KEYS, *(f"motion.{name}" for name in MOTION))


def with_event(folder, changes, friction=FRICTION, seconds=0.5):
    """A log whose first event says something else."""
    run = Run(seconds=seconds, rate=40.0, hurried=False, friction=friction)
    place = next(k for k, each in enumerate(run.messages) if each[0] == "events")
    name, stamp, data = run.messages[place]
    (status,) = statuses(data)
    values = {key: text for key, text in {**status.values, **changes}.items() if text is not None}
    changed = packed(stamp, "world", [status._replace(values=values)])
    run.messages[place] = name, stamp, changed
    return run.write(folder)


def asked(capsys, path, *way):
    """Exit status and sentences of top_replay, which come soon."""
    capsys.readouterr()
    began = time.process_time()
    status = module.main([str(path), *map(str, way)])
    assert time.process_time() - began < SOON
    lines = capsys.readouterr().err.splitlines()
    for line in lines:
        assert_one_sentence(line.removeprefix("top_replay: "))
    return status, lines


ABSURD = {
    ("motion.elapsed", "1e12"): "120 samples are of a motion too fast or too long to be integrated",
    (
        "motion.elapsed",
        "-1e12",
    ): "120 samples are of a motion too fast or too long to be integrated",
    ("motion.stamp", "0"): "120 samples are of a motion too fast or too long to be integrated",
    ("friction", "1e30 0.0"): "120 samples are of a motion too fast or too long to be integrated",
    ("applied_torque", "1e300 0 0"): "120 samples are of a motion too fast or too long to be",
    ("motion.elapsed", "nan"): "motion.elapsed: got nan, allowed is -1e+18 to 1e+18",
    ("motion.elapsed", "x" * 100_000): "could not convert string to float: 'xxx",
    ("motion.stamp", "9" * 4000): "event 'start': no motion has such numbers",
    ("motion.stamp", "9" * 5000): "Exceeds the limit (4300 digits)",
    ("motion.real_time_factor", "0"): "motion.real_time_factor: got 0, allowed is 1e-300 to 1e+06",
    ("motion.real_time_factor", "inf"): "motion.real_time_factor: got inf, allowed",
    ("motion.orientation", "1e300 0 0 0"): "orientation: got a norm of inf, allowed is 1",
    ("motion.orientation", " 1" * 100_000): "orientation: got shape (100000,), allowed is (..., 4)",
    ("motion.orientation", CONTROL): "could not convert string to float: '\\x1b[31m",
    ("motion.angular_velocity", "1e151 0 0"): "angular_velocity: got 1e+151 rad/s, allowed",
    ("top", "nan nan nan"): "Ix: got nan, allowed is a finite number",
    ("top", None): "event 'start': 'top' is missing or incomplete",
    ("after.orientation", None): "orientation: got shape (0,), allowed is (..., 4)",
}


@pytest.mark.parametrize(("change", "sentence"), ABSURD.items(), ids=itertools.count())
def test_an_event_of_absurd_numbers_is_told_in_one_sentence(change, sentence, tmp_path, capsys):
    path = with_event(tmp_path, dict([change]))
    status, lines = asked(capsys, path, "--check")
    assert status == 1
    assert sum(sentence in line for line in lines) == 1
    assert asked(capsys, path, "--repair", tmp_path / "whole.mcap") == (0, [])
    status, lines = asked(capsys, path, "--save", tmp_path / "run.rrd")
    assert status == 0
    assert len(lines) <= 1


@deterministic(100)
@given(data=st.data())
def test_any_numbers_in_an_event_are_checked_or_refused(data, tmp_path_factory):
    wanted = st.dictionaries(
        st.sampled_from(ALL_KEYS), st.lists(NUMBERS, max_size=4).map(" ".join), max_size=3
    )
    path = with_event(tmp_path_factory.mktemp("odd"), data.draw(wanted))
    log = TopLog(McapFile(path))
    check(log)
    assert all(map(str.isprintable, mcap_file.told(log.problems)))


def test_what_came_before_the_log_is_integrated_as_far_as_patience_goes(tmp_path, monkeypatch):
    path = with_event(tmp_path, {"motion.elapsed": "50.0"})
    assert not any(each.unreached for each in check(TopLog(McapFile(path))).values())
    patience = Patience(spare=1000)
    (batch,) = TopLog(McapFile(path)).batches()
    segment = batch.events[0][1].segment()
    assert not patience.reaches(segment.path, (5000.0,), samples=1)
    assert patience.reaches(segment.path, (1.0,), samples=1)


def test_samples_that_are_no_numbers_are_told_and_drawn_without_warnings(tmp_path, capsys):
    run = Run(seconds=0.5, rate=40.0)
    odd = itertools.cycle([np.nan, np.inf, 1e300, -1e308])
    for k, (name, stamp, data) in enumerate(run.messages):
        if name in LAYOUTS and k % 7 == 0:
            width = len(LAYOUTS[name].unpack(np.frombuffer(data, np.uint8)[None])[1][0])
            run.messages[k] = name, stamp, LAYOUTS[name].pack(stamp, [next(odd)] * width)
    path = run.write(tmp_path)
    assert asked(capsys, path, "--check") == (1, [])
    status, lines = asked(capsys, path, "--save", tmp_path / "run.rrd")
    assert (status, lines) == (0, [])


# what is in no log of ours


def record(opcode, data):
    return struct.pack("<BQ", opcode, len(data)) + data


def chunk(packed_data, size, crc):
    body = struct.pack("<QQQII", 0, 1, size, crc, 4) + b"zstd"
    return record(6, body + struct.pack("<Q", len(packed_data)) + packed_data)


def repeated(one, count):
    """A chunk of the same record many times, which packs to almost nothing."""
    data = one * count
    return chunk(zstandard.compress(data, 1), len(data), zlib.crc32(data))


def file_of(tmp_path, *records):
    path = tmp_path / "odd.mcap"
    path.write_bytes(MAGIC + b"".join(records))
    return path


def assert_damaged(problems):
    assert any("a chunk is damaged: all messages of" in problem for problem in problems)


def grown(call):
    """MiB by which the peak of memory grows during a call."""
    before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    call()
    return (resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before) / 1024


def test_millions_of_messages_in_a_chunk_of_a_few_bytes_are_not_held_at_once(tmp_path):
    path = file_of(tmp_path, repeated(record(5, struct.pack("<HIQQ", 1, 0, 5, 5)), 300_000))
    file = McapFile(path)
    counted = []
    assert grown(lambda: counted.append(sum(map(len, file.chunks())))) < 100
    assert counted == [300_000]


def test_a_chunk_of_records_that_are_none_is_damaged_at_once(tmp_path, capsys):
    path = file_of(tmp_path, repeated(bytes(1024), 64 * 1024))
    assert_damaged(asked(capsys, path, "--repair", tmp_path / "whole.mcap")[1])


def test_chunks_that_unpack_to_ever_more_schemas_are_refused(tmp_path, capsys):
    text = struct.pack("<I", 2**20) + bytes(2**20)
    schemas = [
        repeated(record(3, struct.pack("<HI", number, 1) + b"a" + struct.pack("<I", 0) + text), 1)
        for number in range(80)
    ]
    path = file_of(tmp_path, *schemas)
    for way in (["--check"], ["--repair", tmp_path / "whole.mcap"]):
        status, (line,) = asked(capsys, path, *way)
        assert status == 1
        assert line.endswith("more than 67108864 bytes say what is in it: it is no log")
    assert not (tmp_path / "whole.mcap").exists()


def test_a_message_shorter_than_its_head_damages_its_chunk(tmp_path, capsys):
    path = file_of(tmp_path, repeated(record(5, b"short"), 1))
    assert_damaged(asked(capsys, path, "--repair", tmp_path / "whole.mcap")[1])


@pytest.mark.parametrize("size", [2**32, 10 * 2**30, 2**63])
def test_a_chunk_that_lies_about_its_size_costs_no_memory(size, tmp_path):
    file = McapFile(file_of(tmp_path, chunk(zstandard.compress(bytes(2**20)), size, 0)))
    assert grown(lambda: list(file.chunks())) < 50
    assert_damaged(file.problems)


@pytest.mark.parametrize("length", [LARGEST + 1, 2**40, 2**64 - 1])
def test_a_record_that_announces_more_than_the_file_has_ends_it(length, tmp_path):
    file = McapFile(file_of(tmp_path, struct.pack("<BQ", 6, length) + bytes(1000)))
    assert grown(lambda: list(file.chunks())) < 50
    assert "nothing after 0.000 s is in it" in file.problems[0]


def test_ten_thousand_problems_are_told_in_some_lines(tmp_path, capsys):
    path = file_of(tmp_path, chunk(b"?", 1, 1) * 10_000)
    status, lines = asked(capsys, path, "--repair", tmp_path / "whole.mcap")
    assert status == 0
    assert len(lines) == 21
    assert lines[-1] == "top_replay: and 9981 more of the kind"


def written(path, kind, topic, contents):
    """A log of another writer, of one topic."""
    with path.open("wb") as stream:
        writer = Writer(stream)
        writer.start("ros2")
        channel = writer.register_channel(
            topic, "cdr", writer.register_schema(kind, "ros2msg", b"")
        )
        for stamp, data in enumerate(contents):
            writer.add_message(channel, stamp, data, stamp)
        writer.finish()
    return path


def test_joints_that_are_not_three_are_not_those_of_a_top(tmp_path, capsys):
    names = [(), ("a",), messages.JOINTS, tuple("abcdefgh")]
    data = [messages.joints("world", each).pack(0, [0.5] * 2 * len(each)) for each in names]
    path = written(tmp_path / "log.mcap", messages.KINDS["euler_angles"], "/top/euler_angles", data)
    log = TopLog(McapFile(path))
    (batch,) = log.batches()
    assert batch.columns["euler_angles"].numbers.shape == (1, 6)
    assert "euler_angles: 3 messages: 0 joints, readable are 3" in log.problems
    assert asked(capsys, path, "--save", tmp_path / "run.rrd")[0] == 0


def test_a_frame_of_its_own_for_every_message_is_read_up_to_a_number_and_soon(tmp_path, capsys):
    data = [messages.quaternion(f"w{k:05}").pack(k, [0.0, 0, 0, 1]) for k in range(10_000)]
    path = written(tmp_path / "log.mcap", messages.KINDS["orientation"], "/top/orientation", data)
    status, lines = asked(capsys, path, "--check")
    assert status == 1
    assert any("messages: more than 256 frames on one topic" in line for line in lines)


def test_topics_and_events_of_control_characters_are_told_escaped(tmp_path, capsys):
    topic = f"/{CONTROL * 10_000}/orientation"
    path = written(tmp_path / "log.mcap", "other", topic, [b""])
    status, (line,) = asked(capsys, path, "--check")
    assert status == 1
    assert "\\x1b[31m" in line
    status = statuses(Run(seconds=0.1).messages[0][2])[0]
    event = packed(0, "w", [status._replace(name=CONTROL * 10_000, values={})])
    path = written(tmp_path / "events.mcap", DIAGNOSTICS, "/top/events", [event])
    assert asked(capsys, path, "--check")[0] == 1


@pytest.mark.parametrize("kind", ["", "other", "geometry_msgs/msg/TwistStamped"])
def test_a_topic_of_another_type_is_not_the_tops(kind, tmp_path):
    data = [messages.quaternion("world").pack(0, [0.0, 0, 0, 1])]
    path = written(tmp_path / "log.mcap", kind, "/top/orientation", data)
    with pytest.raises(LogError, match="holds no top; its topics: /top/orientation"):
        list(TopLog(McapFile(path)).batches())


def test_a_file_that_vanishes_while_it_is_read_is_told(tmp_path):
    file = McapFile(Run(seconds=0.1).write(tmp_path))
    file.path.unlink()
    with pytest.raises(LogError, match="No such file or directory"):
        list(file.chunks())


@pytest.mark.parametrize("name", [CONTROL, "x" * 100_000, "/dev/zero", "/dev/null", ""])
def test_what_is_no_log_is_told_in_one_line(name, capsys):
    status, lines = asked(capsys, name, "--check")
    assert status == 1
    assert len(lines) == 1
