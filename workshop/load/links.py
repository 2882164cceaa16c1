"""top_node and its user on two hosts, whose link loses, delays and reorders frames.

`make -C workshop links`, or `python -m workshop.load.links --seconds 3`. The hosts are network
namespaces, which only root may make. With `--docs docs` the figures are written into the
documentation.
"""

import argparse
import json
import os
import subprocess
import sys
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from typing import Any

import numpy as np

from symtop_ros.ros.client.connection import UnreachableError
from symtop_ros.ros.node.host import VARIABLES, distribution_name
from workshop.load.follower import SUBSCRIBED_RATE
from workshop.load.processes import DOCS, ROOT, domain, run_program, script, top_node
from workshop.load.two_hosts import Cable, Host, Weather, two_hosts, why_not
from workshop.speed.conditions import describe_conditions
from workshop.speed.publish import format_table, publish, write_chapter

LINKS = {
    "clear": Weather(),
    "1 % lost, 20 ± 5 ms, 10 % reordered": Weather(0.01, 0.020, 0.005, 0.10),
    "5 % lost, 20 ± 5 ms, 10 % reordered": Weather(0.05, 0.020, 0.005, 0.10),
    "20 % lost, 50 ± 10 ms, 10 % reordered": Weather(0.20, 0.050, 0.010, 0.10),
}
# Fast DDS 3 has renamed an element of the profile.
LOSSY_FILES = {"jazzy": "fastdds_lossy.xml", "kilted": "fastdds_lossy_kilted.xml"}
HEAD = ["link", "profile", "lost", "delay p50, p99, ms", "kick p50, longest, ms"]
NAME = "links"  # of the table in the documentation


def list_profiles() -> dict[str, dict[str, str]]:
    """Return the environment of each profile by its name."""
    path = str(ROOT / "config" / LOSSY_FILES[distribution_name()])
    return {"none": {}, "lossy": dict.fromkeys(VARIABLES, path)}


def measure(seconds: float) -> Iterator[list[str]]:
    """Yield the row of each link and profile; a clear one needs no profile."""
    for link, weather in LINKS.items():
        for profile, variables in list_profiles().items():
            if profile == "none" or weather.loss:
                with two_hosts() as (here, there, cable):
                    seen = _follow(here, there, cable, weather, variables, seconds)
                yield [link, profile, *format_cells(seen)]


def _follow(
    here: Host,
    there: Host,
    cable: Cable,
    weather: Weather,
    variables: Mapping[str, str],
    seconds: float,
) -> dict[str, Any]:
    """Return what a user on one host sees of a top on the other, from the weather on."""
    user_words = script("link_user", SUBSCRIBED_RATE, seconds)
    with (
        _running(here, variables, top_node(f"publish_rate:={SUBSCRIBED_RATE}")),
        _running(there, variables, user_words) as user,
    ):
        _read_line(user)  # samples arrive
        cable.weather = weather
        assert user.stdin
        user.stdin.write("begin\n")
        user.stdin.flush()
        seen: dict[str, Any] = json.loads(_read_line(user))
    return seen


def _read_line(user: subprocess.Popen[str]) -> str:
    """Return the next line of the user on the other host."""
    assert user.stdout
    line = user.stdout.readline()
    if not line:
        raise UnreachableError("the user on the other host ended without an answer")
    return line


@contextmanager
def _running(
    host: Host, variables: Mapping[str, str], words: list[str]
) -> Iterator[subprocess.Popen[str]]:
    """Run a program on a host, with its input and output in pipes, and end it."""
    usual = {k: v for k, v in os.environ.items() if k not in VARIABLES}
    usual.pop("ROS_AUTOMATIC_DISCOVERY_RANGE", None)  # hosts have to find each other
    environment = {**usual, "ROS_DOMAIN_ID": str(domain()), **variables}
    pipes: dict[str, Any] = {"stdin": subprocess.PIPE, "stdout": subprocess.PIPE, "text": True}
    with subprocess.Popen(host.words(*words), env=environment, **pipes) as process:
        try:
            yield process
        finally:
            process.terminate()
            process.communicate()


def format_cells(seen: Mapping[str, Any]) -> list[str]:
    """Return the figures of a link as cells of the table."""
    total = seen["lost"] + seen["count"]
    p50, p99 = np.percentile(seen["delays"], [50, 99]) * 1e3
    kick, longest = np.percentile(seen["kicks"], [50, 100]) * 1e3
    return [f"{seen['lost']} of {total}", f"{p50:.0f}, {p99:.0f}", f"{kick:.0f}, {longest:.0f}"]


def _run(options: argparse.Namespace) -> bool:
    if reason := why_not():
        print(f"links: no two hosts can be made here: {reason}", file=sys.stderr)
        return False
    rows = []
    for row in measure(options.seconds):
        print(" | ".join(row), flush=True)
        rows.append(row)
    if options.docs:
        values = {"seconds": options.seconds, "conditions": describe_conditions("rclpy")}
        section = write_chapter(NAME, **values, table=format_table(HEAD, rows))
        publish({NAME: section}, options.docs)
    return True


def main(args: list[str] | None = None) -> int:
    """Print a line for each link; return the exit status."""
    description = "top_node and its user on two hosts whose link loses, delays, reorders frames."
    return run_program("links.py", description, 10.0, _run, args, docs=DOCS)


if __name__ == "__main__":
    sys.exit(main())
