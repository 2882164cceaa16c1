"""Entry point of `top_fit`: find the motion of a top from a record of measurements."""

import argparse
import json
import shutil
import sys
from importlib.resources import as_file, files
from pathlib import Path
from typing import Any

import numpy as np

from symtop_ros.base.command import decimal, new_parser, positive, tell_failures
from symtop_ros.base.progress import Progress
from symtop_ros.base.refusals import RefusedError, refuse
from symtop_ros.truth.fit.aliases import SPINS
from symtop_ros.truth.fit.camera import CENTRE
from symtop_ros.truth.fit.check import FAILS
from symtop_ros.truth.fit.files import Rows, read_rows
from symtop_ros.truth.fit.kinds import KINDS, READ
from symtop_ros.truth.fit.limits import fit_record, leave_out_saturated
from symtop_ros.truth.fit.plan_options import add_options, make_plan, refuse_plan_options
from symtop_ros.truth.fit.plan_report import PlanReport
from symtop_ros.truth.fit.record import MOST, Known, Record, make_record
from symtop_ros.truth.fit.report import Report
from symtop_ros.truth.fit.runs import make_run
from symtop_ros.truth.fit.search import NEAREST
from symtop_ros.truth.residuals.sampling import (
    NANOSECONDS,
    describe_time_step,
    find_time_step,
)
from symtop_ros.truth.tables.forms import is_table

DESCRIPTION = """Find the motion of a heavy symmetric top from a measured record: a table, a log
or a bag. A table has named columns: t, and theta, phi; or x, y, z of the axis; or u, v of a point
in a picture; or wx, wy, wz of the body; or w, x, y, z. The program prints what the record shows,
with standard deviations, what it cannot show, and whether the model holds."""
EXAMPLE = "example.csv"
NOT_GIVEN = (None, False)
CAMERA_OPTIONS = "pivot", "scale", "elevation", "perspective", "distance", "centre", "size"
CLICKED = {"pivot": "U and V", "scale": "the length"}  # numbers that may have a deviation
RATIOS = ("Iz/Ix", "Ix", "Mgl")
WITHIN = "must have rates about the axis, got none within the range"


def main(args: list[str] | None = None) -> int:
    """Fit; return 0 (good), 1 (refused or failed, or the model does not hold) or 2 (usage)."""
    parser = make_parser()
    options = parser.parse_args(args)
    if sum(map(bool, (options.record, options.example, options.plan))) != 1:
        parser.error("one of RECORD, --example and --plan is needed")
    return tell_failures("top_fit", lambda: (_plan if options.plan else _run)(options))


def make_parser() -> argparse.ArgumentParser:
    """Return the parser of the command line."""
    parser = new_parser("top_fit", DESCRIPTION)
    parser.add_argument("record", nargs="?", type=Path, metavar="RECORD", help="table, log or bag")
    parser.add_argument(
        "--example", action="store_true", help=f"copy a record to ./{EXAMPLE} and fit it"
    )
    parser.add_argument(
        "--kind", choices=READ, help="kind of record, if the columns do not show it"
    )
    parser.add_argument("--topic", help="full name of a topic of a log")
    parser.add_argument("--frame", help="child frame of the top, for /tf")
    parser.add_argument("--friction", action="store_true", help="fit linear friction as well")
    parser.add_argument(
        "--mount",
        type=positive,
        metavar="RAD/S",
        help="fit the biases and the tilt of a gyroscope as well; RAD/S is the standard deviation "
        "of its bias about z, which no record shows",
    )
    for name, unit in zip(RATIOS, ("", " in kg m^2", " in J"), strict=True):
        parser.add_argument(
            f"--{name.replace('/', '-')}",
            type=positive,
            nargs=2,
            metavar=("VALUE", "DEVIATION"),
            dest=name,
            help=f"known {name}{unit}, with its standard deviation",
        )
    parser.add_argument(
        "--position",
        type=decimal,
        nargs=3,
        metavar=("X", "Y", "Z"),
        help="use the accelerometer as well; its position in the body frame, in m from the pivot",
    )
    parser.add_argument(
        "--pivot",
        type=decimal,
        nargs=2,
        metavar=("U", "V"),
        help="known position of the pivot in the picture",
    )
    parser.add_argument("--scale", type=positive, metavar="PIXELS", help="known length of the axis")
    for name, of in CLICKED.items():
        parser.add_argument(
            f"--{name}-deviation",
            type=positive,
            metavar="PIXELS",
            help=f"standard deviation of {of}, such as the error of a click; "
            f"without it --{name} is exact",
        )
    parser.add_argument(
        "--elevation", type=decimal, metavar="DEGREES", help="known elevation of the camera"
    )
    parser.add_argument(
        "--perspective", action="store_true", help="fit the distance of the camera as well"
    )
    parser.add_argument(
        "--distance",
        type=positive,
        metavar="LENGTHS",
        help="known distance of the camera from the pivot, in lengths of the axis",
    )
    parser.add_argument(
        "--centre",
        type=decimal,
        nargs=2,
        metavar=("U", "V"),
        help="point of the picture at which a near camera looks, usually its middle",
    )
    parser.add_argument(
        "--size",
        type=positive,
        nargs=2,
        metavar=("WIDTH", "HEIGHT"),
        help="size of the picture, whose middle is the centre; u and v count from its lower left "
        "corner",
    )
    add_options(parser)
    parser.add_argument("--json", action="store_true", help="print JSON instead of text")
    parser.add_argument(
        "--run",
        type=Path,
        metavar="FILE.json",
        help="write the motion with the measured points as a run of the page (run.json)",
    )
    parser.add_argument(
        "--plot", type=Path, metavar="FILE", help="draw record, motion and residuals (.png, .svg)"
    )
    return parser


def _plan(options: argparse.Namespace) -> int:
    """Print what a record will show."""
    kind = "inertial" if options.position else options.kind or "axis"
    _refuse_options(kind, options)
    for name in ("plot", "run"):
        if getattr(options, name):
            raise RefusedError(f"--{name} must be used with a record, got --plan")
    plan = make_plan(options, kind, describe_record(kind, options))
    given = {name: known for name, known in find_given(options).items() if known}
    report = PlanReport(" ".join(options.plan), plan, given)
    print(json.dumps(report.facts(), indent=1) if options.json else report.format())
    return 0


def _run(options: argparse.Namespace) -> int:
    refuse_plan_options(options)
    if options.run and options.run.suffix != ".json":
        raise refuse("--run", "a name that ends in .json", str(options.run))
    path = copy_example() if options.example else options.record
    progress = Progress("top_fit")
    if options.position:
        options.kind = "inertial"
    rows = read(path, options, progress)
    record = fill_record(rows, options)
    fit = fit_record(record, lambda part: progress.report(part, "fitting"))
    given = {name: known for name, known in find_given(options).items() if known}
    report = Report.compare(str(path), len(record), fit, given)
    progress.end()
    print(json.dumps(report.facts(), indent=1) if options.json else report.format())
    if options.plot:
        draw(report, options.plot)
    if options.run:
        refuse_run(report.fit.model.record)
        run = make_run(report.fit, len(record), given)
        run.write(options.run)
        print(run.describe(options.run), file=sys.stderr if options.json else sys.stdout)
    return int(report.verdict == FAILS)


def refuse_run(record: Record) -> None:
    """Refuse to write a fit that is not one motion with all its numbers."""
    if record.has_kick:
        raise RefusedError("--run must have one free motion, got two that a kick joins")
    if record.kind.name not in READ:
        raise RefusedError(f"--run {WITHIN}")


def copy_example() -> Path:
    """Copy the example into the working folder, and return its path."""
    path = Path(EXAMPLE)
    if not path.exists():
        with as_file(files("symtop_ros.truth.fit") / EXAMPLE) as own:
            shutil.copyfile(own, path)
    return path


def read(path: Path, options: argparse.Namespace, progress: Progress) -> Rows:
    """Return the rows of a table or a log."""
    if is_table(path):
        size = path.stat().st_size if path.exists() else 1
        return read_rows(path, options.kind, lambda done: progress.report(done / size, "reading"))
    from symtop_ros.truth.fit.logs import read_log  # logs need mcap

    return read_log(path, options.topic, options.frame, options.kind)


def fill_record(rows: Rows, options: argparse.Namespace) -> Record:
    """Return the record of some rows, completed by the options."""
    _refuse_options(rows.kind, options)
    rows = leave_out_saturated(rows.count_once())
    if options.mount is not None and rows.kind not in SPINS:  # a tilt shows as part of the spin
        raise RefusedError(f"--mount {WITHIN}")
    stamps = np.rint(rows.times * NANOSECONDS).astype(np.int64)
    notes = [*rows.notes, *describe_time_step(find_time_step(stamps))]
    if len(rows.times) > MOST:
        notes.append(f"{len(rows.times)} rows: {MOST} of them are taken, spread over the record")
    more = describe_record(rows.kind, options)
    return make_record(
        rows.times, rows.values, rows.kind, steps=rows.steps, **more, notes=tuple(notes)
    )


def describe_record(kind: str, options: argparse.Namespace) -> dict[str, Any]:
    """Return the attributes of a record that the options give."""
    return {
        "camera": find_camera(options) if kind == "pixels" else {},
        "known": find_known(kind, options),
        "has_friction": options.friction,
        "has_mount": options.mount is not None,
        "has_perspective": options.perspective,
        "position": tuple(options.position or ()),
    }


def _refuse_options(kind: str, options: argparse.Namespace) -> None:
    """Refuse options that say something of a different kind of record."""
    if options.mount is not None and kind not in SPINS:
        raise RefusedError(f"--mount must be used with a record of rates, got {kind}")
    if kind == "inertial" and not options.position:
        raise RefusedError("--position must be the place of the accelerometer, got none")
    of_cameras = [f"--{name}" for name in CAMERA_OPTIONS if getattr(options, name) not in NOT_GIVEN]
    if kind != "pixels" and of_cameras:
        raise RefusedError(f"{of_cameras[0]} must be used with a record of pixels, got {kind}")
    for name in CLICKED:
        if getattr(options, f"{name}_deviation") and not getattr(options, name):
            raise RefusedError(f"--{name}-deviation must be used with --{name}, got none")
    if options.centre and options.size:
        raise RefusedError("--centre must not be given with --size, which sets it")
    if options.perspective and options.distance:
        raise RefusedError("--distance must not be given with --perspective, which fits it")
    if options.distance and options.distance <= 1 / NEAREST:
        raise RefusedError(f"--distance must be > {1 / NEAREST:.3g}, got {options.distance:g}")


def find_camera(options: argparse.Namespace) -> dict[str, float]:
    """Return the numbers of a camera that are known exactly."""
    found: dict[str, float] = {}
    if options.pivot and not options.pivot_deviation:
        found |= dict(zip("uv", options.pivot, strict=True))
    if options.scale and not options.scale_deviation:
        found["log_scale"] = float(np.log(options.scale))
    if options.distance:
        found["nearness"] = 1 / options.distance
    if options.elevation is not None:
        found["elevation"] = float(np.radians(options.elevation))
    centre = options.centre or ([each / 2 for each in options.size] if options.size else None)
    return found | (dict(zip(CENTRE, centre, strict=True)) if centre else {})


def find_given(options: argparse.Namespace) -> dict[str, Known | None]:
    """Return the known values of the options, by name."""
    values = {name: getattr(options, name) for name in RATIOS}
    return {name: (each[0], each[1]) if each else None for name, each in values.items()}


def find_known(kind: str, options: argparse.Namespace) -> dict[str, Known]:
    """Return known parameters of the fit: ratios, a bias of zero, and clicked points."""
    given, known = find_given(options), find_clicked(options)
    ratio, size, weight = (given[name] for name in RATIOS)
    if ratio and KINDS[kind].shows_spin:
        known["Iz/Ix"] = ratio
    if size and weight:
        value = weight[0] / size[0]
        known["Mgl/Ix"] = value, value * float(np.hypot(weight[1] / weight[0], size[1] / size[0]))
    if options.mount is not None:
        known["bias_z"] = 0.0, options.mount
    return known


def find_clicked(options: argparse.Namespace) -> dict[str, Known]:
    """Return the numbers of a camera that are known with a deviation: clicked pivot and length."""
    known: dict[str, Known] = {}
    if options.pivot_deviation:
        known |= {
            n: (at, options.pivot_deviation) for n, at in zip("uv", options.pivot, strict=True)
        }
    if options.scale_deviation:
        relative = options.scale_deviation / options.scale
        known["log_scale"] = float(np.log(options.scale)), relative
    return known


def draw(report: Report, path: Path) -> None:
    """Draw the report, if Matplotlib is installed."""
    try:
        from symtop_ros.truth.fit.figures import write_figure
    except ModuleNotFoundError as error:
        print(f"top_fit: no plot, {error.name} is missing", file=sys.stderr)
    else:
        write_figure(report, path)
