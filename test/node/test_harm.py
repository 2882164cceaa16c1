"""Requests that are made to hurt stop the samples hardly longer than those of a bare rclpy node."""

import contextlib
import sys
import time
from collections.abc import Iterator
from itertools import pairwise
from pathlib import Path

import pytest
from geometry_msgs.msg import QuaternionStamped
from node import harmful_requests as harm
from node.built_messages import with_messages
from node.listener import Listener
from node.test_simulator import _messages  # noqa: F401 - makes the messages importable
from programs import command, environment, running, set_parameters
from trials import choose

from workshop.load.domains import claim_domain, release_domain

MORE = 0.1  # s without samples, more than a bare node
TRIES = 4  # of a request: another process may have the processor meanwhile
AFTER = 0.3  # s after an answer in which samples may be late
# Of each kind one; the first stopped the node for ever.
SHARP = ("filter, backtracking", "kick, doubles", "set_parameters, list as text")


class Watched:
    """A client of a program that publishes samples, with the times at which they are published."""

    def __init__(self, domain: int) -> None:
        self._client, self._sent = Listener(domain), []
        self._client.node.create_subscription(
            QuaternionStamped, "/top/orientation", self._receive, 10_000, raw=True
        )
        self._client.wait_for(self._sent)

    def _receive(self, _, info) -> None:
        self._sent.append(info["source_timestamp"])

    def ask(self, kind, name, request) -> float:
        """Send a request; return the longest time in s without samples until it is answered."""
        client = self._client.node.create_client(kind, f"/top/{name}")
        self._client.spin_until(client.service_is_ready)
        begin = time.time_ns()
        answer = client.call_async(request)
        self._client.spin_until(answer.done)
        end = time.time_ns() + int(AFTER * 1e9)
        self._client.spin_until(lambda: self._sent[-1] > end)
        self._client.node.destroy_client(client)
        times = [each for each in self._sent if begin - 10**8 < each < end + 10**8]
        return max(b - a for a, b in pairwise(times)) / 1e9


@contextlib.contextmanager
def watch(words) -> Iterator[Watched]:
    domain = claim_domain()
    variables = with_messages("simulation_interfaces", environment(domain))
    try:
        with running(words, domain, stdout=None, stderr=None, env=variables):
            yield Watched(domain)
    finally:
        release_domain(domain)


@pytest.fixture(scope="module")
def nodes(tmp_path_factory):
    options = set_parameters(f"record.directory:={tmp_path_factory.mktemp('logs')}")
    bare = [sys.executable, Path(__file__).with_name("bare_services.py")]
    with watch(command("top_node", *options)) as top, watch(bare) as b:
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
