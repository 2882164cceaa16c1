"""A connection to a running top: service calls and subscriptions, with time-outs."""

import time
from collections.abc import Callable, Mapping
from typing import Any

from rcl_interfaces.srv import SetParametersAtomically
from rclpy.client import Client
from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node
from rclpy.parameter import Parameter
from std_srvs.srv import SetBool, Trigger

from symtop_ros.run.session.services import SERVICES
from symtop_ros.run.wire.names import full_name

TYPES = {"named": SetParametersAtomically, "switch": SetBool, "plain": Trigger}  # by kind
POLL = 0.01  # s; an executor does not notice that a service was found
PATIENCE = 1.0  # s, after which a harmless question is asked again
QUESTION = "get_state"  # changes nothing


class UnreachableError(Exception):
    """The node was not found or did not answer in time."""


class Connection:
    """Connection to one top."""

    def __init__(self, node: Node, name: str = "/top", timeout: float = 5.0) -> None:
        self.node = node
        self.name = full_name(name)
        self._timeout = timeout
        self._clients: dict[str, Client] = {}
        # Services whose answers may not reach this connection yet, and a client made after theirs.
        self._unknown: set[str] = set()
        self._question: Client | None = None
        self._executor = SingleThreadedExecutor(context=node.context)
        self._executor.add_node(node)

    def close(self) -> None:
        """End the executor; else Python may end its parts in an order that prints an exception."""
        self._executor.shutdown()

    def request(
        self, service: str, argument: Mapping[str, Any] | bool | None = None
    ) -> tuple[bool, str]:
        """Call a service with named values, on or off, or nothing; return success and answer."""
        if argument is None:
            answer = self.call(Trigger, service, Trigger.Request())
        elif isinstance(argument, bool):
            answer = self.call(SetBool, service, SetBool.Request(data=argument))
        else:
            named = [Parameter(each, value=argument[each]).to_parameter_msg() for each in argument]
            result = self.call(
                SetParametersAtomically,
                service,
                SetParametersAtomically.Request(parameters=named),
            ).result
            return result.successful, result.reason
        return answer.success, answer.message

    @property
    def doubles(self) -> int:
        """Number of nodes that have the name of the top, if there are several, else 0."""
        count = self.node.get_fully_qualified_node_names().count(self.name)
        return count if count > 1 else 0

    def subscribe(self, kind: Any, topic: str, callback: Callable[[Any], None]) -> None:
        """Call `callback` for each message on a topic of the top, given by its short name."""
        self.node.create_subscription(kind, f"{self.name}/{topic}", callback, 100)

    def spin_until(self, done: Callable[[], bool], timeout: float) -> bool:
        """Spin until a condition holds; return False after `timeout` seconds."""
        deadline = time.monotonic() + timeout
        while not done() and time.monotonic() < deadline:
            self._executor.spin_once(timeout_sec=min(POLL, max(0.0, deadline - time.monotonic())))
        return done()

    def prepare(self, *services: str) -> None:
        """Create the clients of some services: at the first call they have found the top."""
        for name in services:
            self._client(TYPES[SERVICES[name].kind if name in SERVICES else "named"], name)
        self._find_question()

    def _client(self, kind: Any, service: str) -> Client:
        if service not in self._clients:
            self._clients[service] = self.node.create_client(kind, f"{self.name}/{service}")
            self._unknown.add(service)
            self._question = None
        return self._clients[service]

    def call(self, kind: Any, service: str, request: Any) -> Any:
        """Return the response of a service of the top, of any type.

        Raises
        ------
        UnreachableError
            If there is none in time.
        """
        client = self._client(kind, service)
        question = self._find_question() if service in self._unknown - {QUESTION} else None
        if not self.spin_until(client.service_is_ready, self._timeout):
            raise UnreachableError(
                f"no answer from {self.name} within {self._timeout:g} s: "
                "is top_node running, with the same ROS_DOMAIN_ID and --node?"
            )
        if question and self._become_known(question):
            self._unknown.clear()
        future = client.call_async(request)
        if not self.spin_until(future.done, self._timeout):
            client.remove_pending_request(future)
            raise UnreachableError(
                f"{self.name}/{service} did not answer within {self._timeout:g} s"
            )
        return future.result()

    def _find_question(self) -> Client:
        """Return a client of a harmless service that was made after all other ones."""
        if not self._question:
            self._question = self.node.create_client(Trigger, f"{self.name}/{QUESTION}")
        return self._question

    def _become_known(self, client: Client) -> bool:
        """Wait until the top has found the readers of answers that were made before this client.

        Fast DDS drops an answer whose reader it has not found after 0.1 s: on a busy machine a kick
        would be done and not answered. Readers are found in the order in which they were made, so
        the answer to a harmless question of the last one says that the others are known.
        """
        deadline = time.monotonic() + self._timeout
        while (left := deadline - time.monotonic()) > 0:
            if self.spin_until(client.service_is_ready, min(PATIENCE, left)):
                future = client.call_async(Trigger.Request())
                if self.spin_until(future.done, min(PATIENCE, left)):
                    return True
                client.remove_pending_request(future)
        return False
