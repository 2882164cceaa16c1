"""Logs of the node: exactly the published bytes, however the node ends."""

import os
import random
import signal
import subprocess
import sys
from pathlib import Path

import pytest
from diagnostic_msgs.msg import DiagnosticArray
from exact_log import assert_exact, assert_no_deviation, read_messages
from geometry_msgs.msg import QuaternionStamped, WrenchStamped
from machine_time import measuring
from programs import PATIENT, command, environment, execute, set_parameters
from ros.node.listener import Listener
from ros.node.running_top import LATCHED, stamp_of, torque_of
from traces import remove_ports
from trials import choose, trials
from waiting import until

from symtop_ros.run.log.reader import McapFile
from symtop_ros.run.log.top_log import TopLog
from workshop.load.domains import claim_domain

DOMAIN = claim_domain()
# Nodes of this machine alone use shared memory, which one that is killed cannot remove.
PROGRAMS = os.pathsep.join([str(Path(sys.executable).parent), os.environ["PATH"]])
REMOVE_SEGMENTS = "fastdds", "shm", "clean"
PUSHES = "kick", "axle_impulse=5e-5", "rate=20", "number=100"
SIGNALS = signal.SIGTERM, signal.SIGINT, signal.SIGHUP


@pytest.mark.slow
@pytest.mark.parametrize("limits", [{"max_duration": 0.5}, {"max_size": 50_000}], ids=str)
def test_each_file_of_a_recording_can_be_checked_alone(limits, start_top, tmp_path):
    parameters = {f"record__{name}": value for name, value in limits.items()}
    run = start_top(record__directory=str(tmp_path), **parameters)
    run.trigger("hurry_precession")
    run.spin_until(lambda: run.now > 3 * 10**8)  # it begins in the middle of the run
    run.switch("record", True)
    run.spin_until(lambda: len(list(tmp_path.iterdir())) == 3)
    third = run.now
    run.spin_until(lambda: run.now > third + 10**8)  # 20 samples in the third file
    run.end_log()
    for path in tmp_path.iterdir():
        assert_no_deviation(path)
    files = sorted(tmp_path.iterdir(), key=lambda path: path.stat().st_mtime_ns)
    assert all(path.stat().st_size > limits.get("max_size", 0) for path in files[:2])


def test_a_log_of_clamps_is_computed_again(start_top, tmp_path):
    """Held, at rest and moving, and let go: samples, torque and balances are those of the hand."""
    run = start_top(record__directory=str(tmp_path), record__enabled=True)
    for held in (True, False, True):
        reached = run.now
        run.spin_until(lambda begin=reached: run.now > begin + 2 * 10**8)
        assert run.switch("clamp", held)[0]
    run.spin_until(lambda: run.now > 15 * 10**8)  # with diagnostics
    path = run.end_log()
    assert_no_deviation(path)


# As processes


def started(folder, rate=1000.0):
    parameters = (f"publish_rate:={rate}", "record.enabled:=true", f"record.directory:={folder}")
    words = command("top_node", *set_parameters(*parameters)[:-1], "error")
    node = subprocess.Popen(words, env=environment(DOMAIN), stderr=subprocess.PIPE, text=True)
    (path,) = until(lambda: [*folder.glob("*.mcap")])
    return node, path


@pytest.mark.realtime
@pytest.mark.parametrize("number", choose(SIGNALS, SIGNALS[:1]))
def test_a_signal_ends_the_node_in_silence_and_its_log_as_it_should(number, tmp_path):
    node, path = started(tmp_path)
    with Listener(DOMAIN) as listener:
        heard = listener.collect(QuaternionStamped, "/top/orientation", raw=True)
        listener.spin_until(lambda: len(heard) > 100)
        node.send_signal(number)
        listener.spin_until(lambda: node.poll() is not None)
    assert (node.returncode, node.communicate()[1]) == (0, "")
    file = McapFile(path)
    logged = {message.data for chunk in file.chunks() for message in chunk}
    assert file.problems == []
    assert file.metadata["symtop_ros.end"]["dropped"] == "0"
    assert set(heard) <= logged  # all that was published, up to the end


def test_a_log_holds_applied_torques_as_they_were_received(start_top, tmp_path):
    run = start_top(record=tmp_path)
    events = run.collect(DiagnosticArray, "/top/events", LATCHED)
    heard = run.collect(WrenchStamped, "/top/applied_torque", raw=True)
    hand = run.publisher(WrenchStamped, "/top/applied_torque")
    run.spin_until(lambda: run.top.simulation.stamp > 0)  # some middleware is that fast
    for frame, size in (("world", 2e-4), ("elsewhere", 1.0), ("", 1e-4)):
        hand.publish(torque_of(z=size, frame=frame))
        run.wait_for(heard)
    run.spin_until(lambda: any("0.0 0.0 0.0001" in str(each) for each in events))
    path = run.end_log()
    logged = [each for name, *each in read_messages(path) if name == "/top/applied_torque"]
    assert [data for _, data in logged] == heard
    assert min(stamp for stamp, _ in logged) > 0
    assert_exact(path)


@pytest.mark.realtime
@pytest.mark.parametrize("attempts", trials(1, 10))
def test_kill_9_at_any_moment_loses_no_more_than_the_last_flush(tmp_path, attempts):
    rng = random.Random(3)
    for attempt in range(attempts):
        folder = tmp_path / str(attempt)
        folder.mkdir()
        node, path = started(folder)
        if attempt % 2 == 0:  # in a series of pushes
            execute(command("top_ctl", *PATIENT, *PUSHES), check=True, env=environment(DOMAIN))
        with Listener(DOMAIN) as listener, measuring() as machine:
            published = listener.collect(QuaternionStamped, "/top/orientation")
            listener.wait_for(published)
            listener.spin(rng.uniform(0.5, 1.5))
            os.kill(node.pid, signal.SIGKILL)
            node.communicate()
            listener.spin(0.1)  # what it had sent
        execute(REMOVE_SEGMENTS, check=True, env={**os.environ, "PATH": PROGRAMS})
        remove_ports(DOMAIN)
        assert_exact(path)
        file = McapFile(path)
        latest = max(message.log_time for chunk in file.chunks() for message in chunk)
        (problem,) = file.problems
        assert "messages after" in problem
        assert TopLog(McapFile(path)).catalog.lacks_only_its_end
        machine.demand(0.1)  # the condition of docs/logs.md
        assert stamp_of(published[-1]) - latest <= 5 * 10**8
