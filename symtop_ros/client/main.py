"""Entry point of `top_ctl`: the services of a running top, from the command line."""

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

from symtop_ros.client.arguments import UsageError, named_values
from symtop_ros.client.connection import Connection
from symtop_ros.client.watch import watch
from symtop_ros.ending import ros
from symtop_ros.wire.text import one_line

Answer = tuple[bool, str]
NAMED = {
    "start": ("set_initial_conditions", "restart: theta=0.5 psi_dot=200 precession=slow ..."),
    "kick": ("kick", "precession_rate=9 hold=spin_momentum, or angular_impulse=0,0,1e-4"),
    "step": ("step", "while paused: duration=0.01"),
}
PLAIN: dict[str, tuple[str, Callable[[Connection], Answer]]] = {
    "hurry": ("kick by the parameter hurry_factor", lambda top: top.trigger("hurry_precession")),
    "reset": ("back to the last initial conditions", lambda top: top.trigger("reset")),
    "pause": ("stop the motion", lambda top: top.switch("pause", True)),
    "resume": ("go on from where it stopped", lambda top: top.switch("pause", False)),
}


def main(args: list[str] | None = None) -> int:
    """Run one command; return 0 (granted), 1 (refused, unreachable, ended) or 2 (usage)."""
    arguments = sys.argv if args is None else ["top_ctl", *args]
    try:
        options = _parser().parse_args(remove_ros_args(arguments)[1:])
        values = named_values(getattr(options, "values", ()))
        with ros(arguments) as listen:
            node = rclpy.create_node("top_ctl", start_parameter_services=False)
            top = Connection(node, options.node, options.timeout)
            listen()
            granted, text = _run(options, values, top)
    except ExternalShutdownException:
        granted, text = options.command == "watch", "ended before the answer came"
    except UsageError as error:
        print(f"top_ctl: {error}", file=sys.stderr)
        return 2
    except Exception as error:
        granted, text = False, str(error) or type(error).__name__
    if granted:
        print(text, end="\n" if text else "")
    elif text:
        print(f"top_ctl: {one_line(text)}", file=sys.stderr)
    return 0 if granted else 1


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="top_ctl", description="Talk to a running top_node; exit status 1 where it refuses."
    )
    parser.add_argument("--node", default="/top", help="name of the node (default /top)")
    parser.add_argument("--timeout", type=_seconds, default=5.0, help="seconds to wait (default 5)")
    commands = parser.add_subparsers(dest="command", required=True, metavar="COMMAND")
    for name, (_, text) in NAMED.items():
        named = commands.add_parser(name, help=text)
        named.add_argument("values", nargs="*", metavar="NAME=VALUE", help=text)
    for name, (text, _call) in PLAIN.items():
        commands.add_parser(name, help=text)
    commands.add_parser("record", help="start or end a log").add_argument(
        "switch", choices=("on", "off")
    )
    commands.add_parser("state", help="full state, constants and verdict").add_argument(
        "--json", action="store_true", help="as it comes, in one line"
    )
    commands.add_parser("watch", help="live line of the motion").add_argument(
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
    watch(top, options.seconds, options.timeout)
    return True, ""


def _readable(state: dict[str, Any]) -> str:
    width = max(map(len, state))
    return "\n".join(f"{name:<{width}}  {_plain(value)}" for name, value in state.items())


def _plain(value: Any) -> str:
    if isinstance(value, dict):
        return ", ".join(f"{name} {_plain(part)}" for name, part in value.items())
    if isinstance(value, list):
        return " ".join(map(_plain, value)) or "none"
    return f"{value:.6g}" if isinstance(value, float) else str(value)
