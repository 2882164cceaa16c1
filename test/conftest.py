"""The soak runs beside all other tests: it begins with the first and is looked at after the last.

SYMTOP_SOAK_SECONDS says how long it takes: 180 s in a run of all tests, 15 s otherwise.
"""

import os
import subprocess
import sys

import pytest
from coverage import Coverage

SOAK = pytest.StashKey[subprocess.Popen[str]]()
SOAK_SECONDS = pytest.StashKey[float]()
ALL = 400  # tests; so many are a run of all that `make test` runs beside the soak
TRACED = "COVERAGE_PROCESS_CONFIG"  # by which coverage reaches programs that tests start
PROGRAM = "import sys; from symtop_ros.report.main import main; sys.exit(main())"


def pytest_collection_modifyitems(config, items):
    items.sort(key=lambda item: item.get_closest_marker("beside") is not None)
    default = 180.0 if len(items) > ALL else 15.0
    config.stash[SOAK_SECONDS] = float(os.environ.get("SYMTOP_SOAK_SECONDS", default))


def pytest_runtestloop(session):
    if session.items and session.items[-1].get_closest_marker("beside"):
        seconds = str(session.config.stash[SOAK_SECONDS])
        session.config.stash[SOAK] = subprocess.Popen(
            [sys.executable, "-c", PROGRAM, "--soak", "--seconds", seconds],
            stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
            env={name: value for name, value in os.environ.items() if name != TRACED},
        )  # fmt: skip


@pytest.fixture(autouse=True, scope="module")
def _untraced(request):
    """Coverage rests during a module that is marked so, and in the programs that it starts."""
    coverage = request.node.get_closest_marker("untraced") and Coverage.current()
    if not coverage:
        yield
        return
    with pytest.MonkeyPatch.context() as patch:
        patch.delenv(TRACED)
        coverage.stop()
        yield
    coverage.start()


@pytest.fixture
def soak(pytestconfig):
    """The process, and how many seconds it takes."""
    return pytestconfig.stash[SOAK], pytestconfig.stash[SOAK_SECONDS]


def pytest_sessionfinish(session):
    if SOAK in session.config.stash:
        session.config.stash[SOAK].terminate()
