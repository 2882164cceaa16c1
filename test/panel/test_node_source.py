"""A running node behind the page: the same events as a local top, bit for bit."""

import signal
import threading
import time

import pytest
import rclpy
from node.running_top import RunningTop
from panel.pages import open_pages, running_panel

from symtop_ros.panel.actions import Actions
from symtop_ros.panel.node_source import SILENCE, NodeTop
from symtop_ros.panel.source import LocalTop
from symtop_ros.simulation.validation import RefusedError
from symtop_ros.web.run import Run
from workshop.load.domains import claim_domain

TIMEOUT = 60.0
# When an event took effect depends on the clock; what happened does not.
OF_THE_CLOCK = ("motion.stamp",)


class Played:
    """A top behind the page, driven as its users would, while its events are collected."""

    def __init__(self, source, spin=lambda: None):
        self.source, self.run, self.events, self._spin = source, Run(), [], spin
        self.actions = Actions(source, self.run)
        source.watch(True)

    def look(self, count):
        """Wait until there are so many events, and a sample after the last one."""
        deadline = time.monotonic() + TIMEOUT
        while len(self.events) < count or self.run.stamp < self.events[-1].stamp:
            self._spin()
            self.events += self.run.follow(self.source.batch())
            assert time.monotonic() < deadline, [event.name for event in self.events]

    def play(self):
        """Pause, and then do something of everything."""
        self.look(1)
        actions = self.actions
        acts = (
            actions.toggle_pause,
            lambda: actions.request("reset"),
            lambda: actions.choose_scene("hurry_slow"),
            actions.step,
            lambda: actions.kick(1.4),
            actions.step,
            lambda: actions.push("along"),
            lambda: actions.push("up"),
            lambda: actions.set_parameters({"top.Mgl": 0.05, "friction.axial": 1e-6}),
            actions.step,
            lambda: actions.pull(self.run.axes[-1] + 0.1),
            lambda: actions.start({"theta": 4.0}),  # refused
            lambda: actions.restart_from(self.run.history[1]),
            lambda: actions.set_parameters({"real_time_factor": 0.25}),
            lambda: actions.request("reset"),
            actions.step,
        )
        messages = []
        counts = (1, 1, 2, 1, 1, 1, 1, 1, 1, 1, 1, 0, 2, 1, 1, 1)
        for act, count in zip(acts, counts, strict=True):
            before = len(self.events)
            try:
                act()
            except RefusedError as refusal:
                messages.append(str(refusal))
            self.look(before + count)
        return messages

    def story(self):
        """Names, verdicts and values of the events after the first reset of the paused top."""
        begin = next(k for k, event in enumerate(self.events) if event.name == "reset")
        told = []
        for event in self.events[begin + 1 :]:
            values = {key: value for key, value in event.values.items() if key not in OF_THE_CLOCK}
            told.append((event.name, event.verdict, values))
        return told


class Spinning:
    """A node that a thread spins, as its own process would."""

    def __init__(self, top):
        self.top, self._ending = top, threading.Event()
        self._thread = threading.Thread(target=self._spin, daemon=True)
        self._thread.start()

    def _spin(self):
        while not self._ending.is_set():
            self.top.executor.spin_once(timeout_sec=0.01)

    def close(self):
        self._ending.set()
        self._thread.join()


@pytest.fixture(name="node")
def _node():
    """A node, and the top that the page has of it."""
    running = RunningTop(realtime=True, scene="cusps", real_time_factor=0.1)
    spinning = Spinning(running)
    user = rclpy.create_node("top_panel", context=running.context, start_parameter_services=False)
    source = NodeTop(user, "/top")
    yield running, source
    source.close()
    spinning.close()
    user.destroy_node()
    running.close()


def test_both_tops_send_the_same_events_bit_for_bit(node):
    _, source = node
    own = Played(LocalTop("cusps", factor=0.1))
    other = Played(source)
    messages = own.play()
    assert other.play() == messages
    (refusal,) = messages
    assert refusal.startswith("theta must be ")
    assert other.story() == own.story()
    assert len(own.story()) == 15
    assert [event.name for event in own.run.history] == [event.name for event in other.run.history]
    own.source.close()


def test_what_is_drawn_is_what_the_node_publishes(node):
    _, source = node
    played = Played(source)
    played.look(1)
    expected = played.run.segment.state_at(played.run.stamp)
    assert (played.run.state.orientation == expected.orientation).all()


def test_a_torque_reaches_the_node(node):
    _, source = node
    played = Played(source)
    played.look(1)
    deadline = time.monotonic() + TIMEOUT
    while played.events[-1].name != "torque":
        source.hold_torque((0.0, 0.0, 5e-4))
        time.sleep(0.02)
        played.events += played.run.follow(source.batch())
        assert time.monotonic() < deadline
    assert played.run.motion.applied_torque[2] in (5e-4, 0.0)  # 0: after its time-out


def test_an_unwatched_node_sends_events_only(node):
    running, source = node
    source.watch(False)
    deadline = time.monotonic() + TIMEOUT
    while running.top.count_subscribers("/top/orientation"):
        assert time.monotonic() < deadline
        time.sleep(0.01)
    source.batch()
    assert source.request("reset")[0]
    events = []
    while not events:
        batch = source.batch()
        assert not batch.columns
        events += batch.events
        assert time.monotonic() < deadline
    source.watch(True)
    while not source.batch().columns:
        assert time.monotonic() < deadline


def test_a_node_that_is_gone_and_back_is_reported_once_each(node, monkeypatch):
    running, source = node
    played = Played(source)
    played.look(1)
    running.top._pacer.stop()  # no samples: as after its end
    played.source.batch()
    source._heard -= SILENCE
    deadline = time.monotonic() + TIMEOUT
    reports = []
    while not reports:
        source.batch()
        source._heard -= SILENCE
        reports = source.reports()
        assert time.monotonic() < deadline
    (silence,) = reports
    assert f"/top for {SILENCE:g} s" in silence
    source.batch()
    assert source.reports() == []
    running.top.simulation.tick()
    while not reports[1:]:
        running.top.simulation.tick()
        source.batch()
        reports += source.reports()
        assert time.monotonic() < deadline
    assert reports[1] == "samples from /top again"


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_a_signal_ends_the_program_silently(number, monkeypatch):
    monkeypatch.setenv("ROS_DOMAIN_ID", str(claim_domain()))
    with running_panel("--node", "lab/top") as (process, url), open_pages(url, least=1):
        process.send_signal(number)
        output, errors = process.communicate(timeout=TIMEOUT)
    assert (process.returncode, output, errors) == (0, "", "")


def test_a_missing_node_is_one_message():
    context = rclpy.Context()
    rclpy.init(context=context)
    user = rclpy.create_node("top_panel", context=context, start_parameter_services=False)
    source = NodeTop(user, "missing")
    source._connection._timeout = 0.1
    assert source.name == "/missing"
    granted, answer = source.request("kick", {"precession_rate": 1.0})
    assert not granted
    assert answer.startswith("no answer from /missing ")
    assert source.log is None
    source.close()
    user.destroy_node()
    rclpy.try_shutdown(context=context)
