"""Command lines that are none: status 1 and a line, or status 2 and the usage; no traceback."""

import pytest
from odd_values import CONTROL, assert_one_sentence
from programs import run as run_program

from symtop_ros.client import main as client
from symtop_ros.live import main as live
from symtop_ros.playback import main as playback
from symtop_ros.report import main as report

DOMAIN = 95
LONG = "x" * 100_000
BYTES = "\udcff\udcfe"  # what Python makes of bytes that are no text
MAINS = {
    "top_ctl": client.main,
    "top_live": live.main,
    "top_replay": playback.main,
    "top_report": report.main,
}
FAILED = [
    ("top_ctl", "--ros-args", "-p", "bad"),
    ("top_ctl", "--ros-args", "--remap"),
    ("top_ctl", "--node", CONTROL, "hurry"),
    ("top_ctl", "--node", LONG, "hurry"),
    ("top_ctl", "--node", BYTES, "hurry"),
    ("top_ctl", "--node", "", "hurry"),
    ("top_ctl", "kick", f"{BYTES}=1"),
    ("top_ctl", "--node", "/nobody", "--timeout", "1e-9", "kick", f"{CONTROL}={CONTROL}"),
    ("top_ctl", "--node", "/nobody", "--timeout", "1e-9", "kick", "angular_impulse=nan,inf,1e999"),
    ("top_live", "--ros-args", "-p", "bad"),
    ("top_live", "--ros-args", "--remap"),
    ("top_live", "--node", BYTES),
    ("top_replay", CONTROL),
    ("top_replay", LONG, "--check"),
    ("top_replay", "/dev/null", "--repair", "/dev/null/x"),
    ("top_replay", BYTES),
]
MISUSED = [
    ("top_ctl", "kick", CONTROL),
    ("top_ctl", "kick", LONG),
    ("top_ctl", "kick", f"{CONTROL}=1", f"{CONTROL}=2"),
]
UNREADABLE = [
    ("top_ctl",),
    ("top_ctl", CONTROL),
    ("top_ctl", "--timeout", "nan", "hurry"),
    ("top_ctl", "--timeout", "-inf", "hurry"),
    ("top_ctl", "watch", "--seconds", "0"),
    ("top_live", "--port", "65536"),
    ("top_live", "--port", "-1"),
    ("top_live", "--port", "9" * 5000),
    ("top_replay",),
    ("top_replay", "a", "b"),
    ("top_report", "--node", "--seconds", "inf"),
    ("top_report", "--node", "--seconds", "nan"),
    ("top_report", "--map", "--points", "1000000"),
    ("top_report", "--points", CONTROL),
]


def status_and_lines(capsys, name, *arguments):
    status = MAINS[name](list(arguments))
    return status, capsys.readouterr().err.splitlines()


@pytest.mark.parametrize("arguments", FAILED, ids=range(len(FAILED)))
def test_what_cannot_be_done_is_status_1_and_one_line(arguments, capsys, monkeypatch):
    monkeypatch.setenv("ROS_DOMAIN_ID", str(DOMAIN))
    status, (line,) = status_and_lines(capsys, *arguments)
    assert status == 1
    assert line.startswith(f"{arguments[0]}: ")
    assert_one_sentence(line)


@pytest.mark.parametrize("arguments", MISUSED, ids=range(len(MISUSED)))
def test_values_that_are_not_allowed_are_status_2_and_one_line(arguments, capsys):
    status, (line,) = status_and_lines(capsys, *arguments)
    assert status == 2
    assert_one_sentence(line)


@pytest.mark.parametrize("arguments", UNREADABLE, ids=range(len(UNREADABLE)))
def test_words_that_cannot_be_read_are_status_2_and_the_usage(arguments, capsys):
    with pytest.raises(SystemExit) as end:
        MAINS[arguments[0]](list(arguments[1:]))
    assert end.value.code == 2
    assert capsys.readouterr().err.startswith(f"usage: {arguments[0]}")


@pytest.mark.parametrize("name", list(MAINS))
def test_help_is_status_0(name, capsys):
    with pytest.raises(SystemExit) as end:
        MAINS[name](["--help"])
    assert end.value.code == 0
    assert capsys.readouterr().out.startswith(f"usage: {name}")


def test_parameter_files_that_are_none_end_the_node_with_one_line(tmp_path):
    path = tmp_path / "odd.yaml"
    head = "/**:\n  ros__parameters:\n"
    for content in (
        head + "    a: &a 1.0\n    top: {Ix: *a}\n",
        head + "    x: " + "[" * 10_000,
        head + "    initial: {orientation: [1.0, a]}\n",
        head + "    initial: {orientation: 5}\n",
        "\0\1\2",
    ):
        path.write_text(content)
        result = run_program("top_node", "--ros-args", "--params-file", str(path), domain=DOMAIN)
        assert result.returncode == 1
        told = [line for line in result.stderr.splitlines() if line.startswith("top_node: ")]
        assert len(told) == 1
        assert_one_sentence(told[0])
        assert "Traceback" not in result.stderr
