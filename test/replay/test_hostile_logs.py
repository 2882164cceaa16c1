"""Logs that are sound as files and absurd in what they say: one sentence, by little work."""

import itertools
import re
import resource
import struct
import zlib

import numpy as np
import pytest
import zstandard
from exact_log import STATES, compare_samples
from hypothesis import given
from hypothesis import strategies as st
from log_files import LAYOUTS, Run, write_mcap
from mcap.data_stream import RecordBuilder
from mcap.records import Channel, Chunk, Message, Schema
from odd_values import CONTROL, assert_one_sentence, examples_of
from trials import trials
from work import counting

from symtop_ros.physics import Friction
from symtop_ros.replay import main as module
from symtop_ros.run.log.reader import MAGIC, McapFile
from symtop_ros.run.log.top_log import TopLog
from symtop_ros.run.wire import messages
from symtop_ros.run.wire.diagnostics import DIAGNOSTIC_ARRAY, decode_statuses, encode_statuses

FRICTION = Friction(1e-6, 1e-5)
# Calls, some seconds of work: ten thousand damaged chunks take a third of them. The kernel takes
# some milliseconds at most in each call.
MOST_WORK = 20_000_000
NUMBERS = st.floats().map(repr) | st.sampled_from(["1e12", "-1e18", "1e150", "9" * 5000, "0", ""])
MOTION = ("orientation", "angular_velocity", "stamp", "elapsed", "elapsed_ns", "running")
ALL_KEYS = ["top", "friction", "applied_torque", "after.orientation", "after.angular_velocity"]
ALL_KEYS += [f"motion.{name}" for name in (*MOTION, "real_time_factor")]


def with_event(folder, changes, number=0):
    """A log of which one event, the start (0) or a kick (1), says something else."""
    run = Run(seconds=0.5, rate=40.0, hurried=number > 0, friction=FRICTION)
    place = run.places("events")[number]
    name, stamp, data = run.messages[place]
    (status,) = decode_statuses(data)
    values = {key: text for key, text in {**status.values, **changes}.items() if text is not None}
    changed = encode_statuses(stamp, "world", [status._replace(values=values)])
    run.messages[place] = name, stamp, changed
    return run.write(folder)


def asked(capsys, path, *way):
    """Exit status and sentences of top_replay, after a limited amount of work."""
    capsys.readouterr()
    with counting() as work:
        status = module.main([str(path), *map(str, way)])
    assert work.calls < MOST_WORK
    lines = capsys.readouterr().err.splitlines()
    for line in lines:
        assert_one_sentence(line.removeprefix("top_replay: "))
    return status, lines


REASON = "the motion is too fast or too long to integrate"
TOO_LONG = f"{20 * len(STATES)} samples cannot be checked: {REASON}"
NS, FACTOR, TURNED = "motion.elapsed_ns", "motion.real_time_factor", "motion.orientation"
BAD_FACTOR, BAD_NS = f"{FACTOR} must be 1e-300 to 1e+06, got ", f"{NS} must be a whole number of ns"
BAD_SHAPE = "orientation must be of shape (..., 4), got shape"
ABSURD = {
    (NS, "1" + "0" * 21): TOO_LONG,
    ("friction", "1e30 0.0"): TOO_LONG,
    ("applied_torque", "1e300 0 0"): TOO_LONG,
    (NS, "nan"): f"{BAD_NS} or a fraction",
    (NS, "x" * 100_000): BAD_NS,
    ("motion.stamp", "9" * 4000): "'start' must describe a motion, its numbers are out of range",
    ("motion.stamp", "9" * 5000): "Exceeds the limit (4300 digits)",
    (FACTOR, "0"): f"{BAD_FACTOR}0",
    (FACTOR, "inf"): f"{BAD_FACTOR}inf",
    (TURNED, " 1" * 100_000): f"{BAD_SHAPE} (100000,)",
    (TURNED, CONTROL): "could not convert string to float: '\\x1b[31m",
    ("top", "nan nan nan"): "Ix must be a finite number (kg m^2), got nan",
    ("top", None): "event 'start' must have all values, 'top' is missing or incomplete",
    ("after.orientation", None): f"{BAD_SHAPE} (0,)",
}


@pytest.mark.parametrize("change", ABSURD, ids=range(len(ABSURD)))
def test_an_event_of_absurd_numbers_is_told_in_one_sentence(change, tmp_path, capsys):
    path = with_event(tmp_path, dict([change]))
    sentence = ABSURD[change]
    status, lines = asked(capsys, path, "--check")
    assert status == 1
    assert sum(sentence in line for line in lines) == 1
    for way in (("--repair", tmp_path / "whole.mcap"), ("--save", tmp_path / "run.rrd")):
        status, lines = asked(capsys, path, *way)
        assert status == 0
        assert sentence in "".join(lines[:1] or [sentence])  # a catalog computes no motion


@pytest.mark.parametrize("examples", trials(30, 100))
def test_any_numbers_in_an_event_are_checked_or_refused(examples, tmp_path_factory):
    values = st.lists(NUMBERS, max_size=4).map(" ".join)

    @examples_of(examples)
    @given(changes=st.dictionaries(st.sampled_from(ALL_KEYS), values, max_size=3))
    def check(changes):
        log = TopLog(McapFile(with_event(tmp_path_factory.mktemp("odd"), changes)))
        compare_samples(log)
        assert all(map(str.isprintable, log.catalog.lines))

    check()


def test_samples_that_are_no_numbers_are_told_and_drawn_without_warnings(tmp_path, capsys):
    run = Run(seconds=0.5, rate=40.0)
    odd = itertools.cycle([np.nan, np.inf, 1e300, -1e308])
    for place, (name, *_) in enumerate(run.messages):
        if name in LAYOUTS and place % 7 == 0:
            run.change(place, lambda numbers: np.full_like(numbers, next(odd)))
    path = run.write(tmp_path)
    assert asked(capsys, path, "--check") == (1, [])
    for options in ((), ("--angles", "--torques", "--fictitious")):
        way = ("--save", tmp_path / "run.rrd", *options)
        assert asked(capsys, path, *way) == (0, [])


@pytest.mark.parametrize("text", ["abc", "1 2", "-"])
def test_a_kick_that_cannot_be_read_is_a_change_of_the_motion_in_the_page(text, tmp_path, capsys):
    path = with_event(tmp_path, {"request.precession_rate_factor": text}, number=1)
    assert asked(capsys, path, "--save", tmp_path / "run.html") == (0, [])
    page = (tmp_path / "run.html").read_text()
    assert re.findall(r'"kind": "(start|change|kick)", "time"', page) == ["start", "change"]


# what is in no log of ours

DAMAGED = "a chunk is damaged: its messages, of "


def write_record(record):
    builder = RecordBuilder()
    record.write(builder)
    return builder.end()


def chunk(packed_data, size, crc):
    return write_record(Chunk("zstd", packed_data, 1, 0, crc, size))


def repeated(one, count):
    """A chunk of the same record many times, which packs to almost nothing."""
    data = one * count
    return chunk(zstandard.compress(data, 1), len(data), zlib.crc32(data))


def file_of(tmp_path, *records):
    path = tmp_path / "odd.mcap"
    path.write_bytes(MAGIC + b"".join(records))
    return path


def grown(call):
    """MiB by which the peak of memory grows during a call."""
    before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    call()
    return (resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before) / 1024


@pytest.mark.slow
def test_millions_of_messages_in_a_chunk_of_a_few_bytes_are_not_held_at_once(tmp_path):
    path = file_of(tmp_path, repeated(write_record(Message(1, 5, b"", 5, 0)), 300_000))
    file = McapFile(path)
    counted = []
    assert grown(lambda: counted.append(sum(map(len, file.chunks())))) < 100
    assert counted == [300_000]


SHORT = struct.pack("<BQ5s", 5, 5, b"short")  # a message of five bytes


@pytest.mark.parametrize(("one", "count"), [(bytes(1024), 64 * 1024), (SHORT, 1)], ids=["0", "1"])
def test_a_chunk_of_records_that_are_none_is_damaged_at_once(one, count, tmp_path, capsys):
    path = file_of(tmp_path, repeated(one, count))
    _, lines = asked(capsys, path, "--repair", tmp_path / "whole.mcap")
    assert any(DAMAGED in line for line in lines)


def schema(number):
    return Schema(number, bytes(2**20), "", "a")


def channel(number):
    return Channel(number, f"/a{number}", "cdr", {"k": "v" * 2**20}, 0)


@pytest.mark.parametrize("make", [schema, channel])
def test_chunks_that_unpack_to_ever_more_descriptions_are_refused(make, tmp_path, capsys):
    path = file_of(tmp_path, *(repeated(write_record(make(number)), 1) for number in range(1, 80)))
    for way in (["--check"], ["--repair", tmp_path / "whole.mcap"]):
        status, (line,) = asked(capsys, path, *way)
        assert status == 1
        assert "must have at most 67108864 bytes of schemas, channels and metadata" in line
        assert line.endswith(", got more: it is not a log")
    assert not (tmp_path / "whole.mcap").exists()


@pytest.mark.parametrize("size", [2**32, 10 * 2**30, 2**63])
def test_a_chunk_that_lies_about_its_size_costs_no_memory(size, tmp_path):
    file = McapFile(file_of(tmp_path, chunk(zstandard.compress(bytes(2**20)), size, 0)))
    assert grown(lambda: list(file.chunks())) < 50
    assert any(DAMAGED in problem for problem in file.problems)


@pytest.mark.slow
def test_ten_thousand_problems_are_told_in_some_lines(tmp_path, capsys):
    path = file_of(tmp_path, chunk(b"?", 1, 1) * 10_000)
    status, lines = asked(capsys, path, "--repair", tmp_path / "whole.mcap")
    assert status == 0
    assert len(lines) == 21
    assert lines[-1] == "top_replay: 9981 more problems"


def write(path, kind, topic, contents):
    """A log of another writer, of one topic."""
    return write_mcap(path, [(topic, kind, enumerate(contents))])


def test_joints_that_are_not_three_are_not_those_of_a_top(tmp_path, capsys):
    names = [(), ("a",), messages.JOINTS, tuple("abcdefgh")]
    layouts = [messages.JOINT_STATE.layout("world", *each) for each in names]
    data = [each.encode(0, [0.5] * 2 * len(n)) for each, n in zip(layouts, names, strict=True)]
    path = write(tmp_path / "log.mcap", messages.JOINT_STATE.type, "/top/euler_angles", data)
    log = TopLog(McapFile(path))
    (batch,) = log.batches()
    assert batch.columns["euler_angles"].numbers.shape == (1, 6)
    assert "euler_angles: 3 messages: JointState must have 3 joints, got 0" in log.catalog.problems
    assert asked(capsys, path, "--save", tmp_path / "run.rrd")[0] == 0


@pytest.mark.slow
def test_a_frame_of_its_own_for_every_message_is_read_up_to_a_number_and_soon(tmp_path, capsys):
    data = [messages.QUATERNION.layout(f"w{k:05}").encode(k, [0.0, 0, 0, 1]) for k in range(10_000)]
    path = write(tmp_path / "log.mcap", messages.QUATERNION.type, "/top/orientation", data)
    status, lines = asked(capsys, path, "--check")
    assert status == 1
    assert any("messages: a topic must have at most 256 frames" in line for line in lines)


def test_topics_and_events_of_control_characters_are_escaped(tmp_path, capsys):
    topic = f"/{CONTROL * 10_000}/orientation"
    path = write(tmp_path / "log.mcap", "other", topic, [b""])
    status, (line,) = asked(capsys, path, "--check")
    assert status == 1
    assert "\\x1b[31m" in line
    status = decode_statuses(Run(seconds=0.1).messages[0][2])[0]
    event = encode_statuses(0, "w", [status._replace(name=CONTROL * 10_000, values={})])
    path = write(tmp_path / "events.mcap", DIAGNOSTIC_ARRAY, "/top/events", [event])
    assert asked(capsys, path, "--check")[0] == 1
