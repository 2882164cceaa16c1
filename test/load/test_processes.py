import subprocess
import time
from unittest.mock import Mock

import pytest
from programs import execute

from symtop_ros.client.connection import UnreachableError
from workshop.load import processes, usage


def run(work, *words):
    """Run a program that does some work, by default for a second."""
    return processes.run_program("load.py", "", 1.0, work, words)


@pytest.mark.parametrize("text", ["0", "-1", "nan", "inf", "1e7", "soon"])
def test_seconds_out_of_range_are_refused_as_usage(text, capsys):
    with pytest.raises(SystemExit) as stopped:
        run(Mock(), f"--seconds={text}")
    assert stopped.value.code == 2
    message = f"--seconds: must be more than 0 and at most 1e+06 s, got '{text}'"
    assert message in capsys.readouterr().err


def test_the_status_says_if_the_figures_are_good():
    assert run(lambda options: options.seconds == 1.0) == 0
    assert run(lambda _: False) == 1


def test_a_node_that_does_not_answer_is_one_line(capsys):
    assert run(Mock(side_effect=UnreachableError("no sample from /top within 30 s"))) == 1
    assert capsys.readouterr().err == "load.py: no sample from /top within 30 s\n"


def test_an_interrupt_is_status_130():
    assert run(Mock(side_effect=KeyboardInterrupt)) == 130


def test_the_resources_of_a_process_are_measured():
    with subprocess.Popen(["sleep", "30"]) as process:
        time.sleep(0.1)
        assert 0 <= usage.cpu_seconds(process.pid) < 0.1
        assert 0.1 < usage.memory(process.pid) < 100
        assert usage.descriptors(process.pid) >= 3
        process.terminate()


@pytest.mark.parametrize("name", ["stress", "soak", "node_cost"])
def test_a_load_program_explains_itself(name):
    pytest.importorskip("matplotlib")
    result = execute(processes.script(name, "--help"), check=True)
    assert f"usage: {name}.py" in result.stdout
    assert "--seconds" in result.stdout
