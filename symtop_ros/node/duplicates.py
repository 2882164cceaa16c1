"""Duplicates in other programs: of the name of this node, or of the simulated clock."""

from typing import cast

from rclpy.clock import ROSClock
from rclpy.node import Node

from symtop_ros.session.diagnostics import make_status
from symtop_ros.wire.diagnostics import OK, WARN, Status

CLOCK = "/clock"


def find_duplicates(node: Node, publishes_clock: bool) -> list[Status]:
    """Return a status on the name of a node and one on /clock; WARN if there are duplicates."""
    return [_look_for_nodes(node), _look_for_clocks(node, publishes_clock)]


def _look_for_nodes(node: Node) -> Status:
    """Look for other nodes of the name of this node: a request reaches any of them."""
    name = node.get_fully_qualified_name()
    count = max(0, node.get_fully_qualified_node_names().count(name) - 1)
    sentence = f"no other node has the name {name}"
    if count:
        others = "another node has" if count == 1 else f"{count} other nodes have"
        sentence = (
            f"{others} the name {name}, and a request reaches any of them: rename this one "
            "with --ros-args -r __node:=NAME or -r __ns:=/NAME (a killed node is listed for 20 s)"
        )
    return make_status("name", WARN if count else OK, sentence, {"name": name, "others": count})


def _look_for_clocks(node: Node, publishes_clock: bool) -> Status:
    """Look for several publishers of /clock: the time steps back and forth between them."""
    concerns = publishes_clock or cast(ROSClock, node.get_clock()).ros_time_is_active
    count = node.count_publishers(CLOCK)
    level, sentence = OK, f"no duplicate publisher of {CLOCK} concerns this node"
    if concerns and count > 1:
        level = WARN
        sentence = (
            f"{count} programs publish {CLOCK}, and the time steps back and forth between "
            "them: end all but one, or start this node with publish_clock:=false"
        )
    return make_status("clock", level, sentence, {"publishers": count})
