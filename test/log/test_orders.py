"""Recordings of other programs: in another order than the run, and in time that goes back."""

import re
from types import SimpleNamespace

import pytest
from exact_log import assert_agrees
from log.test_bag import STORAGES, TYPES, write
from session.test_outputs import SECOND, Program, advance, start

from symtop_ros.check.samples import check_log
from symtop_ros.log.top_log import TopLog, open_run
from symtop_ros.playback import main as module


class Recorder(Program):
    """A host whose messages are recorded with the times of its clock, as `ros2 bag` does it."""

    def __init__(self):
        super().__init__()
        self.session = None
        self.messages = []  # name of the topic, time of the clock, bytes
        self.session, self.clock = start(self, "hurry_slow", publish_rate=100.0)

    def create_publisher_of(self, topic):
        def keep(data):
            self.messages.append((topic.name, self.clock.now if self.session else 0, data))

        return SimpleNamespace(has_subscriber=True, publish=keep) if topic.name in TYPES else None

    def run(self, begin, end):
        """Set the clock to a time in s, and let it run to a later time."""
        for time in range(round(begin * SECOND), round(end * SECOND), SECOND // 100):
            jumped = not 0 <= time - self.clock.now < SECOND
            self.session.simulation.begin_jump()
            self.clock.now = time
            self.session.simulation.end_jump(jumped)
            advance(self.session, self.clock, 0.0)

    def kick(self):
        assert self.session.answer("hurry_precession", dict)[0]


def delay(messages, name, count):
    """Each message of a topic arrives after `count` others."""
    arrivals = sorted((k + (count + 0.5) * (m[0] == name), m) for k, m in enumerate(messages))
    return [each for _, each in arrivals]


def checked(folder):
    return check_log(TopLog(open_run([folder])))


def assert_exact(folder, samples):
    assert_agrees(TopLog(open_run([folder])), samples)


def late_subscription():
    """A node that waited for /clock; the recorder gets its latched events after some samples."""
    recorder = Recorder()
    recorder.run(100.0, 101.0)
    recorder.kick()
    recorder.run(101.0, 102.0)
    latched = [each for each in recorder.messages if each[0] == "events"][:2]  # start, clock
    # the sample of time 0 was not heard
    others = [each for each in recorder.messages if each[1] and each not in latched]
    return [*others[:40], *latched, *others[40:]]


def jump_back():
    """A clock that goes back to a time that was there before, and a kick in each part."""
    recorder = Recorder()
    for begin in (100.0, 99.0, 99.5):
        recorder.run(begin, begin + 1.0)
        recorder.kick()
        recorder.run(begin + 1.0, begin + 2.0)
    return [each for each in recorder.messages if each[1] or each[0] == "events"]


@pytest.mark.parametrize("storage", STORAGES)
def test_late_events_govern_the_first_samples_of_simulated_time(storage, tmp_path):
    assert_exact(write(tmp_path / "bag", late_subscription(), storage), 200)


@pytest.mark.parametrize("storage", STORAGES)
@pytest.mark.parametrize(
    ("topic", "late"), [("events", 0), ("events", 45), ("events", 900), ("torque", 45)]
)
def test_a_clock_that_goes_back_leaves_a_run_right_however_late_messages_arrive(
    storage, topic, late, tmp_path
):
    assert_exact(write(tmp_path / "bag", delay(jump_back(), topic, late), storage), 600)


def test_an_order_that_is_lost_is_named_and_no_error(tmp_path, capsys):
    # A bag that was converted is sorted by its times, in which both parts are mixed.
    messages = sorted(jump_back(), key=lambda each: each[1])
    folder = write(tmp_path / "bag", messages)
    assert module.main([str(folder), "--check"]) == 0
    rows = capsys.readouterr().out.splitlines()
    assert rows[-1] == "the samples agree with the events"
    for row in rows[:-1]:
        found = re.search(r" 600 samples, largest difference 0; (\d+) agree with an event", row)
        assert 0 < int(found[1]) < 600


@pytest.mark.parametrize("late", [0, 45])
def test_a_wrong_number_is_found_although_the_clock_went_back(late, tmp_path, capsys):
    messages = delay(jump_back(), "events", late)
    places = [k for k, each in enumerate(messages) if each[0] == "orientation"]
    k = places[350]
    name, time, data = messages[k]
    messages[k] = name, time, data[:-4] + bytes([data[-4] ^ 1]) + data[-3:]
    folder = write(tmp_path / "bag", messages)
    assert module.main([str(folder), "--check"]) == 1
    assert "the samples DO NOT agree" in capsys.readouterr().out
    deviations = checked(folder)
    assert [name for name, each in deviations.items() if each.differing] == ["orientation"]
