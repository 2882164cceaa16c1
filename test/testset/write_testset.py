"""Write symtop_ros/testset: seventy motions to 30 digits, their models, tables and checksums.

Each state is computed by the closed form in 150 digits, and again by a Taylor series in 80 digits
that shares no formula with it; a difference in the 33rd digit ends the program. It takes twelve
minutes with two processors:

    PYTHONPATH=.:test python test/testset/write_testset.py
"""

from __future__ import annotations

import csv
import hashlib
import io
import json
import math
import sys
from collections.abc import Callable
from multiprocessing import Pool
from pathlib import Path
from typing import Any

from mpmath import mp, mpf
from physics.exact_motion import DIGITS, Inputs, distance, exact_motion, perturb
from physics.taylor_motion import TaylorMotion
from testset.forces import find_forces, find_world_state
from testset.links import find_link_effect
from testset.problems import SETTINGS, Setting

from symtop_ros.models.formats import FORMATS
from symtop_ros.models.free import FREE_FORMATS
from symtop_ros.physics import STANDARD_GRAVITY, Body, Top
from symtop_ros.physics import State as Start

FOLDER = Path(__file__).parents[2] / "symtop_ros" / "testset"
VERSION = "3.0"
SHOWN = 30  # digits
AGREEMENT = mpf(10) ** -33  # of both methods, relative to the largest component
EPS, EPS_32 = 2.0**-52, 2.0**-23  # of float64 and float32
CONSTANTS = ("Ix", "Iz", "Mgl", "mass", "arm", "Ix_centre")
QUATERNION, RATES = ("w", "x", "y", "z"), ("wx", "wy", "wz")
LIMITS = tuple(
    f"{name}_limits{form}"
    for form in ("", "_float32")
    for name in ("orientation", "angular_velocity")
)
# Columns of forces.csv by their lists in problems.json; energies are one column.
FORCES = {
    "angular_accelerations": ("alpha_x", "alpha_y", "alpha_z"),
    "accelerations": ("ax", "ay", "az"),
    "pivot_forces": ("fx", "fy", "fz"),
    "energies": ("energy",),
}
# Columns of world.csv by their lists in problems.json; the attitude comes first.
WORLD = {
    "centre_positions": ("px", "py", "pz"),
    "centre_velocities": ("vx", "vy", "vz"),
    "world_angular_velocities": ("omega_x", "omega_y", "omega_z"),
}
State = tuple[Any, Any]  # orientation and body angular velocity in numbers of mpmath


def solve(setting: Setting) -> list[State]:
    """States at the times of a problem, by both methods."""
    q, omega = setting.start.given_orientation.tolist(), setting.start.angular_velocity.tolist()
    inputs = Inputs.of(*setting.top.moments, q, omega)
    series = TaylorMotion(setting.top.moments, q, omega, 80)
    states = []
    for t in setting.times:
        exact = exact_motion(inputs, t)
        check(setting, t, exact, series)
        states.append(exact)
    return states


def check(setting: Setting, t: float, exact: State, series: TaylorMotion) -> None:
    """End the program if the Taylor series has another state."""
    if not setting.has_period:
        series.reach(t)
    other = series.state_at(t)
    with mp.workdps(DIGITS):
        apart = distance(exact[0], other[0])
        size = mp.norm(exact[1])
        faster = mp.norm([a - b for a, b in zip(exact[1], other[1], strict=True)])
        if apart > AGREEMENT or faster > AGREEMENT * size:
            sys.exit(f"{setting.name} at {t} s: {mp.nstr(apart, 3)}, {mp.nstr(faster / size, 3)}")


def limits(setting: Setting, t: float, exact: State, eps: float = EPS) -> tuple[float, float]:
    """Angle (rad) and rate (rad/s) by which half an ulp of every input changes a state."""
    q, omega = setting.start.given_orientation.tolist(), setting.start.angular_velocity.tolist()
    inputs = Inputs.of(*setting.top.moments, q, omega)
    with mp.workdps(DIGITS):
        moved = [exact_motion(each, t) for each in perturb(inputs, eps)]
        angle = mp.norm([4 * mp.asin(distance(exact[0], each[0]) / 2) for each in moved])
        rate = mp.norm([a - b for each in moved for a, b in zip(exact[1], each[1], strict=True)])
        # no state is held more exactly than its own rounding allows
        floor = eps / 2 * float(mp.norm(exact[1]))
        return min(max(float(angle), eps), math.pi), max(float(rate), floor)


def describe(setting: Setting) -> dict[str, Any]:
    """The entry of a problem."""
    states = solve(setting)
    pairs = [
        (*limits(setting, t, each), *limits(setting, t, each, EPS_32))
        for t, each in zip(setting.times, states, strict=True)
    ]
    shown = ([float(f"{x:.3g}") for x in column] for column in zip(*pairs, strict=True))
    body = setting.body
    return {
        "name": setting.name,
        "level": setting.level,
        "what": setting.what,
        **dict(zip(("Ix", "Iz", "Mgl"), setting.top.moments, strict=True)),
        "mass": body.mass,
        "arm": body.arm,
        "Ix_centre": body.Ix,
        "orientation": setting.start.given_orientation.tolist(),
        "angular_velocity": setting.start.angular_velocity.tolist(),
        "times": setting.times,
        "orientations": [digits(each[0]) for each in states],
        "angular_velocities": [digits(each[1]) for each in states],
        **describe_forces(setting, states),
        **describe_world(setting, states),
        **dict(zip(LIMITS, shown, strict=True)),
        "mujoco_urdf_effect": find_link_effect(setting),
    }


def describe_forces(setting: Setting, states: list[State]) -> dict[str, Any]:
    """Accelerations, pivot forces and energies, at the start and at the times."""
    with mp.workdps(DIGITS):
        found = [find_forces(setting, *each) for each in (find_start(setting), *states)]
        energies = [each.energy for each in found]
        if max(energies) - min(energies) > AGREEMENT * max(map(abs, energies)):
            sys.exit(f"{setting.name}: the energy changes")
    *vectors, energies = zip(*found, strict=True)
    lists = [*([digits(each) for each in column] for column in vectors), digits(energies)]
    return dict(zip(FORCES, lists, strict=True))


def describe_world(setting: Setting, states: list[State]) -> dict[str, Any]:
    """Positions, velocities and rates in the world frame, at the start and at the times."""
    found = [find_world_state(setting, *each) for each in (find_start(setting), *states)]
    columns = zip(*found, strict=True)
    return dict(zip(WORLD, ([digits(each) for each in column] for column in columns), strict=True))


def find_start(setting: Setting) -> State:
    """The start with a unit quaternion."""
    with mp.workdps(DIGITS):
        q = [mpf(x) for x in setting.start.given_orientation.tolist()]
        return [x / mp.norm(q) for x in q], [mpf(x) for x in setting.start.angular_velocity]


def digits(numbers: Any) -> list[str]:
    # The axial rate is a double; mpf() would round the others to the precision of the moment.
    return [mp.nstr(n if isinstance(n, mpf) else mpf(n), SHOWN) for n in numbers]


def tabulate(problems: list[dict[str, Any]]) -> dict[str, str]:
    """Texts of problems.csv, states.csv, forces.csv and world.csv."""
    start = [f"{name}0" for name in (*QUATERNION, *RATES)]
    problem = ("name", "level", *CONSTANTS, *start, "duration", "mujoco_urdf_effect", "what")
    starts: list[tuple[Any, ...]] = [problem]
    limits = [name.replace("limits", "limit") for name in LIMITS]
    states: list[tuple[Any, ...]] = [("name", "t", *QUATERNION, *RATES, *limits)]
    forces: list[tuple[Any, ...]] = [("name", "t", *(c for each in FORCES.values() for c in each))]
    world: list[tuple[Any, ...]] = [
        ("name", "t", *QUATERNION, *(c for each in WORLD.values() for c in each))
    ]
    for each in problems:
        name, effect = each["name"], each["mujoco_urdf_effect"]
        values = [each[key] for key in CONSTANTS]
        values += [*each["orientation"], *each["angular_velocity"], each["times"][-1]]
        end = "" if effect is None else repr(effect), each["what"]
        starts.append((name, each["level"], *map(repr, values), *end))
        columns = (each[key] for key in ("times", "orientations", "angular_velocities", *LIMITS))
        for t, q, omega, *four in zip(*columns, strict=True):
            states.append((name, repr(t), *q, *omega, *map(repr, four)))
        columns = (each[key] for key in FORCES)
        times = [0.0, *each["times"]]
        for t, alpha, a, force, energy in zip(times, *columns, strict=True):
            forces.append((name, repr(t), *alpha, *a, *force, energy))
        attitudes = [normalise(each["orientation"]), *each["orientations"]]
        columns = (each[key] for key in WORLD)
        for t, q, p, v, omega in zip(times, attitudes, *columns, strict=True):
            world.append((name, repr(t), *q, *p, *v, *omega))
    tables = {
        "problems.csv": starts,
        "states.csv": states,
        "forces.csv": forces,
        "world.csv": world,
    }
    return {name: write_csv(rows) for name, rows in tables.items()}


def normalise(numbers: list[float]) -> list[str]:
    """Digits of a unit quaternion."""
    with mp.workdps(DIGITS):
        q = [mpf(x) for x in numbers]
        return digits([x / mp.norm(q) for x in q])


def write_csv(rows: list[tuple[Any, ...]]) -> str:
    text = io.StringIO()
    csv.writer(text, lineterminator="\n").writerows(rows)
    return text.getvalue()


def list_formats(setting: Setting) -> dict[str, Callable[[Top, Start, Body], str]]:
    """The models of a problem: without weight, also those that nothing holds."""
    return FORMATS if setting.top.Mgl else {**FORMATS, **FREE_FORMATS}


def write_models(setting: Setting) -> None:
    """Write the models of a problem."""
    (FOLDER / "models").mkdir(exist_ok=True)
    for form, write in list_formats(setting).items():
        text = write(setting.top, setting.start, setting.body)
        (FOLDER / "models" / f"{setting.name}.{form}").write_text(text, encoding="utf-8")


def write_checksums() -> None:
    """Write SHA256SUMS, in the form of the program sha256sum."""
    files = sorted(
        path
        for path in FOLDER.rglob("*.*")
        if path.suffix in (".json", ".csv") or path.parent.name == "models"
    )
    lines = [
        f"{hashlib.sha256(path.read_bytes()).hexdigest()}  {path.relative_to(FOLDER).as_posix()}\n"
        for path in files
    ]
    (FOLDER / "SHA256SUMS").write_text("".join(lines), encoding="utf-8")


def read_effects() -> dict[str, float | None]:
    """The published effects of links: those near rounding depend on the processor."""
    path = FOLDER / "problems.json"
    found = json.loads(path.read_text(encoding="utf-8"))["problems"] if path.exists() else []
    return {each["name"]: each["mujoco_urdf_effect"] for each in found}


def main() -> None:
    problems, effects = [], read_effects()
    with Pool() as pool:
        for setting, problem in zip(SETTINGS, pool.imap(describe, SETTINGS), strict=True):
            name = setting.name
            problem["mujoco_urdf_effect"] = effects.get(name, problem["mujoco_urdf_effect"])
            problems.append(problem)
            write_models(setting)
            print(setting.name, flush=True)
    write_files(problems)


def write_files(problems: list[dict[str, Any]]) -> None:
    """Write problems.json, the tables and the checksums."""
    facts = {
        "name": "symtop_ros test set",
        "version": VERSION,
        "license": "CC0-1.0",
        "gravity": STANDARD_GRAVITY,
    }
    lines = ",\n".join(map(json.dumps, problems))
    head = json.dumps(facts)[:-1]
    text = f'{head}, "problems": [\n{lines}\n]}}\n'
    (FOLDER / "problems.json").write_text(text, encoding="utf-8")
    for name, table in tabulate(problems).items():
        (FOLDER / name).write_text(table, encoding="utf-8")
    write_checksums()


if __name__ == "__main__":
    main()
