"""Entry points of the programs. What is missing they name in one line."""

import gc
import importlib
import io
import os
import signal
import sys
import warnings
from functools import partial
from importlib.util import find_spec
from itertools import takewhile
from typing import Any, NoReturn

from symtop_ros.base.missing import find_package, name_remedy

# Statuses of programs that a signal has ended, as shells have them: SIGINT, and SIGPIPE, which says
# that the output is no longer read.
INTERRUPTED, BROKEN_PIPE = 130, 141
TRANSPORTS = "FASTDDS_BUILTIN_TRANSPORTS"
THREADS = "OPENBLAS_NUM_THREADS"


def top_ctl() -> int:
    """Call the services of a running node; it ends the process."""
    return _leave(run("top_ctl", "symtop_ros.ros.client"))


def _leave(status: int) -> NoReturn:
    """End the process at once: to unload Fast DDS and NumPy takes 0.2 s, a fourth of a call."""
    gc.collect()  # destroys the ROS node, and so Fast DDS announces its end
    os._exit(status)


def run(name: str, package: str, interruptible: bool = False) -> int:
    """Run the program of a package. A signal before it ends the process without a traceback.

    Both signals raise KeyboardInterrupt in an interruptible program, so that it removes incomplete
    files and ends what it has started. The other programs handle signals themselves. At the end
    the status is known, and a second signal does not change it.
    """
    _set_signals(signal.SIG_DFL)
    _spare_the_user()
    _use_udp_only()
    try:
        _answer_without_the_program(f"{package}.options")
        main = importlib.import_module(f"{package}.main").main
        if interruptible:
            _set_signals(signal.default_int_handler)
        status = int(main())
        return _write_out(name) or status
    except ModuleNotFoundError as error:
        missing = find_package(str(error.name)) or str(error.name).partition(".")[0]
        print(f"{name}: {missing} is missing: {name_remedy(str(error.name))}", file=sys.stderr)
        return 1
    except ImportError as error:  # the compiled kernel, or a library that does not fit the machine
        print(f"{name}: {error}", file=sys.stderr)
        return 1
    except KeyboardInterrupt:
        return INTERRUPTED
    except BrokenPipeError:
        drop_output()
        return BROKEN_PIPE
    finally:
        _set_signals(signal.SIG_IGN)


def _write_out(name: str) -> int:
    """Write what is left of the output; return 0, or 1 and a line if there is no room for it."""
    try:
        sys.stdout.flush()
    except BrokenPipeError:
        raise
    except OSError as error:
        print(f"{name}: output: {error.strerror}", file=sys.stderr)
        drop_output()
        return 1
    return 0


def drop_output() -> None:
    """Let what is left of the output go nowhere; else Python would report it at the exit."""
    os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())


def _answer_without_the_program(options: str) -> None:
    """Answer --help and --version, and end, where the program itself may lack what it needs."""
    words = list(takewhile(lambda word: word != "--ros-args", sys.argv[1:]))
    if {"-h", "--help", "--version"} & {*words} and find_spec(options):
        importlib.import_module(options).make_parser().parse_args(words)


top_node = partial(run, "top_node", "symtop_ros.ros.node")
top_live = partial(run, "top_live", "symtop_ros.ros.live")
top_panel = partial(run, "top_panel", "symtop_ros.page.panel")
top_replay = partial(run, "top_replay", "symtop_ros.replay", interruptible=True)
top_model = partial(run, "top_model", "symtop_ros.run.models")
top_imu = partial(run, "top_imu", "symtop_ros.truth.imu", interruptible=True)
top_fit = partial(run, "top_fit", "symtop_ros.truth.fit", interruptible=True)
top_testset = partial(run, "top_testset", "symtop_ros.truth.testset", interruptible=True)
top_judge = partial(run, "top_judge", "symtop_ros.truth.judge", interruptible=True)


def _spare_the_user() -> None:
    """Let no deprecation and no terminal without Unicode end a program, and no threads slow it.

    With PYTHONWARNINGS=error the former are exceptions. What a terminal has no letter for is
    escaped. The programs' matrices are small: next to three busy programs on two processors least
    squares of `top_judge` took 30 times as long with threads, which wait for each other.
    """
    os.environ[THREADS] = os.environ.get(THREADS) or "1"  # read when NumPy is imported
    warnings.filterwarnings("ignore", category=DeprecationWarning, module=r"(?!symtop_ros\b)")
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, io.TextIOWrapper):
            stream.reconfigure(errors="backslashreplace")


def _use_udp_only() -> None:
    """Let Fast DDS leave out shared memory, unless the user has chosen a profile or transports.

    Who opens the port of a listener that has just come may wait for a third of a second, and so
    does then every publisher and every answer of the process (docs/ros_reference.md, Discovery).
    """
    if not any(name.endswith("_DEFAULT_PROFILES_FILE") for name in os.environ):
        os.environ[TRANSPORTS] = os.environ.get(TRANSPORTS) or "UDPv4"


def _set_signals(handler: Any) -> None:
    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, handler)
