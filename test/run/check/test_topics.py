"""One damaged and one tampered message of each topic, all of which are remapped."""

import json
from dataclasses import replace

import numpy as np
import pytest
from mcap.writer import CompressionType
from run.log.damaged import Log, Recorded
from run.simulation.page_points import make_points

from symtop_ros.replay.main import main
from symtop_ros.run.check.run import check_run
from symtop_ros.run.log.bags import open_run
from symtop_ros.run.log.names import KNOWN
from symtop_ros.run.log.reader import LogError
from symtop_ros.run.log.top_log import TopLog
from symtop_ros.run.simulation.topics import APPLIED_TORQUE, MARKERS, POINTS, SAMPLE_TOPICS
from symtop_ros.run.wire.messages import WRENCH

pytestmark = pytest.mark.numbers

ON = ("imu__enabled", "magnetic_field__enabled", "odometry__enabled")
OPTIONS = {**dict.fromkeys(ON, True), "publish_markers": True, "publish_clock": True}
OPTIONS["points"] = json.dumps(make_points("theta").to_json())
NAMES = {topic.ros_name: f"/other/{name}s" for name, topic in KNOWN.items()}
NOT_COMPARED = {
    MARKERS.name: "markers are drawings of the samples before them",
    APPLIED_TORQUE.name: "it was received, and not computed",
    POINTS.name: "the points were measured, not computed",
}


@pytest.fixture(scope="module")
def log(tmp_path_factory):
    recorded = Recorded(tmp_path_factory.mktemp("run"), NAMES, **OPTIONS)
    recorded.run(0.5)
    recorded.session.log_torque(WRENCH.layout("world").encode(1, [0.0] * 5 + [1e-4]))
    recorded.kick()
    recorded.run(0.7)
    (path,) = recorded.close()
    return Log.read(path)


def alter(data):
    """The message with a number, or a digit of a text, changed."""
    digits = [k for k, byte in enumerate(data) if byte in b"123456789" and k > 12]
    if b"0x" in data or b"robot" in data or b"top: motion" in data or b"top: kick" in data:
        place = digits[len(digits) // 2]
        return data[:place] + b"%d" % (data[place] - 48 - 1) + data[place + 1 :]
    place = len(data) - (12 if len(data) > 40 else 2)  # in one of the last numbers
    return data[:place] + bytes([data[place] ^ 1]) + data[place + 1 :]


def accelerate(data):
    """The message of an IMU with one acceleration of 1e6."""
    place = len(data) - 8 * (9 + 3)  # a covariance is behind it
    return data[:place] + np.float64(1e6).tobytes() + data[place + 8 :]


@pytest.mark.parametrize("name", KNOWN)
def test_a_tampered_message_is_found(name, log, tmp_path, capsys):
    places = log.places(f"/other/{name}s")
    act = accelerate if name == "imu" else alter
    path = log.change(places[len(places) // 2], act).write(tmp_path / "run.mcap")
    status = main([str(path), "--check"])
    out = capsys.readouterr().out
    if name in NOT_COMPARED:
        (row,) = (line for line in out.splitlines() if line.startswith(f"/other/{name}s"))
        assert (status, NOT_COMPARED[name] in row) == (0, True)
    else:
        assert (status, "DO NOT agree" in out) == (1, True)


def test_an_acceleration_of_all_messages_is_found_though_the_topic_is_remapped(
    log, tmp_path, capsys
):
    changed = log
    for place in log.places("/other/imus"):
        changed = changed.change(place, accelerate)
    assert main([str(changed.write(tmp_path / "run.mcap")), "--check"]) == 1
    assert "the samples DO NOT agree with the events\n" in capsys.readouterr().out


@pytest.mark.parametrize("name", KNOWN)
def test_a_damaged_message_is_told(name, log, tmp_path, capsys):
    path = log.write(tmp_path / "run.mcap", compression=CompressionType.NONE)
    places = log.places(f"/other/{name}s")
    data = bytes(log.messages[places[len(places) // 2]].data)
    file = path.read_bytes()
    place = file.index(data) + len(data) // 2
    path.write_bytes(file[:place] + bytes([file[place] ^ 8]) + file[place + 1 :])
    assert main([str(path), "--check"]) == 1
    first = capsys.readouterr().err.splitlines()[0]
    assert first.startswith("top_replay: a chunk is damaged: ")


def test_all_names_are_in_the_metadata_and_in_the_account(log, tmp_path):
    catalog = TopLog(open_run([log.write(tmp_path / "run.mcap")])).catalog
    assert {name: topic.name for name, topic in catalog.topics.items()} == {
        name: f"/other/{name}s" for name in KNOWN
    }
    assert (catalog.node, catalog.guess, catalog.problems) == ("/top", "", ())
    counts = {catalog.topics[name].count for name in SAMPLE_TOPICS}
    assert counts == {len(log.places("/other/imus"))}


def test_names_that_contradict_the_types_of_channels_are_not_taken(log, tmp_path):
    """And a log that does not say names is read by types and the ends of names."""
    values = log.metadata["symtop_ros"]
    for text in ("[]", "{", '{"orientation": 3}'):
        odd = replace(log, metadata={"symtop_ros": {**values, "topics": text}})
        found = TopLog(open_run([odd.write(tmp_path / f"{len(text)}.mcap")]))
        with pytest.raises(LogError, match="no run of a top in"):
            list(found.batches())


@pytest.mark.parametrize("name", ["/robot_description", "/lab/robot_description"])
def test_a_description_where_rviz_looks_for_it_is_read_in_a_log_without_names(name, tmp_path):
    """A bag of a node that was remapped, or of one called top in version 0.6."""
    node = f"{name.rpartition('/')[0]}/top"
    names = {topic.ros_name: topic.resolve(node) for topic in KNOWN.values()}
    recorded = Recorded(tmp_path / "run", {**names, "~/robot_description": name})
    recorded.run(0.5)
    (path,) = recorded.close()
    bag = replace(Log.read(path), metadata={})
    found = TopLog(open_run([bag.write(tmp_path / "bag.mcap")]))
    findings = check_run(found)
    assert (found.catalog.node, findings.mismatches) == (node, [])
    assert findings.compared["robot_description"] == 1
