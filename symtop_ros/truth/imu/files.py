"""Files of a sensor record: one table, an MCAP log, or the folders of EuRoC with poses as of TUM.

With each is the event from which `top_judge` computes the run.
"""

import json
import os
import tempfile
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import asdict, replace
from itertools import chain
from pathlib import Path

import numpy as np

from symtop_ros.base.arrays import Real
from symtop_ros.physics import State
from symtop_ros.run.simulation.sensor.imu import (
    EXACT,
    EXACT_FIELD,
    LIMITS,
    MAGNETOMETER_NOISE,
    NOISE,
)
from symtop_ros.run.simulation.topics import (
    EVENTS,
    SENSOR_TOPICS,
    STATE_TOPICS,
    StateTopic,
    imu_frame,
)
from symtop_ros.run.wire.layout import NANOSECONDS
from symtop_ros.run.wire.messages import IMU, MAGNETIC_FIELD, ODOMETRY
from symtop_ros.truth.imu.record import ImuRecord

# The columns of the table, and further ones with --average or a magnetometer.
INERTIAL = ["wx", "wy", "wz", "fx", "fy", "fz"]
TABLE = ["stamp", *"wxyz", "px", "py", "pz", "vx", "vy", "vz", *INERTIAL]
MORE = {
    "means": [f"mean_{name}" for name in INERTIAL],
    "measured": [f"measured_{name}" for name in INERTIAL],
    "fields": ["mx", "my", "mz"],
    "measured_fields": ["measured_mx", "measured_my", "measured_mz"],
}
EUROC_IMU = [
    "#timestamp [ns]",
    *(f"w_RS_S_{axis} [rad s^-1]" for axis in "xyz"),
    *(f"a_RS_S_{axis} [m s^-2]" for axis in "xyz"),
]
EUROC_FIELD = ["#timestamp [ns]", *(f"m_S_{axis} [T]" for axis in "xyz")]
EUROC_TRUTH = [
    "#timestamp",
    *(f" p_RS_R_{axis} [m]" for axis in "xyz"),
    *(f" q_RS_{axis} []" for axis in "wxyz"),
    *(f" v_RS_R_{axis} [m s^-1]" for axis in "xyz"),
    *(f" b_w_RS_S_{axis} [rad s^-1]" for axis in "xyz"),
    *(f" b_a_RS_S_{axis} [m s^-2]" for axis in "xyz"),
]
NODE, WORLD = "/top", "world"
SENSOR = imu_frame("top")
Content = tuple[str, StateTopic, tuple[str, ...], Real]  # name, type, frames and numbers


def write_table(record: ImuRecord, path: Path) -> None:
    """Write one CSV file with everything, and the event of the run into a JSON file next to it."""
    truth = [record.orientations, record.positions, record.velocities, record.rates, record.forces]
    more = [name for name in MORE if getattr(record, name) is not None]
    names = [*TABLE, *chain(*(MORE[name] for name in more))]
    columns = [*truth, *(getattr(record, name) for name in more)]
    _write_csv(path, names, record.stamps.tolist(), columns)
    write_events(record, path.with_suffix(".json"))


def write_folder(record: ImuRecord, folder: Path) -> None:
    """Write the two folders of EuRoC, one of a magnetometer, poses.tum, and events.json."""
    inertial, truth = folder / "imu0", folder / "state_groundtruth_estimate0"
    for each in (inertial, truth):
        each.mkdir(parents=True, exist_ok=True)
    imu = record.imu
    stamps = record.stamps.tolist()
    _write_csv(inertial / "data.csv", EUROC_IMU, stamps, [record.measured])
    names = *NOISE, *(name for name in LIMITS if getattr(imu, name))
    (inertial / "sensor.yaml").write_text(_describe("imu", imu.rate, imu, names), encoding="utf-8")
    states = [record.positions, record.orientations, record.velocities, record.biases]
    _write_csv(truth / "data.csv", EUROC_TRUTH, stamps, states)
    if record.measured_fields is not None:
        (folder / "mag0").mkdir(exist_ok=True)
        _write_csv(folder / "mag0/data.csv", EUROC_FIELD, stamps, [record.measured_fields])
        text = _describe("magnetometer", imu.rate, imu.magnetometer, MAGNETOMETER_NOISE)
        (folder / "mag0/sensor.yaml").write_text(text, encoding="utf-8")
    _write_tum(record, folder / "poses.tum")
    write_events(record, folder / "events.json")


def write_events(record: ImuRecord, path: Path) -> None:
    """Write the event of the run as JSON, for `top_judge`."""
    events = [{**asdict(record.event), "values": dict(record.event.values)}]
    text = json.dumps({"events": events, "end": int(record.stamps[-1])}, indent=1)
    path.write_text(text + "\n", encoding="utf-8")


def _describe(kind: str, rate: float, sensor: object, names: Sequence[str]) -> str:
    """Return sensor.yaml: the noise by its names in EuRoC and in Kalibr, and the limits."""
    lines = ["%YAML:1.0", f"sensor_type: {kind}", f"rate_hz: {rate!r}"]
    return "\n".join([*lines, *(f"{name}: {getattr(sensor, name)!r}" for name in names), ""])


def _write_tum(record: ImuRecord, path: Path) -> None:
    """Write poses: timestamp tx ty tz qx qy qz qw."""
    poses = np.concatenate((record.positions, record.orientations[:, [1, 2, 3, 0]]), axis=1)
    stamps = (f"{s // NANOSECONDS}.{s % NANOSECONDS:09d}" for s in record.stamps.tolist())
    rows = (
        f"{stamp} {' '.join(map(repr, row))}\n"
        for stamp, row in zip(stamps, poses.tolist(), strict=True)
    )
    path.write_text("".join(rows), encoding="utf-8")


def _write_csv(
    path: Path, names: Sequence[str], stamps: Iterable[int], columns: Sequence[Real]
) -> None:
    """Write stamps and numbers, in decimals that read back to the same doubles."""
    rows = np.concatenate(columns, axis=1).tolist()
    lines = (f"{s},{','.join(map(repr, row))}\n" for s, row in zip(stamps, rows, strict=True))
    path.write_text(f"{','.join(names)}\n{''.join(lines)}", encoding="utf-8")


def write_log(record: ImuRecord, path: Path) -> None:
    """Write the topics of a record in the order of their stamps."""
    from symtop_ros.run.log.reader import log_errors  # only logs need mcap
    from symtop_ros.run.log.writer import NODE_ENTRY, TOPICS_ENTRY, LogFile

    contents = [*_contents(record)]
    topics = [("events", EVENTS), *(content[:2] for content in contents)]
    channels = [replace(topic, ros_name=f"{NODE}/{name}") for name, topic in topics]
    names = {name: f"{NODE}/{name}" for name, topic in topics if name == topic.name}
    metadata = {"program": "top_imu", NODE_ENTRY: NODE, TOPICS_ENTRY: json.dumps(names)}
    layouts = [topic.format.layout(*frames) for _, topic, frames, _ in contents]
    rows = [numbers.tolist() for *_, numbers in contents]
    parent = path.absolute().parent
    with log_errors("write", path), tempfile.TemporaryDirectory(dir=parent) as folder:
        log = LogFile(Path(folder), channels, metadata, {})
        log.write(0, 0, record.event.encode(WORLD, NODE))
        for place, stamp in enumerate(record.stamps.tolist()):
            for channel, (layout, table) in enumerate(zip(layouts, rows, strict=True), start=1):
                log.write(channel, stamp, layout.encode(stamp, table[place]))
        log.finish({"dropped": "0"})
        os.replace(log.path, path)


def _contents(record: ImuRecord) -> Iterator[Content]:
    """Yield the attitude of the body, measurements, exact values, and odometry of the sensor."""
    imu = record.imu
    exact = np.concatenate((record.rates, record.forces), axis=1)
    yield "orientation", STATE_TOPICS["orientation"], (WORLD,), record.attitudes[:, [1, 2, 3, 0]]
    variances = tuple(imu.covariances.values())[1:]
    yield _inertial("imu", record, imu.show(exact, record.stamps), variances)
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
    state = State._wrap(record.orientations, record.rates)
    values = {
        "position": record.positions,
        "orientation": record.orientations[:, [1, 2, 3, 0]],
        "pose_covariance": EXACT,
        "linear": state.to_body(record.velocities),
        "angular": record.rates,
        "twist_covariance": EXACT,
    }
    return ODOMETRY.arrange((len(record.stamps),), values)
