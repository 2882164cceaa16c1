"""top_node as a process: help, refusals in one line, and a clean end."""

import signal
import sys
import time
from contextlib import contextmanager, nullcontext
from itertools import chain, product

import pytest
from exact_log import assert_exact
from geometry_msgs.msg import QuaternionStamped
from odd_values import assert_one_sentence
from programs import command, environment, execute, run, running, set_parameters, write_without
from rcl_interfaces.srv import GetParameters
from ros.node.listener import Listener
from std_srvs.srv import Trigger
from trials import choose

from symtop_ros.ros.client.connection import Connection
from symtop_ros.ros.node.options import find_fault
from workshop.load.domains import share_domain

DOMAIN = share_domain()
SIGNALS = signal.SIGHUP, signal.SIGINT, signal.SIGTERM
HEAD = "/**:\n  ros__parameters:\n"
FILES = {"alias": "    a: &a 1.0\n    top: {Ix: *a}\n"}
FILES["no_list"] = "    initial: {orientation: 5}\n"


WRONG_FORMS = [
    (
        "scene:=hurry_slow",
        "scene must be given as a parameter (--scene hurry_slow, or --ros-args -p ",
    ),
    (
        "--ros-args -r scene:=disc",
        "scene must be given as a parameter (--scene disc, or --ros-args ",
    ),
    (
        "publish_rate:=100",
        "publish_rate must be given as a parameter (--ros-args -p publish_rate:=",
    ),
    ("--ros-args -r top.Mgl:=1", "top.Mgl must be given as a parameter (--ros-args -p top.Mgl:=1)"),
    (
        "--scene disc --ros-args -p scene:=free",
        "scene must be given once, got --scene disc and -p ",
    ),
    ("--scene cups", "scene must be known (the nearest is cusps), got 'cups'"),
    (
        "-p scene:=hurry_slow",
        "-p must come after --ros-args (--ros-args -p scene:=hurry_slow), got none",
    ),
    (
        "--ros-args -r a:=b -- --param other:=1",
        "--param must come after --ros-args (--ros-args --param other:=1), got none",
    ),
]


@pytest.mark.parametrize(("words", "reason"), WRONG_FORMS)
def test_a_wrong_form_is_answered_with_the_right_one(words, reason):
    result = run("top_node", *words.split(), domain=DOMAIN)
    assert result.returncode == (1 if "--scene" in words else 2)
    assert result.stderr.startswith(f"top_node: {reason}")
    assert result.stderr.count("\n") == 1


@pytest.mark.parametrize(
    ("words", "fault"),
    [
        ("--ros-args -p scene:=disc --param top.Mgl:=1", ""),
        ("--ros-args -r __node:=other -r imu:=/imu -r /top/kick:=push", ""),
        ("--ros-args -r gravity:=9.8", "gravity must be given as a parameter"),
    ],
)
def test_a_remapping_of_other_names_is_none_of_a_parameter(words, fault):
    assert find_fault(words.split()).startswith(fault)
    assert bool(find_fault(words.split())) == bool(fault)


def test_a_scene_may_be_a_plain_option():
    with (
        running(command("top_node", "--scene", "looping"), DOMAIN) as node,
        Listener(DOMAIN) as user,
    ):
        top = Connection(user.node, timeout=300.0)
        (value,) = top.call(
            GetParameters, "get_parameters", GetParameters.Request(names=["scene"])
        ).values
        assert value.string_value == "looping"
        node.send_signal(signal.SIGINT)
        assert node.wait(timeout=300) == 0


@pytest.fixture(autouse=True)
def _strict(monkeypatch):
    """Deprecations are errors, as some users have it: those of a dependency end no node."""
    monkeypatch.setenv("PYTHONWARNINGS", "error")


def test_help_names_the_scenes():
    result = run("top_node", "--help", domain=DOMAIN)
    assert result.returncode == 0
    assert "scene:=hurry_slow" in result.stdout
    assert "through_the_pole" in result.stdout


@pytest.mark.parametrize(
    ("arguments", "status", "sentence"),
    [
        ("--fast", 2, "unrecognized arguments: --fast"),
        ("publish_rate:=0", 1, "publish_rate must be "),
        ("steady_torque:=[0,0,0.0001]", 1, "got [0,0,0.0001]: write 0.0 for 0"),  # the advice
        ("--ros-args --params-file /nowhere.yaml", 1, "Couldn't parse params file"),
        ("use_sim_time:=7", 1, "use_sim_time"),
        ("--ros-args --params-file {}/alias.yaml", 1, "alias.yaml"),
        ("--ros-args --params-file {}/no_list.yaml", 1, "initial.orientation"),
    ],
)
def test_bad_start_up_ends_with_one_line_and_no_traceback(arguments, status, sentence, tmp_path):
    for name, text in FILES.items():
        (tmp_path / f"{name}.yaml").write_text(HEAD + text)
    words = arguments.format(tmp_path).split()
    options = set_parameters(*words) if ":=" in arguments else words
    result = run("top_node", *options, domain=DOMAIN)
    assert result.returncode == status
    assert sentence in result.stderr
    assert "Traceback" not in result.stderr
    if status == 1:
        assert ".py" not in result.stderr  # no warning of Python
        (line,) = [each for each in result.stderr.splitlines() if each.startswith("top_node: ")]
        assert_one_sentence(line)


@pytest.mark.parametrize("ending", choose(SIGNALS, SIGNALS[:1]))
def test_a_signal_while_it_starts_ends_it_cleanly(ending):
    with running(command("top_node", *set_parameters("publish_rate:=1000")[:3]), DOMAIN) as node:
        while "scene cusps" not in node.stderr.readline():
            assert node.poll() is None
        node.send_signal(ending)
        _, rest = node.communicate(timeout=300)
    assert node.returncode == 0
    assert "Traceback" not in rest
    assert "top_node:" not in rest


@pytest.mark.parametrize("ending", choose(SIGNALS[1:], SIGNALS[1:2]))
def test_signals_again_and_again_do_not_change_the_status(ending):
    with running(command("top_node", *set_parameters()[:1]), DOMAIN) as node:
        while "states are computed" not in node.stderr.readline():
            assert node.poll() is None
        while node.poll() is None:
            node.send_signal(ending)
            time.sleep(0.005)
        _, rest = node.communicate(timeout=300)
    assert (node.returncode, rest) == (0, "")


WITHOUT_MCAP = write_without(("mcap",), "top_node")
WAY_OUT = (
    "mcap must be installed for a recording, got none: pip install mcap, on Debian and Ubuntu into "
    "a venv"
)


# What Fast DDS talks over; for the range LOCALHOST rmw_fastrtps adds shared memory itself.
TRANSPORTS = ("SHM", "UDPv4", "LOCALHOST", "DEFAULT", "LARGE_DATA")
VARIABLES = ("FASTDDS_BUILTIN_TRANSPORTS", "ROS_AUTOMATIC_DISCOVERY_RANGE")
BUSY = ("alone", "with a client", "in a recording", "in a request")
TRIALS = [*product(TRANSPORTS, BUSY, SIGNALS, range(17))]  # 204 ends on each transport
OFTEN = [("SHM", busy, signal.SIGTERM, 0) for busy in BUSY if busy != "with a client"]


@pytest.mark.parametrize("trial", choose(TRIALS, OFTEN))
def test_it_ends_without_a_fault_on_every_transport(trial, monkeypatch, tmp_path):
    """With shared memory alone the middleware ended after the semaphores that it needs."""
    transport, busy, ending, number = trial
    _use_transport(monkeypatch, transport)
    folder = tmp_path if busy == "in a recording" else None
    with running(_record_into(folder), DOMAIN) as node:
        while "states are computed" not in node.stderr.readline():
            assert node.poll() is None
        with nullcontext() if busy == "alone" else _followed() as connection:
            if busy == "in a request":
                _ask(connection, number * 1e-4)
            node.send_signal(ending)
            _, rest = node.communicate(timeout=300)
    assert (node.returncode, "Traceback" in rest) == (0, False)
    assert all(assert_exact(path) for path in tmp_path.iterdir())
    assert len([*tmp_path.iterdir()]) == (folder is not None)


# Those of a row see each other; UDPv4 is what the programs use if nothing is set.
TOGETHER = (("UDPv4", "DEFAULT", "LOCALHOST"), ("SHM",), ("LARGE_DATA",), ("UDPv6", "DEFAULTv6"))
UNSEEN = 4.0  # s in which a client that cannot see a node is looked at


@pytest.mark.long
@pytest.mark.parametrize("row", TOGETHER, ids=str)
def test_clients_see_a_node_whose_transports_are_theirs(row, monkeypatch):
    for transport in row:
        _use_transport(monkeypatch, transport)
        with running(command("top_node"), DOMAIN) as node:
            while "states are computed" not in node.stderr.readline():
                assert node.poll() is None
            for each in chain(*TOGETHER):
                _use_transport(monkeypatch, each)
                with Listener(DOMAIN) as user:
                    samples = user.collect(QuaternionStamped, "/top/orientation")
                    if each in row:
                        user.wait_for(samples)
                    else:
                        user.spin(UNSEEN)
                        assert samples == [], each


def _use_transport(monkeypatch, name):
    """Let programs, and nodes of this process, use a transport, whatever they used before."""
    for variable in VARIABLES:
        monkeypatch.delenv(variable, raising=False)
    monkeypatch.setenv(VARIABLES[name == "LOCALHOST"], name)


def _record_into(folder):
    options = folder and ("-p", "record.enabled:=true", "-p", f"record.directory:={folder}")
    return command("top_node", "--ros-args", *(options or ()))


@contextmanager
def _followed():
    """A client that receives samples and has had an answer."""
    with Listener(DOMAIN) as user:
        samples = user.collect(QuaternionStamped, "/top/orientation")
        connection = Connection(user.node, timeout=300.0)
        assert connection.request("hurry_precession")[0]
        connection.spin_until(lambda: samples, 300.0)
        yield connection
        connection.close()


def _ask(connection, seconds):
    """Send a request, and return when it is being answered, or after its answer."""
    client = connection._client(Trigger, "hurry_precession")
    client.call_async(Trigger.Request())
    connection.spin_until(lambda: False, seconds)


def test_without_mcap_it_runs_and_refuses_to_record_with_the_way_out():
    words = [sys.executable, "-c", WITHOUT_MCAP]
    with running(words, DOMAIN, stderr=None) as node, Listener(DOMAIN) as user:
        top = Connection(user.node, timeout=300.0)
        assert top.request("hurry_precession")[0]
        assert top.request("record", True) == (False, WAY_OUT)
        assert top.request("get_state")[0]
    assert node.returncode == 0


def test_without_mcap_a_recording_from_the_start_is_refused_in_one_line():
    words = [sys.executable, "-c", WITHOUT_MCAP, "--ros-args", "-p", "record.enabled:=true"]
    result = execute(words, env=environment(DOMAIN))
    assert (result.returncode, result.stderr.splitlines()[-1]) == (1, f"top_node: {WAY_OUT}")
    assert "Traceback" not in result.stderr
