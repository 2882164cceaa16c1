"""Entry points of the programs. If a package is missing they name it in one line."""

import gc
import importlib
import io
import os
import signal
import sys
import warnings
from functools import partial
from typing import Any, NoReturn

# Statuses of programs that a signal has ended, as shells have them: SIGINT, and SIGPIPE, which says
# that the output is no longer read.
INTERRUPTED, BROKEN_PIPE = 130, 141
TRANSPORTS = "FASTDDS_BUILTIN_TRANSPORTS"
THREADS = "OPENBLAS_NUM_THREADS"
# Packages that pip installs, by the names under which they are imported.
PYPI = {"mcap": "mcap", "numpy": "numpy", "scipy": "scipy", "yaml": "pyyaml"}
EXTRAS = {
    **dict.fromkeys(("rerun", "rerun_cli"), "playback"),
    **dict.fromkeys(("matplotlib", "tqdm", "pyarrow", "PIL"), "report"),
    "ahrs": "peers",
}


def top_ctl() -> int:
    """Call the services of a running node; it ends the process."""
    return _leave(run("top_ctl", "symtop_ros.client.main"))


def _leave(status: int) -> NoReturn:
    """End the process at once: to unload Fast DDS and NumPy takes 0.2 s, a fourth of a call."""
    gc.collect()  # destroys the ROS node, and so Fast DDS announces its end
    try:
        sys.stdout.flush()
    except OSError:
        status = status or BROKEN_PIPE
    os._exit(status)


def run(name: str, module: str, interruptible: bool = False) -> int:
    """Run a program. A signal before it ends the process without a traceback.

    Both signals raise KeyboardInterrupt in an interruptible program, so that it removes incomplete
    files and ends what it has started. The other programs handle signals themselves. At the end
    the status is known, and a second signal does not change it.
    """
    _set_signals(signal.SIG_DFL)
    _spare_the_user()
    _use_udp_only()
    try:
        main = importlib.import_module(module).main
        if interruptible:
            _set_signals(signal.default_int_handler)
        return int(main())
    except ModuleNotFoundError as error:
        package = str(error.name).partition(".")[0]
        print(f"{name}: {package} is missing: {_remedy(package)}", file=sys.stderr)
        return 1
    except KeyboardInterrupt:
        return INTERRUPTED
    except BrokenPipeError:
        # What is left of the output goes nowhere; else Python would report it at the exit.
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return BROKEN_PIPE
    finally:
        _set_signals(signal.SIG_IGN)


# Of these the first two and a node on the page need ROS, and the scene in 3D needs Rerun.
top_node = partial(run, "top_node", "symtop_ros.node.main")
top_live = partial(run, "top_live", "symtop_ros.live.main")
top_panel = partial(run, "top_panel", "symtop_ros.panel.main")
top_replay = partial(run, "top_replay", "symtop_ros.playback.main", interruptible=True)
top_model = partial(run, "top_model", "symtop_ros.models.main")
top_imu = partial(run, "top_imu", "symtop_ros.imu.main", interruptible=True)
top_judge = partial(run, "top_judge", "symtop_ros.judge.main", interruptible=True)


def _spare_the_user() -> None:
    """Let no deprecation and no terminal without Unicode end a program, and no threads slow it.

    With PYTHONWARNINGS=error the former are exceptions. What a terminal has no letter for is
    escaped. The programs' matrices are small: beside three busy programs on two processors least
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
    does then every publisher and every answer of the process (docs/ros.md, Discovery).
    """
    if not any(name.endswith("_DEFAULT_PROFILES_FILE") for name in os.environ):
        os.environ[TRANSPORTS] = os.environ.get(TRANSPORTS) or "UDPv4"


def _set_signals(handler: Any) -> None:
    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, handler)


def _remedy(package: str) -> str:
    if package in PYPI:
        return (
            f"pip install {PYPI[package]}, on Debian and Ubuntu into a venv (docs/ros.md, "
            "Installing)"
        )
    if package in EXTRAS:
        return f"pip install '.[{EXTRAS[package]}]' in the checkout"
    return "source a ROS 2, or pip install '.[ros]' in the checkout"
