"""The log of a run with all kinds of events, written once."""

import pytest
from check.run_log import write_log


@pytest.fixture(scope="session")
def path(tmp_path_factory):
    return write_log(tmp_path_factory.mktemp("run"))
