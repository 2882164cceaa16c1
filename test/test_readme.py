"""The commands of the README do what it says."""

import contextlib
import io
import re
from pathlib import Path

import pytest
from programs import run, running_node

ROOT = Path(__file__).parents[1]
README = (ROOT / "README.md").read_text()
DOMAIN = 99
COMMANDS = re.findall(r"^top_ctl (.+)$", README, flags=re.MULTILINE)


@pytest.fixture(scope="module")
def node():
    with running_node(DOMAIN, "scene:=hurry_slow"):
        yield


@pytest.mark.usefixtures("node")
@pytest.mark.parametrize("words", COMMANDS)
def test_a_command_of_the_readme_is_granted(words):
    result = run("top_ctl", *words.split(), domain=DOMAIN)
    assert result.returncode == 0, result.stderr
    if words == "hurry":
        told = " ".join(result.stdout.split())
        assert told in " ".join(README.split())


def test_there_are_commands_in_the_readme():
    assert len(COMMANDS) >= 10


def test_the_example_of_the_library_runs():
    example = re.search(r"```python\n(.+?)```", README, flags=re.DOTALL)
    assert example
    with contextlib.redirect_stdout(io.StringIO()) as printed:
        exec(example[1], {})
    assert printed.getvalue().startswith("cusps (0.5, 0.66")
    assert "the top rises" in printed.getvalue()


@pytest.mark.parametrize("target", ["demo", "test", "report"])
def test_the_targets_of_make_exist(target):
    assert f"make {target}" in README
    assert re.search(rf"^{target}:", (ROOT / "Makefile").read_text(), flags=re.MULTILINE)
