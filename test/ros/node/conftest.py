from collections.abc import Callable, Iterator

import pytest
from ros.node.running_top import RunningTop


@pytest.fixture
def start_top() -> Iterator[Callable[..., RunningTop]]:
    """Start tops with parameters (dots in names as __), and close them after the test."""
    running: list[RunningTop] = []

    def start(**parameters: object) -> RunningTop:
        running.append(RunningTop(**parameters))
        return running[-1]

    yield start
    for each in running:
        each.close()
