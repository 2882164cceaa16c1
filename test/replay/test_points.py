"""Measured points of a run: through a log, a bag and a page, and in the viewer."""

import json

import numpy as np
import pytest
from replay.test_main import read_page
from replay.view.rows import rows, strict
from rosbags.rosbag2 import StoragePlugin, Writer
from rosbags.typesys import Stores, get_typestore
from run.simulation.page_points import TIMES, make_kicked, make_measured, make_points, see
from run.simulation.page_runs import START, find_refusal

from symtop_ros.replay import main as module
from symtop_ros.replay.view import entities
from symtop_ros.run.log.reader import McapFile
from symtop_ros.run.log.top_log import TopLog
from symtop_ros.run.session.run_log import write_run_log
from symtop_ros.run.simulation.points import SEEN
from symtop_ros.run.simulation.run_file import read_run

FLOAT = 2 * float(np.finfo(np.float32).eps)  # positions are single precision in Rerun


@pytest.fixture
def run_file(tmp_path):
    path = tmp_path / "run.json"
    path.write_text(json.dumps(make_kicked()))
    return path


@pytest.fixture
def log(run_file):
    path = run_file.with_name("run.mcap")
    assert module.main([str(run_file), "--mcap", str(path), "--rate", "50"]) == 0
    return path


def copy_to_bag(log, folder, storage):
    """Copy the messages of a log into a bag, which keeps neither metadata nor attachments."""
    file, store = McapFile(log), get_typestore(Stores.ROS2_JAZZY)
    written = Writer(folder, version=9, storage_plugin=storage)
    with written as writer:
        channels = {}
        for message in (each for run in file.chunks() for each in run):
            number = message.channel_id
            if number not in channels:
                channel = file.channels[number]
                kind = file.schemas[channel.schema_id].name
                channels[number] = writer.add_connection(channel.topic, kind, typestore=store)
            writer.write(channels[number], message.log_time, message.data)
    return folder


def test_a_log_and_its_page_keep_the_points(run_file, log, capsys):
    page = run_file.with_name("run.html")
    assert module.main([str(log), "--save", str(page)]) == 0
    assert capsys.readouterr().err == ""
    given, kept = json.loads(run_file.read_text()), read_page(page)
    assert kept["format"] == 5
    assert kept["points"] == given["points"]
    assert kept["events"] == given["events"]


@pytest.mark.parametrize("storage", StoragePlugin)
def test_a_bag_keeps_the_points_to_a_page_and_back_to_a_log(run_file, log, storage, tmp_path):
    bag = copy_to_bag(log, tmp_path / "bag", storage)
    page, again, file = (tmp_path / name for name in ("bag.html", "again.mcap", "again.json"))
    assert module.main([str(bag), "--save", str(page)]) == 0
    given = json.loads(run_file.read_text())["points"]
    assert read_page(page)["points"] == given
    file.write_text(json.dumps(read_page(page)))
    assert module.main([str(file), "--mcap", str(again), "--rate", "50"]) == 0
    kept = TopLog(McapFile(again)).read_points()
    assert kept.to_json() == given


def test_a_repaired_log_keeps_the_points(log, tmp_path):
    again = tmp_path / "whole.mcap"
    assert module.main([str(log), "--repair", str(again)]) == 0
    assert TopLog(McapFile(again)).read_points().to_json() == make_kicked()["points"]


def test_a_check_leaves_the_points_alone_and_says_so(run_file, log, capsys):
    for path in (run_file, log):
        assert module.main([str(path), "--check", "--strict"]) == 0
        (line,) = [each for each in capsys.readouterr().out.splitlines() if "points" in each]
        assert line.split(maxsplit=1) == [
            "/top/points",
            "not compared: the points were measured, not computed",
        ]


def test_a_log_of_a_run_without_points_has_no_topic_for_them(tmp_path, capsys):
    content = make_kicked()
    del content["points"]
    path = tmp_path / "run.json"
    path.write_text(json.dumps(content))
    assert module.main([str(path), "--check"]) == 0
    assert "points" not in capsys.readouterr().out


def test_damaged_points_of_a_log_are_left_out_and_named_in_one_line(run_file, tmp_path, capsys):
    events, end, points = read_run(run_file)
    log, page = tmp_path / "bad.mcap", tmp_path / "bad.html"

    class Damaged:
        def to_json(self):
            return {**points.to_json(), "times": [0.0, 0.0]}

    write_run_log(events, end, log, 50.0, Damaged())
    assert module.main([str(log), "--save", str(page)]) == 0
    error = capsys.readouterr().err
    assert error.startswith(
        "top_replay: the measured points cannot be read: points: times[1] must be later than"
    )
    assert error.count("\n") == 1
    assert "points" not in read_page(page)
    assert module.main([str(log), "--check"]) == 0


def test_a_later_version_is_refused_in_one_line_that_names_it():
    refusal = find_refusal({**make_measured(), "format": 6})
    assert refusal.endswith(" (run.json, format 1 or 2 or 3 or 4 or 5), got format 6")


@pytest.mark.parametrize("kind", SEEN)
def test_the_viewer_draws_each_point_where_it_was_seen(kind, tmp_path):
    path, recording = tmp_path / "run.json", tmp_path / "run.rrd"
    path.write_text(json.dumps(make_measured(kind)))
    with strict():
        assert module.main([str(path), "--save", str(recording)]) == 0
    points, states = make_points(kind), START.at(TIMES)
    theta = states.euler_angles.theta
    stamps = np.rint(TIMES * 1e9).tolist()
    if kind == "theta":
        times, values = rows(recording, entities.SEEN[0], "Scalars:scalars")
        assert times.tolist() == stamps
        assert np.concatenate(values).tolist() == points.values[:, 0].tolist()
    if kind == "axis":
        times, drawn = rows(recording, entities.POINTS, "Points3D:positions")
        norms = np.sqrt((points.values**2).sum(axis=1, keepdims=True))
        assert times.tolist() == stamps
        assert np.abs(np.concatenate(drawn) - points.values / norms).max() < FLOAT
        _, labels = rows(recording, entities.POINTS, "Points3D:labels")
        time, left = labels[7][0].split(" s, measured minus computed: ")
        exact = points.values[7] - see("axis")[7]
        assert float(time) == pytest.approx(TIMES[7], abs=5e-5)
        shown = [float(each.split()[1]) for each in left.split(", ")]
        assert shown == pytest.approx(exact.tolist(), rel=0.05)  # two digits
    if kind in ("rates", "inertial"):
        _, drawn = rows(recording, entities.SEEN[2], "Scalars:scalars")
        rates = START.euler_rates(states)
        # noise of 2^-9 rad/s of each rate, over sin(theta) > 0.4
        assert np.abs(np.concatenate(drawn) - rates.psi_dot).max() < 40 * 2.0**-9
        assert np.concatenate(drawn).std() > 0
    else:
        _, drawn = rows(recording, entities.SEEN[0], "Scalars:scalars")
        # five deviations of 2^-9; of pixels the noise of 2^-9 of 245 is less
        assert np.abs(np.concatenate(drawn) - theta).max() < 6 * 2.0**-9
