"""Values of families of tests: some for each run of the tests, the others for a longer one."""

from collections.abc import Container, Iterable
from typing import Any

import pytest


def choose(values: Iterable[Any], kept: Container[Any], tier: str = "long") -> list[Any]:
    """Return values, of which those that are not kept are of a longer tier: `long` or `slow`."""
    marks = [getattr(pytest.mark, tier)]
    return [pytest.param(each, marks=marks * (each not in kept), id=str(each)) for each in values]


def seeds(often: int, count: int) -> list[Any]:
    """Return numbers for a test; those from `often` on are for the long trials."""
    return choose(range(count), range(often))


def trials(often: int, count: int) -> list[Any]:
    """Return numbers of examples for a test; the larger one is for the long trials."""
    return choose((often, count), (often,))
