"""Options of `top_ctl`, without ROS."""

import argparse
import math

from symtop_ros.base.command import decimal, new_parser, positive
from symtop_ros.run.session.services import SERVICES


def make_parser() -> argparse.ArgumentParser:
    """Return the parser of the command line: each service is a command."""
    parser = new_parser(
        "top_ctl",
        "Call the services of a running top_node; exit status 1 if it refuses.",
    )
    parser.add_argument("--node", default="/top", help="name of the node (default /top)")
    parser.add_argument(
        "--timeout", type=positive, default=5.0, help="seconds to wait for an answer (default 5)"
    )
    commands = parser.add_subparsers(dest="command", required=True, metavar="COMMAND")
    parsers = {
        service.command: commands.add_parser(service.command, help=service.help)
        for service in SERVICES.values()
    }
    for service in SERVICES.values():
        if service.kind == "named":
            parsers[service.command].add_argument(
                "values",
                nargs="*" if service.command == "start" else "+",  # which has a default for each
                metavar="NAME=VALUE",
                help=service.help,
            )
    for command in ("record", "clamp"):
        parsers[command].add_argument("switch", choices=("on", "off"))
    parsers["state"].add_argument("--json", action="store_true", help="print JSON in one line")
    parsers["hurry"].add_argument(
        "factor",
        nargs="?",
        type=decimal,
        help="multiplies phi' at constant spin rate (default: the parameter hurry_factor)",
    )
    commands.add_parser("delay", help="divide the precession rate by 1.4 or FACTOR").add_argument(
        "factor", nargs="?", type=positive, default=1.4, help="by which phi' is divided"
    )
    commands.add_parser(
        "body",
        help="set a top made of parts: disc:170g,5.5cm,10.5cm point:0.9kg,-25.3cm (mass, size, "
        "distance from the pivot), or a known body such as bicycle_wheel; measured values may be "
        "added: gravity=9.8 Ix=1e-3 Iz=5e-4",
    ).add_argument(
        "parts",
        nargs="+",
        metavar="PART",
        help="KIND:MASS,SIZE,DISTANCE (hoop, disc, ball, rod), point:MASS,DISTANCE, the name of a "
        "known body, or a measured value such as Ix=1e-3",
    )
    commands.add_parser("resume", help="continue the motion from where it stopped")
    commands.add_parser("keys", help="send requests by single keys: hurry, delay, pause, push")
    commands.add_parser(
        "watch", help="show the motion in one line, continuously updated"
    ).add_argument(
        "--seconds", type=positive, default=math.inf, help="how long (default: until Ctrl-C)"
    )
    return parser
