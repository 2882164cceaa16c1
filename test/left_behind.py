"""Pytest plugin: a run fails if its tests leave files on the machine, and names them."""

import os
import shlex
import tempfile

import pytest
from traces import Traces

TRACES = pytest.StashKey[Traces]()
LEFT = pytest.StashKey[list]()


def pytest_configure(config):
    if not hasattr(config, "workerinput"):  # not in a worker of pytest-xdist
        config.stash[TRACES] = Traces()
        # pytest keeps the folders of the last runs where it always does, also within a run
        os.environ |= {"PYTEST_DEBUG_TEMPROOT": tempfile.gettempdir(), **os.environ}
        os.environ |= config.stash[TRACES].variables
        tempfile.tempdir = None  # it is looked up again


@pytest.hookimpl(trylast=True)  # processes that test have ended by then
def pytest_sessionfinish(session):
    if TRACES in session.config.stash:
        session.config.stash[LEFT] = left = [*session.config.stash[TRACES].find()]
        if left and session.exitstatus == pytest.ExitCode.OK:
            session.exitstatus = pytest.ExitCode.TESTS_FAILED


def pytest_terminal_summary(terminalreporter, config):
    if left := config.stash.get(LEFT, []):
        terminalreporter.section("left behind by tests")
    for path in left:
        terminalreporter.line(f"ls -ld {shlex.quote(str(path))}")


def pytest_unconfigure(config):
    if TRACES in config.stash:
        config.stash[TRACES].close()
