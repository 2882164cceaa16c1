"""Entry point of `top_ctl`: call the services of a running top, by words or by single keys.

`top_ctl keys` has keys that are requests, `top_ctl watch` shows a live line.
"""

import argparse
import json
import math
import os
import re
import select
import sys
import time
from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import closing, contextmanager
from typing import Any, NamedTuple

import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.utilities import remove_ros_args
from sensor_msgs.msg import JointState

from symtop_ros.base.refusals import MAX_SHOWN, one_line, plain, refuse, validate_names
from symtop_ros.base.shutdown import describe_failure, ros_context
from symtop_ros.base.units import read_value
from symtop_ros.ros.client.body import set_body
from symtop_ros.ros.client.connection import Connection, UnreachableError
from symtop_ros.ros.client.options import make_parser
from symtop_ros.ros.client.spread import describe_spread
from symtop_ros.run.session.services import SERVICES, Response, insert_before_event

BY_COMMAND = {service.command: name for name, service in SERVICES.items()}
UNTIL_INTERRUPTED = ("watch", "keys")  # Ctrl-C is the usual end of these
FACTOR = "precession_rate_factor"
DELAY = {FACTOR: 1 / 1.4}  # undoes a hurry with the default hurry_factor
LARGE = 1e6  # whose last digits count: a stamp in s
DECIMAL_COMMA = re.compile(r"[-+]?\d+,\d+[^,]*$")  # no list of two numbers is asked for
PUSH = 1.0  # rad/s by which an arrow changes a rate
WAIT = 0.1  # s between two checks that ROS is running
UPDATE_PERIOD = 0.1  # s
ONE_KEY = re.compile(r"\x1b\[.?|.", re.DOTALL)  # an arrow is an escape and two characters


def main(args: list[str] | None = None) -> int:
    """Run one command; return 0 (granted), 1 (refused, no answer) or 2 (usage)."""
    arguments = sys.argv if args is None else ["top_ctl", *args]
    try:
        options = make_parser().parse_args(remove_ros_args(arguments)[1:])
        values = parse_values(vars(options).get("values", ()))
        if options.command == "start":
            check_start(values)
        with ros_context(arguments, is_last=args is None) as listen:
            node = rclpy.create_node("top_ctl", start_parameter_services=False)
            with closing(Connection(node, options.node, options.timeout)) as top:
                listen()
                granted, text = carry_out(options, values, top)
                if top.doubles:
                    print(
                        f"top_ctl: {top.doubles} nodes have the name {top.name}, and one of them "
                        "has answered (a killed node is listed for 20 s)",
                        file=sys.stderr,
                    )
    except ExternalShutdownException:
        granted = options.command in UNTIL_INTERRUPTED
        text = "" if granted else "interrupted before the answer arrived"
    except UsageError as error:
        print(f"top_ctl: {error}", file=sys.stderr)
        return 2
    except BrokenPipeError:
        raise
    except Exception as error:
        granted, text = False, describe_failure(error)
    if granted:
        print(text, end="\n" if text else "")
    elif text:
        print(f"top_ctl: {one_line(text)}", file=sys.stderr)
    return 0 if granted else 1


def carry_out(options: argparse.Namespace, values: dict[str, Any], top: Connection) -> Response:
    """Do what a command says; return success and the answer."""
    if options.command in UNTIL_INTERRUPTED:
        if options.command == "keys":
            follow_keys(top)
        else:
            watch(top, options.seconds, options.timeout)
        return True, ""
    if options.command == "resume":
        return top.request("pause", False)
    if options.command == "delay":
        return top.request("kick", {FACTOR: 1 / options.factor})
    if options.command == "hurry" and options.factor is not None:
        return top.request("kick", {FACTOR: options.factor})
    if options.command == "body":
        return set_body(top, options.parts)
    service = BY_COMMAND[options.command]
    on = vars(options).get("switch", "on") == "on"  # `pause` has no word: it means on
    arguments = {"named": values, "switch": on, "plain": None}
    granted, text = top.request(service, arguments[SERVICES[service].kind])
    if options.command == "start" and granted:
        text = insert_before_event(text, describe_spread(top, options.values, values))
    if options.command == "state" and granted and not options.json:
        text = _readable(_join_stamp(json.loads(text)))
    return granted, text


def _join_stamp(state: dict[str, Any]) -> dict[str, Any]:
    """Return the state with its stamp to the nanosecond, for which a double has too few digits."""
    sec, nanosec = state.pop("sec"), state.pop("nanosec")
    return {**state, "stamp": f"{sec}.{nanosec:09d}"}


def _readable(state: dict[str, Any]) -> str:
    width = max(map(len, state))
    return "\n".join(f"{name:<{width}}  {_plain(value)}" for name, value in state.items())


def _plain(value: Any) -> str:
    if isinstance(value, dict):
        return ", ".join(f"{name} {_plain(part)}" for name, part in value.items())
    if isinstance(value, list):
        return " ".join(map(_plain, value)) or "-"
    if value is None:
        return "-"
    if isinstance(value, bool):
        return "yes" if value else "no"
    return write_number(value) if isinstance(value, float) else str(value)


def write_number(value: float) -> str:
    """Return six digits, and all seconds of a clock to the microsecond."""
    return f"{value:.6f}" if abs(value) >= LARGE else f"{value:.6g}"


class UsageError(ValueError):
    """A word of the command line that is not valid."""


def parse_values(words: Iterable[str]) -> dict[str, Any]:
    """Parse words name=value into doubles, lists (`a,b,c` or `[a, b, c]`) and text."""
    values: dict[str, Any] = {}
    for word in words:
        name, equals, text = word.partition("=")
        if not equals or not name:
            raise UsageError(f"argument must be NAME=VALUE, got {one_line(repr(word), MAX_SHOWN)}")
        if name in values:
            raise UsageError(
                f"{one_line(name, MAX_SHOWN)} must be given once, got it more than once"
            )
        values[name] = _value(name, text)
    return values


def check_start(values: Mapping[str, Any]) -> None:
    """Refuse names that no start has, before a node is looked for."""
    from symtop_ros.run.simulation.changes.requests import ALL_START_FIELDS  # takes a while

    validate_names(values, ALL_START_FIELDS)


def _value(name: str, text: str) -> Any:
    """Return a number in SI units, a list of numbers, or else the text itself."""
    if DECIMAL_COMMA.match(text):
        raise refuse(name, "a number with a decimal point", text)
    if not (text.startswith("[") or "," in text):
        return read_value(name, text)
    try:
        return [float(part) for part in plain(text).strip("[]").split(",")]
    except ValueError:
        return text


def follow_keys(top: Connection) -> None:
    """Send a request for each key that is pressed, and print the answers, until q or Ctrl-C."""
    if not sys.stdin.isatty():
        raise ValueError("standard input must be a terminal for keys, got a file or a pipe")
    with _single_keys(sys.stdin.fileno()) as descriptor:
        print("\n".join(f"{key.name:<12}{key.effect}" for key in KEYS.values()))
        print(f"{'q':<12}quit", flush=True)
        for key in _read_keys(descriptor):
            if key in ("q", "\x04"):  # the second one is Ctrl-D; Ctrl-C is a signal
                return
            if key in KEYS:
                granted, text = KEYS[key].act(top)
                print(f"{KEYS[key].name}: {'' if granted else 'refused: '}{text}", flush=True)


def _toggle_clamp(top: Connection) -> Response:
    return top.request("clamp", not json.loads(top.request("get_state")[1])["clamped"])


def _toggle_pause(top: Connection) -> Response:
    return top.request("pause", json.loads(top.request("get_state")[1])["running"])


def _push_along(change: float) -> Callable[[Connection], Response]:
    """Return a push on the axle that changes phi' (rad/s)."""
    return _ask("kick", {"precession_rate_change": change, "hold": "spin_momentum"})


def _push_tilt(change: float) -> Callable[[Connection], Response]:
    """Return a push on the axle that changes theta' (rad/s).

    Its angular impulse is Ix times the change, about the line of nodes (cos phi, sin phi, 0).
    """

    def push(top: Connection) -> Response:
        state = json.loads(top.request("get_state")[1])
        phi = state["euler_angles"]["phi"]
        size = state["top"]["Ix"] * change
        return top.request(
            "kick", {"angular_impulse": [size * math.cos(phi), size * math.sin(phi), 0.0]}
        )

    return push


def _ask(
    service: str, argument: Mapping[str, Any] | None = None
) -> Callable[[Connection], Response]:
    return lambda top: top.request(service, argument)


class Key(NamedTuple):
    """A key: its name, its effect in words, and the request that it sends."""

    name: str
    effect: str
    act: Callable[[Connection], Response]


# By the bytes that a terminal sends.
KEYS = {
    "h": Key("h", "hurry: phi' times hurry_factor, spin rate held", _ask("hurry_precession")),
    "d": Key("d", "delay: divide phi' by 1.4", _ask("kick", DELAY)),
    "c": Key("c", "clamp the precession, or let it go", _toggle_clamp),
    " ": Key("space", "pause or resume", _toggle_pause),
    "r": Key("r", "reset", _ask("reset")),
    "\x1b[A": Key("up", "push the axle up: theta' - 1 rad/s", _push_tilt(-PUSH)),
    "\x1b[B": Key("down", "push the axle down: theta' + 1 rad/s", _push_tilt(PUSH)),
    "\x1b[C": Key("right", "push the axle forward: phi' + 1 rad/s", _push_along(PUSH)),
    "\x1b[D": Key("left", "push the axle back: phi' - 1 rad/s", _push_along(-PUSH)),
}


@contextmanager
def _single_keys(descriptor: int) -> Iterator[int]:
    """Deliver each key at once and without echo; signals of the terminal are kept."""
    import termios  # not on every system
    import tty

    before = termios.tcgetattr(descriptor)
    try:
        tty.setcbreak(descriptor, termios.TCSADRAIN)  # keys that were pressed early are kept
        yield descriptor
    finally:
        termios.tcsetattr(descriptor, termios.TCSADRAIN, before)


def _read_keys(descriptor: int) -> Iterator[str]:
    """Yield keys until ROS shuts down or the terminal is closed."""
    while rclpy.ok():
        if select.select([descriptor], [], [], WAIT)[0]:
            data = os.read(descriptor, 64).decode(errors="replace")
            if not data:
                return
            yield from ONE_KEY.findall(data)


def watch(connection: Connection, seconds: float, timeout: float) -> None:
    """Show tilt, precession and spin in one line of a terminal, updated 10 times a second."""
    latest: list[JointState] = []
    connection.subscribe(JointState, "euler_angles", latest.append)
    end = math.inf
    try:
        while time.monotonic() < end:
            latest.clear()
            if not connection.spin_until(lambda: bool(latest), timeout):
                raise UnreachableError(f"no samples from {connection.name} within {timeout:g} s")
            end = min(end, time.monotonic() + seconds)
            _show(latest[-1])
            connection.spin_until(lambda: False, UPDATE_PERIOD)
    finally:
        if sys.stdout.isatty():
            print()


def _show(message: JointState) -> None:
    phi, theta, _ = message.position
    phi_dot, theta_dot, psi_dot = message.velocity
    bar = "".join("|" if i == round(theta / 3.1416 * 24) else "." for i in range(25))
    print(
        f"theta {theta:6.4f} rad [{bar}]  theta' {theta_dot:+8.3f}  phi {phi:+6.3f}  "
        f"phi' {phi_dot:+8.3f}  psi' {psi_dot:+9.3f} rad/s",
        end="\r" if sys.stdout.isatty() else "\n",
        flush=True,
    )
