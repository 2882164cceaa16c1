"""A fit as a run of the page: the fitted motion and the measured points.

No record determines a moment alone, and a record of an axis determines neither Iz nor the spin.
Numbers that are not given are those of the default scene, with the same p_psi and the same path of
the axis.
"""

import json
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from scipy.spatial.transform import Rotation

from symtop_ros.base.arrays import Real
from symtop_ros.physics import Motion
from symtop_ros.run.simulation.points import Points
from symtop_ros.run.simulation.run_file import RunEvent, write_run
from symtop_ros.run.simulation.settings import Settings
from symtop_ros.truth.fit.camera import CAMERA, rectify
from symtop_ros.truth.fit.model import LENGTH, MOUNT
from symtop_ros.truth.fit.record import Known
from symtop_ros.truth.fit.refine import Fit
from symtop_ros.truth.fit.twins import change_axial_moment, scale_moments
from symtop_ros.truth.fit.values import UNITS
from symtop_ros.words import write

SCENE = "cusps"  # the default of a node


@dataclass(frozen=True, slots=True)
class FittedRun:
    """A motion in kg m^2 with the points that it was fitted to.

    Attributes
    ----------
    motion : Motion
    points : Points
    assumed : mapping
        Numbers that are those of the scene `SCENE`, by the names of known values.
    """

    motion: Motion
    points: Points
    assumed: Mapping[str, float]

    def to_json(self) -> dict[str, Any]:
        """Return the content of run.json."""
        event = RunEvent("start", 0, self.motion, {})
        return write_run([event], int(self.points.stamps[-1]), self.points)

    def write(self, path: Path) -> None:
        """Write the run as run.json."""
        path.write_text(json.dumps(self.to_json()), encoding="utf-8")

    def describe(self, path: Path) -> str:
        """Return a sentence on what was written, and on which numbers were not measured."""
        count, rows = len(self.points), self.points.rows
        assumed = [
            {"name": name, "value": value, "unit": UNITS[name]}
            for name, value in self.assumed.items()
        ]
        record = {
            "path": str(path),
            "count": count,
            "thinned": {"rows": rows} if rows > count else None,
            "supposed": {"scene": SCENE, "numbers": assumed} if assumed else None,
        }
        return write("fitted_run", record)


def make_run(fit: Fit, rows: int, given: Mapping[str, Known]) -> FittedRun:
    """Return the run of a fit.

    Parameters
    ----------
    fit : Fit
    rows : int
        Rows of the record, of which the fit may have taken a part.
    given : mapping
        Known values, as for `values.convert`.
    """
    motion, top = fit.model.find_motion(fit.x), Settings.from_scene(SCENE).top
    assumed: dict[str, float] = {}
    if not fit.model.kind.shows_spin:
        ratio = given["Iz/Ix"][0] if "Iz/Ix" in given else top.Iz / top.Ix
        motion = change_axial_moment(motion, ratio)
        assumed |= {} if "Iz/Ix" in given else {"Iz/Ix": ratio}
    size = top.Ix
    if "Ix" in given:
        size = given["Ix"][0]
    elif "Mgl" in given:
        size = given["Mgl"][0] / motion.top.Mgl
    else:
        assumed["Ix"] = size
    return FittedRun(scale_moments(motion, size), find_points(fit, rows), assumed)


def find_points(fit: Fit, rows: int) -> Points:
    """Return the points of a record, and their residuals.

    The values are corrected: for the bias and the tilt of a sensor, if they were fitted; for the
    fitted distance of points from the pivot, which becomes 1; and for a camera that does not look
    at the pivot, to those of a camera at the same place that does.
    """
    record = fit.model.record
    values, residuals = record.values, -fit.residuals
    if record.has_mount:
        found = dict(zip(fit.model.names, fit.x.tolist(), strict=True))
        bias = [found[name] for name in MOUNT[:3]]
        bias += [found.get(f"bias_{name}", 0.0) for name in record.kind.columns[3:]]
        tilt = [*(found[name] for name in MOUNT[3:]), 0.0]
        values = _turn_back(values - bias, tilt)
        residuals = _turn_back(residuals, tilt)
    if record.has_length:
        length = np.exp(fit.x[fit.model.place[LENGTH]])
        values, residuals = values / length, residuals / length
    camera: dict[str, float] = {}
    if record.kind.name == "pixels":
        found_camera = fit.model.find_camera(fit.x)
        camera = {name: found_camera[name] for name in CAMERA}
        shown = rectify(values - residuals, found_camera)
        values = rectify(values, found_camera)
        residuals = values - shown
    times = record.times - record.times[0]
    return Points(record.kind.name, rows, times, values, residuals, camera)


def _turn_back(rows: Real, tilt: list[float]) -> Real:
    """Return vectors (n, 3 k) of a tilted sensor as the body has them."""
    turn = Rotation.from_rotvec(tilt).as_matrix()
    return np.asarray((rows.reshape(len(rows), -1, 3) @ turn).reshape(rows.shape))
