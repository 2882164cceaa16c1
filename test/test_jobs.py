"""The jobs that a fork can run: their steps are scripts, of which some run here."""

import os
import re
import sys
from pathlib import Path

import pytest
import yaml
from documents import ROOT
from programs import environment, execute

from workshop.load.domains import claim_domain, release_domain

WORKFLOWS = sorted((ROOT / ".github/workflows").iterdir())
SCRIPTS = ("ubuntu", "jazzy")


def read_jobs():
    return {
        name: job
        for path in WORKFLOWS
        for name, job in yaml.safe_load(path.read_text())["jobs"].items()
    }


def list_steps(script):
    """The steps that a script knows: each is a function, and named in the last `case`."""
    text = (ROOT / ".ci" / script).read_text()
    (case,) = re.findall(r"^  ([\w |]+)\) \"\$1\" ;;$", text, re.MULTILINE)
    named = case.split(" | ")
    functions = re.findall(r"^(\w+)\(\) \{", text, re.MULTILINE)
    assert {*named} <= {*functions}
    return named


def test_the_jobs_run_steps_of_scripts_that_there_are_in_their_order():
    jobs = read_jobs()
    assert tuple(jobs) == SCRIPTS
    for name, job in jobs.items():
        uses, *runs = job["steps"]
        assert uses == {"uses": "actions/checkout@v4"}
        words = [each["run"].split() for each in runs]
        assert words == [[f".ci/{name}", step] for step in list_steps(name)]
        assert os.access(ROOT / ".ci" / name, os.X_OK)
    assert jobs["jazzy"]["container"] == "ros:jazzy"


@pytest.mark.parametrize("script", SCRIPTS)
def test_a_step_that_there_is_not_is_named_with_those_that_there_are(script):
    done = execute([ROOT / ".ci" / script, "fly"])
    usage = f"usage: {ROOT / '.ci' / script} {'|'.join(list_steps(script))}\n"
    assert (done.returncode, done.stdout) == (2, usage)


@pytest.mark.slow
@pytest.mark.skipif(Path("/opt/ros").exists(), reason="the scripts would take the ROS of apt")
def test_a_workspace_is_built_and_its_node_records(tmp_path):
    """In the place of the container the wheels of PyPI."""
    domain = claim_domain()
    variables = {
        **environment(domain),
        "WORKSPACE": str(tmp_path),
        "PATH": f"{Path(sys.executable).parent}:{os.environ['PATH']}",
        # colcon's script does not quote the Python that it calls: its path may have a blank
        "COLCON_PYTHON_EXECUTABLE": str(tmp_path / "python"),
    }
    (tmp_path / "python").symlink_to(sys.executable)
    try:
        for step in ("build", "record"):
            done = execute([ROOT / ".ci/jazzy", step], env=variables, timeout=300)
            assert done.returncode == 0, done.stdout + done.stderr
    finally:
        release_domain(domain)
    assert "samples, largest difference 0" in done.stdout
