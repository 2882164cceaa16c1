"""top_ctl keys in a real terminal, against a real top_node in another process."""

import os
import pty
import select
import signal
import subprocess
import time

import pytest
from programs import PATIENT, command, environment, run, running_node

from workshop.load.domains import claim_domain

DOMAIN = claim_domain()
TIMEOUT = 60.0


@pytest.fixture(scope="module", autouse=True)
def node():
    with running_node(DOMAIN, "scene:=hurry_slow"):
        yield


class Terminal:
    """A program in a separate terminal."""

    def __init__(self, *words):
        self._descriptor, inner = pty.openpty()
        self.process = subprocess.Popen(
            command("top_ctl", *PATIENT, *words),
            stdin=inner,
            stdout=inner,
            stderr=inner,
            env=environment(DOMAIN),
            start_new_session=True,
        )
        os.close(inner)
        self.seen = ""

    def press(self, keys):
        os.write(self._descriptor, keys.encode())

    def wait_for(self, text):
        """Read until a text appears after what was read before; return what was read."""
        read, deadline = "", time.monotonic() + TIMEOUT
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
def test_each_key_sends_its_request():
    terminal = Terminal("keys")
    terminal.wait_for("quit")
    for key, answer in (
        ("h", "h: Precession 6.50 -> 9.10 rad/s. The top rises"),
        ("d", "d: Precession"),
        (" ", "space: paused at"),
        ("r", "r: "),
        ("\x1b[A", "up: "),
        ("\x1b[C", "right: Precession 6.50 -> 7.50 rad/s"),
        ("\x1b[D", "left: Precession 7.50 -> 6.50 rad/s"),
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


def test_without_a_terminal_it_is_refused_in_one_line():
    result = run("top_ctl", "keys", domain=DOMAIN)
    assert result.returncode == 1
    assert "standard input must be a terminal for keys, got a file or a pipe" in result.stderr
    assert result.stderr.count("\n") == 1
