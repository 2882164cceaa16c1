import contextlib
import os
import re
import shlex
import signal
import sys
from pathlib import Path

import pytest
from exact_log import assert_no_deviation
from listening import udp_addresses
from programs import execute, running
from trials import choose

from workshop.demo import FIRST_PORT, PORTS
from workshop.load.endings import bound

# All that a user must have set; the home cannot be written to. `make demo` runs in the checkout,
# where Python finds the workshop by itself.
BARE = {"HOME": "/dev/null", "PATH": os.defpath, "PYTHONPATH": str(Path(__file__).parents[1])}
BARE |= {name: value for name, value in os.environ.items() if name.startswith("COVERAGE_")}


LABELS = [  # of the lines after the first two
    *("at its lowest point", "the answer", "the motion after it", "the log", "the replay"),
    *("to open the log", "without a screen", "to check it", "stopped; nothing is left running"),
]


@contextlib.contextmanager
def running_demo(folder):
    """The demonstration in a folder, with its output in a pipe, and its first lines of output."""
    words = bound([sys.executable, "-m", "workshop.demo"])
    with running(words, 0, cwd=folder, env=BARE) as process:
        yield process, process.stdout.readline()


def read_rest(process):
    """What comes until the end; communicate() would lose lines that came with one that was read."""
    return process.stdout.read(), process.stderr.read(), process.wait()


def domain_of(line):
    return int(re.search(r"in the ROS domain (\d+) \.\.\.", line)[1])


def listening_in(domain):
    """Addresses on which anybody of a domain receives."""
    first = FIRST_PORT + PORTS * domain
    return udp_addresses(range(first, first + PORTS))


def other_than_delays(errors):
    """The lines but those in which the node warns that a busy machine has delayed samples."""
    return [line for line in errors.splitlines() if " missed in " not in line]


@pytest.mark.slow
@pytest.mark.wording
def test_two_demonstrations_print_the_same_and_leave_nothing_running(tmp_path):
    with running_demo(tmp_path) as (one, line), running_demo(tmp_path) as (other, second):
        one.stdout.readline()  # as soon as samples have come, and not at the end
        assert one.poll() is None
        listening = listening_in(domain_of(line))
        (printed, errors, status), (same, _, _) = map(read_rest, (one, other))
    assert domain_of(line) != domain_of(second)
    assert (status, other_than_delays(errors)) == (0, [])
    assert len(listening) >= 4
    assert {address for address, _ in listening} == {"127.0.0.1"}
    lines = printed.splitlines()
    assert [line.partition(":")[0].strip() for line in lines] == LABELS, lines
    _, answer, after, log, recording, *commands, _ = lines
    assert_rises(answer, after)
    assert [text for text in (answer, after) if text not in same] == []
    path, replay = tmp_path / Path(log.split()[-1]), tmp_path / Path(recording.split()[-1])
    assert_no_deviation(path)
    assert replay.stat().st_size > 100_000
    assert [*tmp_path.iterdir()] == [tmp_path / "logs"]
    assert_commands(commands, path)


def assert_rises(answer, after):
    """The numbers of the answer are those of the article's top, and are seen in the samples."""
    assert "precession 11.89 -> 16.64 rad/s, spin rate held; the axis moves up. " in answer
    assert "From now on: theta will stay between 0.354 and" in answer
    low, high = re.search(r"between (\S+) and (\S+) rad", answer).groups()
    seen = re.search(r"theta (\S+) to (\S+) rad", after).groups()
    # samples are 5 ms apart: at the highest point theta'' = 250 rad/s^2 moves it by 1e-3 rad
    assert [float(each) for each in seen] == pytest.approx([float(low), float(high)], abs=1.5e-3)


def assert_commands(lines, log):
    """Each line names a program that is installed, and the log; the check runs."""
    words = [shlex.split(line.split(":", 1)[1]) for line in lines]
    for program, *rest in words:
        assert os.access(log.parents[1] / program, os.X_OK)
        assert log in {log.parents[1] / each for each in rest}
    (check,) = [each for each in words if "--check" in each]
    execute(check, cwd=log.parents[1], check=True)


@pytest.mark.slow
@pytest.mark.parametrize("number", choose((signal.SIGINT, signal.SIGTERM), (signal.SIGINT,)))
def test_a_signal_ends_it_and_its_node_without_a_traceback(tmp_path, number):
    with running_demo(tmp_path) as (process, line):
        process.stdout.readline()
        process.send_signal(number)
        _, errors, status = read_rest(process)
    assert (status, other_than_delays(errors)) == (130, [])
    assert listening_in(domain_of(line)) == set()
