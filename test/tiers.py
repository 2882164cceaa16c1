"""Pytest plugin: each test belongs to one tier, and a run has the quick ones unless it says more.

`pytest FOLDER` runs quick tests, those without a marker of TIERS; `pytest -m slow FOLDER` those of
one tier. A test that is named (FILE::TEST) runs in any tier, and so does one that failed (--lf).
"""

import pytest

# A test belongs to the first of these that it carries: of a family that is slow some members, or
# the file they are in, may be long.
TIERS = ("long", "realtime", "slow")
QUICK = " and ".join(f"not {name}" for name in TIERS)


def pytest_configure(config):
    if not config.option.markexpr and not is_named(config) and not runs_failed(config):
        config.option.markexpr = QUICK


def is_named(config):
    """Return True if only tests are named, and no folder or file."""
    return bool(config.args) and all("::" in each for each in config.args)


def runs_failed(config):
    """Return True for --lf after a failure; after none, pytest runs what it runs without it."""
    cache = getattr(config, "cache", None)
    return bool(config.getoption("lf", False) and cache and cache.get("cache/lastfailed", {}))


def pytest_itemcollected(item):
    carried = [name for name in TIERS if item.get_closest_marker(name)]
    item.own_markers = [mark for mark in item.own_markers if mark.name not in carried[1:]]
    left = [name for name in TIERS if item.get_closest_marker(name)]
    if len(left) > 1:
        message = f"{item.nodeid} must be of one tier, got {' and '.join(left)}"
        raise pytest.UsageError(message)
