"""Entry point of `top_ctl`: call the services of a running top from the command line."""

import argparse
import json
import math
import sys
from collections.abc import Iterable
from contextlib import closing
from typing import Any

import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.utilities import remove_ros_args

from symtop_ros.client.connection import Connection
from symtop_ros.client.keys import follow_keys, watch
from symtop_ros.command import positive
from symtop_ros.session.services import SERVICES, Response
from symtop_ros.shutdown import describe_failure, ros_context
from symtop_ros.simulation.validation import one_line

BY_COMMAND = {service.command: name for name, service in SERVICES.items()}
UNTIL_INTERRUPTED = ("watch", "keys")  # Ctrl-C is the usual end of these
MAX_SHOWN = 60  # characters of a word in a message


def main(args: list[str] | None = None) -> int:
    """Run one command; return 0 (granted), 1 (refused, no answer) or 2 (usage)."""
    arguments = sys.argv if args is None else ["top_ctl", *args]
    try:
        options = _parser().parse_args(remove_ros_args(arguments)[1:])
        values = parse_values(vars(options).get("values", ()))
        with ros_context(arguments, is_last=args is None) as listen:
            node = rclpy.create_node("top_ctl", start_parameter_services=False)
            with closing(Connection(node, options.node, options.timeout)) as top:
                listen()
                granted, text = _run(options, values, top)
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


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="top_ctl",
        description="Call the services of a running top_node; exit status 1 if it refuses.",
    )
    parser.add_argument("--node", default="/top", help="name of the node (default /top)")
    parser.add_argument("--timeout", type=positive, default=5.0, help="seconds to wait (default 5)")
    commands = parser.add_subparsers(dest="command", required=True, metavar="COMMAND")
    parsers = {
        service.command: commands.add_parser(service.command, help=service.help)
        for service in SERVICES.values()
    }
    for service in SERVICES.values():
        if service.kind == "named":
            parsers[service.command].add_argument(
                "values", nargs="*", metavar="NAME=VALUE", help=service.help
            )
    parsers["record"].add_argument("switch", choices=("on", "off"))
    parsers["state"].add_argument("--json", action="store_true", help="as JSON in one line")
    commands.add_parser("resume", help="continue the motion from where it stopped")
    commands.add_parser("keys", help="send requests by single keys: hurry, delay, pause, push")
    commands.add_parser("watch", help="show the motion in a line that is updated").add_argument(
        "--seconds", type=positive, default=math.inf, help="how long (default: until Ctrl-C)"
    )
    return parser


def _run(options: argparse.Namespace, values: dict[str, Any], top: Connection) -> Response:
    if options.command == "keys":
        follow_keys(top)
        return True, ""
    if options.command == "watch":
        watch(top, options.seconds, options.timeout)
        return True, ""
    if options.command == "resume":
        return top.request("pause", False)
    service = BY_COMMAND[options.command]
    on = vars(options).get("switch", "on") == "on"  # `pause` has no word: it means on
    argument = {"named": values, "switch": on, "plain": None}[SERVICES[service].kind]
    granted, text = top.request(service, argument)
    if options.command == "state" and granted and not options.json:
        text = _readable(json.loads(text))
    return granted, text


def _readable(state: dict[str, Any]) -> str:
    width = max(map(len, state))
    return "\n".join(f"{name:<{width}}  {_plain(value)}" for name, value in state.items())


def _plain(value: Any) -> str:
    if isinstance(value, dict):
        return ", ".join(f"{name} {_plain(part)}" for name, part in value.items())
    if isinstance(value, list):
        return " ".join(map(_plain, value)) or "-"
    return f"{value:.6g}" if isinstance(value, float) else str(value)


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
        values[name] = _value(text)
    return values


def _value(text: str) -> Any:
    """Return a number, a list of numbers, or else the text itself."""
    try:
        if text.startswith("[") or "," in text:
            return [float(part) for part in text.strip("[]").split(",")]
        return float(text)
    except ValueError:
        return text
