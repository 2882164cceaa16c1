import re
import subprocess
import sys
from pathlib import Path

import pytest
from endings import bound
from listening import udp_addresses
from log_files import Run

from symtop_ros import demo
from symtop_ros.client.connection import Connection
from symtop_ros.distribution import VARIABLES
from symtop_ros.log.check import check_log
from symtop_ros.log.reader import McapFile
from symtop_ros.log.top_log import TopLog
from symtop_ros.playback import viewer


@pytest.mark.wording
def test_the_demonstration_hurries_the_top_logs_it_and_leaves_nothing_running(
    tmp_path, monkeypatch
):
    monkeypatch.delenv("DISPLAY", raising=False)
    monkeypatch.delenv("WAYLAND_DISPLAY", raising=False)
    for name in VARIABLES:
        monkeypatch.delenv(name, raising=False)
    demo = subprocess.Popen(
        bound([sys.executable, "-m", "symtop_ros.demo"]),
        cwd=tmp_path,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )
    heard = [demo.stdout.readline() for _ in range(2)]  # the second when samples have come
    first = 7400 + 250 * (60 + demo.pid % 30)  # of its domain
    listening = udp_addresses(range(first, first + 250))
    printed, errors = demo.communicate(timeout=120)
    assert demo.returncode == 0, (heard, errors)
    assert len(listening) >= 4
    assert {address for address, _ in listening} == {"127.0.0.1"}
    answer, after, log, recording, ended = printed.splitlines()[-5:]
    assert (
        "Precession 11.89 -> 16.64 rad/s. The top rises: theta will stay between 0.354 and"
        in answer
    )
    low, high = re.search(r"between (\S+) and (\S+) rad", answer).groups()
    seen = re.search(r"theta (\S+) to (\S+) rad", after).groups()
    # samples are 5 ms apart: at the highest point theta'' = 250 rad/s^2 moves it by 1e-3 rad
    assert [float(each) for each in seen] == pytest.approx([float(low), float(high)], abs=1.5e-3)
    assert ended == "stopped; nothing is left running"
    path = tmp_path / Path(log.split()[-1])
    assert all(each.largest == 0.0 for each in check_log(TopLog(McapFile(path))).values())
    assert (tmp_path / Path(recording.split()[-1])).stat().st_size > 100_000


@pytest.fixture
def here(tmp_path, monkeypatch):
    """A folder, and an environment that the demonstration may change."""
    for name in ("ROS_AUTOMATIC_DISCOVERY_RANGE", "ROS_DOMAIN_ID", *VARIABLES):
        monkeypatch.setenv(name, "LOCALHOST" if name.endswith("RANGE") else "")
    monkeypatch.chdir(tmp_path)
    return tmp_path


@pytest.mark.usefixtures("here")
def test_a_node_that_does_not_start_is_reported(monkeypatch, capsys):
    monkeypatch.setattr(demo, "NODE", "pass")
    monkeypatch.setattr(demo, "Connection", lambda node, timeout: Connection(node, timeout=0.1))
    assert demo.main() == 1
    assert capsys.readouterr().err.startswith("demo: no answer from /top within 0.1 s")


def test_a_log_that_cannot_be_replayed_is_reported(here, capsys):
    assert demo._replay(here / "none.mcap") == 1
    assert capsys.readouterr().err.endswith("none.mcap: No such file or directory\n")


def test_on_a_screen_the_replay_is_shown(here, monkeypatch, capsys):
    shown = []
    monkeypatch.setattr(viewer, "has_screen", lambda: True)
    monkeypatch.setattr(viewer, "show", lambda *files, web: shown.append((files, web)) or 0)
    log = Run(seconds=0.5).write(here)
    assert demo._replay(log) == 0
    assert shown == [((log.with_suffix(".rrd"),), False)]
    assert "the viewer is open" in capsys.readouterr().out
