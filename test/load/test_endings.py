"""A killed test run leaves no program behind."""

import os
import signal
import subprocess
import sys
from pathlib import Path

import pytest
from waiting import until

from workshop.load.domains import claim_domain
from workshop.load.endings import SETPRIV

DOMAIN = claim_domain()
TEST = Path(__file__).parents[1]
TIMEOUT = 20.0
RUN = """
import sys
from programs import running_node
with running_node(int(sys.argv[1])) as node:
    print(node.pid, flush=True)
    sys.stdin.read()
"""


@pytest.mark.skipif(SETPRIV is None, reason="setpriv (util-linux) is not installed")
def test_a_node_ends_with_the_test_run_that_is_killed():
    path = os.pathsep.join([str(TEST), str(TEST / "load"), os.environ.get("PYTHONPATH", "")])
    run = subprocess.Popen(
        [sys.executable, "-c", RUN, str(DOMAIN)],
        env={**os.environ, "PYTHONPATH": path},
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        text=True,
    )
    node = Path("/proc", run.stdout.readline().strip())
    # A parent that dies before setpriv has asked for the signal is not noticed. While a process
    # becomes another program its command line is empty.
    until(lambda: (node / "cmdline").read_bytes().startswith(sys.executable.encode()))
    run.send_signal(signal.SIGKILL)
    run.wait(timeout=TIMEOUT)
    until(lambda: not node.is_dir())
    run.communicate(timeout=TIMEOUT)
