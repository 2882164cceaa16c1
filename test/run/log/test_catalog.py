"""The catalog of logs of other writers, and of logs that are odd and sound."""

import random
import re
import struct
from dataclasses import replace

import pytest
from log_files import list_records
from mcap.data_stream import RecordBuilder
from mcap.opcode import Opcode
from mcap.reader import make_reader
from mcap.records import Attachment, Message, Metadata
from mcap.writer import Writer
from run.log.damaged import Log, Recorded, cut_end, list_chunks, zero_chunk
from run.log.variants import INPUTS, list_variants, write_variant
from trials import seeds

from symtop_ros.base.counts import write_count
from symtop_ros.run.check.run import check_run
from symtop_ros.run.log.bags import open_run
from symtop_ros.run.log.catalog import read_catalog
from symtop_ros.run.log.names import Names
from symtop_ros.run.log.reader import RECORD_START, LogError, McapFile
from symtop_ros.run.log.repair import repair
from symtop_ros.run.log.top_log import TopLog

KEPT = Message, Attachment, Metadata


@pytest.fixture(scope="module")
def log(tmp_path_factory):
    """A run with a kick: events 1 and 2."""
    recorded = Recorded(tmp_path_factory.mktemp("run"))
    recorded.run(1.2)
    recorded.kick()
    recorded.run(1.3)
    (path,) = recorded.close()
    return Log.read(path)


def catalog_of(path):
    file = McapFile(path)
    return file, read_catalog(file, Names(file))


def test_there_are_all_variants_of_the_conformance_tests():
    assert len(list(list_variants())) == 416


@pytest.mark.parametrize("name", INPUTS)
def test_every_legal_variant_is_sound_and_repaired_with_all_that_it_has(name, tmp_path):
    for number, (_, features) in enumerate(v for v in list_variants() if v[0] == name):
        path = tmp_path / "odd.mcap"
        target = tmp_path / f"{number}.mcap"
        path.write_bytes(write_variant(name, features))
        file, catalog = catalog_of(path)
        assert (catalog.problems, catalog.notes) == ((), ()), features
        found = repair(file, target, catalog)
        counts = found.messages, found.attachments, found.metadata
        own = INPUTS[name]
        expected = (sum(isinstance(each, kind) for each in own) for kind in KEPT)
        assert counts == tuple(expected), features
        with target.open("rb") as stream:
            reader = make_reader(stream)
            assert len(list(reader.iter_messages(log_time_order=False))) == found.messages
            assert len(list(reader.iter_attachments())) == found.attachments
            assert len(list(reader.iter_metadata())) == found.metadata


def test_a_repair_keeps_attachments_and_says_so(log, tmp_path):
    notes = Attachment(0, 0, "notes.txt", "text/plain", b"a fine run")
    path = replace(log, attachments=[notes]).write(tmp_path / "run.mcap")
    file, catalog = catalog_of(path)
    found = repair(file, tmp_path / "whole.mcap", catalog)
    assert str(found) == f"{len(log.messages)} messages, 1 attachment"
    assert list(McapFile(tmp_path / "whole.mcap").attachments()) == [notes]


def test_a_damaged_attachment_is_told_and_not_copied(log, tmp_path):
    notes = Attachment(0, 0, "notes.txt", "text/plain", b"a fine run")
    path = replace(log, attachments=[notes]).write(tmp_path / "run.mcap")
    path.write_bytes(path.read_bytes().replace(b"a fine run", b"a fine rum"))
    file, catalog = catalog_of(path)
    assert catalog.problems[0].startswith("the record before byte ")
    assert repair(file, tmp_path / "whole.mcap", catalog).attachments == 0


def write_large(path, log, size):
    """The log with a sparse attachment before its end, without checksums of the data."""
    whole = log.write(path.with_name("whole.mcap"), enable_crcs=False).read_bytes()
    end = whole.rindex(struct.pack("<BQ", Opcode.DATA_END, 4))
    head = bytes(16) + struct.pack("<I3sI3sQ", 3, b"big", 3, b"bin", size)
    with path.open("wb") as stream:
        stream.write(whole[:end] + struct.pack("<BQ", Opcode.ATTACHMENT, len(head) + size + 4))
        stream.write(head)
        stream.seek(size + 4, 1)
        # without a summary, whose offsets would have to change
        stream.write(struct.pack("<BQI", Opcode.DATA_END, 4, 0))
        stream.write(struct.pack("<BQQQI", Opcode.FOOTER, 20, 0, 0, 0) + whole[:8])


def test_an_attachment_of_any_size_is_passed_over(log, tmp_path):
    path = tmp_path / "run.mcap"
    write_large(path, log, 300 * 2**20)
    _, catalog = catalog_of(path)
    assert catalog.problems == ()
    assert catalog.topics["orientation"].count == len(log.places("/orientation"))


def test_messages_between_chunks_are_read(log, tmp_path):
    """A writer may put a message anywhere; here each second one is behind its chunk."""
    path = tmp_path / "run.mcap"
    with path.open("wb") as stream:
        writer = Writer(stream)
        writer.start("ros2")
        numbers = {n: log.register(writer, each) for n, each in log.channels.items()}
        writer.add_metadata("symtop_ros", log.metadata["symtop_ros"])
        for k, each in enumerate(log.messages):
            message = replace(each, channel_id=numbers[each.channel_id])
            if k % 2:
                writer.flush()
                message.write(record := RecordBuilder())
                stream.write(record.end())
            else:
                writer.add_message(message.channel_id, each.log_time, each.data, each.publish_time)
        writer.add_metadata("symtop_ros.end", log.metadata["symtop_ros.end"])
        writer.finish()
    _, catalog = catalog_of(path)
    assert catalog.problems == ()
    assert catalog.topics["torque"].count == len(log.places("/torque"))


@pytest.mark.parametrize("repeated", [1, 2, 3])
def test_events_that_a_recorder_repeats_at_the_begin_of_each_file_are_none_too_many(
    repeated, tmp_path
):
    """As `ros2 bag record --repeat-transient-local /top/events=2` with split files."""
    recorded = Recorded(tmp_path / "run")
    for _ in range(4):
        recorded.run(0.5)
        recorded.kick()
    (path,) = recorded.close()
    whole = Log.read(path)
    half = len(whole.messages) // 2
    before = [k for k in whole.places("/events") if k < half][-repeated:]
    head = [replace(whole.messages[k], log_time=whole.messages[half].log_time) for k in before]
    paths = [tmp_path / "a.mcap", tmp_path / "b.mcap"]
    replace(whole, messages=whole.messages[:half]).write(paths[0])
    replace(whole, messages=head + whole.messages[half:]).write(paths[1])
    assert TopLog(open_run(paths)).catalog.problems == ()
    twice = replace(whole, messages=whole.messages[:half] + head + whole.messages[half:])
    problems = TopLog(open_run([twice.write(tmp_path / "c.mcap")])).catalog.problems
    assert problems == (f"{write_count(len(head), 'event', 'are')} repeated",)


def test_an_event_of_another_file_that_differs_is_told(log, tmp_path):
    kick = log.places("/events")[1]
    half = kick + 50
    event = log.messages[kick]
    other = replace(event, data=event.data.replace(b"closed form", b"closed farm"))
    assert other != event
    changed = replace(log, messages=[*log.messages[:half], other, *log.messages[half:]])
    problems = TopLog(McapFile(changed.write(tmp_path / "run.mcap"))).catalog.problems
    assert problems == ("event 2 at 1210000000 ns is there twice, and the two differ",)


def test_a_node_that_was_started_again_has_two_runs_in_one_folder(tmp_path):
    for name, start, weight in (("a", 0.0, 0.068), ("b", 50.0, 0.06)):
        recorded = Recorded(tmp_path / name, top__Mgl=weight)
        recorded.jump(start)
        recorded.run(1.2)
        recorded.kick()
        recorded.run(0.5)
        recorded.close()
    paths = sorted(tmp_path.glob("*/*.mcap"))
    catalog = TopLog(open_run(paths)).catalog
    assert catalog.problems == ()
    assert [event.number for event in catalog.events] == [1, 2, 3, 1, 2, 3]


KINDS = [
    (b"version https://git-lfs.github.com/spec/v1\noid sha256:0\n", "a pointer of Git LFS and not"),
    (b"#ROSBAG V2.0\n" + bytes(100), "a bag of ROS 1: rosbags-convert --src FILE --dst FOLDER"),
]


@pytest.mark.parametrize(("content", "kind"), KINDS)
@pytest.mark.parametrize("suffix", ["mcap", "db3", "bag", "mcap.zstd"])
def test_files_of_other_kinds_are_named(content, kind, suffix, tmp_path):
    path = tmp_path / f"run.{suffix}"
    path.write_bytes(content)
    with pytest.raises(LogError, match=f"cannot open {path}: {kind}"):
        open_run([path])


def test_without_numbers_in_diagnostics_nothing_is_known_after_a_loss(log, tmp_path):
    """A log of before says so; a later event with the next number proves that none was lost."""
    old = log
    for place in log.places("/diagnostics"):
        old = old.change(
            place, lambda data: data.replace(b"\x06\0\0\0event\0", b"\x06\0\0\0evens\0")
        )
    path = old.write(tmp_path / "run.mcap")
    zero_chunk(path, 1_600_000_000)
    _, catalog = catalog_of(path)
    (line,) = (text for text in catalog.problems if "is not known" in text)
    assert line.startswith("from 1490000001 ns on the motion is not known: an event may")
    assert line.endswith("the diagnostics of this log do not number the events")
    (interval,) = catalog.unknown
    assert (interval.begin, interval.end) == (1_490_000_001, 2_500_000_001)
    path = old.write(tmp_path / "early.mcap")
    zero_chunk(path, 700_000_000)
    assert catalog_of(path)[1].unknown == ()


def test_diagnostics_after_a_loss_prove_that_no_event_was_lost(log, tmp_path):
    path = log.write(tmp_path / "run.mcap")
    zero_chunk(path, 1_600_000_000)
    _, catalog = catalog_of(path)
    assert catalog.unknown == ()
    assert [each.event.number for each in catalog.intervals] == [1, 2]
    assert catalog.intervals[-1].end == catalog.end + 1 == 2_500_000_001
    assert 0 <= catalog.intervals[0].begin < catalog.intervals[0].end == 1_210_000_000
    assert catalog.topics["orientation"].rate == 100.0


MISSING = re.compile(
    r"(.*): (at least )?(\d+) samples? (?:is|are) missing, (most of them |in (\d+) gaps )?"
    r"between (\d+) and (\d+) ns; the node has counted 0 as missed"
)


@pytest.mark.parametrize("seed", seeds(2, 100))
def test_samples_are_said_to_be_missing_where_they_are(seed, log, tmp_path):
    rng = random.Random(seed)
    topic = rng.choice(("orientation", "torque"))
    places = log.places(f"/{topic}")
    lost = set()
    for _ in range(rng.randrange(1, 6)):
        begin = rng.randrange(len(places))
        lost |= {*places[begin : begin + rng.choice((1, 2, 10, 40))]}
    _, catalog = catalog_of(log.without(lost).write(tmp_path / "run.mcap"))
    stamps = [log.messages[k].log_time for k in sorted(lost)]
    if not catalog.problems:  # the first sample, the last one or both may never have been recorded
        assert lost <= {places[0], places[-1]}
        return
    name, is_least, count, way, gaps, *ends = MISSING.fullmatch(*catalog.problems).groups()
    first, last = map(int, ends)
    inside = sum(first <= each <= last for each in stamps)
    at_an_end = bool(lost & {places[0], places[-1]})
    assert name == topic
    assert bool(is_least) == at_an_end
    assert int(count) in range(len(lost) - 2 * at_an_end, len(lost) + 1)
    if gaps:
        assert int(gaps) > 1
    assert (2 * inside > int(count)) if way == "most of them " else (inside >= int(count))


def record_a_stop(folder, seconds, *, is_kicked=False):
    """Record a node that misses 49 samples; return the log."""
    recorded = Recorded(folder)
    recorded.run(1.2)
    recorded.stop(1.5)
    if is_kicked:
        recorded.kick()
    recorded.run(seconds)
    (path,) = recorded.close()
    return Log.read(path)


@pytest.mark.parametrize(("seconds", "count"), [(0.2, 49), (0.5, 0)])
def test_samples_behind_the_last_count_of_the_node_are_an_open_question(seconds, count, tmp_path):
    """The node counts once a second: the second log has its count, the first one ends before."""
    path = cut_end(record_a_stop(tmp_path, seconds).write(tmp_path / "run.mcap"))
    _, catalog = catalog_of(path)
    assert catalog.lacks_only_its_end
    assert len(catalog.doubts) == (2 if count else 0)
    found = {(each.missing, each.uncounted) for each in catalog.topics.values() if each.rate}
    assert found == {(0, count)}


def test_a_topic_that_lacks_more_than_the_others_has_lost_it(tmp_path):
    log = record_a_stop(tmp_path, 0.2)
    lost = [
        k for k in log.places("/torque") if 1_600_000_000 < log.messages[k].log_time < 18 * 10**8
    ]
    _, catalog = catalog_of(cut_end(log.without(lost).write(tmp_path / "run.mcap")))
    assert not catalog.lacks_only_its_end
    assert catalog.topics["torque"].missing == 49 + len(lost) > 49
    assert catalog.topics["orientation"].uncounted == 49


def test_an_event_that_is_lost_behind_the_last_count_is_found_by_its_samples(tmp_path):
    log = record_a_stop(tmp_path, 0.2, is_kicked=True)
    lost = log.places("/events")[1:]
    assert lost
    path = cut_end(log.without(lost).write(tmp_path / "run.mcap"))
    assert check_run(TopLog(McapFile(path))).unjudged > 0


def test_a_log_of_another_recorder_without_a_later_count_leaves_it_open(tmp_path):
    foreign = replace(record_a_stop(tmp_path, 0.2), metadata={})
    _, catalog = catalog_of(foreign.write(tmp_path / "run.mcap"))
    assert catalog.problems == ()
    assert "; no count of the node follows in the log: it may have missed" in catalog.doubts[1]


def test_attachments_behind_damage_are_repaired(log, tmp_path):
    path = tmp_path / "run.mcap"
    note = Attachment(
        create_time=0, log_time=0, name="note", media_type="text/plain", data=b"hello"
    )
    replace(log, attachments=[note]).write(path)
    data = bytearray(path.read_bytes())
    begin = [begin for kind, begin, _ in list_records(data) if kind == Opcode.CHUNK][2]
    data[begin - RECORD_START.size] = 0
    path.write_bytes(data)
    file, catalog = catalog_of(path)
    assert "a chunk is lost" in catalog.problems[0]
    assert repair(file, tmp_path / "whole.mcap", catalog).attachments == 1
    assert [each.data for each in McapFile(tmp_path / "whole.mcap").attachments()] == [b"hello"]


def test_metadata_of_one_name_are_repaired_one_and_all(log, tmp_path):
    path = tmp_path / "run.mcap"
    with path.open("xb") as stream:
        writer = Writer(stream)
        writer.start("ros2")
        numbers = {n: log.register(writer, each) for n, each in log.channels.items()}
        for value in ("one", "other"):
            writer.add_metadata("notes", {"note": value})
        for each in log.messages:
            writer.add_message(numbers[each.channel_id], each.log_time, each.data, 0)
        writer.finish()
    file, catalog = catalog_of(path)
    repair(file, tmp_path / "whole.mcap", catalog)
    found = [*McapFile(tmp_path / "whole.mcap").list_metadata()]
    assert found == [("notes", {"note": "one"}), ("notes", {"note": "other"})]


@pytest.mark.parametrize("lost", [0, 1, 2, None])
def test_a_file_of_a_recording_that_is_not_there_is_named(lost, log, tmp_path):
    third = len(log.messages) // 3
    paths = []
    for number in {0, 1, 2} - {lost}:
        about = log.metadata | {
            "symtop_ros": log.metadata["symtop_ros"] | {"file": f"{number + 1}"}
        }
        part = replace(log, messages=log.messages[number * third :][:third], metadata=about)
        paths.append(part.write(tmp_path / f"{number}.mcap"))
    catalog = TopLog(open_run(paths)).catalog
    # The last one may never have been.
    expected = [] if lost in (2, None) else [f"file {lost + 1} of the recording is not in the log"]
    assert [each for each in catalog.notes if each.startswith("file")] == expected


def test_messages_that_cannot_be_read_are_counted_in_all_chunks(log, tmp_path):
    places = log.places("/torque")[::20]
    odd = log
    for place in places:
        odd = odd.change(place, lambda data: data[:-3])
    _, catalog = catalog_of(odd.write(tmp_path / "run.mcap"))
    unreadable = catalog.topics["torque"].unreadable
    assert unreadable.startswith(f"{len(places)} messages: ")
    assert len(list_chunks(tmp_path / "run.mcap")) > 3


def test_samples_before_and_after_a_jump_back_are_counted_apart(tmp_path):
    recorded = Recorded(tmp_path)
    for time in (100.0, 100.6, 100.3):
        recorded.jump(time)
        recorded.run(1.0)
    (path,) = recorded.close()
    log = Log.read(path)
    assert catalog_of(path)[1].problems == ()
    places = log.places("/torque")
    again = {places[k] for k in (10, 90, 120, 250)}  # some of them at stamps of two passes
    pairs = [(each,) * (1 + (k in again)) for k, each in enumerate(log.messages)]
    twice = replace(log, messages=[each for pair in pairs for each in pair])
    _, catalog = catalog_of(twice.write(tmp_path / "twice.mcap"))
    assert catalog.problems == ("torque: 4 samples are repeated, at the stamps of others",)
    lost = log.without([places[99], places[100], places[150]])
    _, catalog = catalog_of(lost.write(tmp_path / "lost.mcap"))
    (problem,) = catalog.problems
    assert problem.startswith("torque: at least 3 samples are missing, ")
