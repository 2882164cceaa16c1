"""Write symtop_ros/testset: sixty motions to 30 digits, their models, tables and checksums.

Each state is computed by the closed form in 150 digits, and again by a Taylor series in 80 digits
that shares no formula with it; a difference in the 33rd digit ends the program. It takes a quarter
of an hour:

    PYTHONPATH=.:test python test/testset/write_testset.py
"""

from __future__ import annotations

import csv
import hashlib
import io
import json
import sys
from pathlib import Path
from typing import Any

from mpmath import mp, mpf
from physics.exact_motion import DIGITS, Inputs, distance, exact_motion, perturb
from physics.taylor_motion import TaylorMotion
from testset.problems import SETTINGS, Setting

from symtop_ros.models.formats import FORMATS
from symtop_ros.physics import STANDARD_GRAVITY, Body

FOLDER = Path(__file__).parents[2] / "symtop_ros" / "testset"
VERSION = "1.0"
SHOWN = 30  # digits
AGREEMENT = mpf(10) ** -33  # of both methods, relative to the largest component
EPS = 2.0**-52
CONSTANTS = ("Ix", "Iz", "Mgl", "mass", "arm", "Ix_centre")
QUATERNION, RATES = ("w", "x", "y", "z"), ("wx", "wy", "wz")
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


def limits(setting: Setting, t: float, exact: State) -> tuple[float, float]:
    """Angle (rad) and rate (rad/s) by which half an ulp of every input changes a state."""
    q, omega = setting.start.given_orientation.tolist(), setting.start.angular_velocity.tolist()
    inputs = Inputs.of(*setting.top.moments, q, omega)
    with mp.workdps(DIGITS):
        moved = [exact_motion(each, t) for each in perturb(inputs)]
        angle = mp.norm([2 * distance(exact[0], each[0]) for each in moved])
        rate = mp.norm([a - b for each in moved for a, b in zip(exact[1], each[1], strict=True)])
        # no state is held more exactly than its own rounding allows
        return max(float(angle), EPS), max(float(rate), EPS / 2 * float(mp.norm(exact[1])))


def describe(setting: Setting) -> dict[str, Any]:
    """The entry of a problem."""
    states = solve(setting)
    pairs = [limits(setting, t, each) for t, each in zip(setting.times, states, strict=True)]
    try:
        body = Body.of(setting.top)
    except ValueError:
        body = None
    return {
        "name": setting.name,
        "level": setting.level,
        "what": setting.what,
        **dict(zip(("Ix", "Iz", "Mgl"), setting.top.moments, strict=True)),
        "mass": body and body.mass,
        "arm": body and body.arm,
        "Ix_centre": body and body.Ix,
        "orientation": setting.start.given_orientation.tolist(),
        "angular_velocity": setting.start.angular_velocity.tolist(),
        "times": setting.times,
        "orientations": [digits(each[0]) for each in states],
        "angular_velocities": [digits(each[1]) for each in states],
        "orientation_limits": [float(f"{angle:.3g}") for angle, _ in pairs],
        "angular_velocity_limits": [float(f"{rate:.3g}") for _, rate in pairs],
    }


def digits(numbers: Any) -> list[str]:
    # The axial rate is a double; mpf() would round the others to the precision of the moment.
    return [mp.nstr(n if isinstance(n, mpf) else mpf(n), SHOWN) for n in numbers]


def tabulate(problems: list[dict[str, Any]]) -> dict[str, str]:
    """Texts of problems.csv and states.csv."""
    starts, states = io.StringIO(), io.StringIO()
    table = csv.writer(starts, lineterminator="\n")
    start = [f"{name}0" for name in (*QUATERNION, *RATES)]
    table.writerow(("name", "level", *CONSTANTS, *start, "duration", "what"))
    rows = csv.writer(states, lineterminator="\n")
    both = ("orientation_limit", "angular_velocity_limit")
    rows.writerow(("name", "t", *QUATERNION, *RATES, *both))
    for each in problems:
        constants = ["" if each[name] is None else repr(each[name]) for name in CONSTANTS]
        values = map(repr, (*each["orientation"], *each["angular_velocity"], each["times"][-1]))
        table.writerow((each["name"], each["level"], *constants, *values, each["what"]))
        columns = ("times", "orientations", "angular_velocities")
        ends = ("orientation_limits", "angular_velocity_limits")
        for t, q, omega, *two in zip(*(each[name] for name in (*columns, *ends)), strict=True):
            rows.writerow((each["name"], repr(t), *q, *omega, *map(repr, two)))
    return {"problems.csv": starts.getvalue(), "states.csv": states.getvalue()}


def write_models(setting: Setting) -> None:
    """Write the models of a problem; a top without a body has none."""
    try:
        texts = {form: write(setting.top, setting.start) for form, write in FORMATS.items()}
    except ValueError:
        return
    (FOLDER / "models").mkdir(exist_ok=True)
    for form, text in texts.items():
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


def main() -> None:
    problems = []
    for setting in SETTINGS:
        problems.append(describe(setting))
        write_models(setting)
        print(setting.name, flush=True)
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
