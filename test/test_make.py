"""The first hour: what make says and does before anything is installed."""

import json
import os
import re
import shutil
import signal
import subprocess
import sys
import sysconfig
from collections import namedtuple
from functools import partial

import pytest
from documents import ROOT
from programs import execute
from trials import choose
from waiting import until

import workshop.set_up
from symtop_ros import __version__
from symtop_ros.page.web.join import write_file

README = ROOT / "README.md"
PACKAGE = ("setup.py", "setup.cfg", "build_kernel.py", "package.xml", "symtop_ros/__init__.py")
NEEDED = ("Makefile", "workshop/environment.mk", "workshop/set_up.py", *PACKAGE)
HEADER = "symtop_ros/physics/kernel/symtop.h"
LIBRARY = "symtop_ros/physics/kernel/libsymtop.so"
RECORD = ".venv/lib/python*/site-packages/symtop*/direct_url.json"
# Writes down what it is asked for, and what an editable installation leaves.
PIP = """
import json, pathlib, sys
root = pathlib.Path(sys.prefix).parent
with (root / "asked").open("a") as file:
    print(*(word for word in sys.argv[1:] if word not in ("--no-compile", "--quiet")), file=file)
if "--editable" in sys.argv:
    site = pathlib.Path(__file__).parents[1] / "symtop_ros-1.dist-info"
    site.mkdir(exist_ok=True)
    (site / "direct_url.json").write_text(json.dumps({"dir_info": {"editable": True}, "url": ""}))
sys.exit((root / "no network").exists())
"""
# Makes an environment of the Python that runs it, with that pip.
VENV = """
import pathlib, sys
folder, python = pathlib.Path(sys.argv[-1]), pathlib.Path(sys.executable).resolve()
pip = folder / "lib/python{}.{}/site-packages/pip".format(*sys.version_info[:2])
for each in (folder / "bin", pip):
    each.mkdir(parents=True)
(folder / "bin/python").symlink_to(python)
config = f"home = {python.parent}\\ninclude-system-site-packages = false"
(folder / "pyvenv.cfg").write_text(config)
(pip / "__main__.py").write_text(pathlib.Path("pip.txt").read_text())
"""


def make(folder, *words, **variables):
    """Run make in a folder without any environment; return the process, which has ended."""
    outer = {"MAKEFLAGS", "MFLAGS", "MAKELEVEL"}  # of the make that runs the tests
    environment = {name: os.environ[name] for name in os.environ.keys() - outer}
    words = ["make", *words, *(f"{k}={value}" for k, value in variables.items())]
    return execute(words, cwd=folder, env=environment, timeout=300)


# Of `make lint` and of `make test-rest`.
PARTS = {"style", "types"}
PARTS |= {f"test-{name}" for name in ("slow", "old-processor", "without-ros", "realtime")}


def list_phony():
    """The targets that are no files."""
    (found,) = re.findall(r"^\.PHONY: (help .*)$", make(ROOT, "-pn", "help").stdout, re.MULTILINE)
    return set(found.split())


def test_help_lists_every_target_of_a_user_and_of_a_change():
    listed = make(ROOT, "help").stdout
    assert list_phony() > PARTS
    named = set(re.findall(r"^(\S+)  ", listed, re.MULTILINE))
    assert named == list_phony() - PARTS


@pytest.fixture(name="fresh")
def _fresh(tmp_path):
    return write_checkout(tmp_path / "My Größe")


def write_checkout(folder):
    """Write a checkout with what make needs and a pip that fetches nothing."""
    for name in (*NEEDED, HEADER):
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        shutil.copy(ROOT / name, folder / name)
    (folder / LIBRARY).touch()
    (folder / "venv.py").write_text(VENV)
    (folder / "pip.txt").write_text(PIP)
    return folder


@pytest.fixture(scope="module")
def made(tmp_path_factory):
    """A path with a blank, and a copy of the checkout that was set up there as panel and ros."""
    folder = write_checkout(tmp_path_factory.mktemp("made") / "My Größe")
    done = make(folder, "set-up-panel", "set-up-ros")
    assert (done.returncode, done.stdout.splitlines()[0]) == (0, "Setting up .venv: Python ...")
    (folder / "asked").unlink()
    return folder, folder.rename(folder.with_name("copy"))


@pytest.fixture(name="checkout")
def _checkout(made):
    """The checkout in its place, as after its set-up."""
    folder, copy = made
    shutil.copytree(copy, folder, symlinks=True)
    yield folder
    shutil.rmtree(folder, ignore_errors=True)  # a test may have moved it


def set_up(checkout, *names):
    """Make set-ups; return the status, the lines of make and what pip was asked for."""
    done = make(checkout, *(f"set-up-{name}" for name in names or ("panel", "ros")))
    asked = checkout / "asked"
    lines = asked.read_text().splitlines() if asked.exists() else []
    return done.returncode, done.stdout.splitlines(), lines


def is_anew(printed, reason):
    """Return True if the environment was made anew for a reason, in one line."""
    return printed[:2] == [
        f"make: .venv {reason}: it is made anew",
        "Setting up .venv: Python ...",
    ]


def test_nothing_is_run_where_all_is_there(checkout):
    for path in checkout.rglob("*"):
        if not path.is_symlink():
            os.utime(path)  # an archive has the times of its commit
    assert set_up(checkout) == (0, [], [])


def test_a_link_to_the_environment_of_another_checkout_is_replaced(checkout, tmp_path):
    other = tmp_path / "other"
    shutil.copytree(checkout, other, symlinks=True)
    shutil.rmtree(other / ".venv")
    (other / ".venv").symlink_to(checkout / ".venv")
    assert is_anew(set_up(other)[1], f"was made in {checkout}")
    assert not (other / ".venv").is_symlink()
    assert set_up(checkout) == (0, [], [])


def test_a_program_that_pip_has_installed_is_left_alone(checkout):
    program = checkout / ".venv/bin/top_panel"
    assert "exec" in program.read_text()  # of the set-up of the page
    program.write_text("of pip")
    (checkout / ".venv/set-up/panel.json").unlink()
    assert set_up(checkout, "panel")[0] == 0
    assert program.read_text() == "of pip"


def test_one_extra_more_has_those_before(checkout):
    status, printed, asked = set_up(checkout, "test")
    assert (status, printed[0].partition(":")[0]) == (0, "Setting up .venv")
    wanted = "--editable .[ros,playback,report,test,lint] --constraint test/constraints.txt"
    assert asked[-1].endswith(wanted)
    (checkout / "asked").unlink()
    assert set_up(checkout, "ros", "report", "quick", "panel") == (0, [], [])


REASONS = {
    HEADER: "sources of the package have changed",
    "symtop_ros/__init__.py": "sources of the package have changed",
    LIBRARY: "the compiled kernel is missing",
    RECORD: "the package is not installed",
}


@pytest.mark.parametrize("change", choose(REASONS, (HEADER, RECORD)))
def test_the_package_is_built_anew_for_a_reason(checkout, change):
    reason = REASONS[change]
    (path,) = checkout.glob(change)
    if change in (LIBRARY, RECORD):
        path.unlink()
    else:
        path.write_text(path.read_text() + "\n")
    status, printed, asked = set_up(checkout)
    assert (status, printed) == (0, [f"make: {reason}: it is built anew"])
    assert [line.split()[-3:] for line in asked] == [["--no-deps", "--editable", "."]]
    (checkout / LIBRARY).touch()
    (checkout / "asked").unlink()
    assert set_up(checkout) == (0, [], [])


def test_python_that_has_changed_needs_no_build(checkout):
    (checkout / "symtop_ros/new.py").touch()
    assert set_up(checkout) == (0, [], [])


def test_a_copy_that_pip_has_put_in_its_place_goes(checkout):
    (record,) = checkout.glob(RECORD)
    record.write_text('{"dir_info": {}, "url": ""}')
    status, (line,), asked = set_up(checkout, "ros")
    assert status == 0
    assert "was installed as a copy, which changes of the checkout do not reach" in line
    assert len(asked) == 1


def test_a_moved_checkout_gets_a_new_environment(checkout, tmp_path):
    moved = checkout.rename(tmp_path / "moved")
    status, printed, _ = set_up(moved, "python")
    assert status == 0
    assert is_anew(printed, f"was made in {checkout}")
    assert set_up(moved, "python") == (0, [], [])


def test_an_environment_of_another_python_is_made_anew(checkout):
    stamp = checkout / ".venv/set-up/python.json"
    now = json.loads(stamp.read_text())["python"]
    stamp.write_text(stamp.read_text().replace(now, "Python 3.2 in /usr"))
    status, printed, _ = set_up(checkout, "python")
    assert status == 0
    assert is_anew(printed, f"was made of Python 3.2 in /usr, which is {now} now")


def test_a_python_that_is_asked_for_and_is_in_the_environment_changes_nothing(checkout):
    done = make(checkout, "set-up-python", PYTHON=shutil.which("python3"))
    assert (done.returncode, done.stdout) == (0, "")


def test_an_environment_that_was_not_completed_is_made_anew(checkout):
    (checkout / ".venv/set-up/python.json").unlink()
    status, printed, _ = set_up(checkout, "python")
    assert status == 0
    assert is_anew(printed, "was not completed, or is of an earlier version")


def test_without_a_network_a_line_says_what_to_do_and_the_next_run_tries_again(checkout):
    (checkout / "no network").touch()
    (checkout / "setup.py").write_text((checkout / "setup.py").read_text() + "\n")
    for _ in range(2):
        status, printed, _ = set_up(checkout, "ros")
        assert status == 2
        assert printed[-1].startswith("make: pip could not install what is missing")
    (checkout / "no network").unlink()
    assert set_up(checkout, "ros")[0] == 0


def test_a_python_without_venv_leads_to_its_package(fresh):
    """As on Debian without python3-venv."""
    (fresh / "venv.py").write_text("raise SystemExit(1)")
    for _ in range(2):  # the advice is the same the second time
        done = make(fresh, "set-up-python")
        assert done.returncode == 2
        assert "apt install python3-venv" in done.stdout


def test_ctrl_c_ends_the_set_up_and_what_it_has_started_without_a_traceback(fresh):
    (fresh / "venv.py").write_text(
        "import pathlib, time\npathlib.Path('begun').touch()\ntime.sleep(600)\n"
    )
    words = [sys.executable, "-S", "workshop/set_up.py", "ros"]
    pipes = {"stdout": subprocess.PIPE, "stderr": subprocess.STDOUT, "text": True}
    # A job in the background of a shell has the signal ignored, and so have its children.
    pipes["preexec_fn"] = partial(signal.signal, signal.SIGINT, signal.SIG_DFL)
    with subprocess.Popen(words, cwd=fresh, start_new_session=True, **pipes) as process:
        until((fresh / "begun").exists)
        os.killpg(process.pid, signal.SIGINT)  # as a terminal does
        printed, _ = process.communicate(timeout=60)  # else what was started keeps the pipe open
    assert (process.returncode, printed) == (130, "Setting up .venv: Python ...\n")


def make_read_only(monkeypatch):
    """Root may write to all folders but those of a read-only disk."""
    monkeypatch.setattr(os, "access", lambda *_: False)
    return f"; {workshop.set_up.ROOT} may not be written to"


def fill_the_disk(monkeypatch):
    usage = namedtuple("Usage", "total used free")(10**10, 10**10 - 5 * 10**6, 5 * 10**6)
    monkeypatch.setattr(shutil, "disk_usage", lambda _: usage)
    return f"; only 5 MB are free in {workshop.set_up.ROOT}"


@pytest.mark.parametrize("spoil", [make_read_only, fill_the_disk])
def test_what_a_place_lacks_follows_the_reason_of_a_failure(spoil, monkeypatch, capsys):
    lack = spoil(monkeypatch)

    def fail(_):
        raise workshop.set_up.FailedError("pip failed")

    monkeypatch.setattr(workshop.set_up, "keep", fail)
    monkeypatch.setattr(workshop.set_up, "_keep_environment", lambda _: None)
    assert workshop.set_up.main(["ros"]) == 1
    assert capsys.readouterr().out == f"make: pip failed{lack}\n"


def test_a_python_that_is_missing_or_old_is_named(fresh, tmp_path):
    old = tmp_path / "old python"
    old.write_text("#!/bin/sh\necho 3.9.2\nexit 1\n")
    old.chmod(0o755)
    for python, reason in (("nonexistent", "not found"), (old, "3.9.2; name one")):
        done = make(fresh, "set-up-python", PYTHON=python)
        assert done.returncode == 2
        said = f"PYTHON must be Python 3.11 or later, got {python}: {reason}"
        assert said in done.stdout


def test_ci_types_the_set_up_of_the_readme_without_the_variables_of_the_machine(
    tmp_path,
):
    fake = tmp_path / "make"
    fake.write_text("#!/bin/sh\necho $*\nenv\n")
    fake.chmod(0o755)
    variables = {"PYTHONUNBUFFERED": "1", "ROS_DOMAIN_ID": "7", "PIP_NO_INPUT": "1"}
    path = os.pathsep.join([str(tmp_path), os.environ["PATH"]])
    variables = {**os.environ, **variables, "PATH": path}
    printed = execute([ROOT / ".ci/run"], env=variables, check=True).stdout
    block = re.search(r"## Set-up\n.*?```sh\n.*?\ncd \S+\n(.*?)```", README.read_text(), re.S)[1]
    assert re.findall(r"^\$ (.*)$", printed, re.M) == [*block.splitlines(), "make test-rest"]
    assert block.splitlines()[-1] == "make test"
    names = {line.partition("=")[0] for line in printed.splitlines()}
    assert {"HOME", "PATH", "PIP_NO_INPUT"} <= names
    assert not names & {"PYTHONUNBUFFERED", "ROS_DOMAIN_ID"}


def test_every_variable_of_the_makefile_has_a_value():
    """Of a variable without a definition make takes the empty text, and says so when asked."""
    told = make(ROOT, "--warn-undefined-variables", "-n", "test", "test-kilted", "docs").stderr
    ours = [line for line in told.splitlines() if "undefined variable" in line]
    assert [line for line in ours if not re.search("'(ROS_LOG_DIR|MPLCONFIGDIR)'", line)] == []


@pytest.mark.slow
def test_the_page_needs_no_compiler_and_no_compiled_kernel(checkout):
    """As in a fresh checkout on a machine without a compiler, once NumPy and PyYAML are there."""
    compiled = shutil.ignore_patterns("libsymtop.*", "symtop.dll", "__pycache__")
    shutil.rmtree(checkout / "symtop_ros")
    shutil.copytree(ROOT / "symtop_ros", checkout / "symtop_ros", ignore=compiled)
    shutil.copytree(ROOT / "config", checkout / "config")
    (site,) = checkout.glob(".venv/lib/python*/site-packages")
    (site / "those_of_the_tests.pth").write_text(sysconfig.get_paths()["purelib"])
    words = [shutil.which("make"), "panel"]
    path = {"PATH": str(checkout / ".venv/bin")}
    made = execute(words, cwd=checkout, env=path, timeout=300)
    assert (made.returncode, made.stdout) == (0, "wrote top.html, open it in a browser\n"), made
    assert (checkout / "top.html").read_text() == write_file()
    words = [checkout / ".venv/bin/top_panel", "--version"]  # in a folder with a blank
    done = execute(words, cwd="/", env={"PATH": "/usr/bin:/bin"})
    assert (done.returncode, done.stdout) == (0, f"top_panel {__version__}\n"), done.stderr
