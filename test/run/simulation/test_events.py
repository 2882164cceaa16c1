"""Events of a run, and their outcomes, as fields that read back to the same records."""

import inspect
from dataclasses import replace
from fractions import Fraction

import numpy as np
import pytest
from log_files import ARTICLE, BEGIN, CUSPS
from run.simulation.runs import Run

from symtop_ros.physics import Friction, Motion, Pushes, State, Top
from symtop_ros.run.simulation.changes import outcomes
from symtop_ros.run.simulation.changes.follow import Act, Change
from symtop_ros.run.simulation.changes.outcomes import OUTCOMES, Setting
from symtop_ros.run.simulation.events import Event, decode_events
from symtop_ros.run.simulation.segment import Segment
from symtop_ros.run.simulation.sensor.imu import Imu, Magnetometer, Rig


def event_of(segment, stamp=BEGIN):
    act = Act("kick", stamp, {"hold": "spin_rate"})
    return Event.of(Change(act, segment.motion.start, segment))


VALUES = {  # of parameters that are no sizes of any kind
    "orientation": (0.6, 0.0, 0.8, 0.0),
    "angular_velocity": (1.0, 2.0, 150.0),
    "position": (0.1, 0.2, 0.3),
    "vector": (1e-5, 2e-5, -3e-5),
    "seed": 5,
    "begin": 6,
}


def make(kind, **given):
    """A record with a value for each of its parameters, other than its default.

    It comes back only if it is in the event.
    """
    parameters = dict(inspect.signature(kind).parameters)
    parameters.pop("clamped", None)  # nothing pushes a motion that is held
    parameters.pop("tolerance", None)  # refused in a run
    sizes = {name: 1e-3 * number for number, name in enumerate(parameters, start=2)}
    values = {name: {**sizes, **VALUES, **given}[name] for name in parameters}
    assert all(values[name] != each.default for name, each in parameters.items())
    return kind(**values)


def test_every_number_of_a_motion_and_of_its_sensor_comes_back_from_its_event():
    parts = {"top": make(Top), "start": make(State), "friction": make(Friction)}
    parts["pushes"] = make(Pushes, rate=20.0, number=7)
    motion = make(Motion, **parts, torque=(1e-5, 2e-5, 3e-5))
    rig = make(Rig, gravity=9.7, imu=make(Imu, magnetometer=make(Magnetometer, seed=7)))
    fields = {"stamp": BEGIN, "elapsed": Fraction(7, 4), "factor": 0.7, "running": False}
    segment = make(Segment, motion=motion, **fields, rig=rig)
    again = event_of(segment).segment()
    assert {name: getattr(again, name) for name in fields} == fields
    assert again.rig == rig
    assert again.motion.applied_torque == motion.applied_torque
    for name, part in parts.items():
        for number in inspect.signature(type(part)).parameters:
            found = getattr(getattr(again.motion, name), number)
            assert np.array_equal(found, getattr(part, number)), (name, number)


def test_a_run_refuses_a_motion_whose_bits_its_events_do_not_have():
    damped = Motion(ARTICLE, CUSPS, Friction(1e-6, 1e-6), tolerance=1e-9)
    with pytest.raises(ValueError, match="tolerance must be 0 in a run, got 1e-09"):
        Segment.begin(damped, BEGIN, 1.0)


def test_a_clamp_comes_back_from_its_event_and_was_none_in_events_of_before():
    held = event_of(Segment.begin(Motion(ARTICLE, CUSPS, clamped=True), BEGIN, 1.0))
    assert held.segment().motion.clamped
    values = {name: text for name, text in held.values.items() if name != "motion.clamped"}
    assert not replace(held, values=values).segment().motion.clamped


FACTOR = r"real_time_factor must be 1e-300 to 1e\+06, got"


DAMAGED = [
    *(({"top": text}, r"\S") for text in ("", "1 2", "a b c", "-1.0 1.0 1.0")),
    *(({"motion.real_time_factor": text}, FACTOR) for text in ("1e-301", "1000001.0")),
    *(({"gravity": text}, "must") for text in ("-1", "nan")),
    ({"imu.mount": "0 0 0 0 0 0 1", "imu.noise": "0 0 0 0 0"}, "unpack|values"),
    ({"imu.mount": "0 0 0", "imu.noise": "0 0 0 0 1"}, "unpack|values"),
    ({"imu.mount": "0 0 0 0 0 0 9", "imu.seed": "0", "imu.begin": "0"}, "must"),
]


@pytest.mark.parametrize(("values", "reason"), DAMAGED)
def test_a_damaged_event_is_refused(values, reason):
    event = event_of(Segment.begin(Motion(ARTICLE, CUSPS), BEGIN, 1.0, Rig(9.81)))
    given = {"gravity": "9.81", "imu.noise": "0 0 0 0 1", **values}
    with pytest.raises(ValueError, match=reason):
        replace(event, values={**event.values, **given}).segment()


@pytest.fixture(scope="module", name="run")
def _run():
    """A run with an event of every name."""
    run = Run("cusps", publish_clock=False)
    simulation = run.simulation
    run.advance(0.1)
    run.ask("kick", {"precession_rate_factor": 1.4, "hold": "spin_momentum"})
    run.ask("kick", {"angular_impulse": (0.0, 0.0, 1e-5)})
    run.ask("kick", {"axle_impulse": 1e-6, "rate": 50.0, "number": 20})
    run.ask("release")
    run.ask("clamp", True)
    run.ask("clamp", False)
    run.ask("pause", True)
    run.ask("step", {"duration": 0.01})
    run.ask("pause", False)
    run.ask("reset")
    simulation.hold_torque((0.0, 0.0, 1e-4))
    run.advance(0.3)
    run.change({"hurry_factor": 1.5, "top.Mgl": 0.05})
    simulation.do("record", {}, outcomes.Record("begun", "a  b/c; d=e.mcap"))
    simulation.do("failure", {}, outcomes.Failure("~/kick", "KeyError", "by a bug"))
    simulation.apply(simulation.timeline.set_pace(simulation.stamp, 1.0, 0.25))
    run.jump(run.clock.now + 10**12)
    run.tick()
    return run


def again(event):
    (read,) = decode_events(event.encode("world"))
    return read


def test_an_event_of_every_name_reads_back_to_the_same_record_and_sentence(run):
    assert {event.name for event in run.sink.events} == set(OUTCOMES)
    for event in run.sink.events:
        read = again(event)
        assert read == event
        assert read.outcome() == event.outcome()
        assert type(read.outcome()) is OUTCOMES[event.name]


def test_each_outcome_has_the_numbers_of_its_event(run):
    found = {event.name: again(event).outcome() for event in run.sink.events}
    assert isinstance(found["start"], outcomes.Start)
    assert found["start"].motion == found["reset"].motion == "cusps"
    assert isinstance(found["pause"], outcomes.Pause)
    assert found["step"] == outcomes.Step("stepped", found["pause"].time + 0.01)
    assert found["torque"] == outcomes.Torque("released", (0.0, 0.0, 0.0))
    changes = (Setting("top.Mgl", "0.05"), Setting("hurry_factor", "1.5"))
    assert found["parameters"] == outcomes.Parameters(changes)
    assert (found["pace"].before, found["pace"].after) == (1.0, 0.25)
    assert found["clock"].after - found["clock"].before > 9e11
    assert found["record"].path == "a  b/c; d=e.mcap"


WRONG_FIELDS = [
    ("outcome.direction", "sinks"),
    ("outcome.turning_angles", "0.1 0.2 0.3"),
    ("outcome.turning_angles", "a b"),
    ("outcome.driven", "maybe"),
    ("outcome.reason.place.rate", ""),
]


@pytest.mark.parametrize(("name", "text"), WRONG_FIELDS)
def test_a_field_that_is_not_of_its_type_is_refused_and_the_motion_is_read(run, name, text):
    kick = next(event for event in run.sink.events if event.name == "kick")
    values = {**kick.values, name: text}
    (event,) = decode_events(Event(kick.stamp, "kick", "", values).encode("world"))
    assert event.segment().motion.start == kick.segment().motion.start
    with pytest.raises(ValueError, match=r"\S"):
        event.outcome()


def test_an_event_without_fields_has_its_request_and_no_outcome():
    run = Run("cusps")
    values = {"format": "2", "request": "from=5; to=7"}
    old = {name: text for name, text in run.sink.events[0].values.items() if "." in name}
    event = Event(7, "clock", "the clock jumped", {**old, **values})
    assert not event.has_fields
    assert (event.number, event.previous_end) == (0, 5)
    assert event.request == {"from": "5", "to": "7"}
