import os
import subprocess
import sys
from pathlib import Path

import pytest
from documents import ROOT
from programs import run_python, write_without

from symtop_ros import __version__, programs
from symtop_ros.base import missing
from symtop_ros.physics import kernel_version
from symtop_ros.ros.node.host import VARIABLES

pytestmark = pytest.mark.usefixtures("signals_as_before")


@pytest.fixture(autouse=True)
def _environment_as_before(monkeypatch):
    for name in (programs.TRANSPORTS, programs.THREADS):
        monkeypatch.setenv(name, "")


ROS = "source a ROS 2, or pip install 'symtop_ros[ros]'"
# What programs for logs, ROS and Rerun import.
HEAVY = ("rclpy", "rerun", "rerun_cli", "mcap", "lz4", "zstandard", "sensor_msgs")
PROGRAMS = sorted(path.name for path in (ROOT / "resource").glob("top_*"))


@pytest.mark.parametrize(
    ("program", "missing", "text"),
    [
        ("top_node", "rclpy", f"rclpy is missing: {ROS}"),
        ("top_ctl", "rclpy", f"rclpy is missing: {ROS}"),
        ("top_live", "rclpy", f"rclpy is missing: {ROS}"),
        ("top_live", "rerun", "rerun-sdk is missing: pip install rerun-sdk"),
        ("top_panel", "yaml", "pyyaml is missing: pip install pyyaml"),
        ("top_replay", "mcap", "mcap is missing: pip install mcap"),
        ("top_replay", "lz4", "mcap is missing: pip install mcap"),
    ],
)
def test_a_program_says_what_is_missing(program, missing, text, tmp_path):
    code = write_without((missing,), program)
    done = run_python(code, cwd=tmp_path, PYTHONPATH=str(ROOT))
    assert done.returncode == 1
    assert f"{program}: {text}" in done.stderr


def test_a_checkout_that_is_not_installed_names_its_extra(monkeypatch):
    monkeypatch.setattr(missing, "NAME", "not_installed")
    assert missing.name_remedy("rclpy").endswith("pip install -e '.[ros]' in the checkout")


# Each program is asked in turn, in a process without what they need.
ASK = f"""
import sys
sys.modules.update(dict.fromkeys({HEAVY}))
from symtop_ros import programs
for name in {PROGRAMS}:
    for word in ("--help", "-h", "--version"):
        sys.argv = [name, word]
        try:
            getattr(programs, name)()
        except SystemExit as end:
            print(f"status {{end.code}}")
"""


@pytest.mark.slow
def test_help_and_version_need_neither_ros_nor_rerun_nor_mcap(tmp_path):
    done = run_python(ASK, cwd=tmp_path)
    answers = done.stdout.split("status 0\n")
    assert (done.stderr, answers.pop()) == ("", "")
    assert len(PROGRAMS) == 10
    for program, full, short, version in zip(
        PROGRAMS, *(answers[k::3] for k in range(3)), strict=True
    ):
        assert full.startswith(f"usage: {program} ")
        assert short == full
        assert version == f"{program} {__version__}\n"


def test_help_after_the_arguments_of_ros_is_theirs(monkeypatch, capsys):
    monkeypatch.setattr("sys.argv", ["top_ctl", "--ros-args", "--help"])
    assert programs.run("top_ctl", "a room that is missing") == 1
    assert capsys.readouterr().out == ""


@pytest.mark.parametrize("absent", [(), HEAVY])
def test_what_a_report_needs_is_printed_whatever_is_missing(absent):
    code = f"import sys; sys.modules.update(dict.fromkeys({absent})); "
    done = run_python(code + "from symtop_ros.__main__ import main; sys.exit(main())")
    found = {line[:13].strip(): line[13:] for line in done.stdout.splitlines()}
    assert done.returncode == 0, done.stderr
    assert found["symtop_ros"] == f"{__version__} ({ROOT / 'symtop_ros'})"
    assert found["kernel"].startswith(kernel_version())
    assert {"platform", "Python", "NumPy", "ROS 2", "middleware", "discovery", "mcap"} <= {*found}
    for name in ("ROS 2", "middleware", "mcap"):
        assert (found[name] == "not installed") is bool(absent)


@pytest.mark.parametrize(
    ("chosen", "transports"),
    [
        ({}, "UDPv4"),
        ({programs.TRANSPORTS: "DEFAULT"}, "DEFAULT"),
        *(({name: "mine.xml"}, "") for name in VARIABLES),
    ],
)
def test_programs_use_udp_unless_the_user_has_chosen(chosen, transports, monkeypatch):
    for name in VARIABLES:
        monkeypatch.delenv(name, raising=False)
    for name, value in chosen.items():
        monkeypatch.setenv(name, value)
    assert programs.run("top_ctl", "a module that is missing") == 1
    assert os.environ[programs.TRANSPORTS] == transports


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="no /dev/full")
@pytest.mark.parametrize("words", ["top_model --format urdf", "top_testset"])
def test_an_output_without_room_is_a_line_and_status_1(words):
    name, *options = words.split()
    code = f"import sys; from symtop_ros import programs; sys.exit(programs.{name}())"
    buffered = {key: text for key, text in os.environ.items() if key != "PYTHONUNBUFFERED"}
    with open("/dev/full", "w") as full:
        command = [sys.executable, "-c", code, *options]
        done = subprocess.run(
            command, stdout=full, stderr=subprocess.PIPE, text=True, env=buffered, check=False
        )
    assert (done.returncode, done.stderr) == (1, f"{name}: output: No space left on device\n")


def test_a_program_has_no_threads_of_linear_algebra():
    code = "import os; from symtop_ros import programs; programs._spare_the_user(); import numpy; "
    code += "print(len(os.listdir('/proc/self/task')))"
    assert run_python(code, **{programs.THREADS: ""}).stdout == "1\n"


def test_a_report_that_nobody_reads_to_its_end_is_silent():
    command = [sys.executable, "-m", "symtop_ros"]
    pipe = subprocess.PIPE
    with subprocess.Popen(command, stdout=pipe, stderr=pipe, text=True) as program:
        program.stdout.close()
        assert program.stderr.read() == ""
    assert program.returncode == programs.BROKEN_PIPE
