import sys

from log_files import Run

from symtop_ros.playback import replay as module
from symtop_ros.playback.replay import replay

RUN = Run(seconds=1.0)


def test_on_a_terminal_a_bar_shows_the_progress_of_a_long_log(tmp_path, monkeypatch, capsys):
    monkeypatch.setattr(module, "MIN_SIZE_FOR_BAR", 0)
    monkeypatch.setattr(sys.stderr, "isatty", lambda: True)
    replay(RUN.open(tmp_path), tmp_path / "run.rrd")
    steps = capsys.readouterr().err.replace("\n", "\r").split("\r")
    bars = [step.count("#") for step in steps if step]
    assert bars
    assert bars == sorted(bars)
    assert all(step.endswith("of 0 MiB") for step in steps if step)
