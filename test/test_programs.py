import builtins
import os
import signal
import sys

import pytest

from symtop_ros import programs
from workshop import main as report

pytestmark = pytest.mark.usefixtures("signals_as_before")


@pytest.fixture(autouse=True)
def _environment_as_before(monkeypatch):
    monkeypatch.setenv(programs.TRANSPORTS, "")
    monkeypatch.setattr(programs, "_leave", lambda status: status)


ROS = "source a ROS 2, or pip install '.[ros]' in the checkout"


@pytest.mark.parametrize(
    ("program", "missing", "remedy"),
    [
        (programs.top_node, "rclpy", ROS),
        (programs.top_ctl, "rclpy", ROS),
        (programs.top_live, "rclpy", ROS),
        (programs.top_live, "rerun", "pip install '.[playback]' in the checkout"),
        (programs.top_panel, "yaml", "pip install pyyaml"),
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
    monkeypatch.setattr(sys, "argv", [program.__name__])
    assert program() == 1
    assert f"{missing} is missing: {remedy}" in capsys.readouterr().err


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_a_signal_is_status_130_after_the_program_has_tidied_up(number, monkeypatch):
    tidied = []

    def main():
        try:
            signal.raise_signal(number)
        finally:
            tidied.append(number)

    monkeypatch.setattr(report, "main", main)
    assert programs.run("workshop", "workshop.main", interruptible=True) == 130
    assert tidied == [number]


@pytest.mark.parametrize(
    ("chosen", "transports"),
    [
        ({}, "UDPv4"),
        ({programs.TRANSPORTS: "DEFAULT"}, "DEFAULT"),
        ({"FASTDDS_DEFAULT_PROFILES_FILE": "mine.xml"}, ""),
        ({"FASTRTPS_DEFAULT_PROFILES_FILE": "mine.xml"}, ""),
    ],
)
def test_top_ctl_uses_udp_unless_the_user_has_chosen(chosen, transports, monkeypatch):
    monkeypatch.setattr(programs, "run", lambda *_: 0)
    for name in ("FASTDDS_DEFAULT_PROFILES_FILE", "FASTRTPS_DEFAULT_PROFILES_FILE"):
        monkeypatch.delenv(name, raising=False)
    for name, value in chosen.items():
        monkeypatch.setenv(name, value)
    assert programs.top_ctl() == 0
    assert os.environ[programs.TRANSPORTS] == transports
