"""Entry points of the programs, which say so in a line where ROS 2 is missing."""

from __future__ import annotations

import importlib
import signal
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


def top_report() -> int:
    """Measure, and draw."""
    return _run("top_report", "symtop_ros.report.main")


def _run(name: str, module: str) -> int:
    """Run a program; a signal while it is loaded, or after its end, ends the process in silence."""
    _be_ended_by_signals()
    try:
        main = importlib.import_module(module).main
    except ModuleNotFoundError as error:
        print(f"{name}: {error.name} is missing: {_remedy(error.name)}", file=sys.stderr)
        return 1
    try:
        return int(main())
    finally:
        _be_ended_by_signals()


def _be_ended_by_signals() -> None:
    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, signal.SIG_DFL)


def _remedy(module: str | None) -> str:
    if module in PLAIN:
        return f"pip install {module}"
    if module and module.startswith("rerun"):
        return "pip install 'symtop_ros[playback]'"
    return "source a ROS 2, or pip install 'symtop_ros[ros]'"
