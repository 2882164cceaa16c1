"""Domains are held by one process at a time; who finds none free waits for one."""

import subprocess
import sys
import threading

import pytest

from workshop.load import domains

# A process that holds domain 7 of a folder until its input ends.
HOLDER = """
import sys
from pathlib import Path
from workshop.load import domains
domains.FOLDER, domains.DOMAINS = Path(sys.argv[1]), (7,)
print(domains.claim_domain(), flush=True)
sys.stdin.read()
"""


@pytest.fixture(autouse=True)
def _one_domain(monkeypatch, tmp_path):
    monkeypatch.setattr(domains, "FOLDER", tmp_path)
    monkeypatch.setattr(domains, "DOMAINS", (7,))
    monkeypatch.setattr(domains, "_held", {})


@pytest.fixture
def holder(tmp_path):
    pipes = {"stdin": subprocess.PIPE, "stdout": subprocess.PIPE, "text": True}
    with subprocess.Popen([sys.executable, "-c", HOLDER, str(tmp_path)], **pipes) as process:
        assert process.stdout.readline() == "7\n"
        yield process


def test_a_domain_is_waited_for_until_its_process_ends(holder):
    found = []
    waiting = threading.Thread(target=lambda: found.append(domains.claim_domain()))
    waiting.start()
    assert found == []
    holder.communicate()
    waiting.join(domains.TIMEOUT)
    assert found == [7]
    domains.release_domain(7)


def test_if_none_is_released_it_is_said(holder, monkeypatch):
    monkeypatch.setattr(domains, "TIMEOUT", 0.0)
    with pytest.raises(RuntimeError, match="all 1 domains are held"):
        domains.claim_domain()


def test_a_released_domain_is_claimed_again():
    for _ in range(2):
        assert domains.claim_domain() == 7
        domains.release_domain(7)
