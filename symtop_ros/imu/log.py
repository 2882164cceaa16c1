"""A sensor record as an MCAP log, with the event from which `top_judge` computes the run."""

import os
import tempfile
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import numpy as np

from symtop_ros.arrays import Real
from symtop_ros.imu.record import ImuRecord
from symtop_ros.log.writer import LogFile
from symtop_ros.simulation.sensor.imu import EXACT, EXACT_FIELD
from symtop_ros.simulation.topics import EVENTS, SENSOR_TOPICS, STATE_TOPICS, StateTopic, imu_frame
from symtop_ros.wire.messages import IMU, MAGNETIC_FIELD, ODOMETRY

NODE, WORLD = "/top", "world"
SENSOR = imu_frame("top")
Content = tuple[str, StateTopic, tuple[str, ...], Real]  # name, type, frames and numbers


def write_log(record: ImuRecord, path: Path) -> None:
    """Write the topics of a record in the order of their stamps."""
    contents = [*_contents(record)]
    topics = [("events", EVENTS), *(content[:2] for content in contents)]
    channels = [replace(topic, ros_name=f"{NODE}/{name}") for name, topic in topics]
    layouts = [topic.format.layout(*frames) for _, topic, frames, _ in contents]
    rows = [numbers.tolist() for *_, numbers in contents]
    with tempfile.TemporaryDirectory(dir=path.absolute().parent) as folder:
        log = LogFile(Path(folder), channels, {"program": "top_imu"}, {})
        log.write(0, 0, record.event.encode(WORLD, NODE))
        for place, stamp in enumerate(record.stamps.tolist()):
            for channel, (layout, table) in enumerate(zip(layouts, rows, strict=True), start=1):
                log.write(channel, stamp, layout.encode(stamp, table[place]))
        log.finish({"dropped": "0"})
        os.replace(log.path, path)


def _contents(record: ImuRecord) -> Iterator[Content]:
    """Yield the attitude of the body, measurements, exact values, and odometry of the sensor."""
    imu, exact = record.imu, np.concatenate((record.rates, record.forces), axis=1)
    yield "orientation", STATE_TOPICS["orientation"], (WORLD,), record.attitudes[:, [1, 2, 3, 0]]
    measured = exact + imu.noise(record.stamps)
    variances = tuple(imu.covariances.values())[1:]
    yield _inertial("imu", record, measured, variances)
    if record.means is not None:
        yield _inertial("imu_average", record, record.measured, variances)
        yield _inertial("imu_average_exact", record, record.means)
    yield _inertial("imu_exact", record, exact)
    if record.fields is not None and record.measured_fields is not None and imu.magnetometer:
        variance = imu.magnetometer.variance(imu.rate)
        yield _magnetic("magnetic_field", record.measured_fields, variance)
        yield _magnetic("magnetic_field_exact", record.fields, EXACT_FIELD)
    yield "imu_odometry", SENSOR_TOPICS["odometry"], (WORLD, SENSOR), _odometry(record)


def _inertial(
    name: str, record: ImuRecord, values: Real, variances: tuple[float, ...] = (EXACT, EXACT)
) -> Content:
    measured = {
        "orientation": record.orientations[:, [1, 2, 3, 0]],
        "angular_velocity": values[:, :3],
        "linear_acceleration": values[:, 3:],
    }
    covariances = zip([f"{each}_covariance" for each in measured], (EXACT, *variances), strict=True)
    numbers = IMU.arrange((len(values),), {**measured, **dict(covariances)})
    return name, SENSOR_TOPICS["imu"], (SENSOR,), numbers


def _magnetic(name: str, fields: Real, variance: float) -> Content:
    values = {"magnetic_field": fields, "magnetic_field_covariance": variance}
    numbers = MAGNETIC_FIELD.arrange((len(fields),), values)
    return name, SENSOR_TOPICS["magnetic_field"], (SENSOR,), numbers


def _odometry(record: ImuRecord) -> Real:
    """Return pose of the sensor in the world, and twist in its own frame."""
    values = {
        "position": record.positions,
        "orientation": record.orientations[:, [1, 2, 3, 0]],
        "pose_covariance": EXACT,
        "linear": record.to_sensor(record.velocities),
        "angular": record.rates,
        "twist_covariance": EXACT,
    }
    return ODOMETRY.arrange((len(record.stamps),), values)
