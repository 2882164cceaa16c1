"""The first hour: what make says and does before anything is installed."""

import os
import re
import shutil
import sys

import groups
import pytest
from documents import ROOT
from programs import execute

from symtop_ros.web.join import write_file

MAKEFILE = ROOT / "Makefile"
ACTIVATE = ".venv/bin/activate"  # the target that makes the environment


def make(folder, *words, **variables):
    """Run make in a folder without any environment; return the process, which has ended."""
    outer = {"MAKEFLAGS", "MFLAGS", "MAKELEVEL"}  # of the make that runs the tests
    environment = {name: os.environ[name] for name in os.environ.keys() - outer}
    words = ["make", "-f", MAKEFILE, *words, *(f"{k}={value}" for k, value in variables.items())]
    return execute(words, cwd=folder, env=environment, timeout=300)


PARTS = {"style", "types", "types-js"}  # of `make lint`
GROUPS = {f"test-{name}" for name in groups.list_groups(trace=False)}


def list_phony(*words, folder):
    """The targets that are no files."""
    (found,) = re.findall(r"^\.PHONY: (help .*)$", make(folder, "-pn", *words).stdout, re.MULTILINE)
    return set(found.split())


def test_help_lists_every_target_of_a_user_and_of_a_change(tmp_path):
    listed = make(tmp_path, "help").stdout
    assert list_phony("help", folder=tmp_path) > GROUPS | PARTS
    named = set(re.findall(r"^(\S+)  ", listed, re.MULTILINE))
    assert named == list_phony("help", folder=tmp_path) - GROUPS - PARTS


@pytest.mark.long  # pip is installed; the next test has an environment without a pip, too
@pytest.mark.parametrize("present", ["no pip", "nothing"])
def test_an_environment_that_was_not_completed_is_made_again(tmp_path, present):
    if present != "nothing":
        interpreter = tmp_path / ".venv/bin/python"
        interpreter.parent.mkdir(parents=True)
        interpreter.symlink_to(sys.executable)
    made = make(tmp_path, ACTIVATE, PYTHON=sys.executable)
    assert made.returncode == 0, made.stderr
    pip = [tmp_path / ".venv/bin/python", "-m", "pip", "--version"]
    assert str(tmp_path) in execute(pip, check=True).stdout


def test_a_python_that_cannot_make_an_environment_leaves_none_and_names_the_package(tmp_path):
    """As on Debian without python3-venv, where venv fails after it has written the interpreter."""
    python = tmp_path / "python3"
    python.write_text(
        '#!/bin/sh\n[ "$2" = venv ] || exit 0\nmkdir -p .venv/bin\ntouch .venv/bin/python\nexit 1\n'
    )
    python.chmod(0o755)
    for _ in range(2):  # the advice is the same the second time
        made = make(tmp_path, ACTIVATE, PYTHON=python)
        assert made.returncode == 2
        assert "apt install python3-venv" in made.stdout


def test_a_python_that_is_missing_is_named(tmp_path):
    made = make(tmp_path, ACTIVATE, PYTHON="nonexistent")
    assert made.returncode == 2
    assert "PYTHON must be a Python 3.11 or later, got nonexistent: not found" in made.stdout


def test_the_tests_run_without_the_variables_of_the_machine(tmp_path):
    fake = tmp_path / "make"
    fake.write_text("#!/bin/sh\necho $*\nenv\n")
    fake.chmod(0o755)
    variables = {"PYTHONUNBUFFERED": "1", "ROS_DOMAIN_ID": "7", "PIP_NO_INPUT": "1"}
    path = os.pathsep.join([str(tmp_path), os.environ["PATH"]])
    variables = {**os.environ, **variables, "PATH": path}
    printed = execute([ROOT / ".ci/run"], env=variables, check=True).stdout
    first, *rest = printed.splitlines()
    names = {line.partition("=")[0] for line in rest}
    assert first == "test"
    assert {"HOME", "PATH", "PIP_NO_INPUT"} <= names
    assert not names & {"PYTHONUNBUFFERED", "ROS_DOMAIN_ID"}


def test_every_variable_of_the_makefile_has_a_value():
    """Of a variable without a definition make takes the empty text, and says so when asked."""
    told = make(ROOT, "--warn-undefined-variables", "-nB", "test", "test-kilted", "docs").stderr
    ours = [line for line in told.splitlines() if "undefined variable" in line]
    assert [line for line in ours if not re.search("'(ROS_LOG_DIR|MPLCONFIGDIR)'", line)] == []


def test_the_page_needs_no_compiler_and_no_compiled_kernel(tmp_path):
    """As in a fresh checkout on a machine without a compiler, once NumPy and PyYAML are there."""
    compiled = shutil.ignore_patterns("libsymtop.*", "symtop.dll", "__pycache__")
    shutil.copytree(ROOT / "symtop_ros", tmp_path / "symtop_ros", ignore=compiled)
    shutil.copytree(ROOT / "config", tmp_path / "config")
    shutil.copy(ROOT / "package.xml", tmp_path)
    programs = tmp_path / ".venv/bin"
    programs.mkdir(parents=True)
    python = programs / "python"
    python.write_text(f'#!/bin/sh\nexec {sys.executable} "$@"\n')
    python.chmod(0o755)
    for name in ("bin/activate", "panel"):  # they have been set up
        (tmp_path / ".venv" / name).touch()
    command = [shutil.which("make"), "-f", MAKEFILE, "panel"]
    made = execute(command, cwd=tmp_path, env={"PATH": str(programs)}, timeout=60)
    assert (made.returncode, made.stdout) == (0, "wrote top.html, open it in a browser\n"), made
    assert (tmp_path / "top.html").read_text() == write_file()
