import subprocess
import sys
from pathlib import Path

from symtop_ros.playback.check import check
from symtop_ros.playback.mcap_file import McapFile
from symtop_ros.playback.top_log import TopLog


def test_the_demonstration_hurries_the_top_logs_it_and_leaves_nothing_running(
    tmp_path, monkeypatch
):
    monkeypatch.delenv("DISPLAY", raising=False)
    monkeypatch.delenv("WAYLAND_DISPLAY", raising=False)
    result = subprocess.run(
        [sys.executable, "-m", "symtop_ros.demo"],
        cwd=tmp_path,
        capture_output=True,
        text=True,
        timeout=120,
        check=False,
    )
    assert result.returncode == 0, result.stderr
    said, went, log, recording, ended = result.stdout.splitlines()[-5:]
    assert "the moving top is lifted" in said
    promised = said.split("theta ")[1].split(" rad")[0]
    assert f"theta {promised} rad" in went  # the same to a thousandth of a radian
    assert ended == "stopped; nothing is left running"
    path = tmp_path / Path(log.split()[-1])
    assert all(each.largest == 0.0 for each in check(TopLog(McapFile(path))).values())
    assert (tmp_path / Path(recording.split()[-1])).stat().st_size > 100_000
