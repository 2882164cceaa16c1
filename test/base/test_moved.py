"""Import paths that 0.4 documented."""

import importlib
import subprocess
import sys

import pytest

from symtop_ros.base.moved import MOVED, rename

WORDS = ("imu", "imu.main", "judge", "judge.live", "simulation", "simulation.presets")


@pytest.mark.parametrize("word", WORDS)
def test_a_documented_path_of_0_4_leads_to_the_same_module_with_a_warning(word):
    old = f"symtop_ros.{word}"
    sys.modules.pop(old, None)
    with pytest.warns(DeprecationWarning, match=f"^{old} is symtop_ros\\..* now$"):
        module = importlib.import_module(old)
    assert module is importlib.import_module(rename(old))
    assert module.__name__ == module.__spec__.name == rename(old)


def test_a_module_that_has_moved_is_run_by_its_old_name():
    command = [sys.executable, "-m", "symtop_ros.testset.score", "--help"]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    assert "usage: " in done.stdout


def test_other_names_are_not_found():
    for name in ("symtop_ros.physics", "symtop_ros.log", "other.imu", "symtop_ros.imus"):
        assert rename(name) == ""
    with pytest.raises(ModuleNotFoundError):
        importlib.import_module("symtop_ros.wire")
    assert all(importlib.import_module(f"symtop_ros.{new}") for new in MOVED.values())
