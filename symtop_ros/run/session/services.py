"""The services of the top, and the form of their answers. A method of `Requests` of its name acts.

The node offers what this table says, the page and `top_ctl` call it. It imports nothing, so that
`top_ctl` starts without the library.
"""

from typing import Literal, NamedTuple

Response = tuple[bool, str]  # success, and the sentence or the reason
ServiceKind = Literal["named", "switch", "plain"]  # named values, true or false, or no argument


class Service(NamedTuple):
    """A service of the top."""

    kind: ServiceKind
    command: str  # of top_ctl
    help: str


SERVICES: dict[str, Service] = {
    "set_initial_conditions": Service(
        "named",
        "start",
        "restart with theta=0.5 psi_dot=1900rpm precession=slow ..., or from observed quantities: "
        "theta=90deg precession_period=2.2s",
    ),
    "kick": Service(
        "named",
        "kick",
        "kick the top: precession_rate=9 hold=spin_momentum, or angular_impulse=0,0,1e-4",
    ),
    "step": Service("named", "step", "advance the paused motion: duration=0.01 (s)"),
    "release": Service("plain", "release", "end the current series of pushes"),
    "clamp": Service("switch", "clamp", "hold the precession, or release it"),
    "hurry_precession": Service(
        "plain", "hurry", "multiply phi' by the parameter hurry_factor at constant spin rate"
    ),
    "reset": Service("plain", "reset", "restart from the last initial conditions"),
    "pause": Service("switch", "pause", "stop the motion; `resume` continues it"),
    "record": Service("switch", "record", "start or stop a log"),
    "get_state": Service("plain", "state", "print the state, the constants and the verdict"),
}


def end_with_event(text: str, number: int) -> str:
    """Return an answer that ends with the number of its event."""
    return f"{text} [event {number}]"


def insert_before_event(answer: str, sentence: str) -> str:
    """Return an answer with one more sentence, which still ends with the number of its event.

    Examples
    --------
    >>> insert_before_event("The top rises. [event 2]", "It nods.")
    'The top rises. It nods. [event 2]'
    """
    text, bracket, number = answer.rpartition(" [event ")
    return f"{text} {sentence}{bracket}{number}" if sentence else answer
