"""How SIGINT and SIGTERM end a program of ROS: in order, and with no exception in between."""

from __future__ import annotations

import signal
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from types import FrameType

import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.signals import (
    SignalHandlerOptions,
    install_signal_handlers,
    uninstall_signal_handlers,
)

SIGNALS = signal.SIGINT, signal.SIGTERM


@contextmanager
def ros(arguments: list[str]) -> Iterator[Callable[[], None]]:
    """Initialise ROS, and shut it down; signals end it from the call of what is given on.

    Until then they are only noted: a node that is half made when ROS ends fails in many ways.

    Raises
    ------
    ExternalShutdownException
        In place of whatever else fails because ROS has ended.
    """
    noted: list[int] = []

    def note(number: int, _: FrameType | None) -> None:
        noted.append(number)

    def listen() -> None:
        install_signal_handlers(SignalHandlerOptions.ALL)
        for number in noted[:1]:
            signal.raise_signal(number)

    before = {number: signal.signal(number, note) for number in SIGNALS}
    try:
        with rclpy.init(args=arguments, signal_handler_options=SignalHandlerOptions.NO):
            try:
                yield listen
            except Exception:
                if rclpy.ok():
                    raise
                raise ExternalShutdownException from None
    finally:
        uninstall_signal_handlers()
        for number, handler in before.items():
            signal.signal(number, handler)
