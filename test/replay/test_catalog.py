"""One table: what each of six readers makes of a log that is damaged or odd."""

from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path

import pytest
from run.log.damaged import CHUNK, SECOND, Log, Recorded, cut_end, zero, zero_chunk
from trials import choose

from symtop_ros.replay.main import main as replay
from symtop_ros.truth.judge.main import main as judge

KICKS = 1_310_000_000, 2_610_000_000  # ns
REMAPPED = {
    "~/events": "/ev",
    "~/orientation": "/attitude",
    "~/imu": "/imu/data",
    "/tf": "/tf2",
    "/diagnostics": "/health",
    "~/robot_description": "/urdf",
}


def record(folder, names=None):
    """The log of a run with two kicks: events 1, 2 and 3."""
    recorded = Recorded(folder, names, imu__enabled=True)
    for seconds in (1.3, 1.3):
        recorded.run(seconds)
        recorded.kick()
    recorded.run(1.9)
    (path,) = recorded.close()
    return Log.read(path)


@pytest.fixture(scope="module")
def log(tmp_path_factory):
    return record(tmp_path_factory.mktemp("whole"))


@pytest.fixture(scope="module")
def remapped(tmp_path_factory):
    return record(tmp_path_factory.mktemp("remapped"), REMAPPED)


# Each makes the files of a case in a folder from the log.


def damage_chunk(time):
    def make(log, folder):
        zero_chunk(log.write(folder / "run.mcap"), time)

    return make


def lose_event(number):
    def make(log, folder):
        log.without([log.places("/events")[number - 1]]).write(folder / "run.mcap")

    return make


def damage_index(log, folder):
    path = log.write(folder / "run.mcap")
    zero(path, path.stat().st_size - 300, 100)


def cut(log, folder):
    path = log.write(folder / "run.mcap")
    path.write_bytes(path.read_bytes()[: path.stat().st_size * 2 // 3])


def double(log, folder):
    messages = [each for message in log.messages for each in (message, message)]
    replace(log, messages=messages).write(folder / "run.mcap")


def reverse_chunks(log, folder):
    chunks: dict[int, list] = {}
    for each in log.messages:
        chunks.setdefault(each.log_time // CHUNK, []).append(each)
    messages = [each for chunk in reversed(chunks.values()) for each in chunk]
    replace(log, messages=messages).write(folder / "run.mcap")


def split(log, folder, left_out=()):
    """Three files, each of which begins with the latest event, as the recorder leaves them."""
    for number, part in enumerate(log.split(map(log.find_time, (SECOND, 2 * SECOND)))):
        if number not in left_out:
            part.write(folder / f"{number}.mcap")


def lose_file(log, folder):
    split(log, folder, left_out=(1,))


def write(log, folder):
    log.write(folder / "run.mcap")


def change_rate(_, folder):
    """Two recordings of one run, between which the rate was changed; the second one is slower."""
    run_with_rates(folder, 200.0, 100.0)


def change_rate_back(_, folder):
    run_with_rates(folder, 100.0, 200.0)


def run_with_rates(folder, first, second):
    recorded = Recorded(folder, publish_rate=first)
    recorded.run(1.3)
    recorded.ask("record", False)
    recorded.session.apply_settings({"publish_rate": second})
    recorded.run(0.5)
    recorded.ask("record", True)
    recorded.run(1.3)
    recorded.close()


def lose_after_a_change_of_rate(_, folder):
    """Ten samples are lost in the faster one of two recordings."""
    run_with_rates(folder / "whole", 100.0, 200.0)
    for number, path in enumerate(sorted((folder / "whole").glob("*.mcap"))):
        log = Log.read(path)
        span = range(2_200_000_000, 2_250_000_000) if number else ()
        lost = [k for k, each in enumerate(log.messages) if each.log_time in span]
        log.without(lost).write(folder / path.name)


def move_clock(_, folder):
    """The clock goes forth and back: to a time of before, and to one that no sample has."""
    recorded = Recorded(folder)
    recorded.jump(100.0)
    for time in (None, 100.5, 0.0, 7.0, 50.0):
        if time is not None:
            recorded.jump(time)
        recorded.run(0.8)
        recorded.kick()
        recorded.run(0.7)
    recorded.close()


def kill(_, folder):
    """A node is killed before it has counted what it missed."""
    recorded = Recorded(folder)
    recorded.run(1.2)
    recorded.stop(1.5)
    recorded.run(0.15)
    (path,) = recorded.close()
    cut_end(path)


CHUNK_LOST, EVENT_LOST = "a chunk is damaged: ", "is missing, "
BEGINNING, NOTHING = "the beginning is missing: ", ""


@dataclass(frozen=True)
class Case:
    """A log, the first lines of its readers, and the status of those that judge samples."""

    make: Callable[[Log, Path], None]
    says: tuple[str, ...] = ()  # the begin of each problem, or a part of it
    check: int = 0
    judge: int = 0
    topic: str = "/top/orientation"
    unjudged: bool = False  # True if samples follow from an event that is missing


def broken(make, *says, **more):
    return Case(make, says, check=1, judge=1, **more)


CASES = {
    "whole": Case(write),
    "everything is remapped": Case(write, topic="/attitude"),
    "an event lost with its chunk: first": broken(damage_chunk(0), CHUNK_LOST, BEGINNING),
    "middle": broken(damage_chunk(KICKS[0]), CHUNK_LOST, "event 2 is missing, ", unjudged=True),
    "last": broken(damage_chunk(KICKS[1]), CHUNK_LOST, "event 3 is missing, ", unjudged=True),
    "an event lost alone: first": broken(lose_event(1), BEGINNING),
    "middle alone": broken(lose_event(2), "event 2 is missing, ", unjudged=True),
    "last alone": broken(lose_event(3), "event 3 is missing, ", unjudged=True),
    "a chunk lost without an event": broken(
        damage_chunk(2_100_000_000), CHUNK_LOST, "25 samples are missing"
    ),
    "the index damaged": Case(damage_index, ("the summary is damaged",), check=1),
    "the end cut": broken(cut, "the file ends or is unreadable"),
    "killed after a stop": broken(
        kill,
        "the file ends or is unreadable",
        "from 1200000001 ns on the motion is not known: ",
        "tf: 49 samples are missing, between 1200000000 and 1700000000 ns; no count of the node",
    ),
    "split": Case(split),
    "a file of a split missing": broken(lose_file, "samples are missing"),
    "messages doubled": broken(double, "3 events are repeated", "451 samples are repeated"),
    "chunks in reversed order": Case(reverse_chunks),
    "a slower rate in the second file": Case(change_rate),
    "a faster rate in the second file": Case(change_rate_back),
    "samples lost after a change of rate": broken(
        lose_after_a_change_of_rate, "10 samples are missing"
    ),
    "the clock goes forth and back": Case(move_clock, judge=1),
}
EARLY = {  # what else is said of logs that only end early
    "the end cut": "",
    "killed after a stop": ", and samples before its end may be lost",
}
READERS = "check", "judge", "clock", "replay", "save", "repair"
PAIRS = [(name, reader) for name in CASES for reader in READERS]
# A quarter of them, with each reader and each case: in each row the next places.
OFTEN = [pair for k, pair in enumerate(PAIRS) if (k + k // len(READERS)) % 4 == 0]


def call(reader, case, paths, folder):
    """The status of a reader."""
    files = [*map(str, paths)]
    if reader == "check":
        return replay([*files, "--check"])
    if reader in ("judge", "clock"):
        way = ["--topic", case.topic, "--aligned", "none"]
        return judge([*files, *(way if reader == "judge" else ["--clock", case.topic])])
    if reader == "repair":
        found = {replay([each, "--repair", str(folder / f"{k}")]) for k, each in enumerate(files)}
        (status,) = found
        return status
    target = folder / ("run.rrd" if reader == "replay" else "run.html")
    return replay([*files, "--save", str(target)])


@pytest.mark.parametrize("pair", choose(PAIRS, OFTEN))
def test_each_reader_says_what_is_wrong_first(pair, log, remapped, tmp_path, capsys):
    name, reader = pair
    case = CASES[name]
    (tmp_path / "log").mkdir()
    case.make(remapped if case.topic == "/attitude" else log, tmp_path / "log")
    paths = sorted((tmp_path / "log").glob("*.mcap"))
    status = call(reader, case, paths, tmp_path)
    out, err = capsys.readouterr()
    expected = {"check": case.check, "judge": case.judge, "clock": case.judge}
    assert status == expected.get(reader, 0), err
    lines = err.splitlines()
    if reader == "repair" and len(paths) > 1:
        return  # each file is repaired alone, and says nothing of the others
    assert bool(lines) == bool(case.says or status), err
    for says in case.says:
        assert any(says in line for line in lines), (says, err)
    assert "DO NOT agree" not in out
    if reader == "check":
        assert ("not compared: the motion is not known" in out) == case.unjudged
        early = EARLY.get(name)
        assert (f"the log ends early{early}\n" in out) == (early is not None)
        assert ("the log is damaged or incomplete\n" in out) == (status and early is None)
    if reader == "judge" and (case.unjudged or BEGINNING in case.says):
        assert "cannot be judged: the motion is not known there" in err
    if reader in ("judge", "clock"):
        assert "not explained" not in out


@pytest.mark.parametrize("count", [1, 2])
def test_a_repair_of_a_folder_or_of_several_files_is_refused(count, tmp_path, capsys):
    assert replay([str(tmp_path)] * count + ["--repair", str(tmp_path / "whole.mcap")]) == 1
    got = f"the folder {tmp_path}" if count == 1 else count
    said = f"top_replay: --repair must be given one MCAP file, got {got}\n"
    assert capsys.readouterr().err == said
    assert list(tmp_path.iterdir()) == []


LOST = [name for name, case in CASES.items() if case.check and name != "the index damaged"]


@pytest.mark.parametrize("name", LOST)
def test_a_repaired_log_has_the_account_of_the_damaged_one(name, log, tmp_path, capsys):
    (tmp_path / "log").mkdir()
    CASES[name].make(log, tmp_path / "log")
    paths = sorted((tmp_path / "log").glob("*.mcap"))
    for number, path in enumerate(paths):
        assert replay([str(path), "--repair", str(tmp_path / f"{number}.mcap")]) == 0
    capsys.readouterr()
    repaired = sorted(tmp_path.glob("*.mcap"))
    assert replay([*map(str, repaired), "--check"]) == 1
    out, err = capsys.readouterr()
    assert "DO NOT agree" not in out
    for says in CASES[name].says:
        assert says in err
