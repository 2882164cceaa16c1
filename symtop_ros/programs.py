"""Entry points of the programs, which say so in a line where ROS 2 is missing."""

from __future__ import annotations

import importlib
import sys

PLAIN = {"mcap", "numpy", "scipy"}  # no ROS 2 brings the first; the others come with it


def top_node() -> int:
    """Run the node."""
    return _run("top_node", "symtop_ros.node.main")


def top_ctl() -> int:
    """Run the client."""
    return _run("top_ctl", "symtop_ros.client.main")


def top_replay() -> int:
    """Play logs."""
    return _run("top_replay", "symtop_ros.playback.main")


def top_live() -> int:
    """Show a running node."""
    return _run("top_live", "symtop_ros.live.main")


def _run(name: str, module: str) -> int:
    try:
        main = importlib.import_module(module).main
    except ModuleNotFoundError as error:
        print(f"{name}: {error.name} is missing: {_remedy(error.name)}", file=sys.stderr)
        return 1
    return int(main())


def _remedy(module: str | None) -> str:
    if module in PLAIN:
        return f"pip install {module}"
    if module and module.startswith("rerun"):
        return "pip install 'symtop_ros[playback]'"
    return "source a ROS 2, or pip install 'symtop_ros[ros]'"
