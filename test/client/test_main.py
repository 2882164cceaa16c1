"""top_ctl as a user types it, against a real top_node in another process."""

import json
import os
import signal
import subprocess
import time

import pytest
from node.listener import Listener
from programs import PATIENT, command, environment, run, running_node
from waiting import until

from symtop_ros.programs import BROKEN_PIPE
from workshop.load.domains import claim_domain

DOMAIN = claim_domain()


def ctl(*arguments):
    return run("top_ctl", *PATIENT, *arguments, domain=DOMAIN)


@pytest.fixture(scope="module", autouse=True)
def node():
    with running_node(DOMAIN, "scene:=hurry_slow"):
        yield


@pytest.mark.wording
def test_hurry_prints_the_verdict():
    assert ctl("reset").returncode == 0
    result = ctl("hurry")
    assert result.returncode == 0
    assert "Precession 6.50 -> 9.10 rad/s. The top rises" in result.stdout
    assert result.stderr == ""


@pytest.mark.wording
def test_start_kick_and_state_work_together():
    assert ctl("start", "theta=1.0", "psi_dot=150", "precession=slow").returncode == 0
    assert ctl("pause").returncode == 0
    assert "Perry's rule" in ctl("kick", "precession_rate=20").stdout
    state = json.loads(ctl("state", "--json").stdout)
    assert abs(state["euler_rates"]["phi"] - 20.0) < 1e-12  # rounding of psi' = 150 rad/s
    assert "kind" in ctl("state").stdout
    assert ctl("step", "duration=0.5").returncode == 0
    assert ctl("resume").returncode == 0


def test_two_nodes_of_one_name_are_named_next_to_the_answer():
    with running_node(DOMAIN, "scene:=hurry_slow"):
        result = until(lambda: (answer := ctl("state")).stderr and answer)
        assert result.returncode == 0
        assert result.stderr.startswith("top_ctl: 2 nodes have the name /top")
    with Listener(DOMAIN) as listener:  # until the second one is gone
        names = listener.node.get_fully_qualified_node_names
        listener.spin_until(lambda: names().count("/top") == 1)


def test_a_refusal_is_one_line_and_status_1():
    result = ctl("kick", "precession_rat=9")
    assert result.returncode == 1
    assert result.stderr.startswith("top_ctl: field name must be one of precession_rate,")
    assert result.stderr.count("\n") == 1


def test_watch_shows_the_motion():
    result = ctl("watch", "--seconds", "1")
    assert result.returncode == 0
    lines = result.stdout.splitlines()
    assert len(lines) >= 3
    assert all("theta" in line and "phi'" in line for line in lines)


def test_the_others_know_at_once_that_it_is_gone():
    """Else they would send to it until its lease ends, 20 s later."""
    words = command("top_ctl", "watch")
    with (
        Listener(DOMAIN) as listener,
        subprocess.Popen(words, stdout=subprocess.DEVNULL, env=environment(DOMAIN)) as watching,
    ):
        listener.spin_until(lambda: "top_ctl" in listener.node.get_node_names())
        watching.send_signal(signal.SIGINT)
        assert watching.wait(timeout=60) == 0
        ended = time.monotonic()
        listener.spin_until(lambda: "top_ctl" not in listener.node.get_node_names())
        assert time.monotonic() - ended < 10  # half of the lease


@pytest.mark.parametrize(("verb", "unbuffered"), [("state", ""), ("state", "1"), ("watch", "")])
def test_if_nobody_reads_the_output_it_ends_in_silence_as_by_sigpipe(verb, unbuffered):
    settings = {**environment(DOMAIN), "PYTHONUNBUFFERED": unbuffered}
    reading, writing = os.pipe()
    os.close(reading)
    with os.fdopen(writing, "wb") as closed:
        words, pipes = command("top_ctl", verb), {"stdout": closed, "stderr": subprocess.PIPE}
        result = subprocess.run(words, env=settings, check=False, **pipes)
    assert (result.returncode, result.stderr) == (BROKEN_PIPE, b"")
