"""The services of the top: one record for each, with the method of `Requests` that carries it out.

The node offers what this table says, the page and `top_ctl` call it. It imports nothing, so that
`top_ctl` starts without the library.
"""

from collections.abc import Callable
from typing import TYPE_CHECKING, Any, Literal, NamedTuple

if TYPE_CHECKING:
    from symtop_ros.session.session import Requests

Response = tuple[bool, str]  # success, and the sentence or the reason
ServiceKind = Literal["named", "switch", "plain"]  # named values, true or false, or no argument


class Service(NamedTuple):
    """A service of the top."""

    kind: ServiceKind
    command: str  # of top_ctl
    help: str
    act: "Callable[[Requests, Any], str]"  # gets the argument, or None


SERVICES: dict[str, Service] = {
    "set_initial_conditions": Service(
        "named",
        "start",
        "restart: theta=0.5 psi_dot=200 precession=slow ...",
        lambda requests, values: requests.set_initial_conditions(values),
    ),
    "kick": Service(
        "named",
        "kick",
        "precession_rate=9 hold=spin_momentum, or angular_impulse=0,0,1e-4",
        lambda requests, values: requests.kick(values),
    ),
    "step": Service(
        "named",
        "step",
        "while paused: duration=0.01",
        lambda requests, values: requests.step(values),
    ),
    "hurry_precession": Service(
        "plain",
        "hurry",
        "multiply the precession rate by the parameter hurry_factor",
        lambda requests, _: requests.hurry_precession(),
    ),
    "reset": Service(
        "plain",
        "reset",
        "back to the last initial conditions",
        lambda requests, _: requests.reset(),
    ),
    "pause": Service(
        "switch",
        "pause",
        "stop the motion; `resume` continues it",
        lambda requests, on: requests.pause(on),
    ),
    "record": Service(
        "switch", "record", "start or stop a log", lambda requests, on: requests.record(on)
    ),
    "get_state": Service(
        "plain",
        "state",
        "full state, constants and verdict",
        lambda requests, _: requests.get_state(),
    ),
}
