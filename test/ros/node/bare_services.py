"""A bare rclpy node with the services of a top, which do nothing, and its samples.

Its thread publishes prepared bytes: what delays them is rclpy, which converts messages under the
lock of the interpreter.
"""

import contextlib
import importlib
import sys
import threading
import time

import rclpy
from geometry_msgs.msg import QuaternionStamped
from rcl_interfaces.srv import SetParametersAtomically
from rclpy.executors import ExternalShutdownException
from rclpy.serialization import serialize_message
from std_srvs.srv import SetBool, Trigger

NAMED = ("kick", "set_initial_conditions", "step")
STANDARD = {"get_entities": "GetEntities", "get_entity_state": "GetEntityState"}
STANDARD |= {"set_entity_state": "SetEntityState", "reset_simulation": "ResetSimulation"}
PERIOD = 0.005  # s
# s between two looks at the context: rclpy 7 may wake the executor before a signal has shut ROS
# down, and then it waits for its next event.
LOOK = 1.0


def main() -> None:
    """Run until a signal."""
    sys.setswitchinterval(1e-4)  # as top_node does
    rclpy.init()
    node = rclpy.create_node("top")
    for name in NAMED:
        node.create_service(SetParametersAtomically, f"~/{name}", lambda _, response: response)
    node.create_service(SetBool, "~/record", lambda _, response: response)
    node.create_service(Trigger, "~/get_state", lambda _, response: response)
    types = importlib.import_module("simulation_interfaces.srv")
    for name, kind in STANDARD.items():
        node.create_service(getattr(types, kind), f"~/{name}", lambda _, response: response)
    publisher = node.create_publisher(QuaternionStamped, "~/orientation", 100)
    data = serialize_message(QuaternionStamped())
    node.create_timer(LOOK, lambda: None)

    def publish() -> None:
        begin = time.monotonic()
        count = 0
        while rclpy.ok():
            count += 1
            time.sleep(max(0.0, begin + count * PERIOD - time.monotonic()))
            try:
                publisher.publish(data)
            except Exception:
                if rclpy.ok():
                    raise

    threading.Thread(target=publish, daemon=True).start()
    with contextlib.suppress(KeyboardInterrupt, ExternalShutdownException):
        rclpy.spin(node)


if __name__ == "__main__":
    main()
