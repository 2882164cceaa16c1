import subprocess
import sys
from pathlib import Path

from listening import udp_addresses

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
