"""Every way in, typed in the folder of the checkout: it ends where README and docs/README say.

NumPy and SciPy are those of the tests, and the compiler has compiled the kernel already.
test/newcomer.py types what fetches more: `make demo`, and all of README.
"""

import os
import re
import shutil
import subprocess
import sys
import sysconfig
from pathlib import Path

import lint
import pytest
from documents import ROOT, blocks, names, rows, same
from programs import execute

from symtop_ros import __version__
from symtop_ros.physics.kernel.library import load_library

pytestmark = [pytest.mark.slow, pytest.mark.untraced]
README, GUIDE = ROOT / "README.md", ROOT / "docs/README.md"
REFERENCE = ROOT / "docs/ros_reference.md"
((CODE, SHOWN),) = blocks(README, "python")
# By the first cell of a row of the guide: what it promises. A second table has fewer columns.
ROUTES = [row for row in rows(GUIDE, "Which install do I need?") if len(row) == 4]
PROMISED = {row[0]: names(row[3]) for row in ROUTES}
PROGRAMS = [each for row in rows(REFERENCE, "Programs") for each in names(row[0])]
NEED_ROS = ("top_node", "top_ctl", "top_live")


class Checkout:
    """The files of the project in a folder with a blank, and an environment of its user."""

    def __init__(self, place):
        self.folder = place / "symtop ros"
        for name in lint.list_files():
            (self.folder / name).parent.mkdir(parents=True, exist_ok=True)
            shutil.copy(ROOT / name, self.folder / name)
        compiler = place / "compiler"
        compiler.write_text(
            f'#!/bin/sh\nfor target; do :; done\ncp "{load_library()._name}" "$target"\n'
        )
        compiler.chmod(0o755)
        self.bin = place / "venv/bin"
        self.variables = {
            "PATH": f"{self.bin}:/usr/bin:/bin",
            "CXX": str(compiler),
            "HOME": str(place),
        }

    def make_environment(self, folder):
        """Make an environment that has the packages of the tests, but for this one."""
        execute([sys.executable, "-m", "venv", "--without-pip", folder], check=True)
        (site,) = folder.glob("lib/python*/site-packages")
        (site / "those_of_the_tests.pth").write_text(sysconfig.get_paths()["purelib"])

    def type(self, *words, **variables):
        """Type a line in the folder."""
        found = shutil.which(words[0], path=self.variables["PATH"])
        environment = {**self.variables, **variables}
        return execute([found or words[0], *words[1:]], cwd=self.folder, env=environment)

    def install(self, *words):
        self.make_environment(self.bin.parent)
        options = ["--no-deps", "--no-build-isolation", "--quiet"]
        done = self.type("python", "-m", "pip", "install", *options, *words)
        assert done.returncode == 0, done.stderr

    def assert_python_of_readme(self, **variables):
        done = self.type("python", "-c", CODE, **variables)
        assert done.returncode == 0, done.stderr
        assert same(done.stdout, SHOWN, CODE)

    def assert_programs(self, programs):
        for name in programs:
            done = self.type(name, "--version")
            assert (done.returncode, done.stdout) == (0, f"{name} {__version__}\n"), done.stderr


@pytest.fixture(name="checkout")
def _checkout(tmp_path):
    return Checkout(tmp_path)


def test_the_guide_promises_programs_that_there_are():
    assert PROMISED["the page from a checkout"] == [".venv", "top_panel"]
    assert {*PROMISED["the node, with ROS 2 from PyPI"]} == {"top_node", "top_ctl"}
    assert {*NEED_ROS, "top_panel"} < {*PROGRAMS}


@pytest.mark.parametrize("form", [["."], ["-e", "."]], ids=" ".join)
def test_pip_in_the_checkout(form, checkout):
    """The package of the folder is the one that Python imports, whatever pip has installed."""
    checkout.install(*form)
    checkout.assert_python_of_readme()
    checkout.assert_programs([each for each in PROGRAMS if each not in NEED_ROS])
    told = checkout.type("python", "-m", "symtop_ros").stdout
    assert re.search(rf"^kernel +{re.escape(__version__)}, sources ", told, re.MULTILINE)
    assert f"({checkout.folder / 'symtop_ros'})" in told


def test_make_panel_alone(checkout):
    """It has no kernel, and says so; then `pip install -e .`, which it names, is right."""
    place = checkout.folder / ".venv"
    checkout.make_environment(place)
    checkout.variables["PATH"] = f"{place / 'bin'}:/usr/bin:/bin"
    set_up = "from workshop import set_up; set_up._install = lambda *_: None"
    done = checkout.type("python", "-c", f"{set_up}; set_up._write('python'); set_up.keep('panel')")
    assert done.returncode == 0, done.stderr
    done = checkout.type("make", "panel")
    assert (done.returncode, done.stdout[:14]) == (0, "wrote top.html"), done.stderr
    checkout.assert_programs(["top_panel"])
    failed = checkout.type("python", "-c", CODE)
    assert failed.returncode == 1
    assert failed.stderr.splitlines()[-1] == (
        f"ImportError: no compiled kernel is in {checkout.folder / 'symtop_ros/physics/kernel'}: "
        f"`pip install -e .` in {checkout.folder} builds it"
    )
    told = checkout.type("python", "-m", "symtop_ros").stdout
    assert "kernel       ImportError: no compiled kernel is in" in told


def test_colcon_in_a_workspace(checkout, tmp_path):
    colcon = Path(sys.executable).with_name("colcon")
    if not colcon.exists():
        pytest.skip("colcon is not installed")
    (tmp_path / "ws/src").mkdir(parents=True)
    checkout.folder = checkout.folder.rename(tmp_path / "ws/src/symtop_ros")
    checkout.variables["PATH"] = f"{colcon.parent}:/usr/bin:/bin"
    words = [colcon, "build", "--packages-select", "symtop_ros"]
    execute(words, cwd=tmp_path / "ws", env={**os.environ, **checkout.variables}, check=True)
    # colcon's script does not quote the Python that it calls: its path may have a blank
    (tmp_path / "python").symlink_to(sys.executable)
    checkout.variables["COLCON_PYTHON_EXECUTABLE"] = str(tmp_path / "python")
    lines = 'source ../../install/setup.bash && exec python -c "$CODE"'
    done = subprocess.run(
        ["bash", "-c", lines],
        cwd=checkout.folder,
        env={**checkout.variables, "CODE": CODE},
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    assert same(done.stdout, SHOWN, CODE)
