"""Runs and estimates for the tests of `top_judge`: logs written without ROS."""

import numpy as np
from physics.tops import ARTICLE, CUSPS
from scipy.spatial.transform import Rotation

from symtop_ros.judge.estimates import FORMATS, Estimates
from symtop_ros.judge.truth import Truth
from symtop_ros.physics import Motion, hurry
from symtop_ros.simulation.events import Event
from symtop_ros.simulation.segment import Segment

SECOND = 1_000_000_000
NONE = Rotation.identity()
KICK = 3_123_456_789  # ns


def make_events():
    """A start, a kick, a pause, and a run in slow motion."""
    segment = Segment.begin(Motion(ARTICLE, CUSPS), 0, 1.0)
    events = [Event.of(0, "start", None, {}, CUSPS, segment)]
    for name, stamp, change in (
        ("kick", KICK, lambda s: s.change(KICK, hurry(s.state_at(KICK), 1.4))),
        ("pause", 5 * SECOND, lambda s: s.pause(5 * SECOND)),
        ("resume", 6 * SECOND, lambda s: s.resume(6 * SECOND)),
        ("pace", 7 * SECOND, lambda s: s.set_factor(0.1, 7 * SECOND)),
    ):
        before = segment.state_at(stamp)
        segment = change(segment)
        events.append(Event.of(stamp, name, None, {}, before, segment))
    return events


def make_estimates(truth, stamps, world=NONE, body=NONE, delay=0.0):
    """Estimates that are turned and late."""
    exact, rates, known = truth.states_at(stamps - round(delay * SECOND))
    assert known.all()
    q = Rotation.from_quat(exact[:, [1, 2, 3, 0]])
    turned = (world * q * body).as_quat()[:, [3, 0, 1, 2]]
    return Estimates.of(stamps, turned, body.inv().apply(rates))


def truth_and_stamps(count=3000, seed=1):
    stamps = np.sort(np.random.default_rng(seed).integers(SECOND, 9 * SECOND, count))
    return Truth(make_events()), stamps


SOME = make_estimates(*truth_and_stamps(50))


def write_log(path, topics):
    """Write a log with the events and, for each topic, its type and its messages (stamp, bytes)."""
    from log_files import write_mcap  # it needs mcap

    events = [(event.stamp, event.encode("world")) for event in make_events()]
    content = {"/top/events": ("diagnostic_msgs/msg/DiagnosticArray", events), **topics}
    return write_mcap(path, [(name, *each) for name, each in content.items()])


def encode(kind, estimates):
    """Messages of a type with the attitudes (and rates) of estimates."""
    form = FORMATS[kind]
    names = ("world", "sensor")[: 2 if "Transform" in kind or "Odometry" in kind else 1]
    layout, places = form.layout(*names), form.quantities
    q, rates = (
        next((places[name] for name in names if name in places), None)
        for names in (("orientation", "rotation"), ("angular_velocity", "angular"))
    )
    numbers = np.zeros((len(estimates), form.width))
    numbers[:, q] = estimates.orientations[:, [1, 2, 3, 0]]
    if rates is not None:
        numbers[:, rates] = estimates.angular_velocities
    data = layout.encode_many(estimates.stamps, numbers)
    return kind, [*zip(estimates.stamps.tolist(), data, strict=True)]
