"""Options of a plan, as the motion of a scene and the record that it will give."""

import argparse
from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np

from symtop_ros.base.arrays import Real
from symtop_ros.base.command import decimal, positive
from symtop_ros.base.counts import write_count
from symtop_ros.base.refusals import RefusedError, find_nearest, one_line, refuse
from symtop_ros.physics import Motion
from symtop_ros.run.simulation.changes.requests import start_motion
from symtop_ros.run.simulation.settings import PARAMETERS, Settings
from symtop_ros.truth.fit import record
from symtop_ros.truth.fit.aliases import SPINS
from symtop_ros.truth.fit.kinds import ACROSS, KINDS, Kind
from symtop_ros.truth.fit.limits import MOST, SPIN
from symtop_ros.truth.fit.plan import Plan
from symtop_ros.truth.fit.record import FEWEST, Record
from symtop_ros.truth.fit.search import NEAREST

CAMERA = (300.0, 30.0, 10.0)  # pixels of the axis, degrees of elevation, lengths of the distance
RATE, SECONDS = 120.0, 3.0
# Deviations of noise: rad of angles, parts of the length of the axis, pixels, rad/s
USUAL = {"angles": 0.005, "theta": 0.005, "axis": 0.005, "pixels": 1.0, "attitude": 0.005}
SENSOR = (0.01, 0.1)  # rad/s and m/s^2
UPRIGHT = 1e-6  # rad; an axis nearer to the vertical has no phi'
ASKED = "rate", "noise", "seconds", "camera", "range", "resolution"  # options of a plan alone


def add_options(parser: argparse.ArgumentParser) -> None:
    """Add the options of a plan to a parser."""
    group = parser.add_argument_group("a plan, instead of RECORD")
    group.add_argument(
        "--plan",
        nargs="+",
        metavar=("SCENE", "NAME=VALUE"),
        help="print the deviations that a record of this scene will have; NAME=VALUE changes "
        "parameters of the node, such as initial.phi_dot=0",
    )
    group.add_argument(
        "--rate", type=positive, metavar="HZ", help=f"rows per second (default {RATE:g})"
    )
    group.add_argument(
        "--seconds", type=positive, help=f"length of the record (default {SECONDS:g})"
    )
    group.add_argument(
        "--noise",
        type=positive,
        nargs="+",
        metavar="SIGMA",
        help="standard deviation of the noise of a row, in the unit of the kind of record (rad; "
        "lengths of the axis; pixels; rad/s, and m/s^2 of an accelerometer)",
    )
    group.add_argument(
        "--camera",
        type=decimal,
        nargs=3,
        metavar=("PIXELS", "DEGREES", "LENGTHS"),
        help="length of the axis, elevation of the camera, and its distance, which --perspective "
        f"fits (default {' '.join(f'{each:g}' for each in CAMERA)})",
    )

    for name, what in (("range", "largest value"), ("resolution", "step of the values")):
        group.add_argument(
            f"--{name}",
            type=positive,
            nargs="+",
            metavar="LIMIT",
            help=f"{what} that a gyroscope shows, rad/s, and that an accelerometer shows, m/s^2",
        )


def refuse_plan_options(options: argparse.Namespace) -> None:
    """Refuse options of a plan if no plan is requested."""
    for name in ASKED:
        if getattr(options, name) is not None:
            raise RefusedError(f"--{name} must be used with --plan, got a record")


def read_motion(words: Sequence[str], has_friction: bool) -> Motion:
    """Return the motion of a scene with changes NAME=VALUE."""
    scene, *changes = words
    given = dict(map(_read_change, changes))
    motion = start_motion(Settings.from_scene(scene, **given))
    _refuse_odd(motion, has_friction)
    return motion


def _refuse_odd(motion: Motion, has_friction: bool) -> None:
    """Refuse a motion that no fit looks for, and an axis along the vertical."""
    if motion.clamped or np.any(motion.applied_torque):
        raise RefusedError(
            "--plan must have a top that gravity and friction move, got a driven one"
        )
    if abs(np.sin(float(motion.start.euler_angles.theta))) < UPRIGHT:
        raise RefusedError("--plan must have a tilted axis at the start, got a vertical one")
    rates = motion.friction.axial, motion.friction.transverse
    if has_friction and not all(rates):  # a fit looks for friction that is not negative
        raise RefusedError(
            "--friction must be used with a scene with friction.axial and friction.transverse "
            "above 0"
        )
    if any(rates) and not has_friction:
        raise RefusedError("--friction must be given for a scene with friction, got none")


def _read_change(text: str) -> tuple[str, str | float]:
    name, sign, value = text.partition("=")
    if not sign or name not in PARAMETERS:
        near = find_nearest(name, PARAMETERS)
        hint = f" (nearest: {near})" if near else ""
        raise RefusedError(f"--plan must have SCENE NAME=VALUE, got {one_line(text, 60)}{hint}")
    try:
        return name, decimal(value)
    except ValueError:
        return name, value


def find_noise(kind: Kind, given: Sequence[float] | None) -> Real:
    """Return the deviation (r,) of each residual."""
    numbers = given or (
        [USUAL[kind.name]] if kind.name in USUAL else SENSOR[: len(kind.residuals) // 3]
    )
    units = 2 if kind.name == "inertial" else 1
    if len(numbers) != units:
        raise RefusedError(
            f"--noise must have {write_count(units, 'number')} of {kind.name}, got {len(numbers)}"
        )
    return spread(numbers, kind)


def find_limits(name: str, kind: Kind, given: Sequence[float] | None, default: float) -> Real:
    """Return a range or a resolution (m,) of each column of a sensor."""
    if given and kind.name not in SPINS:
        raise RefusedError(f"--{name} must be used with a record of rates, got {kind.name}")
    numbers, units = [*(given or ())], max(kind.width // 3, 1)
    if len(numbers) > units:
        count = write_count(units, "number")
        raise RefusedError(f"--{name} must have at most {count} of {kind.name}, got {len(numbers)}")
    return spread([*numbers, *[default] * (units - len(numbers))], kind)


def spread(numbers: Sequence[float], kind: Kind) -> Real:
    """Return numbers (r,) of the residuals of a kind, from one of each unit."""
    return np.repeat(np.asarray(numbers, dtype=float), len(kind.residuals) // len(numbers))


def limit_plan(plan: Plan) -> Plan:
    """Return a plan without the columns beyond the range of the sensor, as in a fit."""
    values = np.abs(plan.fit.model.record.values)
    shares = (values > plan.limits).mean(axis=0)
    note, kind = "wz is beyond the range of the sensor: it will be left out", plan.record.kind
    if kind.name == "rates" and shares[SPIN] > MOST:
        record = replace(plan.record, kind=ACROSS, notes=(note,))
        two = [np.asarray(each)[:SPIN] for each in (plan.noise, plan.limits)]
        return limit_plan(Plan(plan.motion, record, two[0], plan.camera, two[1]))
    share = float((values > plan.limits).any(axis=1).mean())
    if share > MOST:
        raise RefusedError(f"--range must contain most of the rows, got {share:.0%} beyond it")
    note = f"{share:.0%} of the rows are beyond the range of the sensor: they will be left out"
    notes = (*plan.record.notes, note) if share else plan.record.notes
    return replace(plan, record=replace(plan.record, notes=notes))


def find_plan_camera(kind: Kind, options: argparse.Namespace) -> dict[str, float]:
    """Return the camera of a plan; what the options know of it is taken as known."""
    if kind.name != "pixels":
        return {}
    size, degrees, distance = options.camera or CAMERA
    if size <= 0 or distance <= 1 / NEAREST:
        raise RefusedError(
            f"--camera must have PIXELS > 0 and LENGTHS > {1 / NEAREST:.3g}, got {size:g} and "
            f"{distance:g}"
        )
    u, v = options.pivot or (0.0, 0.0)
    named = {"u": u, "v": v, "log_scale": float(np.log(options.scale or size)), "roll": 0.0}
    elevation = degrees if options.elevation is None else options.elevation
    nearness = 1 / distance if options.perspective else 0.0
    return {**named, "elevation": float(np.radians(elevation)), "nearness": nearness}


def make_plan(options: argparse.Namespace, kind: str, more: Mapping[str, object]) -> Plan:
    """Return the plan that the options describe; `more` are attributes of its record."""
    motion, found = read_motion(options.plan, options.friction), KINDS[kind]
    rows = round((options.seconds or SECONDS) * (options.rate or RATE)) + 1
    if not FEWEST <= rows <= record.MOST:
        raise refuse("--seconds times --rate", f"{FEWEST} to {record.MOST} rows", rows)
    times = np.arange(rows) / (options.rate or RATE)
    planned = Record(times, np.zeros((rows, found.width)), found, **more)  # type: ignore[arg-type]
    camera, noise = find_plan_camera(found, options), find_noise(found, options.noise)
    steps = find_limits("resolution", found, options.resolution, 0.0)
    ends = find_limits("range", found, options.range, np.inf)
    if found.name not in SPINS:  # an attitude has more columns than residuals, and no range
        return Plan(motion, planned, noise, camera)
    return limit_plan(Plan(motion, planned, np.hypot(noise, steps / np.sqrt(12)), camera, ends))
