"""Topics of a run: who gets which bytes."""

from types import SimpleNamespace

import numpy as np
import pytest
from drawn import normalize
from exact_log import read_messages
from rosbags.typesys import Stores, get_typestore
from run.simulation.runs import HandClock

from symtop_ros.physics import ExactTimes
from symtop_ros.run.models.urdf import LENGTH
from symtop_ros.run.session.diagnostics import log_status, pace_status
from symtop_ros.run.session.outputs import ARROWS, PERIOD, Markers
from symtop_ros.run.session.session import Session
from symtop_ros.run.simulation.changes.requests import start_motion
from symtop_ros.run.simulation.settings import Settings
from symtop_ros.run.simulation.topics import imu_frame
from symtop_ros.run.wire.diagnostics import ERROR, OK, WARN
from symtop_ros.run.wire.messages import CLOCK

SECOND = 1_000_000_000


class Publisher:
    """Keeps the bytes that it publishes."""

    def __init__(self):
        self.has_subscriber = False
        self.sent = []

    def publish(self, data):
        self.sent.append(data)


class Program:
    """A host without ROS that keeps what it is sent."""

    def __init__(self, publishes=True):
        self.is_open = True
        self._publishes = publishes
        self.publishers = {}
        self.said, self.warnings, self.errors = [], [], []

    def resolve(self, topic):
        return topic.resolve("/top")

    def create_publisher_of(self, topic):
        if not self._publishes:
            return None
        return self.publishers.setdefault(topic.name, Publisher())

    def update_statuses(self):
        return []

    def inform(self, text):
        self.said.append(text)

    def warn(self, text):
        self.warnings.append(text)

    def report_error(self, text):
        self.errors.append(text)

    def fail(self, failure):
        self.errors.append(str(failure))


def start(host, scene="cusps", points="", **changes):
    clock = HandClock()
    session = Session(Settings.from_scene(scene, **changes), clock, host, scene, {}, points=points)
    return session, clock


def advance(session, clock, seconds):
    clock.now += round(seconds * SECOND)
    while (wait := session.simulation.tick()) is not None and wait <= 0:
        pass


def test_a_topic_is_published_while_it_has_a_subscriber_and_a_latched_one_always():
    host = Program()
    session, clock = start(host)
    host.publishers["torque"].has_subscriber = True
    advance(session, clock, 0.5)
    assert len(host.publishers["torque"].sent) == 101
    assert host.publishers["orientation"].sent == []
    assert len(host.publishers["events"].sent) == 1
    assert len(host.publishers["robot_description"].sent) == 1


def record_with_markers(folder):
    """Record a second of a run with markers; return the path of the log."""
    options = {"record__enabled": True, "record__directory": str(folder)}
    session, clock = start(Program(), publish_markers=True, publish_rate=100.0, **options)
    path = session.recording.path
    for _ in range(10):
        advance(session, clock, 0.1)
    session.close()
    return path


def test_markers_are_logged_thirty_times_a_second_and_rosbags_reads_them(tmp_path):
    logged = read_messages(record_with_markers(tmp_path))
    data = [each for topic, _, each in logged if topic == "/top/markers"]
    assert len(data) == 31
    types = get_typestore(Stores.ROS2_JAZZY)
    last = types.deserialize_cdr(data[-1], "visualization_msgs/msg/MarkerArray")
    assert types.serialize_cdr(last, "visualization_msgs/msg/MarkerArray") == data[-1]
    trace, *arrows = last.markers
    assert [each.ns for each in arrows] == list(ARROWS)
    assert (len(trace.points), trace.type, trace.header.frame_id) == (31, trace.LINE_STRIP, "world")
    assert {each.type for each in arrows} == {trace.ARROW}
    for arrow in arrows:  # thin compared with the top
        assert 0 < trace.scale.x < arrow.scale.x < arrow.scale.y < LENGTH / 16
    assert {each.scale.z for each in last.markers} == {trace.scale.y} == {0.0}
    for each in last.markers:  # points in the world frame itself
        place, turn = each.pose.position, each.pose.orientation
        assert (place.x, place.y, place.z) == (turn.x, turn.y, turn.z) == (0, 0, 0)
    motion = start_motion(Settings.from_scene("cusps"))
    stamp = trace.header.stamp
    state = motion.at(ExactTimes(stamp.sec * SECOND + stamp.nanosec))
    vectors = [state.to_world(each) for each in ([0.0, 0.0, 1.0], state.angular_velocity)]
    vectors += [motion.top.angular_momentum(state), motion.top.gravity_torque(state)]
    ends = [trace.points[-1], *(each.points[1] for each in arrows)]
    for point, vector in zip(ends, vectors, strict=True):
        # rounding of a product and a division
        end = normalize([point.x, point.y, point.z])
        assert end == pytest.approx(normalize(vector), abs=1e-15)
    assert np.linalg.norm([*vars(trace.points[-1]).values()][:3]) == pytest.approx(LENGTH)
    colors = {(each.color.r, each.color.g, each.color.b) for each in last.markers}
    assert len(colors) == len(last.markers)  # each has its own
    assert all(0.0 <= part <= 1.0 for color in colors for part in color)
    assert {each.color.a for each in last.markers} == {1.0}  # rviz hides what is transparent
    assert {each.action for each in last.markers} == {trace.ADD}
    assert not any(each.frame_locked or each.colors or each.text for each in last.markers)
    assert {(each.lifetime.sec, each.lifetime.nanosec) for each in last.markers} == {(0, 0)}


def test_the_largest_vector_so_far_is_an_arrow_of_its_own_length(tmp_path):
    """About the length of the top, and each of a different length: they do not hide each other."""
    logged = read_messages(record_with_markers(tmp_path))
    types = get_typestore(Stores.ROS2_JAZZY)
    longest = dict.fromkeys(ARROWS, 0.0)
    for topic, _, data in logged:
        if topic == "/top/markers":
            _, *arrows = types.deserialize_cdr(data, "visualization_msgs/msg/MarkerArray").markers
            for arrow in arrows:
                tip = arrow.points[1]
                longest[arrow.ns] = max(longest[arrow.ns], np.hypot(np.hypot(tip.x, tip.y), tip.z))
    lengths = {"angular_velocity": 1.4, "angular_momentum": 1.2, "torque": 0.7}
    assert longest == pytest.approx({name: LENGTH * each for name, each in lengths.items()})


def test_markers_are_due_at_the_first_sample_of_a_period_and_after_a_jump_back():
    markers = Markers("world")
    stamps = 0, 0, PERIOD - 1, PERIOD, 2 * PERIOD + 1, PERIOD - 1
    assert [*map(markers.is_due, stamps)] == [True, False, False, True, True, True]


def test_the_clock_has_the_stamp_of_each_sample_and_is_sent_while_the_motion_rests():
    host = Program()
    session, clock = start(host, publish_clock=True)
    clock.is_simulated = False
    host.publishers["clock"].has_subscriber = True
    advance(session, clock, 0.05)
    sent = host.publishers["clock"].sent
    assert sent == [CLOCK.encode(k * SECOND // 200, ()) for k in range(11)]
    assert session.answer("pause", lambda: True)[0]
    count = len(sent)
    session.keep_up()
    assert len(sent) == count + 1


SLOW = {"initial__precession": "slow", "initial__psi_dot": 200.0}
HEAVY = {"top__Mgl": 1e16}  # it swings at 7e9 rad/s
NO_ROOT, TOO_FAST = (
    "initial.precession must be a rate that .* no real root$",
    "motion must be so slow ",
)


IMPOSSIBLE = [
    (SLOW, {"initial.psi_dot": 3.0}, NO_ROOT),
    (SLOW, {"top.Mgl": 10.0}, NO_ROOT),
    (HEAVY, {"top.Mgl": 1e24}, TOO_FAST),
    (HEAVY, {"real_time_factor": 100.0}, TOO_FAST),
]


@pytest.mark.parametrize(("begun", "changes", "reason"), IMPOSSIBLE)
def test_parameters_without_a_motion_are_refused_when_they_are_planned(begun, changes, reason):
    session, _ = start(Program(), **begun)
    with pytest.raises(ValueError, match=f"^{reason}"):
        session.plan_settings(changes)


def test_the_urdf_moves_by_tf_while_that_is_published():
    host = Program()
    session, clock = start(host, publish_tf=False)
    host.publishers["tf"].has_subscriber = True
    counts = []
    for is_published in (True, False):
        advance(session, clock, 0.1)
        counts.append(len(host.publishers["tf"].sent))
        session.apply_settings({"publish_tf": is_published})
    advance(session, clock, 0.1)
    assert [*counts, len(host.publishers["tf"].sent)] == [0, 20, 20]
    descriptions = host.publishers["robot_description"].sent
    assert [b"floating" in each for each in descriptions] == [False, True, False]


def test_without_odometry_the_sensor_alone_has_a_fixed_frame():
    host = Program()
    place = (0.25, 0.5, -1.0)
    attitude = (0.6, 0.0, 0.8, 0.0)
    start(host, imu__enabled=True, imu__position=place, imu__orientation=attitude)
    (sent,) = host.publishers["tf_static"].sent
    types = get_typestore(Stores.ROS2_JAZZY)
    (frame,) = types.deserialize_cdr(sent, "tf2_msgs/msg/TFMessage").transforms
    assert (frame.header.frame_id, frame.child_frame_id) == ("top", imu_frame("top"))
    translation, rotation = frame.transform.translation, frame.transform.rotation
    assert (translation.x, translation.y, translation.z) == place
    assert (rotation.x, rotation.y, rotation.z, rotation.w) == attitude


def test_with_odometry_the_centre_of_mass_has_a_frame_on_the_axis():
    host = Program()
    session, _ = start(host, odometry__enabled=True)
    (sent,) = host.publishers["tf_static"].sent
    types = get_typestore(Stores.ROS2_JAZZY)
    (frame,) = types.deserialize_cdr(sent, "tf2_msgs/msg/TFMessage").transforms
    assert (frame.header.frame_id, frame.child_frame_id) == ("top", "top_centre_of_mass")
    settings, place = session.simulation.settings, frame.transform.translation
    arm = settings.body.arm
    assert (place.x, place.y, place.z) == (0.0, 0.0, arm)
    session.apply_settings({"odometry.enabled": True, "top.Mgl": settings.top.Mgl / 2})
    assert len(host.publishers["tf_static"].sent) == 2  # it moves with the arm


PACES = [
    (2.0, 0, OK, "on time"),
    (0.5, 0, WARN, "too fast for the compute budget"),
    (2.0, 19, OK, "19 samples missed in a gap of 0.095 s"),  # less than a tenth of a second
    (2.0, 20, WARN, "20 samples missed in a gap of 0.1 s"),
]


@pytest.mark.parametrize(("kept", "missed", "level", "text"), PACES)
def test_a_slower_pace_and_missed_ticks_are_a_warning(kept, missed, level, text):
    session, _ = start(Program(), real_time_factor=2.0)
    simulation = session.simulation
    simulation.apply(simulation.timeline.set_pace(simulation.stamp, 2.0, kept))
    simulation.ticker.missed = missed
    if missed:
        simulation.gaps.add(missed, simulation.ticker.rate, 0)
    for achieved in (kept, 0.0):
        status = pace_status(simulation)
        assert (status.level, status.values["real_time_factor.achieved"]) == (level, str(achieved))
        assert text in status.message
        session.answer("pause", lambda: True)


def test_waiting_for_late_samples_is_a_warning_with_the_pace():
    session, clock = start(Program(), publish_clock=True, real_time_factor=2.0)
    clock.is_simulated = False
    clock.now += SECOND
    session.keep_up()
    status = pace_status(session.simulation)
    assert status.level == WARN
    said = "/clock waited 0.9 s for late samples: real-time factor 0.2 instead of 2"
    assert status.message == said
    assert float(status.values["waited"]) == 0.9
    assert float(status.values["real_time_factor.achieved"]) == pytest.approx(0.2, rel=1e-15)
    for _ in range(20):
        advance(session, clock, 0.05)
    session.keep_up()
    assert pace_status(session.simulation).level == OK


RECORDINGS = [(7, "a: no space", ERROR), (7, "", WARN), (0, "", OK)]


@pytest.mark.parametrize(("dropped", "failure", "level"), RECORDINGS)
def test_a_failed_recording_is_an_error_and_dropped_messages_are_a_warning(dropped, failure, level):
    recorder = SimpleNamespace(path="a", dropped=dropped, failure=failure, running=not failure)
    status = log_status(recorder)
    facts = {"file": "a", "dropped": str(dropped)}
    assert (status.level, status.values) == (level, facts)
    assert failure in status.message
