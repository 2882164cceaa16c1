"""A top on one host and its users on another: discovery, a bad network, and none at all."""

import contextlib
import json
import subprocess
import sys
from pathlib import Path

import programs
import pytest
from documents import ROOT
from programs import command, set_parameters
from waiting import TIMEOUT, until

from symtop_ros.ros.node.host import VARIABLES, distribution_name
from workshop.load.endings import bound
from workshop.load.links import LOSSY_FILES
from workshop.load.two_hosts import ADDRESSES, Weather, two_hosts, why_not

skip = pytest.mark.skipif(bool(why_not()), reason=f"no two hosts here: {why_not()}")
pytestmark = [pytest.mark.long, skip, pytest.mark.untraced]
CONFIG = ROOT / "config"
WITNESS = Path(__file__).with_name("witness.py")
RANGE, PEERS = "ROS_AUTOMATIC_DISCOVERY_RANGE", "ROS_STATIC_PEERS"
SETTINGS = (RANGE, PEERS, *VARIABLES)
LOOPBACK = dict.fromkeys(VARIABLES, str(CONFIG / "fastdds_loopback.xml"))
LOSSY = dict.fromkeys(VARIABLES, str(CONFIG / LOSSY_FILES[distribution_name()]))
LOCAL = {RANGE: "LOCALHOST"}
OFF = {RANGE: "OFF"}
TO_THE_TOP = {PEERS: ADDRESSES[0]}
# of the top, of the one who asks, and whether the top is found
DISCOVERIES = [
    ({}, {}, True),
    (LOCAL, {}, False),
    (LOCAL, LOCAL, False),
    (LOCAL, {**LOCAL, **TO_THE_TOP}, True),
    ({**LOCAL, **LOOPBACK}, {**LOCAL, **TO_THE_TOP}, False),
    ({**OFF, PEERS: ADDRESSES[1]}, {**OFF, **TO_THE_TOP}, False),
]
# With the longest time to an answer, s. A repetition takes a heartbeat and two ways, at most 0.2 s
# on the second link, and fails there with 1 - 0.8**3; 25 of them fail with 5e-8.
BAD = [
    (Weather(loss=0.05, delay=0.020, jitter=0.005, reorder=0.10), 1.0),
    (Weather(loss=0.20, delay=0.050, jitter=0.010, reorder=0.10), 5.0),
]


@pytest.fixture(scope="module")
def hosts():
    with two_hosts() as joined:
        yield joined


def running(host, domain, settings, *words):
    """Run a program on a host; a line that is written to it is answered by a line."""
    usual = programs.environment(domain).items()
    variables = {name: value for name, value in usual if name not in SETTINGS} | settings
    pipes = {"stdin": subprocess.PIPE, "stderr": None}
    return programs.running(host.words(*words), domain, env=variables, **pipes)


def top(host, domain, settings):
    return running(host, domain, settings, *command("top_node", *set_parameters()))


def ask(process, word):
    process.stdin.write(f"{word}\n")
    process.stdin.flush()
    return json.loads(process.stdout.readline())


def report_of(process, done):
    """The first report for which something holds."""
    return until(lambda: done(report := ask(process, "report")) and report)


def counted(report):
    return sum(samples["count"] for samples in report["samples"].values())


def most_lost(report):
    return max(samples["lost"] for samples in report["samples"].values())


def test_the_top_is_found_from_another_host_where_the_settings_say_so(hosts):
    here, there, _ = hosts
    with contextlib.ExitStack() as stack:
        asking = []
        for domain, (of_top, of_user, is_found) in enumerate(DISCOVERIES):
            stack.enter_context(top(here, domain, of_top))
            # six seconds are two announcements; what is to be found may take longer under load
            words = command("top_ctl", "--timeout", TIMEOUT if is_found else 6.0, "state")
            asking.append(stack.enter_context(running(there, domain, of_user, *words)))
        found = [process.wait(timeout=3 * TIMEOUT) == 0 for process in asking]
    assert found == [expected for *_, expected in DISCOVERIES]


@pytest.mark.parametrize(("weather", "longest"), BAD, ids=["5 %", "20 %"])
def test_on_a_link_that_loses_delays_and_reorders_no_message_is_missing(weather, longest, hosts):
    here, there, cable = hosts
    witness = bound([sys.executable, str(WITNESS)])
    with top(here, 10, LOSSY), running(there, 10, LOSSY, *witness) as user:
        ask(user, "kick")
        report_of(user, lambda report: len(report["samples"]) == 5)
        cable.weather = weather
        try:
            waits = [ask(user, "kick") for _ in range(40)]
            report_of(user, lambda report: counted(report) > 4000)
        finally:
            cable.weather = Weather()
        report = report_of(user, lambda report: report["events"] == ["start", *["kick"] * 41])
        assert cable.lost > 100
        assert max(waits) < longest
        assert not any(samples["unordered"] for samples in report["samples"].values())
        report_of(user, lambda report: most_lost(report) <= report["missed"])
