"""top_ctl as a user types it, also in a real terminal, against a top_node in another process."""

import json
import os
import pty
import re
import select
import signal
import subprocess
import sys
import time

import pytest
import rclpy
from programs import PATIENT, command, environment, run, running, running_node
from ros.node.listener import Listener
from std_srvs.srv import Trigger
from waiting import TIMEOUT, until

from symtop_ros.programs import BROKEN_PIPE
from symtop_ros.ros.client.connection import Connection, UnreachableError
from symtop_ros.ros.client.main import main, parse_values
from symtop_ros.ros.node.host import VARIABLES
from workshop.load.domains import claim_domain

DOMAIN = claim_domain()


pytestmark = pytest.mark.usefixtures("signals_as_before")


@pytest.fixture
def ctl(capsys, monkeypatch):
    """A function that runs a command of top_ctl in this process."""
    monkeypatch.setenv("ROS_DOMAIN_ID", str(DOMAIN))

    def call(*words):
        return subprocess.CompletedProcess(words, main([*PATIENT, *words]), *capsys.readouterr())

    return call


@pytest.fixture(scope="module", autouse=True)
def node():
    with running_node(DOMAIN, "scene:=hurry_slow"):
        yield


@pytest.mark.slow
@pytest.mark.wording
def test_hurry_prints_the_verdict(ctl):
    assert ctl("start").returncode == 0
    result = run("top_ctl", *PATIENT, "hurry", domain=DOMAIN)
    assert result.returncode == 0
    assert "precession 6.50 -> 9.10 rad/s, spin rate held; the axis moves up." in result.stdout
    assert result.stderr == ""


@pytest.mark.slow
@pytest.mark.wording
def test_start_kick_and_state_work_together(ctl):
    assert ctl("start", "theta=1.0", "psi_dot=150", "precession=slow").returncode == 0
    assert ctl("pause").returncode == 0
    assert "Perry's rule" in ctl("kick", "precession_rate=20").stdout
    state = json.loads(ctl("state", "--json").stdout)
    assert abs(state["euler_rates"]["phi"] - 20.0) < 1e-12  # rounding of psi' = 150 rad/s
    assert ctl("step", "duration=0.5").returncode == 0
    assert ctl("resume").returncode == 0


def test_a_state_has_its_stamp_to_the_nanosecond(ctl):
    def ask():
        state = json.loads(ctl("state", "--json").stdout)
        return state["sec"] * 10**9 + state["nanosec"]

    before = ask()
    shown = re.search(r"^stamp +(\d+)\.(\d{9})$", ctl("state").stdout, re.MULTILINE)
    assert before < int(shown[1] + shown[2]) < ask()


@pytest.mark.slow
def test_a_factor_may_follow_hurry_and_delay(ctl):
    for word, factor in (("hurry", 1.25), ("delay", 1 / 1.25)):
        assert ctl("start").returncode == 0
        assert ctl("pause").returncode == 0
        before = json.loads(ctl("state", "--json").stdout)["euler_rates"]["phi"]
        assert ctl(word, "1.25").returncode == 0
        after = json.loads(ctl("state", "--json").stdout)["euler_rates"]["phi"]
        assert after == pytest.approx(factor * before, rel=1e-13)
        assert ctl("resume").returncode == 0
    assert ctl("delay").returncode == 0


def test_a_name_of_no_start_is_refused_before_a_node_is_looked_for(ctl):
    result = main(["--node", "/missing", "start", "thetta=0.5"])
    assert result == 1
    result = ctl("start", "thetta=0.5")
    assert result.returncode == 1
    assert result.stderr.startswith("top_ctl: field name must be one of theta, phi, ")
    assert result.stderr.endswith("(the nearest is theta), got 'thetta'\n")


@pytest.mark.slow
def test_a_hand_holds_the_precession_and_lets_it_go(ctl):
    assert ctl("start", "theta=0.5", "psi_dot=200").returncode == 0
    assert ctl("clamp", "on").stdout.startswith("Clamped, the axle falls as if ")
    assert ctl("clamp", "on").stdout.startswith("the precession is held already [event ")
    refused = ctl("hurry")
    assert refused.stderr.startswith(
        "top_ctl: kick must come while the precession is free, got it held: "
    )
    assert json.loads(ctl("state", "--json").stdout)["clamped"]
    assert ctl("clamp", "off").stdout.startswith("Let go. ")


@pytest.mark.slow
def test_two_nodes_of_one_name_are_named_next_to_the_answer(ctl):
    with Listener(DOMAIN) as listener:
        names = listener.node.get_fully_qualified_node_names
        with running_node(DOMAIN, "scene:=hurry_slow"):
            listener.spin_until(lambda: names().count("/top") == 2)
            result = until(lambda: (answer := ctl("state")).stderr and answer)
        listener.spin_until(lambda: names().count("/top") == 1)
    assert result.returncode == 0
    assert "kind" in result.stdout
    assert result.stderr.startswith("top_ctl: 2 nodes have the name /top")


def test_a_refusal_is_one_line_and_status_1(ctl):
    result = ctl("kick", "precession_rat=9")
    assert result.returncode == 1
    assert result.stderr.startswith("top_ctl: field name must be one of precession_rate,")
    assert result.stderr.count("\n") == 1


@pytest.mark.slow
def test_watch_shows_the_motion():
    with running(command("top_ctl", *PATIENT, "watch"), DOMAIN) as watching:
        lines = [watching.stdout.readline() for _ in range(3)]
        watching.send_signal(signal.SIGINT)
        assert watching.wait(timeout=TIMEOUT) == 0
    assert all("theta" in line and "phi'" in line for line in lines)


@pytest.mark.slow
def test_watch_ends_after_some_seconds_of_which_it_shows_one_line_at_least(ctl):
    result = ctl("watch", "--seconds", "0.01")
    assert result.returncode == 0
    assert "theta" in result.stdout.splitlines()[0]


# A process that ends without a word is known to its peers for an hour.
LONG_LEASE = """
<profiles xmlns="http://www.eprosima.com">
  <participant profile_name="hour" is_default_profile="true">
    <rtps><builtin><discovery_config>
      <leaseDuration><sec>3600</sec></leaseDuration>
    </discovery_config></builtin></rtps>
  </participant>
</profiles>
"""


@pytest.mark.slow
def test_the_others_know_that_it_is_gone_before_its_lease_ends(tmp_path):
    """Else they would send to it until then, by default for 20 s."""
    profile = tmp_path / "hour.xml"
    profile.write_text(LONG_LEASE)
    leased = {**environment(DOMAIN), **dict.fromkeys(VARIABLES, str(profile))}
    words = command("top_ctl", *PATIENT, "watch")
    with Listener(DOMAIN) as listener, running(words, DOMAIN, env=leased) as watching:
        listener.spin_until(lambda: "top_ctl" in listener.node.get_node_names())
        watching.send_signal(signal.SIGINT)
        assert watching.wait(timeout=TIMEOUT) == 0
        listener.spin_until(lambda: "top_ctl" not in listener.node.get_node_names())


@pytest.mark.parametrize(("verb", "unbuffered"), [("state", ""), ("state", "1"), ("watch", "")])
def test_if_nobody_reads_the_output_it_ends_in_silence_as_by_sigpipe(verb, unbuffered):
    settings = {**environment(DOMAIN), "PYTHONUNBUFFERED": unbuffered}
    reading, writing = os.pipe()
    os.close(reading)
    with os.fdopen(writing, "wb") as closed:
        words = command("top_ctl", *PATIENT, verb)
        pipes = {"stdout": closed, "stderr": subprocess.PIPE}
        result = subprocess.run(words, env=settings, check=False, **pipes)
    assert (result.returncode, result.stderr) == (BROKEN_PIPE, b"")


class Terminal:
    """A program in a separate terminal."""

    def __init__(self, *words):
        self._descriptor, inner = pty.openpty()
        words = command("top_ctl", *PATIENT, *words)
        options = {"env": environment(DOMAIN), "start_new_session": True}
        options |= dict.fromkeys(("stdin", "stdout", "stderr"), inner)
        self.process = subprocess.Popen(words, **options)
        os.close(inner)
        self.seen = ""

    def press(self, keys):
        os.write(self._descriptor, keys.encode())

    def wait_for(self, text):
        """Read until a text appears after what was read before; return what was read."""
        read = ""
        deadline = time.monotonic() + TIMEOUT
        while text not in read:
            assert time.monotonic() < deadline, f"no {text!r} in {read!r}"
            if select.select([self._descriptor], [], [], 0.1)[0]:
                read += os.read(self._descriptor, 4096).decode()
        self.seen += read
        return read

    def end(self):
        status = self.process.wait(timeout=TIMEOUT)
        os.close(self._descriptor)
        return status


@pytest.mark.wording
def test_each_key_sends_its_request(ctl):
    assert ctl("start").returncode == 0
    terminal = Terminal("keys")
    terminal.wait_for("quit")
    for key, answer in (
        ("h", "h: At this instant: precession 6.50 -> 9.10 rad/s, spin rate held; the axis moves"),
        ("d", "d: At this instant: precession"),
        (" ", "space: paused at"),
        ("r", "r: "),
        ("\x1b[A", "up: "),
        ("\x1b[C", "right: At this instant: precession 6.50 -> 7.50 rad/s"),
        ("\x1b[D", "left: At this instant: precession 7.50 -> 6.50 rad/s"),
        ("\x1b[B", "down: "),
        (" ", "space: resumed at"),
    ):
        terminal.press(key)
        assert "refused" not in terminal.wait_for(answer)
    terminal.press("xq")
    assert terminal.end() == 0


@pytest.mark.parametrize(("words", "shown"), [(("keys",), "quit"), (("watch",), "theta")])
def test_ctrl_c_ends_it_silently(words, shown):
    terminal = Terminal(*words)
    terminal.wait_for(shown)
    os.killpg(terminal.process.pid, signal.SIGINT)
    assert terminal.end() == 0
    assert "interrupted" not in terminal.seen


def test_without_a_terminal_it_is_refused_in_one_line(ctl):
    result = ctl("keys")
    assert result.returncode == 1
    assert "standard input must be a terminal for keys, got a file or a pipe" in result.stderr
    assert result.stderr.count("\n") == 1


def test_a_service_that_does_not_answer_is_reported_after_the_time_out():
    with Listener(DOMAIN, "user") as user:
        silent = rclpy.create_node("silent", context=user.context)  # it is never spun
        silent.create_service(Trigger, "~/reset", lambda _, response: response)
        # Found first: else a short time-out may end before the service is seen.
        user.spin_until(user.node.create_client(Trigger, "/silent/reset").service_is_ready)
        with pytest.raises(UnreachableError, match=r"/silent/reset did not answer within 0\.2 s"):
            Connection(user.node, "/silent", timeout=0.2).request("reset")


def test_a_harmless_question_is_answered_before_the_first_request_to_a_service():
    asked = []

    def note(name):
        return lambda _, response: asked.append(name) or response

    with Listener(DOMAIN, "user") as user:
        top = rclpy.create_node("top", context=user.context)
        for name in ("get_state", "reset"):
            top.create_service(Trigger, f"~/{name}", note(name))
        connection = Connection(user.node, timeout=300.0)
        connection._executor.add_node(top)
        for _ in range(2):
            connection.request("reset")
        connection.close()
    assert asked == ["get_state", "reset", "reset"]


def test_words_become_numbers_lists_and_text():
    words = ["a=9", "b=-1e-3", "c=0,0,1e-4", "d=[1, 2]", "e=slow", "f=9_1"]
    numbers = {"a": 9.0, "b": -1e-3, "c": [0.0, 0.0, 1e-4], "d": [1.0, 2.0]}
    assert parse_values(words) == {**numbers, "e": "slow", "f": "9_1"}


def test_it_is_imported_where_there_are_no_terminals():
    """As on Windows: only `top_ctl keys` needs them."""
    code = (
        "import sys; sys.modules.update(termios=None, tty=None); import symtop_ros.ros.client.main"
    )
    subprocess.run([sys.executable, "-c", code], check=True)
