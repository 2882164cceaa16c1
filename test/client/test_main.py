"""top_ctl as a user types it, against a real top_node in another process."""

import json

import pytest
from programs import run, running_node

DOMAIN = 98


def ctl(*arguments):
    return run("top_ctl", *arguments, domain=DOMAIN)


@pytest.fixture(scope="module", autouse=True)
def node():
    with running_node(DOMAIN, "scene:=hurry_slow"):
        yield


def test_hurry_prints_the_verdict():
    assert ctl("reset").returncode == 0
    result = ctl("hurry")
    assert result.returncode == 0
    assert "precession 6.50 -> 9.10 rad/s (regular at 6.50 and 69.82)" in result.stdout
    assert result.stderr == ""


def test_start_kick_and_state_work_together():
    assert ctl("start", "theta=1.0", "psi_dot=150", "precession=slow").returncode == 0
    assert ctl("pause").returncode == 0
    assert "Perry's rule" in ctl("kick", "precession_rate=20").stdout
    state = json.loads(ctl("state", "--json").stdout)
    assert abs(state["euler_rates"]["phi"] - 20.0) < 1e-12  # rounding of psi' = 150 rad/s
    assert "kind" in ctl("state").stdout
    assert ctl("step", "duration=0.5").returncode == 0
    assert ctl("resume").returncode == 0


def test_a_refusal_is_one_line_and_status_1():
    result = ctl("kick", "precession_rat=9")
    assert result.returncode == 1
    assert result.stderr.startswith("top_ctl: field: got 'precession_rat', allowed is one of")
    assert result.stderr.count("\n") == 1


@pytest.mark.parametrize("arguments", [["fly"], ["kick", "precession_rate"], []])
def test_wrong_usage_is_status_2(arguments):
    result = ctl(*arguments)
    assert result.returncode == 2
    assert "Traceback" not in result.stderr


def test_a_node_that_is_not_there_is_told_after_the_time_out():
    result = ctl("--node", "/nobody", "--timeout", "1", "hurry")
    assert result.returncode == 1
    assert "no answer from /nobody within 1 s: is top_node running" in result.stderr
    assert result.stderr.count("\n") == 1


def test_watch_shows_the_motion():
    result = ctl("watch", "--seconds", "1")
    assert result.returncode == 0
    lines = result.stdout.splitlines()
    assert len(lines) >= 3
    assert all("theta" in line and "phi'" in line for line in lines)


@pytest.mark.parametrize("arguments", [["--help"], ["kick", "--help"]])
def test_help_is_answered(arguments):
    assert ctl(*arguments).returncode == 0
