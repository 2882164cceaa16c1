"""Options of `top_live`, without ROS and Rerun."""

import argparse

from symtop_ros.base.command import new_parser, port
from symtop_ros.replay.options import add_view_options

PORT = 9876  # default of Rerun


def make_parser() -> argparse.ArgumentParser:
    """Return the parser of the command line."""
    parser = new_parser(
        "top_live",
        "Show a running top in the Rerun viewer that listens on --port, or in a new viewer if "
        "none does. You may close the viewer and start it again.",
    )
    parser.add_argument("--node", default="/top", help="name of the node (default /top)")
    parser.add_argument(
        "--port", type=port, default=PORT, help=f"port of the viewer (default {PORT})"
    )
    parser.add_argument(
        "--web", action="store_true", help="serve the view to a browser on this machine"
    )
    add_view_options(parser)
    return parser
