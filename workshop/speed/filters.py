"""Attitude filters fed with the noisy sensor of the top: which of them survive a fast spin.

The filters are those of the package `ahrs`, as their authors made them, with default gains. They
start from the exact attitude, so that nothing but the motion and the noise is judged.
"""

import math
from collections.abc import Callable
from dataclasses import asdict, dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.figure import Figure
from scipy.spatial.transform import Rotation

from symtop_ros.base.arrays import Real, invert
from symtop_ros.base.figure_style import (
    BLUE,
    GOLD,
    GREY,
    INK,
    RED,
    new_figure,
    rows,
    write_figures,
)
from symtop_ros.run.simulation.changes.requests import start_motion
from symtop_ros.run.simulation.settings import Settings
from symtop_ros.truth.imu import CONSUMER, ImuRecord, record_imu
from symtop_ros.truth.judge.compare import NONE, Errors, compare
from symtop_ros.truth.judge.truth import Truth
from symtop_ros.truth.topics.estimates import Estimates
from workshop.pictures.pack import pack
from workshop.speed.conditions import describe_conditions
from workshop.speed.publish import format_table, group, track, write_results

RATE, SPAN = 1000, 20  # Hz, s
SCENES = ("conical_pendulum", "hanging", "regular_precession", "cusps", "looping")
MOUNTS = {  # m, in the body frame
    "in the pivot": (0.0, 0.0, 0.0),
    "1 cm along the axis": (0.0, 0.0, 0.01),
    "1 cm off the axis": (0.01, 0.0, 0.0),
}
FILTERS = ("AngularRate", "Complementary", "Madgwick", "Mahony", "AQUA", "EKF", "UKF")
SHOWN = ("Madgwick", "Mahony", "EKF", "AngularRate")  # in the plot
PLOTTED = ("cusps", "in the pivot")
NAME = "filters"  # of the files, and of the section in the documentation


@dataclass(frozen=True)
class Trial:
    """Errors of a filter on a scene, with the sensor at one place."""

    filter: str
    scene: str
    mount: str
    # root mean squares of the errors in the second half of the run, in rad
    tilt: float
    attitude: float


def record(scene: str, place: tuple[float, float, float]) -> ImuRecord:
    """Return what a sensor measures at a place (m, body frame) on the top of a scene."""
    imu = replace(CONSUMER, position=place, seed=1, rate=float(RATE))
    return record_imu(start_motion(Settings.from_scene(scene)), imu, SPAN)


def run_filter(name: str, recording: ImuRecord) -> Errors:
    """Return the errors of a filter.

    The authors of filters do not agree whether a quaternion turns the sensor or the world. Both
    are tried, and the better one counts.
    """
    found = [_run(name, recording, turn) for turn in (lambda q: q, invert)]
    return min(found, key=lambda errors: float(np.median(errors.total)))


def _run(name: str, recording: ImuRecord, turn: Callable[[Real], Real]) -> Errors:
    import ahrs

    rates = recording.measured[:, :3]
    forces = recording.measured[:, 3:]
    options: dict[str, Any] = {"gyr": rates, "frequency": float(RATE)}
    if name != "AngularRate":
        options["acc"] = forces
    if name == "Complementary":
        turn_at_start = Rotation.from_quat(recording.orientations[0][[1, 2, 3, 0]])
        options["w0"] = turn_at_start.as_euler("ZYX")[::-1]  # roll, pitch and yaw
    else:
        options["q0"] = turn(recording.orientations[0])
    with np.errstate(all="ignore"):
        q = np.asarray(getattr(ahrs.filters, name)(**options).Q, dtype=float)
    q = np.nan_to_num(turn(q))
    q[np.linalg.norm(q, axis=1) < 0.5] = (1.0, 0.0, 0.0, 0.0)  # a filter that has broken down
    return compare(Estimates.of(recording.stamps, q), Truth([recording.event]), NONE)


def judge_filters(folder: Path, docs: Path | None = None) -> None:
    """Write filters.md, filters.json and a plot.

    It needs the package `ahrs`, of the extra `peers`.
    """
    trials: list[Trial] = []
    curves: dict[str, Errors] = {}
    work = [(scene, mount) for mount in MOUNTS for scene in SCENES]
    for scene, mount in track(work, ", ".join):
        recording = record(scene, MOUNTS[mount])
        for name in FILTERS:
            errors = run_filter(name, recording)
            half = len(errors.total) // 2
            parts = errors.tilt[half:], errors.total[half:]
            trials.append(Trial(name, scene, mount, *(math.sqrt((x**2).mean()) for x in parts)))
            if (scene, mount) == PLOTTED and name in SHOWN:
                curves[name] = errors
    conditions = describe_conditions("ahrs")
    facts = {"conditions": conditions, "trials": [asdict(trial) for trial in trials]}
    write_results(NAME, facts, format_trials(facts), folder, docs)
    write_figures({NAME: lambda: draw_tilt_errors(curves)}, folder)
    if docs:
        (docs / f"{NAME}.png").write_bytes(pack(folder / f"{NAME}.png"))
    print(f"{folder / 'filters.md'}, filters.json and a plot")


def format_trials(facts: dict[str, Any]) -> str:
    """Return a table for each place of the sensor."""
    trials = [Trial(**each) for each in facts["trials"]]
    parts = []
    for mount, own in group(trials, lambda trial: trial.mount).items():
        table = [
            [name, *(f"{each.tilt:.1g} / {each.attitude:.1g}" for each in rows)]
            for name, rows in group(own, lambda trial: trial.filter).items()
        ]
        head = ["tilt / attitude, rad", *dict.fromkeys(trial.scene for trial in own)]
        parts.append(f"Sensor {mount}:\n\n{format_table(head, table)}")
    return "\n\n".join([*parts, f"{facts['conditions']}."])


def draw_tilt_errors(curves: dict[str, Errors]) -> Figure:
    """Draw the tilt error of some filters against time."""
    figure = new_figure(3.2)
    (axes,) = rows(figure, 1)
    for color, (name, errors) in zip((INK, BLUE, RED, GOLD, GREY), curves.items(), strict=False):
        step = max(1, len(errors.tilt) // 2000)
        t = errors.seconds[::step]
        axes.plot(t, np.maximum(errors.tilt[::step], 1e-6), color=color, label=name, linewidth=1.0)
    axes.set(yscale="log", ylabel="tilt error (rad)")
    axes.legend(ncols=4, loc="lower center", bbox_to_anchor=(0.5, 1.0))
    return figure
