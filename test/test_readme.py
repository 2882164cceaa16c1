"""The commands of the README do what it says."""

import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
README = (ROOT / "README.md").read_text()
ENVIRONMENT = {**os.environ, "ROS_DOMAIN_ID": "99"}
COMMANDS = re.findall(r"^top_ctl (.+)$", README, flags=re.MULTILINE)


def program(name, *arguments):
    return [sys.executable, str(ROOT / "resource" / name), *arguments]


@pytest.fixture(scope="module")
def node():
    options = ["--ros-args", "-p", "scene:=hurry_slow", "--log-level", "warn"]
    running = subprocess.Popen(program("top_node", *options), env=ENVIRONMENT)
    yield running
    running.terminate()
    running.wait(timeout=20)


def run(command):
    return subprocess.run(
        command, capture_output=True, text=True, timeout=60, check=False, env=ENVIRONMENT
    )


@pytest.mark.usefixtures("node")
@pytest.mark.parametrize("words", COMMANDS)
def test_a_command_of_the_readme_is_granted(words):
    result = run(program("top_ctl", *words.split()))
    assert result.returncode == 0, result.stderr
    if words == "hurry":
        told = " ".join(result.stdout.split())
        assert told in " ".join(README.split())


def test_there_are_commands_in_the_readme():
    assert len(COMMANDS) >= 10


def test_the_example_of_the_library_runs():
    example = re.search(r"```python\n(.+?)```", README, flags=re.DOTALL)
    assert example
    result = run([sys.executable, "-c", example[1]])
    assert result.returncode == 0, result.stderr
    assert result.stdout.startswith("cusps (0.5, 0.66")
    assert "the top rises" in result.stdout


@pytest.mark.parametrize("target", ["demo", "test", "report"])
def test_the_targets_of_make_exist(target):
    assert f"make {target}" in README
    assert re.search(rf"^{target}:", (ROOT / "Makefile").read_text(), flags=re.MULTILINE)
