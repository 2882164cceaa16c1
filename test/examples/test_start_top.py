"""The client in C++: built and run where rclcpp is at hand, else read by a compiler."""

import re
import shutil
import subprocess

import pytest
from documents import ROOT
from programs import PATIENT, execute, running_node
from stub_of_rclcpp import assert_compiles, needs_compiler

from symtop_ros.ros.client.main import main
from workshop.load.domains import share_domain

DOMAIN = share_domain()
SOURCE = ROOT / "examples" / "start_top.cpp"
TEXT = SOURCE.read_text()
NODE, *FIELDS = re.search(r"and then: start_top (.*)", TEXT)[1].split()
BUILT = f"""
cmake_minimum_required(VERSION 3.8)
project(start_top CXX)
set(CMAKE_CXX_STANDARD 17)
{"".join(line.removeprefix("//   ") + chr(10) for line in TEXT.splitlines() if line[:5] == "//   ")}
"""


def find_rclcpp():
    return (
        bool(shutil.which("ros2"))
        and not subprocess.run(
            ["ros2", "pkg", "prefix", "rclcpp"], capture_output=True, check=False
        ).returncode
    )


@pytest.mark.skipif(not find_rclcpp(), reason="no rclcpp: it is not on PyPI")
def test_it_is_built_and_the_node_answers(tmp_path):
    shutil.copy(SOURCE, tmp_path)
    (tmp_path / "CMakeLists.txt").write_text(BUILT)
    execute(["cmake", "-B", "build"], cwd=tmp_path, check=True, timeout=300)
    execute(["cmake", "--build", "build"], cwd=tmp_path, check=True, timeout=300)
    with running_node(DOMAIN, "scene:=cusps"):
        done = execute([tmp_path / "build" / "start_top", NODE, *FIELDS], timeout=60)
    assert done.returncode == 0
    assert "Solution 1 of 2" in done.stdout


@needs_compiler
def test_a_compiler_reads_it(tmp_path):
    assert_compiles(SOURCE, tmp_path)


def test_a_node_answers_the_request_that_it_shows(capsys, monkeypatch, signals_as_before):
    """The same service, names and doubles, sent by top_ctl."""
    monkeypatch.setenv("ROS_DOMAIN_ID", str(DOMAIN))
    assert "/set_initial_conditions" in TEXT
    pairs = [f"{name}={value}" for name, value in zip(FIELDS[::2], FIELDS[1::2], strict=True)]
    with running_node(DOMAIN, "scene:=cusps"):
        assert main([*PATIENT, "--node", NODE, "start", *pairs]) == 0
    assert "Solution 1 of 2" in capsys.readouterr().out
