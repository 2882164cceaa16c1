"""The log of a run with all kinds of events, written once."""

import pytest


@pytest.fixture(scope="session")
def path(tmp_path_factory):
    from run.check.run_log import write_log  # it needs mcap

    return write_log(tmp_path_factory.mktemp("run"))


@pytest.fixture
def memory(path):
    """Its messages, which a test may change."""
    from run.check.run_log import Memory

    return Memory(path)
