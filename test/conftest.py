import contextlib
import os
import re
import signal
import sys
from pathlib import Path

import pytest
from coverage import Coverage

pytest_plugins = ("tiers", "cpu_times", "left_behind")

# Small matrices gain nothing by threads, which take a quarter of the time of two processors.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

with contextlib.suppress(ModuleNotFoundError):  # the matrix has no Hypothesis
    from hypothesis import HealthCheck, settings

    # Only tests marked `realtime` assert a time: an example that waits for the processor is no
    # failure. Each run tries the same examples, so that none fails by chance. A folder that cannot
    # be written has no place for a database of examples.
    profile = {"deadline": None, "database": None, "derandomize": True}
    settings.register_profile("untimed", suppress_health_check=[HealthCheck.too_slow], **profile)
    settings.load_profile("untimed")

# What programs write for themselves stays in the environment of Python: the home of the user is
# unchanged.
PLACES = {"ROS_LOG_DIR": "ros_log", "MPLCONFIGDIR": "matplotlib"}
PLACES |= {f"XDG_{name.upper()}_HOME": name for name in ("config", "data", "cache")}
for variable, folder in PLACES.items():
    os.environ[variable] = str(Path(sys.prefix, folder))

# Packages that package.xml does not declare: for most of them rosdep has no key. `colcon test`
# skips the tests that need them. Any other module that is missing is an error.
UNDECLARED = (
    "PIL",
    "ahrs",
    "axe_playwright_python",
    "distributed",
    "docutils",
    "flint",
    "gmpy2",
    "lz4",
    "matplotlib",
    "mcap",
    "mpmath",
    "mujoco",
    "pinocchio",
    "playwright",
    "pyarrow",
    "rerun",
    "psutil",
    "rerun_cli",
    "rosbags",
    "tqdm",
    "zstandard",
)
MISSING = re.compile(r"ModuleNotFoundError: No module named '(\w+)")


@pytest.hookimpl(hookwrapper=True)
def pytest_make_collect_report(collector):
    """Skip a file that imports what is not declared and not installed."""
    _skip_if_missing((yield).get_result(), collector.path)


@pytest.hookimpl(hookwrapper=True)
def pytest_runtest_makereport(item):
    """Skip a test that imports it while it runs."""
    _skip_if_missing((yield).get_result(), item.path)


def _skip_if_missing(report, path):
    found = MISSING.search(str(report.longrepr)) if report.failed else None
    if found and found[1] in UNDECLARED:
        report.outcome = "skipped"
        report.longrepr = str(path), 0, f"Skipped: {found[1]} is not installed"


TRACED = "COVERAGE_PROCESS_CONFIG"  # by which coverage reaches programs that tests start


@pytest.fixture(autouse=True, scope="module")
def _untraced(request):
    """Suspend coverage during a module that is marked so, also in the programs that it starts."""
    coverage = request.node.get_closest_marker("untraced") and Coverage.current()
    if not coverage:
        yield
        return
    with pytest.MonkeyPatch.context() as patch:
        patch.delenv(TRACED)
        coverage.stop()
        yield
    coverage.start()


@pytest.fixture(scope="session")
def browser():
    """A browser for all tests."""
    from browser import running_browser  # it needs Playwright

    with running_browser() as running:
        yield running


@pytest.fixture
def signals_as_before():
    """Restore the handlers of signals that a program replaces."""
    before = {number: signal.getsignal(number) for number in (signal.SIGINT, signal.SIGTERM)}
    yield
    for number, handler in before.items():
        signal.signal(number, handler)


@pytest.fixture(autouse=True, scope="session")
def _ros_environment():
    """Keep all ROS traffic of the tests on this machine, and use what the programs use."""
    os.environ.setdefault("ROS_AUTOMATIC_DISCOVERY_RANGE", "LOCALHOST")
    os.environ.setdefault("FASTDDS_BUILTIN_TRANSPORTS", "UDPv4")
