import sys

from log_files import Run

from symtop_ros.playback import replay as module
from symtop_ros.playback.mcap_file import McapFile
from symtop_ros.playback.replay import replay
from symtop_ros.playback.top_log import TopLog

RUN = Run(seconds=1.0)


def test_on_a_terminal_a_bar_shows_how_far_a_long_log_is_read(tmp_path, monkeypatch, capsys):
    monkeypatch.setattr(module, "LONG", 0)
    monkeypatch.setattr(sys.stderr, "isatty", lambda: True)
    replay(TopLog(McapFile(RUN.write(tmp_path))), tmp_path / "run.rrd")
    steps = capsys.readouterr().err.replace("\n", "\r").split("\r")
    bars = [step.count("#") for step in steps if step]
    assert bars
    assert bars == sorted(bars)
    assert all(step.endswith("of 0 MiB") for step in steps if step)
