"""Subscriptions to a running top; messages are decoded as those of a log."""

from collections import deque
from collections.abc import Collection
from functools import partial

from rclpy.node import Node
from rclpy.qos import QoSDurabilityPolicy, QoSProfile

from symtop_ros.run.log.batch import TF, Batch, BatchReader
from symtop_ros.run.simulation.topics import EVENTS, STATE_TOPICS

LATCHED = QoSProfile(depth=EVENTS.depth, durability=QoSDurabilityPolicy.TRANSIENT_LOCAL)
DEPTH = 1000  # samples that are queued: 1 s at 1 kHz


# The attitude of /tf is that of ~/orientation.
DRAWN = tuple(name for name in STATE_TOPICS if name != TF)


class Feed:
    """Subscriptions to one top. They find the node again after it was restarted.

    Messages may arrive in another thread than that of the caller.
    """

    def __init__(self, node: Node, name: str, topics: Collection[str] = DRAWN) -> None:
        self._messages: deque[tuple[str, bytes]] = deque()
        self._event: bytes | None = None  # the last one, with which a new recording begins
        self._reader = BatchReader()
        node.create_subscription(
            EVENTS.load_message_class(),
            EVENTS.resolve(name),
            self._receive_event,
            LATCHED,
            raw=True,
        )
        for topic in map(STATE_TOPICS.__getitem__, topics):
            node.create_subscription(
                topic.load_message_class(),
                topic.resolve(name),
                partial(self.receive, topic.name),
                DEPTH,
                raw=True,
            )

    def batch(self) -> Batch:
        """Return the messages since the last call."""
        # Each removal is atomic, so that a message that arrives meanwhile is kept.
        return self._reader.read([self._messages.popleft() for _ in range(len(self._messages))])

    def repeat_event(self) -> None:
        """Put the last event into the next batch, for a new recording."""
        if self._event is not None:
            self._messages.appendleft((EVENTS.name, self._event))

    def receive(self, topic: str, data: bytes) -> None:
        """Put an encoded message of a topic into the next batch."""
        self._messages.append((topic, data))

    def _receive_event(self, data: bytes) -> None:
        self._event = data
        self.receive(EVENTS.name, data)
