"""Entry points of the programs, which say so in a line where ROS 2 is missing."""

from __future__ import annotations

import importlib
import sys


def top_node() -> int:
    """Run the node."""
    return _run("top_node", "symtop_ros.node.main")


def top_ctl() -> int:
    """Run the client."""
    return _run("top_ctl", "symtop_ros.client.main")


def _run(name: str, module: str) -> int:
    try:
        main = importlib.import_module(module).main
    except ModuleNotFoundError as error:
        print(
            f"{name}: {error.name} is missing: source a ROS 2, or pip install 'symtop_ros[ros]'",
            file=sys.stderr,
        )
        return 1
    return int(main())
