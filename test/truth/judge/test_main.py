"""`top_judge` as its users call it."""

import errno
import json
import os
import subprocess
import sys

import numpy as np
import pytest
from log_files import write_mcap
from run.log.damaged import zero_chunk
from scipy.spatial.transform import Rotation
from truth.judge.cases import encode, make_estimates, truth_and_stamps, write_log, write_rows

from symtop_ros.programs import BROKEN_PIPE
from symtop_ros.run.log.reader import McapFile
from symtop_ros.truth.judge.main import main
from symtop_ros.truth.judge.truth import scene_truth
from symtop_ros.truth.topics.estimates import Estimates

IMU = "sensor_msgs/msg/Imu"
HEADER = "stamp", "w", "x", "y", "z"


@pytest.fixture(scope="module")
def log(tmp_path_factory):
    truth, stamps = truth_and_stamps(200)
    turned = make_estimates(truth, stamps, Rotation.from_rotvec([0, 0, 0.3]), delay=0.004)
    topics = {
        "/imu/data": encode(IMU, make_estimates(truth, stamps)),
        "/filter": encode(IMU, turned),
        "/text": ("std_msgs/msg/String", [(5, b"\0\1\0\0\1\0\0\0\0")]),
    }
    return write_log(tmp_path_factory.mktemp("judge") / "run.mcap", topics)


@pytest.mark.wording
def test_exact_estimates_are_told_so(log, capsys):
    assert main([str(log), "--topic", "/imu/data", "--max-error", "1e-14"]) == 0
    out = capsys.readouterr().out
    assert out.startswith("/imu/data: 200 estimates in ")
    assert "\nnothing is left to explain: " in out


@pytest.mark.slow
def test_the_delay_and_the_offset_are_found_written_and_can_be_removed(log, capsys, tmp_path):
    arguments = [str(log), "--topic", "/filter", "--max-error", "1e-3"]
    assert main([*arguments, "--aligned", "none"]) == 1
    assert "top_judge: the attitude is off by " in capsys.readouterr().err
    removed = ("--remove", "offset", "--remove", "delay")
    assert main([*arguments, *removed, "-o", str(tmp_path / "new")]) == 0
    assert "offset and delay removed" in capsys.readouterr().out
    facts = json.loads((tmp_path / "new" / "judge.json").read_text())
    assert facts["found"]["delay"] == pytest.approx(0.004, abs=1e-8)
    assert facts["found"]["world_offset"]["angle"] == pytest.approx(0.3, abs=1e-5)
    pytest.importorskip("matplotlib")
    for suffix in ("svg", "png"):
        assert (tmp_path / "new" / f"judge.{suffix}").stat().st_size > 1000


def test_estimates_may_be_in_another_file(log, capsys, tmp_path):
    path = tmp_path / "mine.csv"
    truth, stamps = truth_and_stamps(20)
    exact = Estimates.of(stamps, *truth.states_at(stamps)[:2])
    path.write_text(write_rows(exact, header=HEADER, seconds=False))
    assert main([str(log), "--estimates", str(path), "--max-error", "1e-15"]) == 0
    assert main([str(log), "--estimates", str(log), "--topic", "/imu/data"]) == 0


def test_an_output_that_is_no_longer_read_is_no_failure(log):
    command = "import sys; from symtop_ros.programs import top_judge; sys.exit(top_judge())"
    options = ["--topic", "/filter", "--aligned", "none", "--json"]
    words = [sys.executable, "-c", command, str(log), *options]
    with subprocess.Popen(words, stdout=subprocess.PIPE, stderr=subprocess.PIPE) as process:
        process.stdout.close()  # as `| head -0` does it
        error = process.stderr.read().decode()
    assert (process.returncode, "Broken pipe" in error) == (BROKEN_PIPE, False)


def test_what_is_lost_in_a_log_of_estimates_is_told(log, tmp_path, capsys):
    other = tmp_path / "estimates.mcap"
    file = McapFile(log)
    topics = {file.channels[m.channel_id].topic: [] for chunk in file.chunks() for m in chunk}
    for chunk in file.chunks():
        for message in chunk:
            topics[file.channels[message.channel_id].topic].append(
                (message.log_time, bytes(message.data))
            )
    write_mcap(other, [("/filter", IMU, topics["/filter"])], chunk_size=5000)
    whole = [str(log), "--estimates", str(other), "--topic", "/filter", "--aligned", "none"]
    assert main(whole) == 0
    capsys.readouterr()
    zero_chunk(other, topics["/filter"][100][0])
    for reader in (whole, [str(log), "--estimates", str(other), "--clock", "/filter"]):
        assert main(reader) == 1
        lines = capsys.readouterr().err.splitlines()
        assert lines[0].startswith("top_judge: a chunk is damaged: ")
        assert "top_judge: /filter: estimates may be missing: the log is damaged" in lines


REFUSED = [
    (("--topic", "/nothing"), "--topic must be one of /filter, /imu/data, /text, /top/events"),
    (("--topic", "/text"), "topic must have a type"),
    (("--topic", "/filter", "--node", "/other"), "no run of a top /other "),
    (("--estimates", "missing.csv"), f"cannot open missing.csv: {os.strerror(errno.ENOENT)}"),
    (("--estimates", "missing.mcap"), "--topic must name the estimates in missing.mcap"),
]


@pytest.mark.parametrize(("arguments", "reason"), REFUSED)
def test_what_cannot_be_judged_is_one_line(log, arguments, reason, capsys):
    assert main([str(log), *arguments]) == 1
    err = capsys.readouterr().err
    assert err.startswith(f"top_judge: {reason}")
    assert err.count("\n") == 1


def test_a_csv_file_is_judged_against_a_scene_as_json(tmp_path, capsys):
    path = tmp_path / "mine.csv"
    stamps = np.arange(0, 10**9, 10**7)
    exact = Estimates.of(stamps, *scene_truth("cusps").states_at(stamps)[:2])
    path.write_text(write_rows(exact, header=HEADER, seconds=False))
    assert main(["--scene", "cusps", "--estimates", str(path), "--json"]) == 0
    facts = json.loads(capsys.readouterr().out)
    assert facts["attitude"]["p100"] == 0.0
    assert main(["--scene", "none", "--estimates", str(path)]) == 1
    assert capsys.readouterr().err.startswith("top_judge: scene must be one of ")
