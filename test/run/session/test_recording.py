"""Recordings of a run: what a request for one answers, also if the disk fails."""

import errno
import json
import os

import pytest
from run.session.test_outputs import Program, advance, start

from symtop_ros.run.log import recorder as module


def switch(session, on):
    """Ask for the begin or the end of a recording; return whether it is granted, and the answer."""
    granted, answer = session.answer("record", lambda: on)
    return granted, str(answer)


@pytest.fixture(name="host")
def _host():
    return Program()


@pytest.fixture(name="run")
def _run(host, tmp_path):
    """A run that records into `tmp_path`, and its clock."""
    return start(host, record__directory=str(tmp_path))


def test_it_begins_and_ends_once_and_each_answer_has_the_path(run, tmp_path):
    session, clock = run
    assert switch(session, False)[0]  # nothing to end
    granted, answer = switch(session, True)
    (path,) = tmp_path.iterdir()
    assert (granted, str(path) in answer, session.recording.path) == (True, True, path)
    assert str(path) in switch(session, True)[1]
    advance(session, clock, 0.1)
    granted, answer = switch(session, False)
    assert (granted, str(path) in answer, session.recording.path) == (True, True, None)
    assert [*tmp_path.iterdir()] == [path]


def test_last_bytes_that_cannot_be_written_refuse_the_end_and_are_reported_once(
    run, host, tmp_path, monkeypatch
):
    monkeypatch.setattr(module, "LONGEST_AGE", 3600.0)  # nothing fails before the end
    session, clock = run
    assert switch(session, True)[0]
    advance(session, clock, 0.1)
    (path,) = tmp_path.iterdir()
    path.unlink()
    reason = f"{path}: the file was removed"
    assert switch(session, False) == (False, f"recording failed: {reason}")
    assert [reason in each for each in host.errors] == [True]
    session.keep_up()
    assert len(host.errors) == 1
    assert session.recording.path is None
    assert switch(session, True)[0]  # the next one begins
    assert session.recording.unreported_failure == ""
    session.close()


def test_a_folder_that_cannot_be_written_refuses_the_recording_alone(host, tmp_path):
    file = tmp_path / "file"
    file.touch()
    session, clock = start(host, record__directory=str(file))
    granted, answer = switch(session, True)
    assert not granted
    sentence = f"record.directory must be a writable folder, got {str(file)!r}: "
    assert answer == sentence + os.strerror(errno.EEXIST)
    advance(session, clock, 0.1)
    assert json.loads(str(session.answer("get_state", lambda: None)[1]))
