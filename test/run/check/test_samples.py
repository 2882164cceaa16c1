"""A correct log agrees with its events to the last bit, and a wrong log is detected."""

from dataclasses import fields

import numpy as np
import pytest
from exact_log import compare_samples
from log_files import ARTICLE, LAYOUTS, Run

from symtop_ros.physics import Friction, Motion, State, Top
from symtop_ros.replay.main import main
from symtop_ros.run.check.run import check_run
from symtop_ros.run.check.samples import LogCheck
from symtop_ros.run.log.batch import Columns
from symtop_ros.run.log.catalog import Catalog
from symtop_ros.run.log.event_order import Ordered
from symtop_ros.run.log.intervals import Interval
from symtop_ros.run.log.reader import LogError, McapFile
from symtop_ros.run.log.top_log import TopLog
from symtop_ros.run.simulation.changes.follow import Act, Change
from symtop_ros.run.simulation.events import MAX_STAMP, Event, start_event
from symtop_ros.run.simulation.segment import Segment
from symtop_ros.run.simulation.topics import SAMPLE_TOPICS, Samples

pytestmark = pytest.mark.numbers

EPS = np.finfo(float).eps


def make_catalog(events, places, intervals=()):
    """The catalog of a log that has some events, all of one run."""
    ordered = Ordered(tuple(events), tuple(places), (0,) * len(events))
    others = dict.fromkeys((field.name for field in fields(Catalog)), ())
    return Catalog(**others | {"ordered": ordered, "intervals": tuple(intervals)})


def deviations_of(run, folder):
    return compare_samples(TopLog(McapFile(run.write(folder))))


RUNS = [
    {"start": State.from_euler(theta=0.5, psi_dot=200.0)},
    {"top": Top(2e-4, 3e-4, -0.05), "start": State.from_euler(theta=2, phi_dot=3, psi_dot=-40)},
    {"top": Top(2e-4, 1e-4, 0.0), "start": State.from_euler(theta=1, phi_dot=3, psi_dot=40)},
    # a disc in its pivot that has weight: no body, of which the force is known, is like that
    {"top": Top(2e-4, 4e-4, 0.05), "start": State.from_euler(theta=0.5, psi_dot=100.0)},
    # on the vertical phi' means nothing
    {"start": State.from_euler(theta=0, theta_dot=1, psi_dot=60), "hurried": False},
    {"friction": Friction(2e-6, 1e-5), "torque": (1e-4, 0.0, 2e-4), "seconds": 4.0},
]


@pytest.mark.parametrize("arguments", RUNS)
def test_a_correct_log_agrees_to_the_last_bit(arguments, tmp_path):
    run = Run(**arguments)
    for name, deviation in deviations_of(run, tmp_path).items():
        assert (name, deviation.largest, deviation.unchecked) == (name, 0.0, 0)
        assert deviation.samples == run.seconds * run.rate


NONE = Friction()
WEAK = Friction(1e-6, 1e-6)
SIZES = [(NONE, 4, False), (WEAK, 4, True), (WEAK, 400, False)]


@pytest.mark.parametrize(("friction", "size", "is_accepted"), SIZES)
def test_rounding_is_accepted_in_a_driven_motion_alone(friction, size, is_accepted, tmp_path):
    run = Run(friction=friction, seconds=0.25)
    for place, (name, *_) in enumerate(run.messages):
        if name in LAYOUTS:
            run.change(place, lambda numbers: numbers * (1 + size * EPS))
    for deviation in deviations_of(run, tmp_path).values():
        assert deviation.relative > 0
        assert deviation.is_rounding is is_accepted


@pytest.mark.parametrize("friction", [NONE, WEAK])
def test_an_angle_that_is_a_turn_off_is_the_same_angle_in_a_driven_motion_alone(friction, tmp_path):
    run = Run(friction=friction, seconds=0.25)
    turn = np.array([2 * np.pi, 0, -2 * np.pi, 0, 0, 0])
    for place in run.places("euler_angles"):
        run.change(place, lambda numbers: numbers + turn)
    assert deviations_of(run, tmp_path)["euler_angles"].is_rounding == (friction is WEAK)


WRONG = {
    "one bit": lambda numbers: np.nextafter(numbers, np.inf),
    "a billionth": lambda numbers: numbers * (1 + 1e-9),
    "no number": lambda numbers: numbers * np.nan,
}


@pytest.mark.parametrize("name", list(LAYOUTS))
@pytest.mark.parametrize("change", WRONG)
def test_one_wrong_number_is_damage_however_small_the_difference(name, change, tmp_path):
    def falsify(numbers):
        is_largest = np.abs(numbers) == np.abs(numbers).max()
        return np.where(is_largest, WRONG[change](numbers), numbers)

    run = Run(seconds=0.5)
    run.change(run.places(name)[70], falsify)
    deviations = deviations_of(run, tmp_path)
    assert not deviations[name].is_rounding
    found = {other: each.differing for other, each in deviations.items()}
    assert found == {**dict.fromkeys(LAYOUTS, 0), name: 1}


def test_a_message_with_another_frame_is_damage(tmp_path):
    run = Run()
    k = run.places("torque")[7]
    _, stamp, data = run.messages[k]
    run.messages[k] = "torque", stamp, data.replace(b"world", b"vorld")
    log = TopLog(McapFile(run.write(tmp_path)))
    (damage,) = log.catalog.problems
    assert damage.startswith("torque: 1 ")
    assert "vorld" in damage


def test_a_log_without_fields_is_read_and_left_to_its_version(tmp_path, monkeypatch, capsys):
    monkeypatch.setattr("symtop_ros.run.simulation.events.FORMAT", "2")
    path = Run(seconds=0.2).write(tmp_path)
    monkeypatch.undo()
    log = TopLog(McapFile(path))
    assert sum(len(batch.columns["orientation"].stamps) for batch in log.batches()) > 10
    with pytest.raises(LogError, match=r"format of events must be 3 for a check, got 2: symtop"):
        check_run(TopLog(McapFile(path)))
    assert main([str(path), "--check"]) == 1
    assert f"symtop_ros test, which has recorded {path}, can check it" in capsys.readouterr().err


def test_a_sample_that_agrees_with_two_events_belongs_to_the_exact_one():
    """After a jump of the clock back the states of repeated stamps may be the same but rounding."""
    first = start_event(Motion(ARTICLE, State.from_euler(theta=0.5, psi_dot=200.0)))
    before = first.segment()
    begin = 100_000_000
    end = 900_000_000
    assert (first.stamp, first.state(), first.state_before()) == (0, *[before.state_at(0)] * 2)
    start = before.state_at(begin)
    after = Segment.begin(Motion(ARTICLE, start), begin, 1.0)
    request = {"from": str(end), "to": str(begin)}
    back = Event.of(Change(Act("clock", begin, request), start, after), 2)
    stamps = np.arange(begin, end, 5_000_000)
    topic = SAMPLE_TOPICS["orientation"]
    numbers = topic.compute(Samples.at(before, stamps))
    assert (numbers != topic.compute(Samples.at(after, stamps))).any()
    check = LogCheck(make_catalog([first, back], places=[0, 1]))
    check.add("orientation", Columns(stamps, numbers, np.arange(2, 162)))
    found = check.deviations["orientation"]
    assert (found.samples, found.differing) == (len(stamps), 0)


def test_where_the_motion_is_not_known_a_number_is_that_of_an_event_by_its_own_size():
    event = start_event(Motion(ARTICLE, State.from_euler(theta=0.5, psi_dot=200.0)))
    stamps = np.arange(10) * 5_000_000
    numbers = SAMPLE_TOPICS["torque"].compute(Samples.at(event.segment(), stamps)).copy()
    numbers[3, 3] += 1e-14  # N m of 0.03, of which it is far above the rounding; of 1 it is not
    intervals = [Interval(0, 1, event), Interval(1, MAX_STAMP, None, "lost", (1, 100))]
    check = LogCheck(make_catalog([event], places=[0], intervals=intervals))
    check.add("torque", Columns(stamps, numbers, np.arange(1, 11)))
    assert check.deviations["torque"].unjudged == 1


def test_only_rates_of_a_held_precession_may_be_rounded_in_older_logs():
    """Up to version 0.5 phi' and psi' were those of the state, not exactly 0 and omega_z."""
    event = start_event(Motion(ARTICLE, State.from_euler(theta=0.5, psi_dot=200.0), clamped=True))
    stamps = np.arange(1, 101) * 5_000_000
    samples = Samples.at(event.segment(), stamps)
    now = SAMPLE_TOPICS["euler_angles"].compute(samples)
    older = np.stack([*samples.state.euler_angles, *samples.state.euler_rates], axis=-1)
    assert (now != older).any()
    wrong = older.copy()
    wrong[7, 3] += 1e-16
    for numbers, differing in ((now, 0), (older, 0), (wrong, 1)):
        check = LogCheck(make_catalog([event], places=[0]))
        check.add("euler_angles", Columns(stamps, numbers, np.arange(1, 101)))
        assert check.deviations["euler_angles"].differing == differing


@pytest.mark.parametrize(("theta", "is_rounding"), [(2.0**-10, True), (1.0, False)])
def test_the_angles_of_a_driven_motion_have_fewer_digits_next_to_the_pole_only(theta, is_rounding):
    """Of phi and psi rounding leaves eps / sin(theta)."""
    start = State.from_euler(theta=theta, psi_dot=200.0)
    event = start_event(Motion(ARTICLE, start, Friction(axial=1e-9)))
    stamps = np.arange(1, 11) * 100_000  # in a ms nothing else has lost digits
    numbers = SAMPLE_TOPICS["euler_angles"].compute(Samples.at(event.segment(), stamps)).copy()
    numbers[:, 0] += 30 * 2.0**-52 * 2.0**10  # of 64 that are allowed
    check = LogCheck(make_catalog([event], places=[0]))
    check.add("euler_angles", Columns(stamps, numbers, np.arange(1, 11)))
    assert check.deviations["euler_angles"].is_rounding == is_rounding
