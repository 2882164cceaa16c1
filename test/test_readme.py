"""The commands of the README do what it says."""

import contextlib
import io
import re
import shutil
import subprocess
import time
import urllib.error
import urllib.request
from pathlib import Path

import pytest
import yaml
from diagnostic_msgs.msg import DiagnosticArray
from geometry_msgs.msg import WrenchStamped
from log_files import Run
from node.listener import Listener
from programs import command, run, running_node

from symtop_ros.report import main as report

ROOT = Path(__file__).parents[1]
README = (ROOT / "README.md").read_text()
DOMAIN = 99
REPLAYS = re.findall(r"^top_replay (.+?) *#", README, flags=re.MULTILINE)
REPORTS = re.findall(r"^top_report (.*?) *#|`top_report (--\w+)`", README, flags=re.MULTILINE)
REPORTS = ["".join(each) for each in REPORTS]
COMMANDS = re.findall(r"^top_ctl (.+)$", README, flags=re.MULTILINE)


@pytest.fixture(scope="module")
def node():
    with running_node(DOMAIN, "scene:=hurry_slow"):
        yield


@pytest.mark.usefixtures("node")
@pytest.mark.parametrize("words", COMMANDS)
def test_a_command_of_the_readme_is_granted(words):
    result = run("top_ctl", *words.split(), domain=DOMAIN)
    assert result.returncode == 0, result.stderr
    if words == "hurry":
        told = " ".join(result.stdout.split())
        assert told in " ".join(README.split())


@pytest.mark.usefixtures("node")
def test_the_torque_that_the_readme_publishes_acts():
    """As `ros2 topic pub` would publish it; ros2cli is not on PyPI."""
    pattern = r"^ros2 topic pub -r \d+ (\S+) geometry_msgs/msg/WrenchStamped '(.+)'$"
    topic, text = re.search(pattern, README, flags=re.MULTILINE).groups()
    message = WrenchStamped()
    ((part, numbers),) = yaml.safe_load(text)["wrench"].items()
    for axis, value in numbers.items():
        setattr(getattr(message.wrench, part), axis, float(value))
    with Listener(DOMAIN) as listener:
        events = listener.collect(DiagnosticArray, "/top/events")
        publisher = listener.node.create_publisher(WrenchStamped, topic, 10)
        listener.spin_until(publisher.get_subscription_count)
        publisher.publish(message)
        listener.spin_until(lambda: events)
    told = {pair.key: pair.value for pair in events[0].status[0].values}
    assert told["applied_torque"] == "0.0 0.0 0.0005"


@pytest.mark.parametrize("words", REPLAYS)
def test_a_replay_of_the_readme_works(words, tmp_path):
    shutil.copy(Run(seconds=0.5).write(tmp_path), tmp_path / "run.mcap")
    program = command("top_replay", *words.split())
    if words.endswith(".mcap") and "--" not in words:  # opens a window: here there is none
        program += ["--save", "run.rrd"]
    with subprocess.Popen(program, cwd=tmp_path, stdout=subprocess.PIPE, text=True) as process:
        told = process.stdout.readline()
        try:
            if "--web" in words:
                address = re.match(r"open (http://127\.0\.0\.1:\d+/)\?url=", told)[1]
                assert "Rerun SDK-bundled web viewer" in page(address)
                process.terminate()
            assert process.wait(timeout=60) == 0
        finally:
            process.kill()


def page(address):
    """Content of a page, when somebody serves it."""
    deadline = time.monotonic() + 20
    while True:
        try:
            with urllib.request.urlopen(address, timeout=20) as answer:
                return answer.read().decode()
        except urllib.error.URLError:
            assert time.monotonic() < deadline
            time.sleep(0.1)


def test_there_are_commands_in_the_readme():
    assert len(COMMANDS) >= 12
    assert len(REPLAYS) == 5
    assert len(REPORTS) >= 3


def test_the_example_of_the_library_runs():
    example = re.search(r"```python\n(.+?)```", README, flags=re.DOTALL)
    assert example
    with contextlib.redirect_stdout(io.StringIO()) as printed:
        exec(example[1], {})
    assert printed.getvalue().startswith("cusps (0.5, 0.66")
    assert "the top rises" in printed.getvalue()


@pytest.mark.parametrize("words", REPORTS)
def test_a_report_of_the_readme_is_one_that_there_is(words):
    """Each of them runs in test/report, in a smaller form."""
    assert report._parser().parse_args(words.split()).folder


@pytest.mark.parametrize("target", ["demo", "test", "report"])
def test_the_targets_of_make_exist(target):
    assert f"make {target}" in README
    assert re.search(rf"^{target}:", (ROOT / "Makefile").read_text(), flags=re.MULTILINE)
