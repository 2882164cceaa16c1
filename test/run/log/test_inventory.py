"""Bags that are not whole: what `metadata.yaml` counts is compared with what is there."""

import errno
import itertools
import shutil
import sqlite3
from contextlib import closing
from pathlib import Path

import numpy as np
import pytest
import yaml
import zstandard
from rosbags.rosbag2 import CompressionMode, StoragePlugin
from run.log.test_bag import RUN, STORAGES, assert_complete, join, write

from symtop_ros.replay import main as module
from symtop_ros.run.log import bags
from symtop_ros.run.log.bags import SqliteBag, open_run
from symtop_ros.run.log.reader import LogError
from symtop_ros.run.log.top_log import TopLog

SPLITS = 5


def split(folder, storage=StoragePlugin.MCAP, mode=CompressionMode.NONE):
    """A bag of several files, as `ros2 bag record --max-bag-duration` leaves it."""
    cuts = np.linspace(0, len(RUN.messages), SPLITS + 1).astype(int)
    folders = [
        write(folder / f"bag_{k}", RUN.messages[begin:end], storage, mode=mode)
        for k, (begin, end) in enumerate(itertools.pairwise(cuts))
    ]
    return join(folders, folder / "bag")


def change(bag, act):
    """Change the metadata of a bag."""
    path = bag / "metadata.yaml"
    facts = yaml.safe_load(path.read_text())
    act(facts["rosbag2_bagfile_information"])
    path.write_text(yaml.safe_dump(facts))


def keep_in_log(bag, kept):
    """Leave messages after the first ones in the write-ahead log, and return the files of both."""
    (file,) = bag.glob("*.db3")
    with closing(sqlite3.connect(file)) as database:
        database.execute("PRAGMA journal_mode=WAL")
        rows = database.execute("SELECT * FROM messages WHERE id > ?", (kept,)).fetchall()
        database.execute("DELETE FROM messages WHERE id > ?", (kept,))
        database.commit()
        database.execute("PRAGMA wal_checkpoint(TRUNCATE)")
        database.executemany("INSERT INTO messages VALUES (?, ?, ?, ?)", rows)
        database.commit()
        killed = bag.with_name("killed")
        killed.mkdir()
        for each in bag.iterdir():  # while the recorder has it open, as `kill -9` leaves it
            shutil.copy(each, killed)
    return killed


def read_problems(bag):
    return list(TopLog(open_run([bag])).catalog.problems)


def read_losses(bag):
    source = open_run([bag])
    for _ in source.chunks():
        pass
    return [(each.text, each.place) for each in source.losses], source


@pytest.mark.parametrize("storage", STORAGES)
@pytest.mark.parametrize("mode", [CompressionMode.NONE, CompressionMode.FILE])
def test_a_bag_of_which_all_files_are_there_is_whole(storage, mode, tmp_path):
    assert_complete([split(tmp_path, storage, mode)])


@pytest.mark.parametrize("storage", STORAGES)
@pytest.mark.parametrize("mode", [CompressionMode.NONE, CompressionMode.FILE])
def test_the_last_files_of_a_bag_are_missed(storage, mode, tmp_path, capsys):
    bag = split(tmp_path, storage, mode)
    for each in sorted(bag.glob("bag_*"))[-2:]:
        each.unlink()
    assert module.main([str(bag), "--check"]) == 1
    out, err = capsys.readouterr()
    assert "the log ends early\n" in out
    suffix = "mcap" if storage is StoragePlugin.MCAP else "db3"
    said = f"2 files of the bag are missing: bag_3.{suffix}, bag_4.{suffix} (metadata.yaml: "
    assert said in err
    count = len(RUN.messages)
    lost = count - int(count * 3 / SPLITS)
    assert f"{lost} of {count} messages, " in err
    assert "it ended 0.6" in err


def test_a_file_in_the_middle_is_missed_at_its_place(tmp_path):
    bag = split(tmp_path)
    (bag / "bag_2.mcap").unlink()
    ((text, place),), _ = read_losses(bag)
    assert text.startswith("1 file of the bag is missing: bag_2.mcap (metadata.yaml: ")
    assert "ended" not in text
    assert place == int(len(RUN.messages) * 2 / SPLITS)


def test_messages_of_a_write_ahead_log_that_is_lost_are_missed(tmp_path, capsys):
    half = len(RUN.messages) // 2
    killed = keep_in_log(write(tmp_path / "bag", RUN.messages, StoragePlugin.SQLITE3), half)
    for each in (*killed.glob("*-wal"), *killed.glob("*-shm")):
        each.unlink()
    assert module.main([str(killed), "--check"]) == 1
    out, err = capsys.readouterr()
    assert "the log ends early\n" in out
    count = len(RUN.messages)
    assert f"{count - half} of {count} messages are missing in bag.db3 (metadata.yaml: " in err
    assert " on /top/" in err


@pytest.mark.parametrize("has_index", [True, False])
def test_reading_a_write_ahead_log_changes_nothing_next_to_it(has_index, tmp_path):
    half = len(RUN.messages) // 2
    killed = keep_in_log(write(tmp_path / "bag", RUN.messages, StoragePlugin.SQLITE3), half)
    (index,) = killed.glob("*-shm")
    if not has_index:
        index.unlink()
    before = {each.name for each in killed.iterdir()}
    assert_complete([killed])
    assert {each.name for each in killed.iterdir()} == before


class Refusal(sqlite3.OperationalError):
    """What SQLite raises for a disk that cannot be read."""

    sqlite_errorcode = sqlite3.SQLITE_IOERR | 1 << 8  # SQLITE_IOERR_READ


def test_a_medium_that_fails_is_not_said_to_be_a_file_of_another_kind(tmp_path, monkeypatch):
    bag = write(tmp_path / "bag", RUN.messages, StoragePlugin.SQLITE3)

    def refuse(*_, **__):
        raise Refusal("disk I/O error")

    monkeypatch.setattr(bags.sqlite3, "connect", refuse)
    with pytest.raises(LogError, match=r"bag.db3: it cannot be read here \(disk I/O error\)$"):
        open_run([bag])


def test_a_medium_that_fails_later_is_not_said_to_be_damage_of_the_file(tmp_path, monkeypatch):
    bag = write(tmp_path / "bag", RUN.messages, StoragePlugin.SQLITE3)
    source = open_run([bag])
    rows = SqliteBag._rows

    def fail(self, query):
        yield from itertools.islice(rows(self, query), 100)
        raise Refusal("disk I/O error")

    monkeypatch.setattr(SqliteBag, "_rows", fail)
    assert sum(map(len, source.chunks())) == 100
    first = source.losses[0].text
    assert first == "the bag cannot be read after the messages that were read: disk I/O error"


def test_a_full_disk_for_the_copy_of_a_write_ahead_log_is_named(tmp_path, monkeypatch):
    killed = keep_in_log(write(tmp_path / "bag", RUN.messages, StoragePlugin.SQLITE3), 100)
    next(killed.glob("*-shm")).unlink()

    def refuse(*_):
        raise OSError(errno.ENOSPC, "No space left on device")

    monkeypatch.setattr(bags.shutil, "copyfile", refuse)
    with pytest.raises(LogError, match=r"cannot open \S+bag.db3: No space left on device"):
        open_run([killed])


def test_a_database_that_replaced_a_longer_one_is_short(tmp_path):
    bag = write(tmp_path / "bag", RUN.messages, StoragePlugin.SQLITE3)
    shorter = write(tmp_path / "shorter", RUN.messages[:-7], StoragePlugin.SQLITE3)
    shutil.copy(shorter / "shorter.db3", bag / "bag.db3")
    ((text, place),), source = read_losses(bag)
    assert text.startswith(f"7 of {len(RUN.messages)} messages are missing in bag.db3")
    assert place == source.count == len(RUN.messages) - 7


def test_older_metadata_without_counts_of_files_misses_messages_by_topic(tmp_path):
    bag = write(tmp_path / "bag", RUN.messages[:-7])
    whole = write(tmp_path / "whole", RUN.messages)
    shutil.copy(whole / "metadata.yaml", bag)
    change(bag, lambda about: (about.pop("files"), about.update(relative_file_paths=["bag.mcap"])))
    ((text, place),), source = read_losses(bag)
    count = len(RUN.messages)
    assert text.startswith(f"messages of the bag are missing (metadata.yaml: 7 of {count} messages")
    assert place == source.count


def test_paths_in_metadata_may_have_folders(tmp_path):
    bag = write(tmp_path / "bag", RUN.messages)
    change(bag, lambda about: about.update(relative_file_paths=["bag/bag.mcap"]))
    assert_complete([bag])


def test_messages_that_metadata_does_not_count_are_no_loss(tmp_path):
    """As a recorder that was killed after its first file may leave them."""
    bag = write(tmp_path / "bag", RUN.messages)
    fewer = write(tmp_path / "fewer", RUN.messages[:100])
    shutil.copy(fewer / "metadata.yaml", bag)
    change(bag, lambda about: about.update(relative_file_paths=["bag.mcap"]))
    assert_complete([bag])


def test_a_message_that_is_counted_in_the_file_before_its_own_is_no_loss(tmp_path):
    """As a recorder with a cache may count those at a split; it closed after its last message."""
    bag = split(tmp_path)

    def move(about):
        about["files"][0]["message_count"] += 1
        about["files"][1]["message_count"] -= 1
        about["duration"]["nanoseconds"] += 10**9

    change(bag, move)
    assert_complete([bag])


def test_messages_that_cannot_be_decompressed_are_there(tmp_path):
    pack = zstandard.ZstdCompressor().compress
    messages = [(name, stamp, pack(data)) for name, stamp, data in RUN.messages]
    name, stamp, data = messages[40]
    messages[40] = name, stamp, data[:8] + b"\xff" * 8
    losses, _ = read_losses(write(tmp_path / "bag", messages))
    assert losses == [("messages that cannot be decompressed: 1", 0)]


def test_a_bag_that_is_read_twice_has_its_losses_once(tmp_path):
    bag = split(tmp_path)
    (bag / "bag_4.mcap").unlink()
    source = open_run([bag])
    for _ in range(2):
        for _ in source.chunks():
            pass
        assert len(source.losses) == 1


def test_of_two_bags_with_files_of_the_same_names_each_has_its_own_counts(tmp_path):
    cut = 2 * len(RUN.messages) // 3
    folders = [
        write(tmp_path / place / "bag", part)
        for place, part in (("a", RUN.messages[:cut]), ("b", RUN.messages[cut:]))
        if (tmp_path / place).mkdir() is None
    ]
    assert_complete(folders)
    shutil.copy(folders[1] / "bag.mcap", folders[0])
    assert any("missing in bag.mcap" in text for text, _ in read_losses(folders[0])[0])


NO_METADATA = [
    b"",
    b"text",
    b"- 1",
    b"a: [",
    b"\xff\xfe",
    b"[" * 5000,
    b"x: !!python/object:os.x 1",
]


@pytest.mark.parametrize("content", NO_METADATA)
def test_metadata_that_is_damaged_is_said_to_be(content, tmp_path):
    bag = write(tmp_path / "bag", RUN.messages)
    (bag / "metadata.yaml").write_bytes(content)
    (problem,) = read_problems(bag)
    assert problem.endswith(
        "metadata.yaml is damaged, so missing messages are not known: it is not what rosbag2 writes"
    )


@pytest.mark.parametrize("count", [-1, 0.5, "many", None, 2**64, True])
def test_counts_that_are_none_are_damage_of_the_metadata(count, tmp_path):
    bag = write(tmp_path / "bag", RUN.messages)
    change(bag, lambda about: about.update(message_count=count))
    (problem,) = read_problems(bag)
    assert problem.endswith(f"so missing messages are not known: a count is {count}")


def test_metadata_that_cannot_be_read_is_said_to_be(tmp_path, monkeypatch):
    bag = write(tmp_path / "bag", RUN.messages)
    opened = Path.open

    def refuse(path, *args, **names):
        if path.name == "metadata.yaml":
            raise PermissionError(errno.EACCES, "Permission denied")
        return opened(path, *args, **names)

    monkeypatch.setattr(Path, "open", refuse)
    (problem,) = read_problems(bag)
    assert problem.endswith("metadata.yaml, so missing messages are not known: Permission denied")
