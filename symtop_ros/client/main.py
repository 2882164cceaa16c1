"""Entry point of `top_ctl`: call the services of a running top from the command line."""

from __future__ import annotations

import argparse
import json
import math
import sys
from collections.abc import Callable
from typing import Any

import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.utilities import remove_ros_args

from symtop_ros.client.arguments import UsageError, parse_values
from symtop_ros.client.connection import Connection
from symtop_ros.client.watch import watch
from symtop_ros.shutdown import describe_failure, ros_context
from symtop_ros.simulation.validation import one_line

Answer = tuple[bool, str]
NAMED = {
    "start": ("set_initial_conditions", "restart: theta=0.5 psi_dot=200 precession=slow ..."),
    "kick": ("kick", "precession_rate=9 hold=spin_momentum, or angular_impulse=0,0,1e-4"),
    "step": ("step", "while paused: duration=0.01"),
}
PLAIN: dict[str, tuple[str, Callable[[Connection], Answer]]] = {
    "hurry": (
        "multiply the precession rate by the parameter hurry_factor",
        lambda top: top.trigger("hurry_precession"),
    ),
    "reset": ("back to the last initial conditions", lambda top: top.trigger("reset")),
    "pause": ("stop the motion", lambda top: top.switch("pause", True)),
    "resume": ("continue the motion from where it stopped", lambda top: top.switch("pause", False)),
}
UNTIL_INTERRUPTED = ("watch", "keys")  # Ctrl-C is the usual end of these


def main(args: list[str] | None = None) -> int:
    """Run one command; return 0 (granted), 1 (refused, no answer) or 2 (usage)."""
    arguments = sys.argv if args is None else ["top_ctl", *args]
    try:
        options = _parser().parse_args(remove_ros_args(arguments)[1:])
        values = parse_values(getattr(options, "values", ()))
        with ros_context(arguments) as listen:
            node = rclpy.create_node("top_ctl", start_parameter_services=False)
            top = Connection(node, options.node, options.timeout)
            listen()
            granted, text = _run(options, values, top)
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


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="top_ctl",
        description="Call the services of a running top_node; exit status 1 if it refuses.",
    )
    parser.add_argument("--node", default="/top", help="name of the node (default /top)")
    parser.add_argument("--timeout", type=_seconds, default=5.0, help="seconds to wait (default 5)")
    commands = parser.add_subparsers(dest="command", required=True, metavar="COMMAND")
    for name, (_, text) in NAMED.items():
        named = commands.add_parser(name, help=text)
        named.add_argument("values", nargs="*", metavar="NAME=VALUE", help=text)
    for name, (text, _call) in PLAIN.items():
        commands.add_parser(name, help=text)
    commands.add_parser("record", help="start or stop a log").add_argument(
        "switch", choices=("on", "off")
    )
    commands.add_parser("state", help="full state, constants and verdict").add_argument(
        "--json", action="store_true", help="as JSON in one line"
    )
    commands.add_parser("keys", help="send requests by single keys: hurry, delay, pause, push")
    commands.add_parser("watch", help="show the motion in a line that is updated").add_argument(
        "--seconds", type=_seconds, default=math.inf, help="how long (default: until Ctrl-C)"
    )
    return parser


def _seconds(text: str) -> float:
    value = float(text)
    if not value > 0:
        raise ValueError
    return value


def _run(options: argparse.Namespace, values: dict[str, Any], top: Connection) -> Answer:
    if options.command in NAMED:
        return top.set(NAMED[options.command][0], values)
    if options.command in PLAIN:
        return PLAIN[options.command][1](top)
    if options.command == "record":
        return top.switch("record", options.switch == "on")
    if options.command == "state":
        granted, text = top.trigger("get_state")
        return granted, text if options.json or not granted else _readable(json.loads(text))
    if options.command == "keys":
        from symtop_ros.client.keys import follow_keys

        follow_keys(top)
    else:
        watch(top, options.seconds, options.timeout)
    return True, ""


def _readable(state: dict[str, Any]) -> str:
    width = max(map(len, state))
    return "\n".join(f"{name:<{width}}  {_plain(value)}" for name, value in state.items())


def _plain(value: Any) -> str:
    if isinstance(value, dict):
        return ", ".join(f"{name} {_plain(part)}" for name, part in value.items())
    if isinstance(value, list):
        return " ".join(map(_plain, value)) or "-"
    return f"{value:.6g}" if isinstance(value, float) else str(value)
