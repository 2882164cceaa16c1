import os

import pytest
from documents import ROOT
from programs import run_python, write_without

from symtop_ros import programs
from symtop_ros.node.host import VARIABLES

pytestmark = pytest.mark.usefixtures("signals_as_before")


@pytest.fixture(autouse=True)
def _environment_as_before(monkeypatch):
    for name in (programs.TRANSPORTS, programs.THREADS):
        monkeypatch.setenv(name, "")


ROS = "source a ROS 2, or pip install '.[ros]' in the checkout"


@pytest.mark.parametrize(
    ("program", "missing", "remedy"),
    [
        ("top_node", "rclpy", ROS),
        ("top_ctl", "rclpy", ROS),
        ("top_live", "rclpy", ROS),
        ("top_live", "rerun", "pip install '.[playback]' in the checkout"),
        ("top_panel", "yaml", "pip install pyyaml"),
        ("top_replay", "mcap", "pip install mcap"),
    ],
)
def test_a_program_says_what_is_missing(program, missing, remedy, tmp_path):
    code = write_without((missing,), program)
    done = run_python(code, cwd=tmp_path, PYTHONPATH=str(ROOT))
    assert done.returncode == 1
    assert f"{missing} is missing: {remedy}" in done.stderr


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


def test_a_program_has_no_threads_of_linear_algebra():
    code = "import os; from symtop_ros import programs; programs._spare_the_user(); import numpy; "
    code += "print(len(os.listdir('/proc/self/task')))"
    assert run_python(code, **{programs.THREADS: ""}).stdout == "1\n"
