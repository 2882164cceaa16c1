"""Bytes of a file that no reader of messages looks at are verified: indexes and checksums."""

import random

import pytest
from log_files import list_records
from mcap.opcode import Opcode
from trials import choose, seeds

from symtop_ros.run.check.run import check_run
from symtop_ros.run.log.checksums import read_damage
from symtop_ros.run.log.reader import McapFile
from symtop_ros.run.log.top_log import TopLog


@pytest.fixture(scope="module")
def log(path):
    return path.read_bytes()


def flip(data, place, bit):
    """The bytes with one bit flipped."""
    return data[:place] + bytes([data[place] ^ 1 << bit]) + data[place + 1 :]


def find_all(path):
    """All that reading and verifying a file finds."""
    file = McapFile(path)
    for _ in file.chunks():
        pass
    return file.problems + read_damage(path)


@pytest.mark.parametrize("seed", seeds(3, 30))
def test_a_flipped_bit_anywhere_is_found(log, tmp_path, seed):
    rng = random.Random(seed)
    path = tmp_path / "run.mcap"
    for _ in range(20):
        place = rng.randrange(len(log))
        bit = rng.randrange(8)
        path.write_bytes(flip(log, place, bit))
        assert find_all(path), (place, bit)


KINDS = [*range(Opcode.HEADER, Opcode.DATA_END + 1)]
ABSENT = [Opcode.MESSAGE, Opcode.ATTACHMENT, Opcode.ATTACHMENT_INDEX]  # or in chunks alone


@pytest.mark.parametrize("opcode", choose({*KINDS}.difference(ABSENT), (Opcode.DATA_END,)))
def test_a_flipped_bit_in_the_head_of_a_record_is_found(log, tmp_path, opcode):
    path = tmp_path / "run.mcap"
    begin = next(begin - 9 for kind, begin, _ in list_records(log) if kind == opcode)
    for bit in range(72):
        path.write_bytes(flip(log, begin + bit // 8, bit % 8))
        assert find_all(path), bit


OPCODES = [Opcode.MESSAGE_INDEX, Opcode.DATA_END, Opcode.FOOTER, Opcode.STATISTICS]


@pytest.mark.parametrize("opcode", OPCODES)
def test_a_flipped_bit_in_each_kind_of_record_is_found(log, tmp_path, opcode):
    rng = random.Random(4)
    path = tmp_path / "run.mcap"
    records = [(begin, end) for kind, begin, end in list_records(log) if kind == opcode]
    assert records
    for _ in range(20):
        place = rng.randrange(*rng.choice(records))
        path.write_bytes(flip(log, place, rng.randrange(8)))
        assert read_damage(path), place


def test_indexes_are_verified_without_a_checksum_of_the_data(log, tmp_path):
    path = tmp_path / "run.mcap"
    ((begin, end),) = ((b, e) for kind, b, e in list_records(log) if kind == Opcode.DATA_END)
    unsigned = log[:begin] + bytes(end - begin) + log[end:]
    path.write_bytes(unsigned)
    assert read_damage(path) == []
    first = next(b for kind, b, _ in list_records(log) if kind == Opcode.MESSAGE_INDEX)
    path.write_bytes(flip(unsigned, first + 6, 3))
    (problem,) = read_damage(path)
    assert problem.startswith("the index of messages before byte ")
    path.write_bytes(flip(log, first + 5, 6))  # the number of its entries
    problem, *_ = read_damage(path)
    assert problem.startswith("the record before byte ")


def test_a_check_of_a_run_names_the_damage(log, tmp_path):
    path = tmp_path / "run.mcap"
    begin = next(b for kind, b, _ in list_records(log) if kind == Opcode.MESSAGE_INDEX)
    path.write_bytes(flip(log, begin + 6, 3))
    log = TopLog(McapFile(path))
    findings = check_run(log)
    assert findings.samples_agree
    assert findings.mismatches == []
    assert not findings.foreign
    first, second = log.catalog.problems
    assert "index of messages" in first
    assert "checksum of the data" in second
