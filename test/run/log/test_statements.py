"""Files that are damaged at random: the reported losses are compared with what is lost."""

import random
import re
from collections import Counter

import pytest
from log_files import BEGIN, Run, list_records, write_mcap
from mcap.opcode import Opcode
from mcap.writer import IndexType
from trials import seeds

from symtop_ros.run.log.reader import McapFile

RUN = Run(seconds=2.0, rate=100.0)
SIZES = 1, 8, 40, 500, 5000  # bytes that are damaged
COUNTED = re.compile(r"a chunk is damaged: (\d+) messages? of (\S+) \.\. (\S+) s (?:is|are) lost")
TIMED = re.compile(r"a chunk is damaged: (its) messages, of (\S+) \.\. (\S+) s, are lost")
CHUNKS = re.compile(
    r"bytes \d+ to \d+ .*: (.*) (?:is|are) lost, with messages of (\S+) \.\. (\S+) s"
)
MISSING = re.compile(r"(\d+) of (\d+) messages that the index counts (?:is|are) missing")
SHIFTED = re.compile(r"(\d+) bytes? before the index (?:is|are) missing: messages may be lost")
INSERTED = re.compile(r"(\d+) bytes? (?:was|were) inserted before the index")
NOTHING_LOST = re.compile(
    r"bytes \d+ to \d+ are damaged|a chunk without messages is damaged|"
    r"\d+ bytes? (?:was|were) inserted before the index"
)
MAY_BE_LOST = re.compile(r".*(may be lost|its messages are lost)|the record before .* is damaged")


@pytest.fixture(scope="module")
def good(tmp_path_factory):
    return RUN.write(tmp_path_factory.mktemp("logs")).read_bytes()


def read(folder, data):
    path = folder / "odd.mcap"
    path.write_bytes(data)
    file = McapFile(path)
    messages = [(each.log_time, each.data) for run in file.chunks() for each in run]
    return file.problems, messages


def flip(data, rng, records):
    begin, end = rng.choice(records)
    place = rng.randrange(begin, rng.choice((begin + 9, end)))
    return data[:place] + bytes([data[place] ^ 1 << rng.randrange(8)]) + data[place + 1 :]


def zero(data, rng, records):
    place = rng.choice(records)[0] + rng.choice((0, 9, 17, rng.randrange(500)))
    size = len(data[place : place + rng.choice(SIZES)])
    return data[:place] + bytes(size) + data[place + size :]


def cut(data, rng, records):
    return data[: rng.choice((rng.choice(records)[0], rng.randrange(8, len(data))))]


def take_out(data, rng, _):
    place = rng.randrange(8, len(data))
    return data[:place] + data[place + rng.choice(SIZES) :]


def insert(data, rng, _):
    place = rng.randrange(8, len(data))
    return data[:place] + rng.randbytes(rng.choice(SIZES)) + data[place:]


def take_out_record(data, rng, records):
    begin, end = rng.choice(records)
    return data[:begin] + data[end:]


def repeat_record(data, rng, records):
    begin, end = rng.choice(records)
    return data[:end] + data[begin:]


WAYS = flip, zero, cut, take_out, insert, take_out_record, repeat_record


@pytest.mark.parametrize("seed", seeds(1, 200))
@pytest.mark.parametrize("way", WAYS)
def test_what_a_file_is_said_to_have_lost_is_lost_and_nothing_else(way, seed, good, tmp_path):
    rng = random.Random(seed)
    records = [(begin - 9, end) for _, begin, end in list_records(good)]
    _, whole = read(tmp_path, good)
    for _ in range(15):
        data = way(good, rng, records)
        problems, found = read(tmp_path, data)
        assert_true(problems, Counter(whole) - Counter(found), len(data) - len(good))
        extra = Counter(found) - Counter(whole)
        assert not extra or way is repeat_record
        told = [each for each in problems if not NOTHING_LOST.fullmatch(each)]
        assert told or set(found) == set(whole)


@pytest.mark.slow
@pytest.mark.parametrize("part", seeds(1, 20))
def test_a_flipped_bit_in_the_head_of_a_record_loses_what_is_said_and_nothing_else(
    part, good, tmp_path
):
    _, whole = read(tmp_path, good)
    heads = [begin - 9 for _, begin, _ in list_records(good)]
    for place, bit in [(head + k // 8, k % 8) for head in heads for k in range(72)][part::20]:
        flipped = bytes([good[place] ^ 1 << bit])
        problems, found = read(tmp_path, good[:place] + flipped + good[place + 1 :])
        assert_true(problems, Counter(whole) - Counter(found), 0)
        told = [each for each in problems if not NOTHING_LOST.fullmatch(each)]
        assert told or found == whole, place


def assert_true(problems, lost, longer):
    """Compare sentences with the messages that are lost, and the bytes that a file is longer."""
    counted, is_counted = 0, True
    times = [(stamp - BEGIN) * 1e-9 for stamp, _ in lost.elements()]
    for text in problems:
        if found := COUNTED.fullmatch(text) or TIMED.fullmatch(text) or CHUNKS.fullmatch(text):
            inside = [each for each in times if spans(found[2], each, found[3])]
            for end, time in zip(found.groups()[1:], (min(inside), max(inside)), strict=True):
                assert end == f"{time:.3f}", text
        if found := COUNTED.fullmatch(text) or MISSING.fullmatch(text):
            counted += int(found[1])
        elif found := SHIFTED.fullmatch(text) or INSERTED.fullmatch(text):
            assert abs(longer) == int(found[1])
            assert (longer < 0) == bool(SHIFTED.fullmatch(text))
            is_counted = False
        elif not NOTHING_LOST.fullmatch(text):
            assert TIMED.fullmatch(text) or CHUNKS.fullmatch(text) or MAY_BE_LOST.fullmatch(text)
            is_counted = False
    assert counted == lost.total() or (not is_counted and counted < lost.total())


def spans(first, time, last):
    return float(first) - 6e-4 <= time <= float(last) + 6e-4


def test_a_chunk_whose_head_is_zero_is_damaged_and_not_empty(good, tmp_path):
    chunks = [b for kind, b, _ in list_records(good) if kind == Opcode.CHUNK]
    begin = chunks[2]
    problems, found = read(tmp_path, good[:begin] + bytes(40) + good[begin + 40 :])
    (problem,) = problems
    assert COUNTED.fullmatch(problem)[1] == str(len(RUN.messages) - len(found))


def test_an_index_that_a_flipped_bit_makes_a_chunk_loses_no_messages(good, tmp_path):
    place = next(b - 9 for kind, b, _ in list_records(good) if kind == Opcode.MESSAGE_INDEX)
    problems, found = read(tmp_path, good[:place] + bytes([Opcode.CHUNK]) + good[place + 1 :])
    assert len(found) == len(RUN.messages)
    assert all(each.startswith("the record before byte ") for each in problems)


def test_a_log_whose_last_record_is_damaged_was_finished(good, tmp_path):
    place = next(b - 9 for k, b, e in list_records(good) if b"symtop_ros.end" in good[b:e])
    problems, found = read(tmp_path, good[:place] + b"\x7f" + good[place + 1 :])
    assert len(found) == len(RUN.messages)
    assert problems == [
        "the log has no record of its end: messages after the last one, at 1.990 s, may be lost"
    ]


@pytest.mark.parametrize("index", [IndexType.ALL, IndexType.CHUNK])
def test_a_damaged_chunk_with_a_message_at_the_time_0_has_messages(index, tmp_path):
    words = [("/words", "std_msgs/msg/String", [(0, bytes(500)), (10**9, bytes(500))])]
    options = {"chunk_size": 400, "index_types": index}
    data = write_mcap(tmp_path / "good.mcap", words, **options).read_bytes()
    begin = next(b for kind, b, _ in list_records(data) if kind == Opcode.CHUNK)
    data = data[: begin + 60] + b"\xff" + data[begin + 61 :]
    problems, found = read(tmp_path, data)
    assert len(found) == 1
    lost = "its messages, of" if index == IndexType.CHUNK else "1 message of"
    assert problems[0].startswith(f"a chunk is damaged: {lost} 0.000 .. 0.000 s")


DROPPED = "8 messages were dropped: the disk was too slow, if the record of the end is not damaged"
COUNTS = [(b"8", DROPPED), (b"x", "the record of the end of the log is damaged")]


@pytest.mark.parametrize(("count", "said"), COUNTS)
def test_a_damaged_count_of_dropped_messages_is_not_a_fact(count, said, good, tmp_path):
    head, key, rest = good.rpartition(b"dropped\x01\0\0\0")
    problems, _ = read(tmp_path, head + key + count + rest[1:])
    assert problems == [said]
