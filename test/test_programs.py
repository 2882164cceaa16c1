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


ROS = "source a ROS 2, or pip install 'symtop_ros[ros]'"


@pytest.mark.parametrize(
    ("program", "missing", "remedy"),
    [
        (programs.top_node, "rclpy", ROS),
        (programs.top_ctl, "rclpy", ROS),
        (programs.top_live, "rclpy", ROS),
        (programs.top_live, "rerun", "pip install 'symtop_ros[playback]'"),
        (programs.top_replay, "mcap", "pip install mcap"),
    ],
)
def test_a_program_says_what_is_missing(program, missing, remedy, monkeypatch, capsys):
    original = builtins.__import__

    def without(name, *rest):
        if name.split(".")[0] == missing:
            raise ModuleNotFoundError(name=missing)
        return original(name, *rest)

    for name in [name for name in sys.modules if name.startswith("symtop_ros.")]:
        if name not in ("symtop_ros.programs",) and ".physics" not in name:
            monkeypatch.delitem(sys.modules, name)
    monkeypatch.setattr(builtins, "__import__", without)
    assert program() == 1
    assert f"{missing} is missing: {remedy}" in capsys.readouterr().err
