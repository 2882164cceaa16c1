"""Contents of a recording, read back by the reader of Rerun."""

import numpy as np
import pytest
from log_files import ARTICLE, BEGIN, Run
from replay.view.rows import arrows, entities_of, record, recording_to, rows, strict
from run.log.damaged import SECOND, Log, Recorded

from symtop_ros.physics import ExactTimes, Motion, specific_force
from symtop_ros.replay.view import entities
from symtop_ros.replay.view.view import View, ViewOptions
from symtop_ros.replay.viewer import replay
from symtop_ros.run.log.bags import open_run
from symtop_ros.run.log.batch import Batch, BatchReader, Columns
from symtop_ros.run.log.reader import McapFile
from symtop_ros.run.log.top_log import TopLog
from symtop_ros.run.simulation.changes.follow import Act, Change
from symtop_ros.run.simulation.events import Event
from symtop_ros.run.simulation.segment import Segment
from symtop_ros.run.simulation.sensor.imu import Imu, Rig
from symtop_ros.run.simulation.topics import SAMPLE_TOPICS, Samples

RUN = Run(seconds=2.0)
FLOAT = 2 * float(np.finfo(np.float32).eps)  # vectors and rotations are single precision in Rerun


@pytest.fixture(scope="module")
def recording(tmp_path_factory):
    return record(RUN, tmp_path_factory.mktemp("scene"))


@pytest.fixture(scope="module")
def truth():
    """States of the run, before the kick."""
    stamps = np.arange(200) * 5_000_000  # ns
    return stamps * 1e-9, Motion(ARTICLE, RUN.start).at(ExactTimes(stamps))


def test_the_body_is_turned_as_logged_at_every_sample(recording, truth):
    times, values = rows(recording, entities.BODY, "Transform3D:quaternion")
    assert times.tolist() == [stamp - BEGIN for name, stamp, _ in RUN.messages if name == "tf"]
    drawn = np.array([value[0] for value in values])[:200, [3, 0, 1, 2]]
    assert np.abs(drawn - truth[1].orientation).max() <= FLOAT


def test_arrows_are_the_vectors_over_one_scale_that_is_stated(recording, truth):
    momentum = ARTICLE.angular_momentum(truth[1])
    _, texts = rows(recording, entities.PANEL, "TextDocument:text")
    scale = float(texts[0][0].split("1 unit of L, omega, torque | **")[1].split(" ")[0])
    drawn = arrows(recording, entities.MOMENTUM)[:200]
    assert np.abs(drawn - momentum / scale).max() <= FLOAT * np.abs(momentum / scale).max()
    assert 1.3 < np.linalg.norm(drawn, axis=1).max() < 1.6


def test_the_trace_is_an_unbroken_line_on_the_unit_sphere(recording, truth):
    times, values = rows(recording, entities.TRACE, "LineStrips3D:strips")
    strips = np.array([value[0] for value in values])
    assert len(strips) == 399
    assert np.array_equal(strips[1:, 0], strips[:-1, 1])
    axis = truth[1].to_world([0.0, 0.0, 1.0])
    assert np.abs(strips[:199, 1] - axis[1:]).max() <= FLOAT
    assert times[0] == round(1e9 / 200)


def test_plots_hold_the_doubles_that_were_logged(recording, truth):
    L = ARTICLE.angular_momentum(truth[1])
    rates = truth[1].euler_rates
    for path, expected in (
        (entities.THETA, truth[1].euler_angles.theta[:, None]),
        (entities.PHI_DOT, rates.phi_dot[:, None]),
        (entities.PSI_DOT, rates.psi_dot[:, None]),
        (entities.L, L),
        (entities.L_HORIZONTAL, (L[:, :1] ** 2 + L[:, 1:2] ** 2)),
    ):
        assert rows(recording, path, "Scalars:scalars")[1][:200] == expected.tolist()


def test_constants_drift_by_rounding_only_and_start_anew_after_a_kick(recording):
    _, values = rows(recording, entities.DRIFT, "Scalars:scalars")
    drift = np.array(values)
    assert drift.shape == (400, 3)
    assert drift[0].tolist() == drift[200].tolist() == [0.0, 0.0, 0.0]
    # in eps: a product of some numbers, each with the rounding of the log's doubles
    assert np.abs(drift).max() < 16


def test_events_and_turning_circles_are_on_the_time_line(recording):
    times, texts = rows(recording, entities.EVENTS, "TextLog:text")
    kick = next(stamp for name, stamp, _ in RUN.messages[1:] if name == "events") - BEGIN
    assert times.tolist() == [0, kick]
    assert [text[0].split(":")[0].split(" (")[0] for text in texts] == ["start", "kick"]
    _, circles = rows(recording, entities.CIRCLES, "LineStrips3D:strips")
    low, high = Motion(ARTICLE, RUN.start).turning_angles
    heights = [strip[0][2] for strip in circles[0]]
    assert heights == pytest.approx(np.cos([low, high]), abs=FLOAT)


@pytest.mark.parametrize("missing", ["events", "orientation", "angular_momentum", "euler_angles"])
def test_a_scene_is_made_of_what_there_is(missing, tmp_path):
    log = Run().without(missing).open(tmp_path)
    target = tmp_path / "part.rrd"
    with strict():
        replay(log, target)
    assert any(missing in problem for problem in log.catalog.problems)
    assert len(rows(target, entities.BODY, "Transform3D:quaternion")[0]) == 400


def test_a_gap_in_the_log_is_not_drawn_across(tmp_path):
    run = Run(hurried=False)
    run.messages = [each for each in run.messages if not 0.5e9 < each[1] - BEGIN < 1.0e9]
    _, values = rows(record(run, tmp_path), entities.TRACE, "LineStrips3D:strips")
    strips = np.array([value[0] for value in values])
    steps = np.linalg.norm(strips[:, 1] - strips[:, 0], axis=1)
    assert steps.max() < 0.05  # a sample's worth; the gap is some tenths


@pytest.mark.slow
def test_samples_that_come_one_by_one_make_the_same_recording_as_all_at_once(tmp_path):
    run = Run(seconds=0.5)
    reader = BatchReader()
    with recording_to(tmp_path / "live.rrd") as recording:
        view = View(recording, live=True)
        for name, _, data in run.messages:
            view.send(reader.read([(name, data)]))
    _, values = rows(tmp_path / "live.rrd", entities.TRACE, "LineStrips3D:strips")
    assert len(values) == 99


def test_what_a_sensor_feels_is_an_arrow_in_the_world(tmp_path):
    stamps = np.arange(50) * 5_000_000
    imu = Imu((0.0, 0.0, 0.02), (0.6, 0.0, 0.0, 0.8))
    segment = Segment.begin(Motion(ARTICLE, RUN.start), 0, 1.0, Rig(9.81, imu))
    samples = Samples.at(segment, stamps)
    numbers = {name: SAMPLE_TOPICS[name].compute(samples) for name in ("orientation", "imu")}
    counts = 1 + np.arange(50)
    columns = {name: Columns(stamps, each, counts) for name, each in numbers.items()}
    event = Event.of(Change(Act("start", 0, {}), RUN.start, segment))
    file = tmp_path / "sensor.rrd"
    with recording_to(file) as recording:
        View(recording).send(Batch(columns, [(0, event)]))
    _, texts = rows(file, entities.PANEL, "TextDocument:text")
    assert "a + g z'" in texts[0][0]
    drawn = arrows(file, entities.SPECIFIC_FORCE)
    force = specific_force(segment.motion, samples.state, imu.position)
    world = samples.state.to_world(force)
    scale = np.linalg.norm(world, axis=1).max() / np.linalg.norm(drawn, axis=1).max()
    # the scale is rounded to two digits for the panel
    assert np.abs(drawn * float(f"{scale:.2g}") - world).max() <= 2 * FLOAT * np.abs(world).max()


@pytest.mark.parametrize(
    ("option", "own"),
    [
        ("torques", (entities.INERTIAL,)),
        ("fictitious", (entities.FICTITIOUS,)),
        ("angles", (entities.ANGLES, f"{entities.BODY}/axes")),
    ],
)
def test_what_is_drawn_only_if_asked(option, own, recording, tmp_path):
    added = entities_of(record(RUN, tmp_path, **{option: True})) - entities_of(recording)
    assert len(added) > 2
    assert all(each.startswith(own) for each in added), added
    assert not any(each.startswith(own) for each in entities_of(recording))


def test_an_event_that_files_repeat_is_drawn_once(tmp_path):
    recorded = Recorded(tmp_path)
    recorded.run(1.0)
    recorded.kick()
    recorded.run(1.5)
    log = Log.read(*recorded.close())
    parts = log.split(map(log.find_time, (SECOND // 2, 3 * SECOND // 2, 2 * SECOND)))
    paths = [part.write(tmp_path / f"{number}.mcap") for number, part in enumerate(parts)]
    replay(TopLog(open_run(paths)), tmp_path / "run.rrd")
    _, texts = rows(tmp_path / "run.rrd", entities.EVENTS, "TextLog:text")
    assert [text[0].partition(" ")[0] for text in texts] == ["start", "kick"]
    # The top that was not kicked differs from the top until the end.
    found = (
        rows(tmp_path / "run.rrd", entity, "Transform3D:quaternion")[1]
        for entity in (entities.BODY, entities.GHOST)
    )
    top, ghost = (np.array(values)[-1, 0] for values in found)
    assert np.abs(top - ghost).max() > 0.01


def test_where_an_event_is_lost_the_motion_is_said_to_be_unknown(tmp_path):
    recorded = Recorded(tmp_path)
    for _ in range(3):
        recorded.run(1.3)
        recorded.kick()
    recorded.run(1.0)
    (path,) = recorded.close()
    whole = Log.read(path)
    lost = whole.without([whole.places("/events")[2]]).write(tmp_path / "lost.mcap")
    log = TopLog(McapFile(lost))
    (unknown,) = log.catalog.unknown
    target = tmp_path / "run.rrd"
    replay(log, target, ViewOptions(fictitious=True))
    times, texts = rows(target, entities.PANEL, "TextDocument:text")
    said = [
        (time, "not known" in text[0]) for time, text in zip(times.tolist(), texts, strict=True)
    ]
    first = next(stamp for stamp in range(0, 10**10, 10**7) if stamp >= unknown.begin)
    last = unknown.end
    assert (first, True) in said
    assert (last, False) in said
    for entity, column in (
        (entities.DRIFT, "Scalars:scalars"),
        (entities.ENERGY, "Scalars:scalars"),
        (entities.GHOST, "Transform3D:quaternion"),
        (f"{entities.FICTITIOUS}/sum", "Arrows3D:vectors"),
        (f"{entities.POTENTIAL}/state", "Points2D:positions"),
    ):
        drawn = rows(target, entity, column)[0]
        assert len(drawn)
        assert not ((drawn >= first) & (drawn < last)).any(), entity
    bodies = rows(target, entities.BODY, "Transform3D:quaternion")[0]
    assert ((bodies >= first) & (bodies < last)).sum() > 50


def test_the_sentence_is_that_of_the_last_event_that_changed_the_motion(tmp_path):
    recorded = Recorded(tmp_path)
    for service, value in (
        ("kick", {"precession_rate_factor": 1.2}),
        ("clamp", True),
        ("pause", True),
        ("pause", False),
        ("clamp", False),
    ):
        recorded.run(0.5)
        recorded.ask(service, value)
    recorded.run(0.5)
    log = TopLog(McapFile(*recorded.close()))
    target = tmp_path / "run.rrd"
    replay(log, target)
    said = [text[0] for text in rows(target, entities.SENTENCE, "TextDocument:text")[1]]
    events = {event.name: event for event in log.catalog.events}
    names = "start", "kick", "clamp", "unclamp"
    assert said == [events[name].verdict for name in names]
    # A hand that holds the precession changes p_phi: there is no effective potential.
    drawn = rows(target, f"{entities.POTENTIAL}/state", "Points2D:positions")[0]
    first, last = (events[name].stamp - events["start"].stamp for name in names[2:])
    assert (drawn < first).any()
    assert (drawn > last).any()
    assert not ((drawn > first) & (drawn < last)).any()


@pytest.mark.parametrize(
    ("scene", "is_pushed", "condition"),
    [
        ("hurry_slow", False, ""),
        ("hurry_slow", True, "after the last push"),
        ("friction", False, "without friction"),
        ("friction", True, "without friction and later pushes"),
    ],
)
def test_the_table_says_when_its_angles_and_rates_hold(scene, is_pushed, condition, tmp_path):
    recorded = Recorded(tmp_path, scene=scene)
    if is_pushed:
        recorded.ask("kick", {"axle_impulse": 1e-5, "rate": 5.0, "number": 3})
    recorded.run(0.5)
    replay(TopLog(McapFile(*recorded.close())), tmp_path / "run.rrd")
    *_, (table,) = rows(tmp_path / "run.rrd", entities.PANEL, "TextDocument:text")[1]
    assert (f"| angles and rates | **{condition}** |" in table) == bool(condition)


def test_after_a_release_the_potential_is_that_of_the_pushes_that_were_given(tmp_path):
    recorded = Recorded(tmp_path)
    recorded.ask("kick", {"axle_impulse": 1e-5, "rate": 5.0, "number": 30})
    recorded.run(0.5)
    recorded.ask("release")
    recorded.run(0.5)
    log = TopLog(McapFile(*recorded.close()))
    replay(log, tmp_path / "run.rrd")
    _, labels = rows(tmp_path / "run.rrd", f"{entities.POTENTIAL}/marks", "Points2D:labels")
    low, _ = log.catalog.events[-1].segment().final_motion.turning_angles
    assert labels[-1][0] == f"{low:.3f} rad"
    assert labels[-1] != labels[-2]
