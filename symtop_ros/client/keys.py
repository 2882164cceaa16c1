"""The terminal of `top_ctl`: keys that are requests, and the live line of `top_ctl watch`."""

import json
import math
import os
import select
import sys
import time
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from typing import Any, NamedTuple

import rclpy
from sensor_msgs.msg import JointState

from symtop_ros.client.connection import Connection, UnreachableError
from symtop_ros.session.services import Response

# Undoes a hurry with the default hurry_factor.
DELAY = {"precession_rate_factor": 1 / 1.4}
PUSH = 1.0  # rad/s by which an arrow changes a rate
WAIT = 0.1  # s between two checks that ROS is running
QUIT = ("q", "\x04")  # also Ctrl-D; Ctrl-C is a signal
UPDATE_PERIOD = 0.1  # s


def follow_keys(top: Connection) -> None:
    """Send a request for each key that is pressed, and print the answers, until q or Ctrl-C."""
    if not sys.stdin.isatty():
        raise ValueError("standard input must be a terminal for keys, got a file or a pipe")
    with _single_keys(sys.stdin.fileno()) as descriptor:
        print("\n".join(f"{key.name:<12}{key.effect}" for key in KEYS.values()))
        print(f"{'q':<12}quit", flush=True)
        for key in _read_keys(descriptor):
            if key in QUIT:
                return
            if key in KEYS:
                granted, text = KEYS[key].act(top)
                print(f"{KEYS[key].name}: {'' if granted else 'refused: '}{text}", flush=True)


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
        phi, size = state["euler_angles"]["phi"], state["top"]["Ix"] * change
        impulse = [size * math.cos(phi), size * math.sin(phi), 0.0]
        return top.request("kick", {"angular_impulse": impulse})

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
    "h": Key("h", "hurry: multiply phi' by the parameter hurry_factor", _ask("hurry_precession")),
    "d": Key("d", "delay: divide phi' by 1.4", _ask("kick", DELAY)),
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
            yield from _split(data)


def _split(data: str) -> Iterator[str]:
    """Split what was read into keys; an arrow is an escape and two characters."""
    while data:
        length = 3 if data.startswith("\x1b[") else 1
        yield data[:length]
        data = data[length:]


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
    line = (
        f"theta {theta:6.4f} rad [{bar}]  theta' {theta_dot:+8.3f}  phi {phi:+6.3f}  "
        f"phi' {phi_dot:+8.3f}  psi' {psi_dot:+9.3f} rad/s"
    )
    end = "\r" if sys.stdout.isatty() else "\n"
    print(line, end=end, flush=True)
