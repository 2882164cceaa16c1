from unittest.mock import Mock

import pytest
from programs import execute

from workshop.load import processes


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


@pytest.mark.parametrize("name", ["stress", "soak", "node_cost"])
def test_a_load_program_explains_itself(name):
    pytest.importorskip("matplotlib")
    result = execute(processes.script(name, "--help"), check=True)
    assert f"usage: {name}.py" in result.stdout
    assert "--seconds" in result.stdout
