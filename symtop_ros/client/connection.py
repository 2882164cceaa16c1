"""A client of a running top: calls its services and follows its topics, with time-outs."""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping
from typing import Any

from rcl_interfaces.msg import Parameter as ParameterMessage
from rcl_interfaces.srv import SetParametersAtomically
from rclpy.client import Client
from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node
from rclpy.parameter import Parameter
from std_srvs.srv import SetBool, Trigger


class UnreachableError(Exception):
    """The node did not show up, or did not answer, in time."""


class Connection:
    """Calls to one top.

    Parameters
    ----------
    node : Node
        A node of the caller's own, spun here while waiting.
    name : str
        Full name of the top's node, such as /top.
    timeout : float
        How long to wait for the top to show up and to answer, s.
    """

    def __init__(self, node: Node, name: str = "/top", timeout: float = 5.0) -> None:
        self.node = node
        self.name = "/" + name.strip("/")
        self._timeout = timeout
        self._clients: dict[str, Client[Any, Any]] = {}
        self._executor = SingleThreadedExecutor(context=node.context)
        self._executor.add_node(node)

    def set(self, service: str, values: Mapping[str, Any]) -> tuple[bool, str]:
        """Call a service that takes named values; return success and the answer."""
        request = SetParametersAtomically.Request(parameters=_messages(values))
        result = self._call(SetParametersAtomically, service, request).result
        return result.successful, result.reason

    def trigger(self, service: str) -> tuple[bool, str]:
        """Call a service that takes nothing."""
        answer = self._call(Trigger, service, Trigger.Request())
        return answer.success, answer.message

    def switch(self, service: str, on: bool) -> tuple[bool, str]:
        """Call a service that takes on or off."""
        answer = self._call(SetBool, service, SetBool.Request(data=on))
        return answer.success, answer.message

    def follow(self, kind: Any, topic: str, callback: Callable[[Any], None]) -> None:
        """Call back for every message of one of the top's topics, while spinning."""
        self.node.create_subscription(kind, f"{self.name}/{topic}", callback, 100)

    def spin_until(self, done: Callable[[], bool], timeout: float) -> bool:
        """Spin until a condition holds; return whether it does."""
        deadline = time.monotonic() + timeout
        while not done() and time.monotonic() < deadline:
            self._executor.spin_once(timeout_sec=min(0.1, max(0.0, deadline - time.monotonic())))
        return done()

    def _call(self, kind: Any, service: str, request: Any) -> Any:
        if service not in self._clients:
            self._clients[service] = self.node.create_client(kind, f"{self.name}/{service}")
        client = self._clients[service]
        if not self.spin_until(client.service_is_ready, self._timeout):
            msg = (
                f"no answer from {self.name} within {self._timeout:g} s: "
                "is top_node running, with the same ROS_DOMAIN_ID and --node?"
            )
            raise UnreachableError(msg)
        future = client.call_async(request)
        if not self.spin_until(future.done, self._timeout):
            client.remove_pending_request(future)
            msg = f"{self.name}/{service} did not answer within {self._timeout:g} s"
            raise UnreachableError(msg)
        return future.result()


def _messages(values: Mapping[str, Any]) -> list[ParameterMessage]:
    return [Parameter(name, value=value).to_parameter_msg() for name, value in values.items()]
