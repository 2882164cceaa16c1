"""Invalid command lines: status 1 and a line, or status 2 and the usage; no traceback."""

import shlex
from importlib import import_module

import pytest
from odd_values import CONTROL, assert_one_sentence

from workshop import main as workshop_main
from workshop.load.domains import share_domain

DOMAIN = share_domain()
LONG = "x" * 100_000
BYTES = "\udcff\udcfe"  # what Python makes of bytes that are no text
TEXTS = {"CONTROL": CONTROL, "LONG": LONG, "BYTES": BYTES, "NUL": "\0", "NINES": "9" * 5000}
FOLDERS = {"ctl": "ros.client", "live": "ros.live", "panel": "page.panel", "replay": "replay"}
FOLDERS |= {"model": "run.models", "judge": "truth.judge", "imu": "truth.imu", "fit": "truth.fit"}
FOLDERS |= {"testset": "truth.testset"}
MAINS = {
    f"top_{name}": import_module(f"symtop_ros.{folder}.main").main
    for name, folder in FOLDERS.items()
} | {"workshop": workshop_main.main}
# Of each program some command lines, with bars between; words in capitals stand for these texts.
FAILED = {
    "top_ctl": "--ros-args -p bad | --ros-args --remap | --node CONTROL hurry | "
    "--node LONG hurry | --node BYTES hurry | --node '' hurry | kick BYTES=1 | "
    "--node /missing --timeout 1e-9 kick CONTROL=CONTROL | --node /missing --timeout 1e-9 watch | "
    "--node /missing --timeout 1e-9 kick angular_impulse=nan,inf,1e999",
    "top_live": "--ros-args -p bad | --ros-args --remap | --node BYTES",
    # 192.0.2.1 is of TEST-NET: of no machine
    "top_panel": "--host 192.0.2.1 --port 0 | --host CONTROL --port 0 | "
    "--node /top --ros-args -p bad | --node BYTES | --write CONTROL | --write LONG.html",
    "top_replay": "/dev/null --mcap /dev/null/x.mcap | /dev/null --mcap BYTES.mcap | "
    "/dev/null/run.json --save a.html | /dev/null/run.json --mcap a.mcap --rate nan | CONTROL | "
    "LONG --check | /dev/null --repair /dev/null/x | BYTES | a b | a b --repair c.mcap",
    "top_judge": "CONTROL --topic CONTROL | LONG --topic LONG | BYTES --topic BYTES | "
    "/dev/null --estimates /dev/null/x.csv | --live --topic /x --ros-args -p bad",
    "top_testset": "CONTROL x.csv | cusps LONG | cusps BYTES | cusps aNULb | all LONG | all / | "
    "cusps -o /dev/null/x | -o LONG | cusps.CONTROL -o x | BYTES -o x | LONG x.csv",
    "top_model": "--format urdf --scene CONTROL | --format sdf --scene LONG | "
    "--format mjcf --scene BYTES | --format urdf --gravity 1e999 | --format urdf -o LONG | "
    "--format urdf -o aNULb",
    "top_imu": "--scene CONTROL -o x.csv | --noise /dev/null -o x.csv | --noise LONG -o x.csv | "
    "--rate nan -o x.csv | --rate 1e6 --seconds 1e6 -o x.csv | --seconds -1 -o x.csv | "
    "--position 1e999 0 0 -o x.csv | --orientation 0 0 0 0 -o x.csv | "
    "--seconds 1 -o /dev/null/x.csv | --seconds 1 -o aNULb | --magnetic-field=1,2 -o x.csv | "
    "--magnetic-field=1,2,nan -o x.csv | --rate 0 -o x.csv | -o x.txt",
}
FAILED["top_fit"] = (
    "--plan CONTROL | --plan cusps CONTROL | --plan cusps initial.theta=CONTROL | "
    "CONTROL | LONG | BYTES | aNULb | /dev/null | /dev/null/x.csv | / | --kind axis /dev/null | "
    "--topic /x CONTROL.mcap"
)
MISUSED = {"top_ctl": "kick CONTROL | kick LONG | kick =3 | kick CONTROL=1 CONTROL=2"}
UNREADABLE = {
    "top_testset": "cusps | a b c | a b -o c | --json | a b --max-error nan | CONTROL",
    "top_ctl": " | kick | step | CONTROL | --timeout nan hurry | --timeout -inf hurry | "
    "watch --seconds 0",
    "top_live": "--port 65536 | --port -1 | --port NINES",
    "top_panel": "--port 65536 | --port CONTROL | --host | --no-such-option | "
    "--node /top --no-such-option",
    "top_replay": "run.json --rate 100 | run.json --mcap a.mcap --rate CONTROL |  | a --save | "
    "a.mcap --fly | a --web --check",
    "workshop": " | CONTROL | speed --limit nan | speed --limit CONTROL | filters --docs nowhere",
    "top_model": " | --format CONTROL",
    "top_imu": "--rate 1_0 -o x.csv | --seed 1_0 -o x.csv | --magnetic-field 1_0 -o x.csv",
    "top_fit": " | a b | a --kind CONTROL | a --Ix 1 | a --Ix nan 1 | a --Mgl 1_0 1 | a --example"
    " | a --plan cusps | --plan | --plan cusps --rate 0 | --plan cusps --noise nan",
    "top_judge": " | a --topic b --max-error nan | a --topic b --remove CONTROL | --live | "
    "a --topic b --ros-args",
}


def list_lines(table):
    """Yield the words of each command line, the program first."""
    for program, lines in table.items():
        for line in lines.split(" | "):
            yield [program, *map(replace, shlex.split(line))]


def shorten(words):
    return ascii(" ".join(words))[:50]


def replace(word):
    for name, text in TEXTS.items():
        word = word.replace(name, text)
    return word


@pytest.mark.parametrize("arguments", [*list_lines(FAILED), *list_lines(MISUSED)], ids=shorten)
def test_what_cannot_be_done_is_status_1_or_2_and_one_line(arguments, capsys, monkeypatch):
    monkeypatch.setenv("ROS_DOMAIN_ID", str(DOMAIN))
    name, *words = arguments
    status = MAINS[name](words)
    (line,) = capsys.readouterr().err.splitlines()
    assert status == 1 + (arguments in list_lines(MISUSED))
    assert line.startswith(f"{name}: ")
    assert_one_sentence(line)


@pytest.mark.parametrize("arguments", [*list_lines(UNREADABLE)], ids=shorten)
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
