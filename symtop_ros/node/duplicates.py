"""Other nodes that have the name of this node: a request reaches any of them."""

from rclpy.node import Node

from symtop_ros.session.diagnostics import make_status
from symtop_ros.wire.diagnostics import OK, WARN, Status


class DuplicateNodes:
    """Counts the other nodes that have the name of this node."""

    def __init__(self, node: Node) -> None:
        self._node, self.name, self.count = node, node.get_fully_qualified_name(), 0

    def update(self) -> None:
        """Count them, and report once when they appear and when they are gone."""
        names = self._node.get_fully_qualified_node_names()
        before, self.count = self.count, max(0, names.count(self.name) - 1)
        if self.count and not before:
            self._node.get_logger().warning(self.sentence)
        elif before and not self.count:
            self._node.get_logger().info(self.sentence)

    @property
    def sentence(self) -> str:
        """Description of the duplicates, and what to do about them."""
        if not self.count:
            return f"no other node has the name {self.name}"
        others = "another node has" if self.count == 1 else f"{self.count} other nodes have"
        return (
            f"{others} the name {self.name}, and a request reaches any of them: rename this one "
            "with --ros-args -r __node:=NAME or -r __ns:=/NAME (a killed node is listed for 20 s)"
        )

    @property
    def status(self) -> Status:
        """The status in /diagnostics."""
        facts = {"name": self.name, "others": self.count}
        return make_status("name", WARN if self.count else OK, self.sentence, facts)
