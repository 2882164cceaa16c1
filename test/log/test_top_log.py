"""Tops in logs of all kinds: other writers, namespaces, missing topics, other topics mixed in."""

import numpy as np
import pytest
from exact_log import STATES
from log_files import Run, topic, write_mcap

from symtop_ros.check.samples import check_log
from symtop_ros.log.reader import LogError, McapFile
from symtop_ros.log.top_log import TopLog
from symtop_ros.simulation.topics import EVENTS, STATE_TOPICS

RUN = Run(seconds=1.0)
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
    log = write(tmp_path, {"/lab/one/top": RUN}, others=others)
    columns = columns_of(log)
    assert log.node == "/lab/one/top"
    assert len(columns["orientation"]) == 200
    assert log.problems == []


def test_of_several_tops_one_is_chosen_and_the_others_are_listed(tmp_path):
    slow = Run(seconds=1.0, rate=50.0)
    log = write(tmp_path, {"/a": RUN, "/b": slow})
    assert len(columns_of(log)["torque"]) == 200
    (note,) = log.problems
    assert "/a;" in note
    assert note.endswith("--node: /b")
    assert len(columns_of(TopLog(log.file, "b"))["torque"]) == 50  # the slash may be left out


def test_of_several_tops_that_of_the_default_name_is_chosen(tmp_path):
    log = write(tmp_path, {"/a": RUN, "/top": RUN})
    next(log.events())
    assert log.node == "/top"


@pytest.mark.parametrize("shift", [1, 60, -60])
def test_a_sample_belongs_to_an_event_by_its_stamp_wherever_it_was_logged(shift, tmp_path):
    run = Run(seconds=1.0)
    place = run.places("events")[1]
    run.messages.insert(place + shift, run.messages.pop(place))
    stretches = [each for b in run.open(tmp_path).batches() for each in b.stretches() if each[0]]
    (_, before), (event, after) = stretches[-2:]
    for name in STATES:
        assert max(before[name].stamps) < event.stamp == min(after[name].stamps)
        assert sum(len(columns[name].stamps) for _, columns in stretches) == len(run.places(name))


def test_missing_topics_are_listed(tmp_path):
    part = Run(seconds=1.0)
    part.messages = [each for each in part.messages if each[0] in ("orientation", "events")]
    log = write(tmp_path, {"/top": part})
    assert set(columns_of(log)) == {"orientation"}
    missing = ", ".join(f"no {name}" for name in STATES[1:])
    assert log.problems == [f"the log has {missing}"]


def test_a_log_without_a_top_is_refused_with_a_list_of_its_topics(tmp_path):
    others = [("/camera/image", "sensor_msgs/msg/Image", b"noise")]
    empty = Run(seconds=1.0)
    empty.messages = []
    log = write(tmp_path, {"/top": empty}, others=others)
    with pytest.raises(LogError, match=r"no run of a top in \S+a\.mcap: topics "):
        list(log.batches())
    log = write(tmp_path, {"/top": RUN}, "/missing")
    with pytest.raises(LogError, match=r"no run of a top /missing in \S+: topics /tf, /top/"):
        list(log.batches())


def test_messages_that_cannot_be_decoded_are_reported_and_the_others_used(tmp_path):
    run = Run(seconds=1.0)
    run.messages = [
        (name, stamp, data[:-3] if name == "torque" and k % 2 else data)
        for k, (name, stamp, data) in enumerate(run.messages)
    ]
    log = write(tmp_path, {"/top": run})
    assert 0 < len(columns_of(log)["torque"]) < 200
    (problem,) = log.problems
    assert "torque" in problem
    assert "are not a geometry_msgs/msg/WrenchStamped" in problem


def test_samples_of_one_stamp_are_never_parted(tmp_path):
    run = Run(seconds=6.0, rate=1000.0)
    log = run.open(tmp_path)
    for batch in log.batches():
        stamps = [columns.stamps.tolist() for columns in batch.columns.values()]
        assert all(each == stamps[0] for each in stamps)
        assert len(stamps[0]) < 5000


def test_two_tops_that_share_tf_are_told_apart_by_the_frames_in_their_events(tmp_path):
    one, other = Run(seconds=1.0), Run(seconds=1.0, rate=50.0, frame="gyro")
    for node, count in (("/a", 200), ("/b", 50)):
        columns = columns_of(write(tmp_path, {"/a": one, "/b": other}, node))
        assert len(columns["tf"]) == count
        assert columns["tf"][:, 3:].tolist() == columns["orientation"].tolist()


def test_transforms_of_another_top_before_the_first_event_are_not_those_of_this_one(tmp_path):
    one, other = Run(seconds=1.0), Run(seconds=1.0, rate=2000.0, frame="gyro")
    one.messages = [each for each in one.messages if each[1] >= one.messages[0][1] + 5 * 10**8]
    assert one.messages[0][0] == "events"  # the kick
    deviations = check_log(write(tmp_path, {"/top": other, "/one": one}, "/one"))
    for each in deviations.values():
        assert (each.samples, each.largest, each.unchecked) == (100, 0.0, 0)
