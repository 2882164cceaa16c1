"""Invalid command lines: status 1 and a line, or status 2 and the usage; no traceback."""

import pytest
from odd_values import CONTROL, assert_one_sentence
from programs import run as run_program

from symtop_ros.client import main as client
from symtop_ros.imu import main as imu
from symtop_ros.judge import main as judge
from symtop_ros.live import main as live
from symtop_ros.models import main as models
from symtop_ros.panel import main as panel
from symtop_ros.playback import main as playback
from workshop import main as workshop_main
from workshop.load.domains import claim_domain

DOMAIN = claim_domain()
LONG = "x" * 100_000
BYTES = "\udcff\udcfe"  # what Python makes of bytes that are no text
HEAD = "/**:\n  ros__parameters:\n"
MAINS = {
    "top_ctl": client.main,
    "top_live": live.main,
    "top_panel": panel.main,
    "top_replay": playback.main,
    "workshop": workshop_main.main,
    "top_model": models.main,
    "top_judge": judge.main,
    "top_imu": imu.main,
}
FAILED = [
    ("top_ctl", "--ros-args", "-p", "bad"),
    ("top_ctl", "--ros-args", "--remap"),
    ("top_ctl", "--node", CONTROL, "hurry"),
    ("top_ctl", "--node", LONG, "hurry"),
    ("top_ctl", "--node", BYTES, "hurry"),
    ("top_ctl", "--node", "", "hurry"),
    ("top_ctl", "kick", f"{BYTES}=1"),
    ("top_ctl", "--node", "/missing", "--timeout", "1e-9", "kick", f"{CONTROL}={CONTROL}"),
    ("top_ctl", "--node", "/missing", "--timeout", "1e-9", "kick", "angular_impulse=nan,inf,1e999"),
    ("top_live", "--ros-args", "-p", "bad"),
    ("top_live", "--ros-args", "--remap"),
    ("top_live", "--node", BYTES),
    ("top_panel", "--host", "192.0.2.1", "--port", "0"),  # TEST-NET: of no machine
    ("top_panel", "--host", CONTROL, "--port", "0"),
    ("top_panel", "--node", "/top", "--ros-args", "-p", "bad"),
    ("top_panel", "--node", BYTES),
    ("top_panel", "--write", CONTROL),
    ("top_panel", "--write", f"{LONG}.html"),
    ("top_replay", "/dev/null", "--mcap", "/dev/null/x.mcap"),
    ("top_replay", "/dev/null", "--mcap", f"{BYTES}.mcap"),
    ("top_replay", "/dev/null/run.json", "--save", "a.html"),
    ("top_replay", "/dev/null/run.json", "--mcap", "a.mcap", "--rate", "nan"),
    ("top_replay", CONTROL),
    ("top_replay", LONG, "--check"),
    ("top_replay", "/dev/null", "--repair", "/dev/null/x"),
    ("top_replay", BYTES),
    ("top_replay", "a", "b"),
    ("top_replay", "a", "b", "--repair", "c.mcap"),
    ("top_judge", CONTROL, "--topic", CONTROL),
    ("top_judge", LONG, "--topic", LONG),
    ("top_judge", BYTES, "--topic", BYTES),
    ("top_judge", "/dev/null", "--estimates", "/dev/null/x.csv"),
    ("top_judge", "--testset", CONTROL, "x.csv"),
    ("top_judge", "--testset", "cusps", LONG),
    ("top_judge", "--testset", "cusps", BYTES),
    ("top_judge", "--testset", "cusps", "-o", "/dev/null/x"),
    ("top_judge", "--live", "--topic", "/x", "--ros-args", "-p", "bad"),
    ("top_model", "--format", "urdf", "--scene", CONTROL),
    ("top_model", "--format", "sdf", "--scene", LONG),
    ("top_model", "--format", "mjcf", "--scene", BYTES),
    ("top_model", "--format", "urdf", "--gravity", "1e999"),
    ("top_model", "--format", "urdf", "-o", LONG),
    ("top_model", "--format", "urdf", "-o", "a\0b"),
    ("top_imu", "--scene", CONTROL, "-o", "x.csv"),
    ("top_imu", "--noise", "/dev/null", "-o", "x.csv"),
    ("top_imu", "--noise", LONG, "-o", "x.csv"),
    ("top_imu", "--rate", "nan", "-o", "x.csv"),
    ("top_imu", "--rate", "1e6", "--seconds", "1e6", "-o", "x.csv"),
    ("top_imu", "--seconds", "-1", "-o", "x.csv"),
    ("top_imu", "--position", "1e999", "0", "0", "-o", "x.csv"),
    ("top_imu", "--orientation", "0", "0", "0", "0", "-o", "x.csv"),
    ("top_imu", "--seconds", "1", "-o", "/dev/null/x.csv"),
    ("top_imu", "--seconds", "1", "-o", "a\0b"),
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
    ("top_panel", "--port", "65536"),
    ("top_panel", "--port", CONTROL),
    ("top_panel", "--host"),
    ("top_replay", "run.json", "--rate", "100"),
    ("top_replay", "run.json", "--mcap", "a.mcap", "--rate", CONTROL),
    ("top_panel", "--no-such-option"),
    ("top_panel", "--node", "/top", "--no-such-option"),
    ("top_replay",),
    ("top_replay", "a", "--save"),
    ("top_replay", "a.mcap", "--fly"),
    ("top_replay", "a", "--web", "--check"),
    ("workshop",),
    ("workshop", CONTROL),
    ("workshop", "maps", "--points", "1000000"),
    ("workshop", "maps", "--points", CONTROL),
    ("top_model",),
    ("top_judge",),
    ("top_judge", "a", "--topic", "b", "--max-error", "nan"),
    ("top_judge", "a", "--topic", "b", "--remove", CONTROL),
    ("top_judge", "--live"),
    ("top_judge", "a", "--topic", "b", "--ros-args"),
    ("top_model", "--format", CONTROL),
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


@pytest.mark.parametrize(
    "content",
    [
        HEAD + "    a: &a 1.0\n    top: {Ix: *a}\n",
        HEAD + "    initial: {orientation: 5}\n",
        *(
            pytest.param(content, marks=pytest.mark.long)
            for content in (
                HEAD + "    x: " + "[" * 10_000,
                HEAD + "    initial: {orientation: [1.0, a]}\n",
                "\0\1\2",
            )
        ),
    ],
    ids=range(5),
)
def test_a_parameter_file_that_is_none_ends_the_node_with_one_line(content, tmp_path):
    path = tmp_path / "odd.yaml"
    path.write_text(content)
    result = run_program("top_node", "--ros-args", "--params-file", str(path), domain=DOMAIN)
    assert result.returncode == 1
    told = [line for line in result.stderr.splitlines() if line.startswith("top_node: ")]
    assert len(told) == 1
    assert_one_sentence(told[0])
    assert "Traceback" not in result.stderr
