"""Outcomes of events, as fields that read back to the same records."""

import pytest
from simulation.runs import Run

from symtop_ros.simulation.changes import outcomes
from symtop_ros.simulation.changes.outcomes import OUTCOMES, Setting
from symtop_ros.simulation.events import Event, decode_events


@pytest.fixture(scope="module", name="run")
def _run():
    """A run with an event of every name."""
    run = Run("cusps", publish_clock=False)
    simulation = run.simulation
    run.advance(0.1)
    run.ask("kick", {"precession_rate_factor": 1.4, "hold": "spin_momentum"})
    run.ask("kick", {"angular_impulse": (0.0, 0.0, 1e-5)})
    run.ask("kick", {"axle_impulse": 1e-6, "rate": 50.0, "number": 20})
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


@pytest.mark.parametrize(
    ("name", "text"),
    [
        ("outcome.direction", "sinks"),
        ("outcome.turning_angles", "0.1 0.2 0.3"),
        ("outcome.turning_angles", "a b"),
        ("outcome.driven", "maybe"),
        ("outcome.reason.place.rate", ""),
    ],
)
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
