"""Euler's angles drawn as in the article's figure 1: two frames, the line of nodes, three arcs.

phi turns from x' to the line of nodes N in the horizontal plane, theta from z' to z in the vertical
plane of the axis, and psi from N to x in the plane across the axis.
"""

import numpy as np
import rerun as rr

from symtop_ros.arrays import Real
from symtop_ros.log.batch import Columns
from symtop_ros.playback.view import entities
from symtop_ros.playback.view.entities import GOLD, GREEN, ORANGE, VIOLET, WHITE
from symtop_ros.playback.view.quantities import find_step, nodes_of
from symtop_ros.playback.view.stream import Stream

RATE = 60.0  # positions per s of the clock
POINTS = 33  # of an arc
# In scene units. The arcs have different radii, so that letters do not meet; that of theta is
# outside of the sphere, where the rotor does not hide it. The z axis is longer than L and omega,
# which are nearly parallel to it in a fast top, so that its letter stands beyond theirs.
WORLD_AXES, BODY_AXES = 1.3, (0.8, 0.8, 1.55)
RADII = {"phi": 0.5, "theta": 1.08, "psi": 0.66}
NODES_LENGTH = 0.95
LETTERS = {"phi": "\u03c6", "theta": "\u03b8", "psi": "\u03c8"}
COLORS = {"phi": ORANGE, "theta": GOLD, "psi": GREEN}  # of their curves in the plots
BEYOND = 1.08  # a letter's distance from the origin, in radii of its arc


def log_frames(stream: Stream) -> None:
    """Log the static parts: both frames, and the styles of the arcs."""
    for entity, lengths, color, mark in (
        (f"{entities.ANGLES}/world", (WORLD_AXES,) * 3, WHITE, "'"),
        (f"{entities.BODY}/axes", BODY_AXES, VIOLET, ""),
    ):
        ends = np.diag(lengths)
        stream.log(entity, rr.Arrows3D(vectors=ends, colors=[color], radii=[0.005]), static=True)
        names = [f"{letter}{mark}" for letter in "xyz"]
        stream.log_labels(f"{entity}/names", names, color, 1.06 * ends)
    for name, color in COLORS.items():
        stream.style_lines(f"{entities.ANGLES}/{name}", color, 0.008)
        stream.log_labels(f"{entities.ANGLES}/{name}/letter", [LETTERS[name]], color)
    stream.style_arrows(f"{entities.ANGLES}/nodes", ORANGE, 0.006, "N")


def send_angles(stream: Stream, euler: Columns) -> None:
    """Send the arcs, their letters and the line of nodes, at some of the stamps."""
    step = find_step(euler.stamps, RATE)
    stamps, angles = euler.stamps[::step], euler.numbers[::step]
    phi, theta, psi = angles[:, 0] % (2 * np.pi), angles[:, 1], angles[:, 2] % (2 * np.pi)
    for name, arcs in draw_arcs(phi, theta, psi).items():
        entity = f"{entities.ANGLES}/{name}"
        stream.send_lines(entity, stamps, arcs)
        letters = BEYOND * arcs[:, POINTS // 2]
        stream.send(f"{entity}/letter", stamps, rr.Points3D.columns(positions=letters))
    vectors = NODES_LENGTH * nodes_of(phi)
    stream.send_arrows(f"{entities.ANGLES}/nodes", stamps, vectors, 1.06 * vectors)


def draw_arcs(phi: Real, theta: Real, psi: Real) -> dict[str, Real]:
    """Return the arcs (n, 33, 3) of angles (n,) in rad, by the name of the angle."""
    part = np.linspace(0.0, 1.0, POINTS)
    nodes = nodes_of(phi)
    ahead = np.stack([np.sin(phi), -np.cos(phi), np.zeros_like(phi)], axis=-1)  # where z leans to
    up = np.array([0.0, 0.0, 1.0])
    sine, cosine = np.sin(theta)[:, None], np.cos(theta)[:, None]
    across = sine * up - cosine * ahead  # z x N
    starts = {"phi": np.broadcast_to([1.0, 0.0, 0.0], nodes.shape), "theta": up, "psi": nodes}
    quarters = {"phi": np.array([0.0, 1.0, 0.0]), "theta": ahead, "psi": across}
    turned = {"phi": phi, "theta": theta, "psi": psi}
    arcs = {}
    for name, radius in RADII.items():
        angle = turned[name][:, None] * part
        start, quarter = (np.atleast_2d(each[name])[:, None] for each in (starts, quarters))
        arcs[name] = radius * (
            np.cos(angle)[..., None] * start + np.sin(angle)[..., None] * quarter
        )
    return arcs
