import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from documents import ROOT, find_section
from programs import running
from waiting import until

from workshop.load import node_cost
from workshop.load.domains import claim_domain
from workshop.load.endings import SETPRIV
from workshop.load.listener import Traffic


@pytest.mark.long
def test_the_node_is_measured_and_compared_with_bare_ones(capsys, monkeypatch, tmp_path):
    monkeypatch.setattr(node_cost, "COST_RATES", (200.0,))
    monkeypatch.setattr(node_cost, "RATES", (500.0,))
    monkeypatch.setattr(node_cost, "KICKS", 10)
    (tmp_path / "README.md").touch()
    (docs := tmp_path / "docs").mkdir()
    page = docs / "reliability.md"
    page.write_text("<!-- figures: node cost --><!-- end of figures -->")
    kept = []
    write = node_cost.format_sections
    monkeypatch.setattr(node_cost, "format_sections", lambda each: kept.append(each) or write(each))
    assert node_cost.main(["--seconds", "1", "--runs", "1", "--docs", str(docs)]) == 0
    (facts,) = kept
    assert facts["count"] == 1
    cpu = facts["runs"][f"200 Hz: {node_cost.CPU}"]
    assert set(cpu) == set(node_cost.list_commands(""))
    assert all(0 < value < 200 for values in cpu.values() for value in values)
    assert all(0 < value < 1e4 for (value,) in facts["runs"][f"200 Hz: {node_cost.KICK}"].values())
    sections = write(facts)
    assert sections["node cost"] in capsys.readouterr().out
    assert find_section(page.read_text(), "node cost") == sections["node cost"]


def test_late_samples_and_jitter_are_counted_from_the_time_of_publishing():
    sent = np.array([0.0, 0.010, 0.020, 0.0305, 0.0605, 0.070])
    figures = node_cost.summarize(Traffic(sent, 1.0, cpu=0.003), 100.0, 0.07)
    assert figures[node_cost.LATE_SAMPLES] == pytest.approx(100 / 5)
    assert figures[node_cost.JITTER] == pytest.approx(20.0, rel=0.05)  # ms; p99 of five gaps
    assert figures[node_cost.CPU] == pytest.approx(100 * 0.003 / 0.07)


def test_lost_samples_are_late():
    sent = np.arange(100) * 0.01
    figures = node_cost.summarize(Traffic(sent, 0.75, cpu=0.0), 100.0, 1.0)
    assert figures[node_cost.LATE_SAMPLES] == pytest.approx(25.0)


DOMAIN = claim_domain()
RUN = """
import sys
from programs import running_node
with running_node(int(sys.argv[1])) as node:
    print(node.pid, flush=True)
    sys.stdin.read()
"""


@pytest.mark.slow
@pytest.mark.skipif(SETPRIV is None, reason="setpriv (util-linux) is not installed")
def test_a_node_ends_with_the_test_run_that_is_killed():
    path = os.pathsep.join([str(ROOT / "test"), os.environ.get("PYTHONPATH", "")])
    options = {"env": {**os.environ, "PYTHONPATH": path}, "stdin": subprocess.PIPE}
    with running([sys.executable, "-c", RUN, DOMAIN], DOMAIN, **options) as run:
        node = Path("/proc", run.stdout.readline().strip())
        # A parent that dies before setpriv has asked for the signal is not noticed. While a process
        # becomes another program its command line is empty.
        until(lambda: (node / "cmdline").read_bytes().startswith(sys.executable.encode()))
        run.kill()
        until(lambda: not node.is_dir())
