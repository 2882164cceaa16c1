"""Requests that are made to hurt stop the samples hardly longer than those of a bare rclpy node."""

from __future__ import annotations

import contextlib
import sys
import time
from collections.abc import Iterator
from itertools import pairwise
from pathlib import Path

import pytest
from node import harmful_requests as harm
from node.built_messages import with_messages
from node.listener import Listener
from node.test_simulator import _messages  # noqa: F401 - makes the messages importable
from programs import command, environment, running, set_parameters
from trials import choose
from waiting import until

from workshop.load.domains import claim_domain, release_domain

HERE = Path(__file__).parent
MORE = 0.1  # s without samples, more than a bare node
TRIES = 4  # of a request: another process may have the processor meanwhile
AFTER = 0.3  # s after an answer in which samples may be late
# Of each kind one; the first stopped the node for ever.
SHARP = ("filter, backtracking", "kick, doubles", "set_parameters, list as text")


class Watched:
    """A program that publishes samples, their arrivals, and a client."""

    def __init__(self, domain: int, arrivals: Path) -> None:
        self._client, self._arrivals = Listener(domain), arrivals
        self._clients: dict[str, object] = {}
        until(self._read)

    def _read(self) -> list[int]:
        return [int(line) for line in self._arrivals.read_text().splitlines(True) if "\n" in line]

    def ask(self, kind, name, request) -> float:
        """Send a request; return the longest time in s without samples until it is answered."""
        client = self._clients.get(name) or self._client.node.create_client(kind, f"/top/{name}")
        self._clients[name] = client
        self._client.spin_until(client.service_is_ready)
        begin = time.monotonic_ns()
        answer = client.call_async(request)
        self._client.spin_until(answer.done)
        end = time.monotonic_ns() + int(AFTER * 1e9)
        until(lambda: self._read()[-1] > end)
        times = [each for each in self._read() if begin - 10**8 < each < end + 10**8]
        return max(b - a for a, b in pairwise(times)) / 1e9


@contextlib.contextmanager
def watch(words, folder, name) -> Iterator[Watched]:
    domain, arrivals = claim_domain(), folder / f"{name}.txt"
    variables = with_messages("simulation_interfaces", environment(domain))
    quiet = {"stdout": None, "stderr": None, "env": variables}
    try:
        with (
            running(words, domain, **quiet),
            arrivals.open("w") as file,
            running([sys.executable, HERE / "arrivals.py"], domain, stdout=file, stderr=None),
        ):
            yield Watched(domain, arrivals)
    finally:
        release_domain(domain)


@pytest.fixture(scope="module")
def nodes(tmp_path_factory):
    folder = tmp_path_factory.mktemp("arrivals")
    options = set_parameters(f"record.directory:={folder / 'logs'}")
    bare = [sys.executable, HERE / "bare_services.py"]
    with (
        watch(command("top_node", *options), folder, "top") as top,
        watch(bare, folder, "bare") as b,
    ):
        yield top, b


@pytest.mark.realtime
@pytest.mark.parametrize("name", choose(harm.list_requests(), SHARP))
def test_a_request_stops_samples_hardly_longer_than_those_of_a_bare_node(name, nodes):
    request, (top, bare) = harm.list_requests()[name](), nodes
    allowed = max(bare.ask(*request) for _ in range(2)) + MORE
    gaps = []
    for _ in range(TRIES):
        gaps.append(top.ask(*request))
        if gaps[-1] <= allowed:
            break
    assert min(gaps) <= allowed
