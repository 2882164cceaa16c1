"""The axis of the article's top from above, for four starts."""

import numpy as np
from numpy.typing import NDArray

from symtop_ros.judge.figures import GREY, RED
from symtop_ros.physics import Motion, State
from workshop.article.motions import PSI_DOT, SLOW, THETA, TOP

STARTS = {"regular precession": SLOW, "cusps": 0.0, "loops": -8.0, "hurried: it rises": 1.4 * SLOW}
TURN = 2 * np.pi / SLOW  # s; regular precession closes its circle
POINTS = 900  # of a trace; with fewer, its cusps would be blunt
SIZE, SCALE = 220, 125  # points; points per unit of the sphere, seen from above


def draw_curve(points: NDArray[np.float64], style: str) -> str:
    """Draw a curve (n, 3) on the sphere, seen from above: steps in tenths of a point."""
    tenths = np.rint(10 * (SIZE / 2 + SCALE * points[:, :2] * (1, -1))).astype(int)
    steps = " ".join(f"{x},{y}" for x, y in np.diff(tenths, axis=0, prepend=[[0, 0]]).tolist())
    return f'<path d="m{steps}" transform="scale(0.1)" fill="none" {style}/>'


def draw_circle(theta: float, style: str) -> str:
    """Draw a circle of equal tilt."""
    radius = SCALE * np.sin(theta)
    return f'<circle cx="{SIZE / 2}" cy="{SIZE / 2}" r="{radius:.1f}" fill="none" {style}/>'


def panel(name: str, phi_dot: float) -> str:
    """One start: turning circles, and the trace of the axis."""
    path = Motion(TOP, State.from_euler(theta=THETA, psi_dot=PSI_DOT, phi_dot=phi_dot))
    trace = path.at(np.linspace(0.0, TURN, POINTS)).to_world(np.array([0.0, 0.0, 1.0]))
    circles = "".join(
        draw_circle(theta, f'stroke="{GREY}" stroke-width="1" stroke-dasharray="3 3"')
        for theta in path.turning_angles
    )
    curve = draw_curve(trace, f'stroke="{RED}" stroke-width="20" stroke-linejoin="round"')
    label = f'<text x="{SIZE / 2}" y="{SIZE + 8}" text-anchor="middle">{name}</text>'
    return circles + curve + label


def draw_traces() -> str:
    """Return the picture."""
    panels = "".join(
        f'<g transform="translate({i * SIZE},0)">{panel(name, rate)}</g>'
        for i, (name, rate) in enumerate(STARTS.items())
    )
    width = SIZE * len(STARTS)
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width} {SIZE + 16}" '
        f'font-family="sans-serif" font-size="14" fill="#555">{panels}</svg>\n'
    )
