"""Entry point of `top_imu`: a record of an inertial sensor on the top of a scene."""

import argparse
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import yaml

from symtop_ros.base.command import decimal, integer, new_parser, tell_failures
from symtop_ros.base.refusals import RefusedError, one_line, refuse
from symtop_ros.run.simulation.changes.requests import start_motion
from symtop_ros.run.simulation.sensor.imu import BMM150, CONSUMER, MAGNETOMETER_NOISE, NOISE
from symtop_ros.run.simulation.settings import Settings
from symtop_ros.truth.imu.files import write_folder, write_log, write_table
from symtop_ros.truth.imu.record import ImuRecord, record_imu

INSTRUMENTS = "gyroscope", "accelerometer"
MAX_BYTES = 65_536  # of a file with noise
DESCRIPTION = """Write what an inertial sensor on the top measures, next to the exact truth: a log
(FILE.mcap), a table (FILE.csv, with the event of the run in FILE.json), or a folder with CSV
files in the form of EuRoC and poses in the form of TUM. Stamps begin at 0."""


def main(args: list[str] | None = None) -> int:
    """Write a record; return 0 (good), 1 (refused or failed) or 2 (usage)."""
    return tell_failures("top_imu", lambda: _run(make_parser().parse_args(args)))


def _run(options: argparse.Namespace) -> int:
    write = find_writer(options.output)
    record = make_record(options)
    write(record, options.output)
    print(f"{options.output}: {len(record.stamps)} samples at {record.imu.rate:g} Hz")
    return 0


def make_record(options: argparse.Namespace) -> ImuRecord:
    """Return the record that the options ask for."""
    kinds = dict.fromkeys(NOISE, "imu") | dict.fromkeys(MAGNETOMETER_NOISE, "magnetic_field")
    noise = {
        f"{kinds[name]}__noise__{name}": value for name, value in read_noise(options.noise).items()
    }
    settings = Settings.from_scene(
        options.scene,
        imu__enabled=True,
        imu__position=options.position,
        imu__orientation=options.orientation,
        imu__noise__seed=options.seed,
        magnetic_field__enabled=options.magnetic_field is not None,
        magnetic_field__vector=options.magnetic_field or (),
        magnetic_field__noise__seed=options.seed,
        **noise,
        **find_limits(options),
    )
    assert settings.imu  # it is enabled
    return record_imu(
        start_motion(settings),
        replace(settings.imu, rate=options.rate),
        options.seconds,
        gravity=settings.gravity,
        average=options.average,
    )


def find_limits(options: argparse.Namespace) -> dict[str, float]:
    """Return the parameters of the range and of the resolution that are given."""
    found: dict[str, float] = {}
    for name in ("range", "resolution"):
        numbers = getattr(options, name)
        if len(numbers) > len(INSTRUMENTS):
            raise refuse(f"--{name}", "one number or two", len(numbers))
        found |= {
            f"imu__limits__{instrument}_{name}": number
            for instrument, number in zip(INSTRUMENTS, numbers, strict=False)
        }
    return found


def read_noise(name: str | None) -> dict[str, Any]:
    """Return the noise of "consumer", or of a YAML file with the names of Kalibr."""
    if name is None:
        return {}
    if name == "consumer":
        return {each: getattr(CONSUMER, each) for each in NOISE} | {MAGNETOMETER_NOISE[0]: BMM150}
    with open(name, "rb") as file:
        text = file.read(MAX_BYTES + 1)
    try:
        content = yaml.safe_load(text[:MAX_BYTES].removeprefix(b"%YAML:1.0"))
        found = {e: content[e] for e in (*NOISE, *MAGNETOMETER_NOISE) if e in content}
    except (yaml.YAMLError, TypeError, ValueError):
        found = {}
    if not found:
        raise RefusedError(
            f"--noise must be consumer or YAML with {NOISE[0]}, got {one_line(name)}"
        )
    return found


def find_writer(path: Path) -> Callable[[ImuRecord, Path], None]:
    """Return the function that writes the format selected by the name of a path."""
    writers = {".mcap": write_log, ".csv": write_table, "": write_folder}
    if path.suffix in writers or path.is_dir():
        return writers.get(path.suffix, write_folder)
    raise refuse("--output", "FILE.mcap, FILE.csv or a folder (without an ending)", str(path))


def decimals(text: str) -> list[float]:
    """Read numbers with commas between them."""
    return [decimal(part) for part in text.split(",")]


def make_parser() -> argparse.ArgumentParser:
    """Return the parser of the command line."""
    parser = new_parser("top_imu", DESCRIPTION)
    parser.add_argument("--scene", default="cusps", help="name of a scene, default cusps")
    parser.add_argument(
        "--rate", type=decimal, default=200.0, help="samples per second, default 200"
    )
    parser.add_argument("--seconds", type=decimal, default=20.0, help="duration, default 20")
    parser.add_argument(
        "--position",
        type=decimal,
        nargs=3,
        default=(),
        metavar=("X", "Y", "Z"),
        help="position of the sensor in the body frame, m; default: the pivot",
    )
    parser.add_argument(
        "--orientation",
        type=decimal,
        nargs=4,
        default=(),
        metavar=("X", "Y", "Z", "W"),
        help="quaternion, sensor to body, W last (links of the page and tables have w first); "
        "default: parallel to the axes of the body",
    )
    parser.add_argument(
        "--magnetic-field",
        type=decimals,
        nargs="?",
        const=(),
        metavar="X,Y,Z",
        help="record a magnetometer in this field (T, world; write =X,Y,Z if X is negative); "
        "default: as in central Europe, with y north",
    )
    parser.add_argument(
        "--noise",
        metavar="FILE",
        help="`consumer`, or a YAML file in the form of Kalibr; default: no noise",
    )
    for name, what, default in (
        ("range", "largest value", "unlimited"),
        ("resolution", "step of the values", "not rounded"),
    ):
        parser.add_argument(
            f"--{name}",
            type=decimal,
            nargs="+",
            default=(),
            metavar=("RAD/S", "M/S^2"),
            help=f"{what} of the gyroscope, and of the accelerometer; default: {default}",
        )
    parser.add_argument("--seed", type=integer, default=0, help="seed of the noise, default 0")
    parser.add_argument(
        "--average",
        action="store_true",
        help="output means over the sample interval, as integrating sensors do",
    )
    parser.add_argument(
        "-o",
        "--output",
        type=Path,
        required=True,
        metavar="PATH",
        help="FILE.mcap, FILE.csv or a folder",
    )
    return parser
