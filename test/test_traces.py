"""What tests leave behind is theirs, and never that of the user's other programs."""

import subprocess
import sys
import tempfile

import pytest
import traces
from waiting import until

# A program that leaves a file in the shared memory when it ends.
LEAVE = """
import mmap, sys
with open(sys.argv[1], "w+b") as file:
    file.truncate(4096)
    mapped = mmap.mmap(file.fileno(), 4096)
    print(flush=True)
    sys.stdin.read()
"""


@pytest.fixture(name="found")
def _found(monkeypatch, tmp_path):
    for name in ("home", "shared"):
        (tmp_path / name).mkdir()
    monkeypatch.setenv("HOME", str(tmp_path / "home"))
    monkeypatch.setattr(traces, "SHARED", tmp_path / "shared")
    monkeypatch.setattr(traces, "PERIOD", 0.01)
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path))
    found = traces.Traces()
    yield found
    found.close()


def leave(path, is_seen, **options):
    """Let a program leave a file, after the watch has seen that it uses it."""
    pipes = {"stdin": subprocess.PIPE, "stdout": subprocess.PIPE}
    with subprocess.Popen([sys.executable, "-c", LEAVE, str(path)], **pipes, **options) as process:
        process.stdout.readline()
        until(is_seen)
    assert path.exists()


def test_a_file_that_a_program_of_the_user_had_mapped_is_none_of_the_tests(
    found, monkeypatch, tmp_path
):
    monkeypatch.setattr(traces, "is_child", lambda _: False)  # as if the user had started it
    path = tmp_path / "shared/other"
    leave(path, lambda: path in found._of_others)
    assert list(found.find()) == []


def test_a_file_that_a_program_of_the_tests_had_mapped_is_left_behind(found, tmp_path):
    looked = []
    path = tmp_path / "shared/own"
    leave(path, lambda: looked.append(found._look()) or path in looked[-1])
    assert list(found.find()) == [path]


def test_a_program_that_has_left_its_parent_is_known_by_its_environment(
    found, monkeypatch, tmp_path
):
    monkeypatch.setattr(traces, "is_child", lambda _: False)
    looked = []
    path = tmp_path / "shared/orphan"
    leave(path, lambda: looked.append(found._look()) or path in looked[-1], env=found.variables)
    assert list(found.find()) == [path]


def test_only_names_that_tests_may_write_are_looked_for_in_the_home(found, tmp_path):
    for name in ("notes.txt", ".viminfo", ".rerun", ".ros"):
        (tmp_path / "home" / name).touch()
    assert [path.name for path in found.find()] == [".rerun", ".ros"]
