"""Time of calls of top_ctl, each from the start of its process to its exit.

`python -m workshop.load.calls`, or `--seconds 30`.
"""

import argparse
import os
import subprocess
import sys
import time

import numpy as np

from workshop.load.processes import domain, program, run_program, running, top_node

SECONDS = 180.0  # s
PROMISED = 1.0  # s, the time in which a call is to end
HEAD = "calls  shortest  median   p99  longest, s  within 1 s"


def main(args: list[str] | None = None) -> int:
    """Print the times of calls one after the other; return an exit status, 1 if one is too long."""
    description = "Time of calls of top_ctl, one after the other for some seconds."
    return run_program("calls.py", description, SECONDS, _run, args)


def measure(seconds: float) -> list[float]:
    """Return the time in s of each call of `top_ctl reset` for some seconds."""
    with running(top_node("scene:=hurry_slow")):
        _call()  # waits for the node's start
        times = []
        end = time.monotonic() + seconds
        while time.monotonic() < end:
            times.append(_call())
        return times


def format_row(times: list[float]) -> str:
    """Return the line of times in s under HEAD."""
    shortest, half, most, longest = np.percentile(times, [0, 50, 99, 100])
    within = sum(each < PROMISED for each in times)
    return f"{len(times):5d}{shortest:10.2f}{half:8.2f}{most:6.2f}{longest:12.2f}{within:12d}"


def _call() -> float:
    begin = time.monotonic()
    environment = {**os.environ, "ROS_DOMAIN_ID": str(domain())}
    subprocess.run(
        program("top_ctl", "reset"), check=True, stdout=subprocess.DEVNULL, env=environment
    )
    return time.monotonic() - begin


def _run(options: argparse.Namespace) -> bool:
    times = measure(options.seconds)
    print(HEAD)
    print(format_row(times))
    return max(times) < PROMISED


if __name__ == "__main__":
    sys.exit(main())
