"""A node of the test that listens to a top, in another process or in its own."""

import time
from collections.abc import Callable, Mapping
from typing import Any, Self

import rclpy
from rcl_interfaces.msg import Parameter
from rclpy.executors import SingleThreadedExecutor
from waiting import until


class Listener:
    """A node in a domain, spun until a condition holds."""

    def __init__(self, domain: int, name: str = "listener") -> None:
        self.context = rclpy.Context()
        rclpy.init(context=self.context, domain_id=domain)
        self.node = rclpy.create_node(name, context=self.context)
        self.executor = SingleThreadedExecutor(context=self.context)
        self.executor.add_node(self.node)

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.executor.shutdown()
        self.node.destroy_node()  # else shared memory ends before what uses it
        rclpy.shutdown(context=self.context)

    def collect(self, kind: Any, topic: str, qos: Any = 1000, raw: bool = False) -> list[Any]:
        """Subscribe, and return the list that messages (or their bytes) come into."""
        messages: list[Any] = []
        self.node.create_subscription(kind, topic, messages.append, qos, raw=raw)
        return messages

    def spin_until(self, done: Callable[[], Any]) -> None:
        until(done, lambda: self.executor.spin_once(timeout_sec=0.05))

    def wait_for(self, messages: list[Any], count: int = 1) -> None:
        """Wait until so many more messages have come into a list."""
        enough = len(messages) + count
        self.spin_until(lambda: len(messages) >= enough)

    def spin(self, seconds: float) -> None:
        end = time.monotonic() + seconds
        while time.monotonic() < end:
            self.executor.spin_once(timeout_sec=0.01)


def fill(message: Any, values: Mapping[str, Any]) -> Any:
    """Set the fields of a message from nested values, as rosidl_runtime_py does it from YAML."""
    for name, value in values.items():
        if isinstance(value, dict):
            fill(getattr(message, name), value)
        elif name == "parameters":
            message.parameters = [fill(Parameter(), each) for each in value]
        else:
            setattr(message, name, type(getattr(message, name))(value))  # YAML: 5e-4 is text
    return message
