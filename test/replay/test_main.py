"""top_replay as a user types it; in an environment that has no rclpy."""

import importlib.metadata
import json
import re
import shutil
import sys
import sysconfig
from pathlib import Path

import numpy as np
import pytest
from documents import ROOT
from exact_log import STATES
from log_files import Run
from packaging.requirements import Requirement
from programs import execute
from run.simulation.page_runs import make_run

from symtop_ros.replay import main as module
from symtop_ros.run.simulation.run_file import write_run

RUN = Run()
SITE = Path(sysconfig.get_paths()["purelib"])
PROGRAM = "import sys; from symtop_ros.programs import top_replay; sys.exit(top_replay())"


@pytest.fixture
def log(tmp_path):
    return RUN.write(tmp_path / "logs")


def distributions(extra):
    """Distributions that `pip install symtop_ros[extra]` brings, by their metadata."""
    found = set()
    wanted = [("symtop_ros", extra)]
    while wanted:
        name, with_extra = wanted.pop()
        every = map(Requirement, importlib.metadata.requires(name) or [])
        names = {r.name for r in every if not r.marker or r.marker.evaluate({"extra": with_extra})}
        wanted += [(each, "") for each in names - found]
        found |= names
    return found


@pytest.fixture(scope="module")
def laptop(tmp_path_factory):
    """A Python with what the extra `playback` brings and nothing else: no ROS."""
    folder = tmp_path_factory.mktemp("laptop") / "venv"
    execute([sys.executable, "-m", "venv", "--without-pip", folder], check=True)
    site = next(folder.glob("lib/python*/site-packages"))
    for name in distributions("playback"):
        for file in importlib.metadata.files(name):
            top = file.parts[0]
            if top not in ("..", "__pycache__") and not (site / top).exists():
                (site / top).symlink_to(SITE / top)
    shutil.copytree(ROOT / "symtop_ros", site / "symtop_ros")
    return folder / "bin" / "python"


def replay(python, *arguments):
    """Run top_replay in a separate environment, which inherits no ROS."""
    words = [python, "-c", PROGRAM, *arguments]
    return execute(words, env={"PATH": "/usr/bin:/bin"}, timeout=120)


@pytest.mark.slow
@pytest.mark.wording  # of the log, which another program computes again
def test_without_ros_a_log_becomes_a_recording_and_is_checked(laptop, log, tmp_path):
    none = execute([laptop, "-c", "import rclpy"], env={})
    assert "No module named 'rclpy'" in none.stderr
    saved = replay(laptop, log, "--save", tmp_path / "run.rrd")
    assert (saved.returncode, saved.stderr) == (0, "")
    target = tmp_path / "run.rrd"
    assert saved.stdout == f"wrote {target}; open it with: rerun {target}\n"
    assert target.stat().st_size > 100_000
    checked = replay(laptop, log, "--check")
    assert (checked.returncode, checked.stderr) == (0, "")
    assert checked.stdout.count("      400 samples, largest difference 0\n") == len(STATES)
    assert checked.stdout.startswith("the samples agree with the events\n")
    repaired = replay(laptop, log, "--repair", tmp_path / "again.mcap")
    assert repaired.stdout == f"wrote {len(RUN.messages)} messages to {tmp_path / 'again.mcap'}\n"


@pytest.mark.slow
def test_without_a_screen_the_message_names_the_options(laptop, log):
    result = replay(laptop, log)
    assert result.returncode == 1
    advice = "use --save OUT.rrd to write a recording, or --web for a browser"
    assert result.stderr == f"top_replay: no screen for the viewer: {advice}\n"


def test_a_wrong_log_is_status_1_and_names_the_topic(log, tmp_path, capsys):
    run = Run()
    run.change(run.places("torque")[0], lambda wrench: np.array([*wrench[:3], 1.0, 0.0, 0.0]))
    assert module.main([str(run.write(tmp_path / "wrong")), "--check"]) == 1
    output = capsys.readouterr().out
    found = r"largest difference 0\.9\d+ \(\S+ of its size\)"
    assert re.search(rf"/top/torque +400 samples, {found}", output)
    assert "DO NOT agree" in output.splitlines()[0]


def test_a_log_without_events_cannot_be_checked(tmp_path, capsys):
    assert module.main([str(Run().without("events").write(tmp_path)), "--check"]) == 1
    assert "nothing can be checked" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("arguments", "sentence"),
    [
        (["none.mcap"], "cannot open none.mcap: No such file or directory"),
        (["{log}", "--save", "out.mp4"], "--save must be a name that ends in .rrd or .html"),
        (["{log}", "--save", "none/out.rrd"], "cannot write none/out.rrd: No such file or dir"),
        (["{log}", "--save", "none/out.html"], "cannot write none/out.html: No such file or dir"),
        (["{log}", "--repair", "{log}"], "must not exist (nothing is overwritten)"),
        (["{log}", "--node", "/x", "--check"], "no run of a top /x in"),
        (["{run}", "--mcap", "run.log"], "--mcap must be OUT.mcap in a folder that exists,"),
        (["{run}", "--mcap", "run.mcap", "--rate", "5000"], "--rate must be 1 to 2000 Hz, got 5"),
        (["{run}", "x.mcap", "--mcap", "run.mcap"], "a run of the page must be one file, got 2"),
    ],
)
def test_a_refusal_is_one_line(arguments, sentence, log, run_file, tmp_path, capsys, monkeypatch):
    monkeypatch.chdir(tmp_path)
    before = set(tmp_path.iterdir())
    assert module.main([each.format(log=log, run=run_file) for each in arguments]) == 1
    assert set(tmp_path.iterdir()) == before
    error = capsys.readouterr().err
    assert error.startswith("top_replay: ")
    assert sentence in error
    assert error.count("\n") == 1


def read_page(path):
    """The run in a page."""
    pattern = r'<script type="application/json" id="top-run">(.*?)</script>'
    found = re.search(pattern, path.read_text())
    return json.loads(found[1])


@pytest.fixture(name="run_file")
def _run_file(tmp_path):
    path = tmp_path / "run.json"
    path.write_text(json.dumps(write_run(make_run(), 3_000_000_000)))
    return path


@pytest.mark.slow
def test_a_run_of_the_page_is_checked_saved_and_becomes_a_log(run_file, capsys):
    log, page, again = (run_file.with_name(name) for name in ("run.mcap", "run.html", "again.html"))
    assert module.main([str(run_file), "--check"]) == 0
    assert module.main([str(run_file), "--mcap", str(log), "--rate", "50"]) == 0
    assert module.main([str(log), "--check"]) == 0
    assert module.main([str(run_file), "--save", str(page)]) == 0
    assert module.main([str(log), "--save", str(again)]) == 0
    assert capsys.readouterr().err == ""
    events = json.loads(run_file.read_text())["events"]
    assert read_page(page)["events"] == read_page(again)["events"] == events
