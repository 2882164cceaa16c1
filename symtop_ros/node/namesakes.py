"""Other nodes of the same name: ROS lets them be, and each request reaches one or all of them."""

from __future__ import annotations

from rclpy.node import Node


class Namesakes:
    """Looks for them in the graph.

    Attributes
    ----------
    name : str
        Full name of the node.
    count : int
        How many others had it at the last look.
    """

    def __init__(self, node: Node) -> None:
        self._node, self.name, self.count = node, node.get_fully_qualified_name(), 0

    def look(self) -> None:
        """Count them, and say so once when they come and when they are gone."""
        names = self._node.get_fully_qualified_node_names()
        before, self.count = self.count, max(0, names.count(self.name) - 1)
        if self.count and not before:
            self._node.get_logger().warning(self.sentence)
        elif before and not self.count:
            self._node.get_logger().info(self.sentence)

    @property
    def sentence(self) -> str:
        """What there is, and what to do."""
        if not self.count:
            return f"no other node is named {self.name}"
        others = "another node is" if self.count == 1 else f"{self.count} other nodes are"
        return (
            f"{others} named {self.name}, and requests reach any of them: give this one "
            "--ros-args -r __node:=NAME or -r __ns:=/NAME (one that was killed counts for 20 s)"
        )
