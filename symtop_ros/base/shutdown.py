"""A ROS program from its start to its orderly end by SIGINT, SIGTERM and SIGHUP."""

import argparse
import os
import re
import signal
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager

import rclpy
from rclpy.executors import ExternalShutdownException, SingleThreadedExecutor
from rclpy.signals import (
    SignalHandlerOptions,
    install_signal_handlers,
    uninstall_signal_handlers,
)
from rclpy.utilities import remove_ros_args

from symtop_ros.base.refusals import one_line

# rcl's text for a list such as [0, 0, 0.1], which says nothing of integers; and its rule
MIXED = "Sequence should be of same type"
OVERRIDE = re.compile(r"'-p (\S+?):=(.*?)'")
SIGNALS = signal.SIGINT, signal.SIGTERM, signal.SIGHUP


def describe_failure(error: Exception) -> str:
    r"""Return the text of an error that ends a program, in one line.

    With SROS2 most errors at the start come from the middleware, whose text does not say what is
    wrong with the keys.
    """
    text = one_line(error) or type(error).__name__
    if MIXED in text and (found := OVERRIDE.search(text)):
        return f"{found[1]} must have numbers of one kind, got {found[2]}: write 0.0 for 0"
    if os.environ.get("ROS_SECURITY_ENABLE") != "true":
        return text
    return (
        f"{text} (ROS_SECURITY_ENABLE is true: keys and permissions must be those of this program "
        f"in domain {os.environ.get('ROS_DOMAIN_ID', '0')}, see SECURITY.md)"
    )


@contextmanager
def ros_context(arguments: list[str], is_last: bool = False) -> Iterator[Callable[[], None]]:
    """Initialise ROS on entry, and shut it down on exit.

    Yields a function `listen`. Signals are only noted until it is called, because a node that is
    being created when ROS shuts down fails in many ways. If the process ends afterwards
    (`is_last`), a second signal is ignored: it would end the process with another status.
    """
    noted: list[int] = []

    def listen() -> None:
        install_signal_handlers(SignalHandlerOptions.ALL)
        if signal.SIGHUP in before:  # a closed terminal; rclpy knows the other two
            signal.signal(signal.SIGHUP, lambda *_: signal.raise_signal(signal.SIGTERM))
        for number in noted[:1]:
            signal.raise_signal(number)

    # nohup ignores SIGHUP
    heeded = SIGNALS if signal.getsignal(signal.SIGHUP) != signal.SIG_IGN else SIGNALS[:2]
    before = {
        number: signal.signal(number, lambda number, _: noted.append(number)) for number in heeded
    }
    try:
        # Not as a context manager: rclpy 7 (Jazzy) returns None here.
        rclpy.init(args=arguments, signal_handler_options=SignalHandlerOptions.NO)
        try:
            yield listen
        except Exception:
            if rclpy.ok():
                raise
            raise ExternalShutdownException from None
        finally:
            rclpy.try_shutdown()
    finally:
        uninstall_signal_handlers()
        for number, handler in before.items():
            signal.signal(
                number, signal.SIG_IGN if is_last and handler == signal.SIG_DFL else handler
            )


def run_with_ros(
    parser: argparse.ArgumentParser,
    args: list[str] | None,
    run: Callable[[argparse.Namespace, Callable[[], None]], int],
) -> int:
    """Run a ROS program until it ends or is shut down; return the exit status.

    `run` gets the options and the function of `ros_context`.
    """
    arguments = sys.argv if args is None else [parser.prog, *args]
    try:
        options = parser.parse_args(remove_ros_args(arguments)[1:])
        with ros_context(arguments, is_last=args is None) as listen:
            return run(options, listen)
    except ExternalShutdownException:
        return 0
    except Exception as error:
        print(f"{parser.prog}: {describe_failure(error)}", file=sys.stderr)
        return 1


def spin_until(executor: SingleThreadedExecutor, deadline: float) -> None:
    """Let the executor work until a time of `time.monotonic`."""
    while (left := deadline - time.monotonic()) > 0:
        executor.spin_once(timeout_sec=left)
