"""The groups of `make test`: all of them run, and the summary says what failed."""

import shlex
import shutil
import sys
import tempfile
from multiprocessing.shared_memory import SharedMemory
from pathlib import Path

import groups
import pytest
import traces
from documents import ROOT
from programs import execute

TESTS = """
import pytest

@pytest.mark.parametrize("text", ["a - b [c]", "d"])
def test_one(text):
    assert text == "d", "no - [d]"

def test_two():
    pytest.skip("not here")
"""


@pytest.fixture(name="folder", autouse=True)
def _folder(tmp_path, monkeypatch):
    """A folder for output, in which the groups run."""
    for name in ("OUTPUT", "ROOT"):
        monkeypatch.setattr(groups, name, tmp_path)
    for name in ("home", "shared"):  # without what other groups do there meanwhile
        (tmp_path / name).mkdir()
    monkeypatch.setenv("HOME", str(tmp_path / "home"))
    monkeypatch.setattr(traces, "SHARED", tmp_path / "shared")
    for name in ("TMPDIR", "PYTEST_DEBUG_TEMPROOT"):  # what `groups` sets is undone
        monkeypatch.setenv(name, tempfile.gettempdir())
    monkeypatch.setenv("PYTEST_DISABLE_PLUGIN_AUTOLOAD", "1")  # half of the time of a short run
    return tmp_path


def script(text):
    """A check that a line of Python makes."""
    return groups.Command((sys.executable, "-c", text), ())


def run(monkeypatch, commands, *words):
    monkeypatch.setattr(groups, "list_groups", lambda _: commands)
    monkeypatch.setattr(sys, "argv", ["groups.py", *words])
    return groups.main()


def test_every_group_runs_and_failures_are_summed_up_at_the_end(monkeypatch, capsys, folder):
    failing, good = script("import sys; print('oh'); sys.exit(3)"), script("print('fine')")
    others = ("second", "third", "fourth", "realtime")
    commands = {"first": [failing, good], **{name: [good] for name in others}}
    assert run(monkeypatch, commands) == 1
    lines = capsys.readouterr().out.splitlines()
    assert lines[-1] == "6 passed, 1 failed"  # with the check of what is left behind
    assert [line for line in lines if line.endswith("# exit status 3")] == [
        f"  {shlex.join(failing.words)}  # exit status 3"
    ]
    assert (folder / "first.txt").read_text() == "oh\nfine\n"


def test_each_failed_test_is_named_with_the_command_that_runs_it_alone(monkeypatch, capsys, folder):
    (folder / "test_some.py").write_text(TESTS)
    tests = groups.pytest("test_some.py", options=("-p", "no:cacheprovider"))
    assert run(monkeypatch, {"some": [tests]}) == 1
    printed = capsys.readouterr().out
    assert printed.splitlines()[-1] == "2 passed, 1 failed, 1 skipped"
    (again,) = [shlex.split(line) for line in printed.splitlines() if "::" in line and "-m" in line]
    assert again[-1] == "test_some.py::test_one[a - b [c]]"
    alone = [sys.executable, *again[1:]]
    result = execute(alone, cwd=folder)
    assert "1 failed in" in result.stdout


LEAVES = {
    "the temporary folder": "import tempfile; tempfile.mkdtemp(prefix='left-')",
    "the home": "import pathlib; (pathlib.Path.home() / 'left-rerun').touch()",
    "shared memory": "import pathlib; pathlib.Path('shared/left-here').touch()",
}


@pytest.mark.parametrize("place", LEAVES)
def test_what_a_test_leaves_behind_is_a_failure(place, monkeypatch, capsys, folder):
    assert run(monkeypatch, {"some": [script(LEAVES[place])]}) == 1
    printed = capsys.readouterr().out
    (line,) = [line for line in printed.splitlines() if "is left by a test" in line]
    left = Path(line.split()[2])
    assert left.name.startswith("left-")
    if left.is_dir():
        shutil.rmtree(left.parent)


def test_shared_memory_of_a_running_program_is_not_left_behind(monkeypatch):
    monkeypatch.setattr(traces, "SHARED", Path("/dev/shm"))
    found = traces.Traces()
    segment = SharedMemory(create=True, size=4096)
    left = [path for path in found.find() if segment.name.strip("/") in path.name]
    segment.close()
    segment.unlink()
    found.close()
    assert left == []


def test_an_empty_file_of_the_browser_is_no_trace_and_one_with_content_is():
    found = traces.Traces()
    empty, full = (found.folder / f".org.chromium.Chromium.{name}" for name in ("a", "b"))
    empty.touch()
    full.write_text("left")
    left = [path for path in found.find() if path.parent == found.folder]
    full.unlink()
    found.close()
    assert left == [full]
    assert not found.folder.exists()


def test_make_test_runs_every_test_of_real_time():
    paths = [path for path in ROOT.glob("test/**/test_*.py") if path.name != "test_groups.py"]
    marked = [p.relative_to(ROOT) for p in paths if "pytest.mark.realtime" in p.read_text()]
    run = [Path(folder) for folder in groups.REALTIME]
    assert all(any(path.is_relative_to(folder) for folder in run) for path in marked)
