"""Recordings of other programs: in another order than the run, and in time that goes back."""

import re

import pytest
from exact_log import assert_agrees
from log.test_bag import STORAGES, TYPES, write
from rosbags.rosbag2 import StoragePlugin

from symtop_ros.check.samples import check_log
from symtop_ros.log.bag import open_run
from symtop_ros.log.top_log import TopLog
from symtop_ros.playback import main as module
from symtop_ros.session.session import Session
from symtop_ros.simulation.settings import Settings

SECOND = 1_000_000_000


class Recorder:
    """A host whose messages are recorded with the times of its clock, as `ros2 bag` does it."""

    is_open, has_subscriber = True, True

    def __init__(self, **changes):
        self.now, self.is_simulated = 0, True
        self.messages = []  # name of the topic, time of the clock, bytes
        settings = Settings.from_scene("hurry_slow", publish_rate=100.0, **changes)
        self.session = Session(settings, self, self, "hurry_slow", {})

    def resolve(self, topic):
        return topic.resolve("/top")

    def create_publisher_of(self, topic):
        return Publisher(self, topic.name) if topic.name in TYPES else None

    def inform(self, text):
        pass

    def run(self, begin, end):
        """Set the clock to a time in s, and let it run to a later time."""
        for time in range(round(begin * SECOND), round(end * SECOND), SECOND // 100):
            jumped = not 0 <= time - self.now < SECOND
            self.session.simulation.begin_jump()
            self.now = time
            self.session.simulation.end_jump(jumped)
            while (wait := self.session.simulation.tick()) is not None and wait <= 0:
                pass

    def kick(self):
        assert self.session.answer("hurry_precession", dict)[0]


class Publisher:
    has_subscriber = True

    def __init__(self, recorder, name):
        self._recorder, self._name = recorder, name

    def publish(self, data):
        self._recorder.messages.append((self._name, self._recorder.now, data))


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


def test_a_sample_of_the_old_motion_after_a_kick_is_wrong(tmp_path):
    messages = late_subscription()
    recorder = Recorder()
    recorder.run(100.0, 102.0)  # without the kick
    other = {each[1]: each for each in recorder.messages if each[0] == "orientation"}
    k = [k for k, each in enumerate(messages) if each[0] == "orientation"][150]
    messages[k] = other[messages[k][1]]
    deviations = checked(write(tmp_path / "bag", messages, StoragePlugin.SQLITE3))
    assert not deviations["orientation"].is_rounding
    assert deviations["orientation"].differing == 1
