"""Pytest plugin: name the tests that took much CPU time, `--cpu SECONDS`.

CPU time hardly depends on what else the machine does, as the time on the wall does. Included are
the programs that a test starts, and browser and nodes that outlive it. It is reported; no test
fails by it.
"""

import os
from collections.abc import Iterator
from pathlib import Path

import pytest

NAME = "cpu"
BEFORE = pytest.StashKey[float]()
TICK = 1 / os.sysconf("SC_CLK_TCK") if hasattr(os, "sysconf") else 0.0


def pytest_addoption(parser):
    words = "name the tests that took more CPU time than this, with the programs they use"
    parser.addoption("--cpu", type=float, metavar="SECONDS", help=words)


def list_descendants(process: int) -> Iterator[int]:
    """Yield a process and all that descend from it, as Linux lists them by thread."""
    yield process
    for path in Path(f"/proc/{process}/task").glob("*/children"):
        try:
            children = path.read_text().split()
        except OSError:  # the thread has ended
            continue
        for child in children:
            yield from list_descendants(int(child))


def read_cpu(process: int) -> float:
    """Return the CPU time of a process and of its children that have ended, in s."""
    try:
        text = Path(f"/proc/{process}/stat").read_text()
    except OSError:  # it has ended, or this is not Linux
        return 0.0
    # proc(5): utime, stime, cutime and cstime, counted behind the name, which may have blanks.
    return sum(map(int, text.rpartition(")")[2].split()[11:15])) * TICK


def sum_cpu() -> float:
    """Return the CPU time of this process and of all that it has started, in s."""
    return sum(map(read_cpu, list_descendants(os.getpid())))


@pytest.hookimpl(tryfirst=True)
def pytest_runtest_setup(item):
    if item.config.option.cpu is not None:
        item.stash[BEFORE] = sum_cpu()


@pytest.hookimpl(hookwrapper=True)
def pytest_runtest_makereport(item, call):
    outcome = yield
    if call.when == "teardown" and BEFORE in item.stash:
        outcome.get_result().user_properties.append((NAME, sum_cpu() - item.stash[BEFORE]))


def pytest_terminal_summary(terminalreporter, config):
    limit = config.option.cpu
    if limit is None:
        return
    reports = [each for found in terminalreporter.stats.values() for each in found]
    times = {
        each.nodeid: dict(each.user_properties)[NAME]
        for each in reports
        if NAME in dict(getattr(each, "user_properties", ()))
    }
    much = sorted((seconds, name) for name, seconds in times.items() if seconds > limit)
    terminalreporter.section(f"{len(much)} of {len(times)} tests took more than {limit:g} s of CPU")
    for seconds, name in reversed(much):
        terminalreporter.line(f"{seconds:5.2f} s  {name}")
    terminalreporter.line(f"{sum(times.values()):5.0f} s  all tests, without collecting them")
