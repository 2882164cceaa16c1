"""The services of the top: one record for each, with the method of `Requests` that carries it out.

The node offers what this table says, the page and `top_ctl` call it. It imports nothing, so that
`top_ctl` starts without the library.
"""

from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, Any, Literal, NamedTuple

if TYPE_CHECKING:
    from symtop_ros.session.requests import Requests

ServiceKind = Literal["named", "switch", "plain"]  # named values, true or false, or no argument


class Named(NamedTuple):
    """A service with named values."""

    act: "Callable[[Requests, Mapping[str, Any]], str]"
    command: str  # of top_ctl
    help: str
    kind: ServiceKind = "named"


class Switch(NamedTuple):
    """A service that switches on or off."""

    act: "Callable[[Requests, bool], str]"
    command: str
    help: str
    kind: ServiceKind = "switch"


class Plain(NamedTuple):
    """A service without an argument."""

    act: "Callable[[Requests], str]"
    command: str
    help: str
    kind: ServiceKind = "plain"


Service = Named | Switch | Plain
SERVICES: dict[str, Service] = {
    "set_initial_conditions": Named(
        lambda requests, values: requests.set_initial_conditions(values),
        "start",
        "restart: theta=0.5 psi_dot=200 precession=slow ...",
    ),
    "kick": Named(
        lambda requests, values: requests.kick(values),
        "kick",
        "precession_rate=9 hold=spin_momentum, or angular_impulse=0,0,1e-4",
    ),
    "step": Named(
        lambda requests, values: requests.step(values), "step", "while paused: duration=0.01"
    ),
    "hurry_precession": Plain(
        lambda requests: requests.hurry_precession(),
        "hurry",
        "multiply the precession rate by the parameter hurry_factor",
    ),
    "reset": Plain(
        lambda requests: requests.reset(), "reset", "back to the last initial conditions"
    ),
    "pause": Switch(
        lambda requests, on: requests.pause(on), "pause", "stop the motion; `resume` continues it"
    ),
    "record": Switch(lambda requests, on: requests.record(on), "record", "start or stop a log"),
    "get_state": Plain(
        lambda requests: requests.get_state(), "state", "full state, constants and verdict"
    ),
}
