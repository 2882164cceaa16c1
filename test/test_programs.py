import builtins
import signal
import sys

import pytest

from symtop_ros import programs


@pytest.fixture(autouse=True)
def _signals_as_before():
    before = {number: signal.getsignal(number) for number in (signal.SIGINT, signal.SIGTERM)}
    yield
    for number, handler in before.items():
        signal.signal(number, handler)


@pytest.mark.parametrize("program", [programs.top_node, programs.top_ctl, programs.top_live])
def test_without_ros_a_program_says_what_is_missing(program, monkeypatch, capsys):
    original = builtins.__import__

    def without_ros(name, *rest):
        if name.split(".")[0] == "rclpy":
            raise ModuleNotFoundError(name=name)
        return original(name, *rest)

    for name in [name for name in sys.modules if name.startswith("symtop_ros.")]:
        if name not in ("symtop_ros.programs",) and ".physics" not in name:
            monkeypatch.delitem(sys.modules, name)
    monkeypatch.setattr(builtins, "__import__", without_ros)
    assert program() == 1
    told = capsys.readouterr().err
    assert "rclpy is missing: source a ROS 2, or pip install 'symtop_ros[ros]'" in told
