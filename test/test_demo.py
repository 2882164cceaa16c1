import subprocess
import sys
from pathlib import Path

import pytest
from listening import udp_addresses
from log_files import Run

from symtop_ros import demo
from symtop_ros.client.connection import Connection
from symtop_ros.playback import viewer
from symtop_ros.playback.check import check
from symtop_ros.playback.mcap_file import McapFile
from symtop_ros.playback.top_log import TopLog


def test_the_demonstration_hurries_the_top_logs_it_and_leaves_nothing_running(
    tmp_path, monkeypatch
):
    monkeypatch.delenv("DISPLAY", raising=False)
    monkeypatch.delenv("WAYLAND_DISPLAY", raising=False)
    monkeypatch.delenv("FASTDDS_DEFAULT_PROFILES_FILE", raising=False)
    demo = subprocess.Popen(
        [sys.executable, "-m", "symtop_ros.demo"],
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
    said, went, log, recording, ended = printed.splitlines()[-5:]
    assert "the moving top is lifted" in said
    promised = said.split("theta ")[1].split(" rad")[0]
    assert f"theta {promised} rad" in went  # the same to a thousandth of a radian
    assert ended == "stopped; nothing is left running"
    path = tmp_path / Path(log.split()[-1])
    assert all(each.largest == 0.0 for each in check(TopLog(McapFile(path))).values())
    assert (tmp_path / Path(recording.split()[-1])).stat().st_size > 100_000


@pytest.fixture
def here(tmp_path, monkeypatch):
    """A folder, and an environment that the demonstration may change."""
    for name in ("ROS_AUTOMATIC_DISCOVERY_RANGE", "FASTDDS_DEFAULT_PROFILES_FILE", "ROS_DOMAIN_ID"):
        monkeypatch.setenv(name, "LOCALHOST" if name.endswith("RANGE") else "")
    monkeypatch.chdir(tmp_path)
    return tmp_path


@pytest.mark.usefixtures("here")
def test_a_node_that_does_not_come_up_is_told(monkeypatch, capsys):
    monkeypatch.setattr(demo, "NODE", "pass")
    monkeypatch.setattr(demo, "Connection", lambda node, timeout: Connection(node, timeout=0.1))
    assert demo.main() == 1
    assert capsys.readouterr().err.startswith("demo: no answer from /top within 0.1 s")


def test_a_log_that_cannot_be_replayed_is_told(here, capsys):
    assert demo._replay(here / "none.mcap") == 1
    assert capsys.readouterr().err.endswith("none.mcap: No such file or directory\n")


def test_where_there_is_a_screen_the_replay_is_shown(here, monkeypatch, capsys):
    shown = []
    monkeypatch.setattr(viewer, "has_screen", lambda: True)
    monkeypatch.setattr(viewer, "show", lambda *files, web: shown.append((files, web)) or 0)
    log = Run(seconds=0.5).write(here)
    assert demo._replay(log) == 0
    assert shown == [((log.with_suffix(".rrd"),), False)]
    assert "the viewer is open" in capsys.readouterr().out
