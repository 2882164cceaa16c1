"""Layout of a recording: the 3D scene on the left, the plots of the article on the right.

The framing of a motion states how much of its trace is visible, and which range of time the plots
show.
"""

import math
from collections.abc import Mapping
from dataclasses import dataclass, field, replace

import numpy as np
import rerun.blueprint as rrb
from rerun.blueprint.archetypes import PlotBackground

from symtop_ros.physics import Motion
from symtop_ros.replay.view import entities
from symtop_ros.replay.view.potential import HEIGHT, WIDTH
from symtop_ros.run.simulation.segment import Segment

# Position of the eye and its target in scene units: from the front, slightly from above
EYE_UPPER_HALF = ((1.55, -1.75, 1.05), (0.0, 0.0, 0.46))
EYE_WHOLE_SPHERE = ((1.85, -2.1, 0.9), (0.0, 0.0, 0.0))

# The colours are for a dark background; in the light theme of the viewer plots would be white.
PLOT_BACKGROUND = PlotBackground(color=entities.BACKGROUND)
TRACE_NUTATIONS = 12  # longest trace in nutations, if one turn of the precession has more
PLOT_NUTATIONS = 30  # nutations on each side of the cursor
LEAST_SPAN = 0.02  # least range of a plot, relative to the size of the quantity
HORIZON = 1.65  # rad; slightly below the horizontal plane of the pivot
# Margins around the box of a chart, in heights of the box: at the sides and above, and below. The
# texts with the angles stand below the box of the potential; in a window of 1280 x 720 they end at
# 0.25.
MARGIN, BELOW = 0.06, 0.3


@dataclass(frozen=True, slots=True)
class Framing:
    """Visible part of a motion. The default is for a log without events."""

    trace: float = 2.0  # time for which the trace of the axis stays visible, s of the clock
    window: float = 10.0  # range of the plots on each side of the cursor, s of the clock
    # True if the axis moves below the pivot: the whole sphere is drawn, and no stand
    below_pivot: bool = True
    # ranges of plots, by entity, for quantities that hardly change: otherwise their rounding errors
    # would fill the plot
    ranges: Mapping[str, tuple[float, float]] = field(default_factory=dict)

    @classmethod
    def of(cls, segment: Segment) -> "Framing":
        """Return the framing of a motion."""
        motion = segment.final_motion
        free = Motion(motion.top, motion.start) if motion.is_driven else motion
        turn, nutation = free.precession_period, free.nutation_period
        return cls(
            trace=_clip(0.2, min(turn, TRACE_NUTATIONS * nutation) / segment.factor, 30.0),
            window=_clip(2.0, PLOT_NUTATIONS * nutation / segment.factor, 60.0),
            below_pivot=motion.top.Mgl < 0 or motion.turning_angles[1] > HORIZON,
            ranges=_find_ranges(motion),
        )

    def after(self, before: "Framing | None") -> "Framing":
        """Return the framing with ranges for the motion before, too: plots show both."""
        if before is None:
            return self
        both = self.ranges.keys() & before.ranges.keys()
        ends = {each: (*self.ranges[each], *before.ranges[each]) for each in both}
        return replace(self, ranges={each: (min(four), max(four)) for each, four in ends.items()})


def _find_ranges(motion: Motion) -> dict[str, tuple[float, float]]:
    """Return a range for each plotted quantity that hardly changes, `LEAST_SPAN` of it wide."""
    if motion.is_driven:
        return {}
    states = motion.at(np.linspace(0.0, _clip(0.01, motion.nutation_period, 10.0), 201))
    momentum = motion.top.angular_momentum(states)
    rates = motion.euler_rates(states)
    found = {}
    for entity, values in (
        (entities.THETA, np.asarray(states.euler_angles.theta)),
        (entities.PHI_DOT, np.asarray(rates.phi_dot)),
        (entities.PSI_DOT, np.asarray(rates.psi_dot)),
        (entities.L_HORIZONTAL, (momentum[:, :2] ** 2).sum(axis=1)),
    ):
        low, high = float(values.min()), float(values.max())
        least = LEAST_SPAN * max(abs(low), abs(high))
        if high - low < least < math.inf:
            middle = (low + high) / 2
            found[entity] = (middle - least / 2, middle + least / 2)
    return found


def create_blueprint(framing: Framing, live: bool) -> rrb.Blueprint:
    """Return the layout for a motion; a live view follows the newest data.

    The first tab is for the first look: the top, what follows, and why. The second has the rest.
    """
    window = around_cursor(-framing.window, 0.0 if live else framing.window)
    plots = {
        entity: _plot(entity, name, window, framing.ranges.get(entity))
        for entity, name in entities.PLOTS.items()
    }
    first = [plots.pop(entity) for entity in (entities.THETA, entities.PHI_DOT)]
    top = rrb.Horizontal(
        rrb.Vertical(
            create_space_view(framing),
            rrb.TextDocumentView(origin=entities.SENTENCE, name="what follows"),
            row_shares=[3, 1],
        ),
        rrb.Vertical(*first, _chart(entities.POTENTIAL, "effective potential (J)")),
        column_shares=[3, 2],
        name="the top",
    )
    return rrb.Blueprint(
        rrb.Tabs(top, _lay_out_rest(list(plots.values())), active_tab=0),
        rrb.TimePanel(
            timeline=entities.TIMELINE,
            state="collapsed",
            play_state="following" if live else "playing",
        ),
        rrb.BlueprintPanel(state="collapsed"),
        rrb.SelectionPanel(state="collapsed"),
    )


def _lay_out_rest(plots: list[rrb.TimeSeriesView]) -> rrb.Vertical:
    """Return the tab of all that the first one leaves out."""
    half = (len(plots) + 1) // 2
    return rrb.Vertical(
        rrb.Horizontal(
            rrb.Vertical(
                rrb.TextDocumentView(origin=entities.PANEL, name="this motion"),
                _chart(entities.CUBIC, "f(u), u = cos(theta)"),
            ),
            rrb.Vertical(*plots[:half]),
            rrb.Vertical(*plots[half:]),
        ),
        rrb.TextLogView(
            origin=entities.EVENTS,
            name="events",
            columns=rrb.TextLogColumns(text_log_columns=["Body"]),
        ),
        row_shares=[5, 1],
        name="momenta, energy, events",
    )


def _plot(
    entity: str, name: str, window: rrb.VisibleTimeRanges, span: tuple[float, float] | None
) -> rrb.TimeSeriesView:
    return rrb.TimeSeriesView(
        origin=entity,
        name=name,
        plot_legend=rrb.Corner2D.RightTop,
        background=PLOT_BACKGROUND,
        time_ranges=window,
        axis_y=rrb.ScalarAxis(range=span) if span else None,
    )


def create_space_view(framing: Framing) -> rrb.Spatial3DView:
    """Return the 3D view of the top."""
    eye, target = EYE_WHOLE_SPHERE if framing.below_pivot else EYE_UPPER_HALF
    return rrb.Spatial3DView(
        origin=entities.SPACE,
        name="the top",
        background=entities.BACKGROUND,
        line_grid=False,
        eye_controls=rrb.EyeControls3D(position=eye, look_target=target, eye_up=(0, 0, 1)),
        overrides={
            entity: around_cursor(-framing.trace, 0.0)
            for entity in (entities.TRACE, entities.GHOST_TRACE, entities.POINTS)
        },
    )


def _chart(entity: str, name: str) -> rrb.Spatial2DView:
    return rrb.Spatial2DView(
        origin=entity,
        name=name,
        background=entities.BACKGROUND,
        visual_bounds=rrb.VisualBounds2D(
            x_range=(-MARGIN, WIDTH + MARGIN), y_range=(-HEIGHT - MARGIN, BELOW)
        ),
    )


def around_cursor(first: float, last: float) -> rrb.VisibleTimeRanges:
    """Return the time range between two offsets from the cursor, in s."""
    return rrb.VisibleTimeRanges(
        timeline=entities.TIMELINE,
        start=rrb.TimeRangeBoundary.cursor_relative(seconds=first),
        end=rrb.TimeRangeBoundary.cursor_relative(seconds=last),
    )


def _clip(low: float, value: float, high: float) -> float:
    """Return a number within bounds; the lower bound for nan."""
    return min(max(low, value), high)
