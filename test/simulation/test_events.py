import inspect
from dataclasses import replace
from fractions import Fraction

import numpy as np
import pytest
from log_files import ARTICLE, BEGIN, CUSPS

from symtop_ros.physics import Friction, Motion, State, Top
from symtop_ros.simulation.events import Event
from symtop_ros.simulation.segment import Segment
from symtop_ros.simulation.sensor.imu import Imu, Magnetometer, Rig


def event_of(segment, stamp=BEGIN):
    return Event.of(stamp, "kick", None, {"hold": "spin_rate"}, segment.motion.start, segment)


# A value for each number of a motion, other than its default: a new one must be added here, and
# comes back only if it is in the event.
NUMBERS = {
    Top: {"Ix": 2.3e-4, "Iz": 6e-5, "Mgl": 0.07},
    State: {"orientation": (0.8, 0.0, 0.6, 0.0), "angular_velocity": (1.0, 2.0, 150.0)},
    Friction: {"axial": 1.3e-6, "transverse": 2.3e-6},
    Magnetometer: {
        "vector": (1e-5, 2e-5, -3e-5),
        "magnetometer_noise_density": 5e-8,
        "magnetometer_random_walk": 6e-9,
        "seed": 7,
    },
    Imu: {
        "position": (0.1, 0.2, 0.3),
        "orientation": (0.6, 0.0, 0.8, 0.0),
        "gyroscope_noise_density": 1e-4,
        "gyroscope_random_walk": 2e-4,
        "accelerometer_noise_density": 3e-4,
        "accelerometer_random_walk": 4e-4,
        "seed": 5,
        "rate": 300.0,
        "begin": 6,
    },
}


def make(kind, **given):
    """A record with a value for each of its parameters."""
    values = {**NUMBERS.get(kind, {}), **given}
    assert set(inspect.signature(kind).parameters) == set(values), kind
    return kind(**values)


def test_every_number_of_a_motion_and_of_its_sensor_comes_back_from_its_event():
    parts = {"top": make(Top), "start": make(State), "friction": make(Friction)}
    motion = make(Motion, **parts, torque=(1e-5, 2e-5, 3e-5))
    rig = make(Rig, gravity=9.7, imu=make(Imu, magnetometer=make(Magnetometer)))
    fields = {"stamp": BEGIN, "elapsed": Fraction(7, 4), "factor": 0.7, "running": False}
    segment = make(Segment, motion=motion, **fields, rig=rig)
    again = event_of(segment).segment()
    assert {name: getattr(again, name) for name in fields} == fields
    assert again.rig == rig
    assert again.motion.applied_torque == motion.applied_torque
    for name, part in parts.items():
        for number in NUMBERS[type(part)]:
            values = (
                np.asarray(getattr(getattr(each.motion, name), number)) for each in (segment, again)
            )
            assert np.array_equal(*values), (name, number)


def test_an_event_without_a_valid_top_is_refused():
    event = event_of(Segment.begin(Motion(ARTICLE, CUSPS), BEGIN, 1.0))
    for bad in ("", "1 2", "a b c", "-1.0 1.0 1.0"):
        with pytest.raises(ValueError, match=r"\S"):
            replace(event, values={**event.values, "top": bad}).segment()


@pytest.mark.parametrize("factor", ["1e-301", "1000001.0"])
def test_an_event_with_a_factor_beyond_every_run_is_refused(factor):
    event = event_of(Segment.begin(Motion(ARTICLE, CUSPS), BEGIN, 1.0))
    values = {**event.values, "motion.real_time_factor": factor}
    with pytest.raises(ValueError, match=r"real_time_factor must be 1e-300 to 1e\+06, got"):
        replace(event, values=values).segment()
