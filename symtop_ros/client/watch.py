"""The live line of `top_ctl watch`."""

import math
import sys
import time
from typing import Any

from sensor_msgs.msg import JointState

from symtop_ros.client.connection import Connection, UnreachableError

UPDATE_PERIOD = 0.1  # s


def watch(connection: Connection, seconds: float, timeout: float) -> None:
    """Show tilt, precession and spin in one line of a terminal, updated 10 times a second."""
    latest: list[Any] = []

    def take(message: JointState) -> None:
        latest[:] = [message]

    connection.subscribe(JointState, "euler_angles", take)
    end = math.inf
    try:
        while time.monotonic() < end:
            latest.clear()
            if not connection.spin_until(lambda: bool(latest), timeout):
                raise UnreachableError(f"no samples from {connection.name} within {timeout:g} s")
            end = min(end, time.monotonic() + seconds)
            _show(latest[0])
            connection.spin_until(lambda: False, UPDATE_PERIOD)
    finally:
        if sys.stdout.isatty():
            print()


def _show(message: JointState) -> None:
    phi, theta, _ = message.position
    phi_dot, theta_dot, psi_dot = message.velocity
    bar = "".join("|" if i == round(theta / 3.1416 * 24) else "." for i in range(25))
    line = (
        f"theta {theta:6.4f} rad [{bar}]  theta' {theta_dot:+8.3f}  phi {phi:+6.3f}  "
        f"phi' {phi_dot:+8.3f}  psi' {psi_dot:+9.3f} rad/s"
    )
    end = "\r" if sys.stdout.isatty() else "\n"
    print(line, end=end, flush=True)
