"""Measured points for tests: of each kind, seen of an exact motion, and hostile ones."""

import numpy as np
from drawn import Numbers
from run.simulation.page_runs import HOSTILE, START, make_run

from symtop_ros.physics import specific_force
from symtop_ros.run.simulation.points import SEEN, Points
from symtop_ros.run.simulation.run_file import RunEvent, write_run

TIMES = np.arange(48) / 64  # s
NOISE = 2.0**-9
CAMERA = {
    "u": 600.0,
    "v": 400.0,
    "log_scale": 5.5,
    "elevation": 0.5,
    "roll": 0.0625,
    "nearness": 0.25,
}
END = 750_000_000  # ns


def look(axes, camera=CAMERA):
    """The picture of axes by a pinhole, from its eye and the directions it has there."""
    elevation, roll = camera["elevation"], camera["roll"]
    to_eye = np.array([0.0, -np.cos(elevation), np.sin(elevation)])
    right, up = np.array([1.0, 0.0, 0.0]), np.array([0.0, np.sin(elevation), np.cos(elevation)])
    eye = to_eye / camera["nearness"]
    way = axes - eye
    depth = -way @ to_eye
    across = np.stack([way @ right, way @ up], axis=1) / depth[:, None] / camera["nearness"]
    turn = np.array([[np.cos(roll), np.sin(roll)], [-np.sin(roll), np.cos(roll)]])
    return [camera["u"], camera["v"]] + np.exp(camera["log_scale"]) * across @ turn


def see(kind, times=TIMES, motion=START):
    """What a kind of record shows of a motion, without noise."""
    states = motion.at(times)
    axes = states.to_world([0.0, 0.0, 1.0])
    phi, theta, _ = states.euler_angles
    seen = {
        "attitude": lambda: states.orientation,
        "rates": lambda: states.angular_velocity,
        "inertial": lambda: np.concatenate(
            [states.angular_velocity, specific_force(motion, states, (0.0, 0.0, 0.25), 9.8125)],
            axis=1,
        ),
        "axis": lambda: axes,
        "angles": lambda: np.stack([theta, phi], axis=1),
        "pixels": lambda: look(axes),
        "theta": lambda: theta[:, None],
    }
    return seen[kind]()


def make_points(kind, times=TIMES, noise=NOISE, rows=None):
    """Points of a kind; their noise is what they leave, but for a fourth number of attitudes."""
    exact = see(kind, times)
    errors = noise * Numbers(7).normals(*exact.shape)
    left = errors[:, : len(SEEN[kind].residuals)]
    camera = CAMERA if kind == "pixels" else {}
    return Points(kind, rows or len(times), times, exact + errors, left, camera)


def make_measured(kind="axis", **options):
    """The content of run.json with points."""
    return write_run([RunEvent("start", 0, START, {})], END, make_points(kind, **options))


def change_points(**values):
    content = make_measured(times=TIMES[:3])
    content["points"] |= values
    return content


def list_hostile_points():
    """Return runs with damaged points, each with the beginning of its refusal."""
    rows = [[0.0, 0.5, 0.75]] * 3
    runs = [("points", {**change_points(), "points": each}) for each in HOSTILE if each != {}]
    runs += [("points: kind", {**change_points(), "points": {}})]
    runs += [
        ("points: kind", change_points(kind=each)) for each in ("__proto__", "", "toString", 3, [])
    ]
    runs += [("points: rows", change_points(rows=each)) for each in (0, -1, "x", [], True, 1e16)]
    runs += [("points: times", change_points(times=each)) for each in (None, [], "123", {}, 3)]
    runs += [("points: times", change_points(times=[0.0] * 100_001))]
    runs += [
        ("points: times[2]", change_points(times=[0.0, 0.5, each]))
        for each in (0.5, 0.25, -1, 5e6, None, "2", True, [1], 10**400)
    ]
    for name in ("values", "residuals"):
        wrong = (None, {}, "abc", rows[:2], [*rows, rows[0]])
        runs += [(f"points: {name}", change_points(**{name: each})) for each in wrong]
        inner = ([0.0] * 2, [0.0] * 4, None, 3, {}, "abc", [0, 0, None], [0, 0, 1e101], [[0]] * 3)
        runs += [
            (f"points: {name}[1]", change_points(**{name: [rows[0], each, rows[0]]}))
            for each in inner
        ]
    seen = {"values": [[1.0, 2.0]] * 3, "residuals": [[0.0, 0.0]] * 3, "kind": "pixels"}
    for name in CAMERA:
        for each in (None, "x", [], 1e300 if name in ("log_scale", "nearness") else None):
            wrong = change_points(**seen, camera={**CAMERA, name: each})
            runs.append((f"points: camera: {name}", wrong))
    runs += [("points: camera: u", change_points(**seen, camera=each)) for each in (None, [], 3)]
    return runs


def make_kicked(kind="axis"):
    """A run of several events with points."""
    return write_run(make_run(), 3_000_000_000, make_points(kind, times=np.arange(48) / 16))
