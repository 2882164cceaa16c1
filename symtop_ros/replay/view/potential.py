"""The effective potential with its energy line, and the cubic f(u): why theta stays where it does.

Both are drawn as curves in a box, with what is allowed hatched and the state as a moving dot.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import rerun as rr

from symtop_ros.base.arrays import Real
from symtop_ros.physics import EffectivePotential, Motion
from symtop_ros.replay.view import entities
from symtop_ros.words.templates import write_number

WIDTH, HEIGHT = 2.0, 1.0  # of the box in scene units; y points down
TILTS = np.linspace(1e-4, np.pi - 1e-4, 4001)
# The height above the energy line up to which the curve is drawn: in depths of the well, and at
# least this share of Mgl, for regular precession has no depth.
ABOVE, LEAST = 1.0, 0.02
HATCHES = 40
HATCHED, DRAWN = 10.0, 20.0  # what is drawn later is in front
CLEAR = rr.Clear(recursive=False)
FRAME = np.array([(0, -HEIGHT), (0, 0), (WIDTH, 0)], dtype=float)  # left and lower edge of the box


@dataclass(frozen=True, slots=True)
class Chart:
    """A box of the scene that shows a range of x and of y."""

    # smallest and largest x, then smallest and largest y
    left: float
    right: float
    bottom: float
    top: float

    def place(self, x: Real | float, y: Real | float) -> Real:
        """Return points (n, 2) of the scene; what lies outside is moved to the edge."""
        across = (np.asarray(x, dtype=float) - self.left) / (self.right - self.left)
        up = (np.asarray(y, dtype=float) - self.bottom) / (self.top - self.bottom)
        return np.stack(
            np.broadcast_arrays(WIDTH * across.clip(0, 1), -HEIGHT * up.clip(0, 1)), axis=-1
        )

    def cut(self, x: Real, y: Real) -> list[Real]:
        """Return the parts of a curve that lie inside, as strips of the scene."""
        inside = (x >= self.left) & (x <= self.right) & (y >= self.bottom) & (y <= self.top)
        parts = np.split(np.arange(len(x)), np.flatnonzero(np.diff(inside)) + 1)
        return [self.place(x[part], y[part]) for part in parts if inside[part[0]] and len(part) > 1]

    @property
    def sides(self) -> Real:
        """Smallest and largest x."""
        return np.array([self.left, self.right])


def frame_potential(motion: Motion, potential: EffectivePotential) -> Chart:
    """Return the box for the potential of a motion: the well, and what is near it."""
    low, high = motion.turning_angles
    heights = potential.at(TILTS)
    bottom = float(min(heights.min(), potential.energy))
    depth = potential.energy - bottom
    top = potential.energy + max(ABOVE * depth, LEAST * max(abs(motion.top.Mgl), abs(depth), 1e-12))
    near = TILTS[heights <= top]
    left, right = (near.min(), near.max()) if len(near) else (low, high)
    margin = 0.04 * max(right - left, 0.1)
    return Chart(
        max(0.0, min(left, low) - margin),
        min(np.pi, max(right, high) + margin),
        bottom - 0.08 * (top - bottom),
        top,
    )


def frame_cubic(motion: Motion, potential: EffectivePotential) -> Chart:
    """Return the box for the cubic: all heights u, and the third root if it is near."""
    u2, u1 = (float(np.cos(angle)) for angle in motion.turning_angles)
    third = potential.find_third_root(*motion.turning_angles)
    size = max(
        float(potential.cubic(np.linspace(u1, u2, 101)).max()),
        1e-3 * float(np.abs(potential.cubic(np.linspace(-1, 1, 101))).max()),
        1e-12,
    )
    ends = [-1.0, 1.0, third] if abs(third) < 3 else [-1.0, 1.0]
    return Chart(min(ends) - 0.1, max(ends) + 0.1, -size, 1.4 * size)


class PotentialView:
    """Both charts of one recording."""

    _charts: tuple[Chart, Chart]  # of the last motion, without which nothing is drawn

    def __init__(self, stream: entities.Stream) -> None:
        self._stream = stream
        self._potential: EffectivePotential | None = None
        for entity in (entities.POTENTIAL, entities.CUBIC):
            stream.log(
                f"{entity}/state",
                rr.Points2D.from_fields(
                    colors=[entities.WHITE], radii=rr.Radius.ui_points([5.0]), draw_order=DRAWN + 2
                ),
                static=True,
            )

    def log_motion(self, motion: Motion) -> None:
        """Draw the curves of a motion from the current time on, and those before it in grey."""
        potential = EffectivePotential.from_state(motion.top, motion.start)
        self._charts = frame_potential(motion, potential), frame_cubic(motion, potential)
        self._log_potential(motion, potential, self._charts[0])
        self._log_cubic(motion, potential, self._charts[1])
        self._potential = potential

    def remove(self) -> None:
        """Remove the charts: the motion from the current time on is not known."""
        self._potential = None
        for entity in (entities.POTENTIAL, entities.CUBIC):
            self._stream.log(entity, rr.Clear(recursive=True))

    def place(self, tilts: Real, energies: Real, squares: Real) -> dict[str, Real]:
        """Return the positions (n, 2) of the dot in each chart, by its entity."""
        chart, cubic = self._charts
        return {
            entities.POTENTIAL: chart.place(tilts, energies),
            entities.CUBIC: cubic.place(np.cos(tilts), squares),
        }

    def draw(self, potentials: list[EffectivePotential]) -> dict[str, list[Real]]:
        """Return lines for potentials that drift, one strip for each, by the entity.

        Friction and torques change the constants of motion, and the curves with them.
        """
        chart, cubic = self._charts
        heights = np.linspace(cubic.left, cubic.right, 501)
        return {
            f"{entities.POTENTIAL}/curve": [
                _join(chart.cut(TILTS[::8], each.at(TILTS[::8]))) for each in potentials
            ],
            f"{entities.POTENTIAL}/energy": [
                chart.place(chart.sides, each.energy) for each in potentials
            ],
            f"{entities.CUBIC}/curve": [
                _join(cubic.cut(heights, each.cubic(heights))) for each in potentials
            ],
        }

    def _log_potential(self, motion: Motion, potential: EffectivePotential, chart: Chart) -> None:
        low, high = motion.turning_angles
        between = np.linspace(low, high, HATCHES)
        floor = np.minimum(potential.at(between), potential.energy)
        hatches = [chart.place(between, floor), chart.place(between, potential.energy)]
        self._log_curve(entities.POTENTIAL, chart, EffectivePotential.at, TILTS, potential, hatches)
        self._log_lines(
            entities.POTENTIAL,
            "energy",
            [chart.place(chart.sides, potential.energy)],
            entities.GOLD,
        )
        self._log_lines(entities.POTENTIAL, "frame", [FRAME], entities.GREY, 1.0)
        first, last = (write_number(angle, "3f") for angle in (low, high))
        marks = {f"{first} rad": low, last: high} if high > low else {first: low}
        self._log_marks(entities.POTENTIAL, chart, marks, chart.bottom)

    def _log_cubic(self, motion: Motion, potential: EffectivePotential, chart: Chart) -> None:
        u2, u1 = (float(np.cos(angle)) for angle in motion.turning_angles)
        between = np.linspace(u1, u2, HATCHES)
        values = np.maximum(potential.cubic(between), 0.0)
        hatches = [chart.place(between, 0.0), chart.place(between, values)]
        heights = np.linspace(chart.left, chart.right, 2001)
        self._log_curve(
            entities.CUBIC, chart, EffectivePotential.cubic, heights, potential, hatches
        )
        poles = [chart.place(end, np.array([chart.bottom, chart.top])) for end in (-1.0, 1.0)]
        zero = chart.place(chart.sides, 0.0)
        self._log_lines(entities.CUBIC, "frame", [zero, *poles], entities.GREY, 1.0)
        roots = {_name_root(1, u1): u1, _name_root(2, u2): u2}
        third = potential.find_third_root(*motion.turning_angles)
        if chart.left < third < chart.right:
            roots[_name_root(3, third)] = third
        self._log_marks(entities.CUBIC, chart, roots, 0.0)

    def _log_curve(
        self,
        entity: str,
        chart: Chart,
        curve: Callable[[EffectivePotential, Real], Real],
        x: Real,
        potential: EffectivePotential,
        hatches: list[Real],
    ) -> None:
        """Draw a curve, that of the potential before, and hatches between two rows of ends."""
        old = self._potential
        before = chart.cut(x, curve(old, x)) if old and old != potential else []
        self._log_lines(entity, "curve", chart.cut(x, curve(potential, x)), entities.BLUE)
        self._log_lines(entity, "allowed", [*np.stack(hatches, axis=1)], (*entities.GOLD, 40), 2.0)
        self._log_lines(entity, "before", before, entities.ASH, 1.0)

    def _log_lines(
        self,
        entity: str,
        name: str,
        strips: list[Real],
        color: tuple[int, ...],
        width: float = 1.8,
    ) -> None:
        lines = rr.LineStrips2D(
            strips,
            colors=[color],
            radii=rr.Radius.ui_points([width]),
            draw_order=HATCHED if name == "allowed" else DRAWN,
        )
        self._stream.log(f"{entity}/{name}", lines if strips else CLEAR)

    def _log_marks(self, entity: str, chart: Chart, marks: dict[str, float], y: float) -> None:
        self._stream.log(
            f"{entity}/marks",
            rr.Points2D(
                chart.place(np.array([*marks.values()]), y),
                labels=list(marks),
                colors=[entities.GOLD],
                radii=rr.Radius.ui_points([3.5]),
                draw_order=DRAWN + 1,
                show_labels=True,
            ),
        )


def _join(strips: list[Real]) -> Real:
    """Return the longest strip, or a point."""
    return max(strips, key=len, default=np.zeros((1, 2)))


def _name_root(number: int, root: float) -> str:
    return f"u{number} = {write_number(root, '3f')}"
