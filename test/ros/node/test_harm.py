"""Requests that are made to hurt stop the samples hardly longer than those of a bare rclpy node.

They are large, long, deep or many; each is built when it is sent.
"""

import contextlib
import importlib
import sys
import time
from array import array
from collections.abc import Callable, Iterator
from functools import partial
from itertools import pairwise
from pathlib import Path
from typing import Any

import pytest
from geometry_msgs.msg import QuaternionStamped
from machine_time import measuring
from programs import command, environment, running, set_parameters
from rcl_interfaces.msg import Parameter, ParameterType, ParameterValue
from rcl_interfaces.srv import (
    DescribeParameters,
    GetParameters,
    GetParameterTypes,
    ListParameters,
    SetParameters,
    SetParametersAtomically,
)
from ros.node.built_messages import with_messages
from ros.node.listener import Listener
from ros.node.test_simulator import _messages  # noqa: F401 - makes the messages importable
from std_srvs.srv import SetBool, Trigger
from trials import choose

from workshop.load.domains import claim_domain, release_domain

MILLION, MANY = 1_000_000, 100_000
Build = Callable[[], tuple[Any, str, Any]]  # type, name and request


def make(name: str, **field: Any) -> Parameter:
    """A parameter with a value of the type of its field."""
    ((kind, _),) = field.items()
    number = getattr(ParameterType, f"PARAMETER_{kind.removesuffix('_value').upper()}")
    return Parameter(name=name, value=ParameterValue(type=number, **field))


# By what is hard about them; the name is that of a real parameter.
PARAMETERS: dict[str, Callable[[str], list[Parameter]]] = {
    "doubles": lambda name: [make(name, double_array_value=array("d", [0.5]) * MILLION)],
    "integers": lambda name: [make(name, integer_array_value=array("q", [7]) * MILLION)],
    "bools": lambda name: [make(name, bool_array_value=[True] * MILLION)],
    "texts": lambda name: [make(name, string_array_value=["a"] * MANY)],
    "long text": lambda name: [make(name, string_value="a" * 10 * MILLION)],
    "deep text": lambda name: [make(name, string_value="[" * 10 * MILLION)],
    "list as text": lambda name: [make(name, string_value=f"[{'1,' * 5 * MILLION}1]")],
    "digits": lambda name: [make(name, string_value="[" + "9" * 10 * MILLION + "]")],
    "bytes": lambda name: [make(name, byte_array_value=[b"\1"] * MANY)],
    "the same name": lambda name: [make(name, double_value=0.5)] * MANY,
    "other names": lambda name: [make(f"{name}.{k}", double_value=0.5) for k in range(MANY)],
}
NAMED = {"kick": "angular_impulse", "set_initial_conditions": "orientation", "step": "duration"}
NAMED |= {"set_parameters": "initial.orientation", "set_parameters_atomically": "steady_torque"}
ASKED = {"get_parameters": GetParameters, "get_parameter_types": GetParameterTypes}
ASKED |= {"describe_parameters": DescribeParameters}
FILTERS = {
    "backtracking": ".?" * 900 + "z",
    "a short one": ".?" * 60 + "z",
    "nested stars": "((a*)*)*" * 100 + "z",
    "groups": "(" * 5000 + ")" * 5000,
    "ranges": "[a-z]{1,1000}" * 70,
    "counted": "((((.{255}){255}){255}){255}){255}",
    "choices": "(top|" * 90 + "t" + ")" * 90,
    "long": "t" * MILLION,
    "classes": "[[:alpha:]]" * 900,
}


def list_requests() -> dict[str, Build]:
    """Return all requests by their names."""
    names = [f"top.{k}" for k in range(MANY)]
    return {
        **{
            f"{service}, {hard}": partial(_set, service, partial(build, name))
            for service, name in NAMED.items()
            for hard, build in PARAMETERS.items()
        },
        **{name: partial(_ask, kind, name, names=names) for name, kind in ASKED.items()},
        **{f"filter, {name}": partial(_filter, filter=text) for name, text in FILTERS.items()},
        "filter, tags": lambda: _filter(tags=_standard("TagsFilter")(tags=["a"] * MANY)),
        "filter, categories": lambda: _filter(categories=[_standard("EntityCategory")()] * MANY),
        "entity of a long name": lambda: _ask(
            _standard("GetEntityState", "srv"), "get_entity_state", entity="t" * 10 * MILLION
        ),
        "frame of a long name": _set_entity,
        "list_parameters": partial(_ask, ListParameters, "list_parameters", prefixes=names[:1000]),
        "begin to record": partial(_ask, SetBool, "record", data=True),
        "state": partial(_ask, Trigger, "get_state"),
    }


def _ask(kind: Any, service: str, **fields: Any) -> tuple[Any, str, Any]:
    return kind, service, kind.Request(**fields)


def _set(service: str, build: Callable[[], list[Parameter]]) -> tuple[Any, str, Any]:
    kind = SetParameters if service == "set_parameters" else SetParametersAtomically
    return _ask(kind, service, parameters=build())


def _standard(name: str, package: str = "msg") -> Any:
    """A type of all simulators, whose messages may have been built for the tests."""
    return getattr(importlib.import_module(f"simulation_interfaces.{package}"), name)


def _filter(**fields: Any) -> tuple[Any, str, Any]:
    filters = _standard("EntityFilters")(**fields)
    return _ask(_standard("GetEntities", "srv"), "get_entities", filters=filters)


def _set_entity() -> tuple[Any, str, Any]:
    kind = _standard("SetEntityState", "srv")
    asked = _ask(kind, "set_entity_state", entity="top", set_pose=True)
    asked[-1].state.header.frame_id = "w" * 10 * MILLION
    return asked


MORE = 0.1  # s without samples, more than a bare node
TRIES = 4  # of a request: another process may have the processor meanwhile
AFTER = 0.3  # s after an answer in which samples may be late
# Of each kind one; the first stopped the node for ever.
SHARP = ("filter, backtracking", "kick, doubles", "set_parameters, list as text")


class Watched:
    """A client of a program that publishes samples, with the times at which they are published."""

    def __init__(self, domain: int) -> None:
        self._client = Listener(domain)
        self._sent = []
        subscribe = self._client.node.create_subscription
        subscribe(QuaternionStamped, "/top/orientation", self._receive, 10_000, raw=True)
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
@pytest.mark.parametrize("name", choose(list_requests(), SHARP))
def test_a_request_stops_samples_hardly_longer_than_those_of_a_bare_node(name, nodes):
    request = list_requests()[name]()
    top, bare = nodes
    with measuring() as machine:
        allowed = max(bare.ask(*request) for _ in range(2)) + MORE
        is_soon = any(top.ask(*request) <= allowed for _ in range(TRIES))
    if not is_soon:
        machine.demand(MORE / 2)
    assert is_soon
