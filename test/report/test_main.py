import numpy as np
import pytest

from symtop_ros.physics import State, Top, motion
from symtop_ros.report import main as report
from symtop_ros.report.peer import derivative


def test_the_report_prints_costs_and_ratios(capsys, monkeypatch):
    monkeypatch.setattr(report, "REPEATS", 1)
    monkeypatch.setattr(report, "SPANS", (0.1,))
    assert report.main(["--states", "100"]) == 0
    printed = capsys.readouterr().out
    assert "cusps" in printed
    assert "DOP853" in printed


def test_no_states_are_refused(capsys):
    assert report.main(["--states", "0"]) == 2
    assert "--states: got 0, allowed is 1 or more" in capsys.readouterr().err


def test_the_load_of_the_node_is_measured(capsys):
    assert report.main(["--node", "--seconds", "1"]) == 0
    rates = capsys.readouterr().out.splitlines()[1:]
    assert [line.split()[0] for line in rates] == ["200", "200", "1000", "1000"]
    assert ["recording" in line for line in rates] == [False, True, False, True]
    for line in rates:
        assert 0 < float(line.split()[2].rstrip("%")) <= 100  # of the samples
        assert float(line.split()[3].rstrip("%")) > 0


@pytest.mark.parametrize("theta", [0.0, 0.5, 3.0])
def test_the_peer_integrates_the_same_top(theta):
    top = Top(0.0002, 0.0003, -0.05)
    path = motion(top, State.from_euler(theta=theta, theta_dot=2.0, phi_dot=3.0, psi_dot=50.0))
    h = 1e-4
    ahead, behind = (np.concatenate(list(path.at(t))) for t in (h, -h))
    slope = derivative(0.0, np.concatenate(list(path.start)), *top.moments)
    # central difference: h^2/6 times a third derivative of order 50^3, times angular velocity
    np.testing.assert_allclose((ahead - behind) / (2 * h), slope, atol=h**2 * 50**4)
