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
from domains import claim_domain
from geometry_msgs.msg import WrenchStamped
from log_files import Run
from node.listener import Listener
from programs import PATIENT, command, run, running_node
from rcl_interfaces.msg import Parameter as ParameterMessage
from rcl_interfaces.srv import SetParametersAtomically
from std_srvs.srv import SetBool, Trigger

from symtop_ros.report import main as report

pytestmark = pytest.mark.untraced
ROOT = Path(__file__).parents[1]
README = (ROOT / "README.md").read_text()
DOMAIN = claim_domain()
REPLAYS = re.findall(r"^top_replay (.+?) *#", README, flags=re.MULTILINE)
REPORTS = re.findall(r"^top_report (.*?) *#", README, flags=re.MULTILINE)
COMMANDS = [
    words.removeprefix("top_ctl ")
    for line in re.findall(r"^top_ctl .+$", README, flags=re.MULTILINE)
    for words in line.split(" && ")
]
CALLS = re.findall(r'`ros2 service call /top/(\w+) \w+/srv/(\w+)(?: "([^`]+)")?`', README)
SERVICES = {
    "set_initial_conditions": SetParametersAtomically,
    "kick": SetParametersAtomically,
    "hurry_precession": Trigger,
    "reset": Trigger,
    "get_state": Trigger,
    "pause": SetBool,
    "step": SetParametersAtomically,
    "record": SetBool,
}


@pytest.fixture(scope="module")
def node():
    with running_node(DOMAIN, "scene:=hurry_slow"):
        yield


@pytest.mark.usefixtures("node")
@pytest.mark.parametrize("words", COMMANDS)
def test_a_command_of_the_readme_is_granted(words):
    result = run("top_ctl", *PATIENT, *words.split(), domain=DOMAIN)
    assert result.returncode == 0, result.stderr
    if words == "hurry":
        told = " ".join(result.stdout.split())
        assert told in " ".join(README.split())


@pytest.mark.usefixtures("node")
def test_the_service_calls_of_the_readme_are_granted():
    """As `ros2 service call` would send them, one after the other; ros2cli is not on PyPI."""
    assert [name for name, _, _ in CALLS] == list(SERVICES)
    with Listener(DOMAIN) as listener:
        for name, kind, text in CALLS:
            client = listener.node.create_client(SERVICES[name], f"/top/{name}")
            assert f"{SERVICES[name].__name__}" == kind
            request = filled(SERVICES[name].Request(), yaml.safe_load(text or "{}"))
            listener.spin_until(client.service_is_ready)
            future = client.call_async(request)
            listener.spin_until(future.done)
            answer = getattr(future.result(), "result", future.result())
            assert getattr(answer, "success", True), (name, answer)
            assert getattr(answer, "successful", True), (name, answer)


def filled(message, values):
    """A message with its fields set from YAML, as rosidl_runtime_py does it."""
    for name, value in values.items():
        if isinstance(value, dict):
            filled(getattr(message, name), value)
        elif name == "parameters":
            message.parameters = [filled(ParameterMessage(), each) for each in value]
        else:
            setattr(message, name, value)
    return message


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
        # as -r 50 does: a message before both sides are matched is lost
        listener.spin_until(lambda: events or publisher.publish(message))
    told = {pair.key: pair.value for pair in events[0].status[0].values}
    assert told["applied_torque"] == "0.0 0.0 0.0005"


@pytest.mark.parametrize("words", REPLAYS)
def test_a_replay_of_the_readme_works(words, tmp_path):
    shutil.copy(Run(seconds=0.5).write(tmp_path), tmp_path / "run.mcap")
    program = command("top_replay", *words.split())
    if words.endswith(".mcap") and "--" not in words:  # would open a window: there is no screen
        program += ["--save", "run.rrd"]
    pipes = {"stdout": subprocess.PIPE, "stderr": subprocess.PIPE}
    with subprocess.Popen(program, cwd=tmp_path, text=True, **pipes) as process:
        told = process.stdout.readline()
        try:
            if "--web" in words:
                address = re.match(r"open (http://127\.0\.0\.1:\d+/)\?url=", told)[1]
                assert "Rerun SDK-bundled web viewer" in page(address)
                process.terminate()
            assert process.wait(timeout=60) == 0
            assert process.stderr.read() == ""
        finally:
            process.kill()


def page(address):
    """Content of a page, when somebody serves it."""
    deadline = time.monotonic() + 60
    while True:
        try:
            with urllib.request.urlopen(address, timeout=60) as answer:
                return answer.read().decode()
        except urllib.error.URLError:
            assert time.monotonic() < deadline
            time.sleep(0.1)


def test_there_are_commands_in_the_readme():
    assert len(COMMANDS) >= 12
    assert len(REPLAYS) == 5
    assert len(REPORTS) == 2


def test_the_example_of_the_library_runs():
    example = re.search(r"```python\n(.+?)```", README, flags=re.DOTALL)
    assert example
    with contextlib.redirect_stdout(io.StringIO()) as printed:
        exec(example[1], {})
    assert printed.getvalue().startswith("cusps (0.5, 0.66")
    assert "The top stays: theta will stay at 0.500 rad. Perry's rule holds" in printed.getvalue()


@pytest.mark.parametrize("words", REPORTS)
def test_a_report_of_the_readme_is_one_that_there_is(words):
    """Each of them runs in test/report, in a smaller form."""
    assert report._parser().parse_args(words.split()).folder


@pytest.mark.parametrize("target", ["panel", "demo", "test", "report", "node-cost"])
def test_the_targets_of_make_exist(target):
    assert f"make {target}" in README
    assert re.search(rf"^{target}:", (ROOT / "Makefile").read_text(), flags=re.MULTILINE)
