"""Duplicates in other programs: of the name of this node, or of the simulated clock."""

from abc import ABC, abstractmethod
from typing import cast

from rclpy.clock import ROSClock
from rclpy.node import Node

from symtop_ros.session.diagnostics import make_status
from symtop_ros.wire.diagnostics import OK, WARN, Status

CLOCK = "/clock"


class Duplicates(ABC):
    """Counts what should be there once, reports once when it is not, and when it is again."""

    kind: str  # name of the status
    fact: str  # name of the count in it

    def __init__(self, node: Node) -> None:
        self._node, self.count = node, 0

    @abstractmethod
    def _count(self) -> int:
        """Return the number of those that are too many."""

    @property
    @abstractmethod
    def sentence(self) -> str:
        """Description of the duplicates, and what to do about them."""

    def update(self) -> None:
        """Count them, and report when they appear and when they are gone."""
        before, self.count = self.count, max(0, self._count())
        if self.count and not before:
            self._node.get_logger().warning(self.sentence)
        elif before and not self.count:
            self._node.get_logger().info(self.sentence)

    @property
    def status(self) -> Status:
        """The status in /diagnostics."""
        facts = {"name": self._name, self.fact: self.count}
        return make_status(self.kind, WARN if self.count else OK, self.sentence, facts)

    @property
    def _name(self) -> str:
        return self._node.get_fully_qualified_name()


class DuplicateNodes(Duplicates):
    """Other nodes that have the name of this node: a request reaches any of them."""

    kind, fact = "name", "others"

    def _count(self) -> int:
        return self._node.get_fully_qualified_node_names().count(self._name) - 1

    @property
    def sentence(self) -> str:
        """Description of the duplicates, and what to do about them."""
        if not self.count:
            return f"no other node has the name {self._name}"
        others = "another node has" if self.count == 1 else f"{self.count} other nodes have"
        return (
            f"{others} the name {self._name}, and a request reaches any of them: rename this one "
            "with --ros-args -r __node:=NAME or -r __ns:=/NAME (a killed node is listed for 20 s)"
        )


class DuplicateClocks(Duplicates):
    """Publishers of /clock beyond the first: the time steps back and forth between them."""

    kind, fact = "clock", "publishers"

    def __init__(self, node: Node, publishes: bool) -> None:
        super().__init__(node)
        self._publishes = publishes

    def _count(self) -> int:
        clock = cast(ROSClock, self._node.get_clock())
        concerns = self._publishes or clock.ros_time_is_active
        return self._node.count_publishers(CLOCK) - 1 if concerns else 0

    @property
    def status(self) -> Status:
        """The status in /diagnostics, with the number of all publishers."""
        facts = {self.fact: self._node.count_publishers(CLOCK)}
        return make_status(self.kind, WARN if self.count else OK, self.sentence, facts)

    @property
    def sentence(self) -> str:
        """Description of the duplicates, and what to do about them."""
        if not self.count:
            return f"no duplicate publisher of {CLOCK} concerns this node"
        return (
            f"{self.count + 1} programs publish {CLOCK}, and the time steps back and forth between "
            "them: end all but one, or start this node with publish_clock:=false"
        )
