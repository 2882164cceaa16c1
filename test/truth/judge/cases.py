"""Runs and estimates for the tests of `top_judge`: logs written without ROS, and known errors."""

from dataclasses import dataclass, replace

import numpy as np
from physics.tops import ARTICLE, CUSPS, multiply
from scipy.spatial.transform import Rotation

from symtop_ros.base.arrays import compose, invert
from symtop_ros.physics import Motion, hurry
from symtop_ros.run.simulation.changes.follow import Act, Change
from symtop_ros.run.simulation.events import Event
from symtop_ros.run.simulation.segment import Segment
from symtop_ros.truth.judge.truth import Truth
from symtop_ros.truth.topics.estimates import FORMATS, Estimates

SECOND = 1_000_000_000
NONE = Rotation.identity()
KICK = 3_123_456_789  # ns


def make_events():
    """A start, a kick, a pause, and a run in slow motion."""
    segment = Segment.begin(Motion(ARTICLE, CUSPS), 0, 1.0)
    events = [Event.of(Change(Act("start", 0, {}), CUSPS, segment))]
    for name, stamp, change in (
        ("kick", KICK, lambda s: s.change(KICK, hurry(s.state_at(KICK), 1.4))),
        ("pause", 5 * SECOND, lambda s: s.pause(5 * SECOND)),
        ("resume", 6 * SECOND, lambda s: s.resume(6 * SECOND)),
        ("pace", 7 * SECOND, lambda s: s.set_factor(0.1, 7 * SECOND)),
    ):
        before = segment.state_at(stamp)
        segment = change(segment)
        events.append(Event.of(Change(Act(name, stamp, {}), before, segment)))
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


def write_rows(estimates, separator=",", order=range(4), middle=(), header=(), seconds=True):
    """A table of estimates: times, further numbers, and the components of states in an order."""
    rows = [separator.join(header)] if header else []
    numbers = np.hstack((estimates.orientations, estimates.angular_velocities))[:, order].tolist()
    for stamp, each in zip(estimates.stamps.tolist(), numbers, strict=True):
        time = f"{stamp // 10**9}.{stamp % 10**9:09d}" if seconds else str(stamp)
        rows.append(separator.join([time, *middle, *map(repr, each)]))
    return "\n".join(rows) + "\n"


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
    layout = form.layout(*names)
    places = form.quantities
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


NED = Rotation.from_quat([np.sqrt(0.5), np.sqrt(0.5), 0.0, 0.0])
FRD = Rotation.from_rotvec([np.pi, 0.0, 0.0])
TILT = Rotation.from_rotvec([0.4, 0.2, 0.0])


def heading(angle):
    return Rotation.from_rotvec([0.0, 0.0, angle])


@dataclass(frozen=True)
class Made:
    """An error of estimates."""

    world: Rotation = NONE
    body: Rotation = NONE
    delay: float = 0.0
    drift: float = 0.0
    spin: float = 0.0
    clock: float = 0.0
    scale: float = 0.0  # of a gyroscope whose rates are integrated
    change: str = ""
    noise: float = 0.0
    other: str = ""  # errors that no cause explains

    def make(self, truth, stamps, seed=1):
        """Return estimates with these errors."""
        random = np.random.default_rng(seed)
        seconds = (stamps - stamps[0]) / SECOND
        shifted = stamps - np.rint(self.clock * (stamps - stamps[0])).astype(np.int64)
        found = make_estimates(truth, shifted, delay=self.delay)
        q = found.orientations
        if self.scale:
            late = shifted - round(self.delay * SECOND)
            q = integrate_rates(truth, late, 1 + self.scale)
        q = compose(turn_z(self.drift * seconds), compose(wxyz(self.world), q))
        q = compose(compose(q, turn_z(self.spin * seconds)), wxyz(self.body))
        q = OTHERS[self.other](q)
        if self.noise:
            q = compose(q, wxyz(Rotation.from_rotvec(random.normal(0, self.noise, (len(q), 3)))))
        return replace(found, stamps=stamps, orientations=WRONG[self.change](q))


def integrate_rates(truth, stamps, factor):
    """Attitudes that follow from rates in the body frame, times a factor; exact at the first stamp.

    Magnus' series of fourth order in steps of at most 100 us: at 300 rad/s they turn by 0.03 rad.
    """
    begin, end = int(stamps[0]), int(stamps[-1])
    marks = np.unique(np.concatenate((stamps, np.arange(begin, end, 100_000))))
    widths = np.diff(marks)
    early, late = (
        factor * truth.states_at(marks[:-1] + np.rint(part * widths).astype(np.int64))[1]
        for part in (0.5 - 3**0.5 / 6, 0.5 + 3**0.5 / 6)
    )
    steps = widths[:, np.newaxis] / SECOND
    turns = (early + late) / 2 * steps + 3**0.5 / 12 * steps**2 * np.cross(early, late)
    attitude = truth.states_at(stamps[:1])[0][0]
    path = []
    wanted = set(stamps.tolist())
    steps = wxyz(Rotation.from_rotvec(turns))
    for mark, step in zip(marks.tolist(), [*steps, None], strict=True):
        if mark in wanted:
            path.append(attitude)
        if step is not None:
            attitude = multiply(attitude, step)
    return np.array(path)


def wxyz(rotation):
    return rotation.as_quat()[..., [3, 0, 1, 2]]


def turn_z(angles):
    return wxyz(Rotation.from_rotvec(np.outer(angles, [0.0, 0.0, 1.0])))


WRONG = {
    "": lambda q: q,
    "order": lambda q: q[:, [1, 2, 3, 0]],
    "conjugate": invert,
    "conjugate_order": lambda q: invert(q)[:, [1, 2, 3, 0]],
}
OTHERS = {
    "": lambda q: q,
    "wave": lambda q: compose(turn_z(np.sin(np.arange(len(q)) * 0.05)), q),
    "still": lambda q: np.tile(q[:1], (len(q), 1)),
}
