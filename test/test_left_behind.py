"""What tests leave on the machine fails their run, and is named."""

import os
import shutil
import sys
import tempfile
from pathlib import Path

import pytest
from documents import ROOT
from programs import execute

TEST = """
import pathlib, tempfile

def test_one():
    {}
"""
LEAVES = {
    "nothing": "tempfile.TemporaryDirectory().cleanup()",
    "the temporary folder": "tempfile.mkdtemp(prefix='left-')",
    "the home": "(pathlib.Path.home() / '.rerun-left').touch()",
}


def run(folder, line, *words):
    """Run a test of one line, with a home in its folder; return the process, which has ended."""
    (folder / "test_some.py").write_text(TEST.format(line))
    (folder / "home").mkdir()
    words = [sys.executable, "-m", "pytest", "-p", "left_behind", *words, "test_some.py"]
    variables = {"PYTHONPATH": f"{ROOT}:{ROOT}/test", "HOME": str(folder / "home")}
    return execute(words, cwd=folder, env={**os.environ, **variables})


@pytest.mark.parametrize("processes", ["0", pytest.param("2", marks=pytest.mark.slow)])
@pytest.mark.parametrize(
    "place", ["nothing", "the home", pytest.param("the temporary folder", marks=pytest.mark.slow)]
)
def test_what_a_test_leaves_behind_fails_the_run_and_is_named(place, processes, tmp_path):
    done = run(tmp_path, LEAVES[place], "-n", processes)
    named = [Path(line.split()[2]) for line in done.stdout.splitlines() if "ls -ld" in line]
    assert "1 passed" in done.stdout, done
    assert done.returncode == (place != "nothing")
    assert ["left" in path.name for path in named] == [True] * (place != "nothing")
    for path in named:
        if tmp_path not in path.parents:
            assert path.parent.parent == Path(tempfile.gettempdir())
            shutil.rmtree(path.parent)
