"""Measured points of a run, over the exact curves of its motion: in the scene and in the plots."""

from collections.abc import Sequence

import numpy as np
import rerun as rr

from symtop_ros.base.arrays import Mask, Places, Real
from symtop_ros.physics import State
from symtop_ros.replay.view import entities
from symtop_ros.run.log.intervals import Interval
from symtop_ros.run.simulation.points import SEEN, Points

RADIUS = 0.011  # scene units
SIZE = 2.5  # px in a plot
ROWS = 4096  # in one call, as of samples


def send_points(stream: entities.Stream, points: Points, intervals: Sequence[Interval]) -> None:
    """Send the points, each at its time, with its residuals as its label.

    The motion is that of the last interval of a log that has begun; where none is known nothing is
    drawn.
    """
    shown = np.full((len(points), 3), np.nan), np.full((len(points), 3), np.nan)
    begins = [each.begin for each in intervals]
    owners = np.searchsorted(begins, points.stamps, side="right") - 1
    for number, each in enumerate(intervals):
        inside = owners == number
        if each.event and inside.any():
            states = each.event.segment().state_at(points.stamps[inside])
            _fill(shown, inside, points, states)
    axes, values = shown
    is_seen = np.isfinite(axes).all(axis=1)
    _send_axes(stream, points, axes, is_seen)
    for entity, column in zip(entities.SEEN, values.T, strict=True):
        _send_plot(stream, entity, points, column)


def _fill(shown: tuple[Real, Real], inside: Mask, points: Points, states: State) -> None:
    """Add what the points of an interval show: axes, theta, phi' and psi'."""
    part = points.select(inside)
    shown[0][inside] = part.find_axes(states)
    shown[1][inside] = np.stack([part.find_tilts(states), *part.find_rates(states)], axis=1)


def _send_axes(stream: entities.Stream, points: Points, axes: Real, is_seen: Mask) -> None:
    stream.log(
        entities.POINTS,
        rr.Points3D.from_fields(colors=[entities.SKY], radii=[RADIUS], show_labels=False),
        static=True,
    )
    for places in _split(np.flatnonzero(is_seen)):
        labels = [describe_point(points, place) for place in places.tolist()]
        columns = rr.Points3D.columns(positions=axes[places], labels=labels)
        stream.send(entities.POINTS, points.stamps[places], columns)


def _send_plot(stream: entities.Stream, entity: str, points: Points, values: Real) -> None:
    found = np.flatnonzero(np.isfinite(values))
    if not len(found):
        return
    style = rr.SeriesPoints(
        colors=[entities.SKY], names=["measured"], markers=["circle"], marker_sizes=[SIZE]
    )
    stream.log(entity, style, static=True)
    for places in _split(found):
        stream.send_scalars(entity, points.stamps[places], values[places, np.newaxis])


def _split(places: Places) -> list[Places]:
    return np.array_split(places, max(1, -(-len(places) // ROWS))) if len(places) else []


def describe_point(points: Points, place: int) -> str:
    """Return the time and the residuals of a point."""
    seen = SEEN[points.kind]
    left = zip(seen.residuals, points.residuals[place].tolist(), seen.units, strict=True)
    texts = (f"{name} {value:.2g} {unit}".rstrip() for name, value, unit in left)
    return f"{points.times[place]:.4f} s, measured minus computed: {', '.join(texts)}"
