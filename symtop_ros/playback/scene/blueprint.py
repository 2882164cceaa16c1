"""How the recording looks at first sight: the top on the left, the article's figures beside it."""

from __future__ import annotations

import rerun.blueprint as rrb

from symtop_ros.playback.scene import paths
from symtop_ros.playback.scene.colors import GROUND
from symtop_ros.playback.scene.framing import Framing

# eye and what it looks at, in scene units: from the front, a little above
UPPER = ((1.55, -1.75, 1.05), (0.0, 0.0, 0.46))
WHOLE = ((1.85, -2.1, 0.9), (0.0, 0.0, 0.0))


def blueprint(framing: Framing, live: bool) -> rrb.Blueprint:
    """Return the layout of a motion; a live one follows the newest data."""
    after = 0.0 if live else framing.window
    window = _around_cursor(-framing.window, after)
    plots = [_plot(path, name, window) for path, name in paths.PLOTS.items()]
    half = (len(plots) + 1) // 2
    left = rrb.Vertical(
        space(framing),
        rrb.TextDocumentView(origin=paths.PANEL, name="this motion"),
        row_shares=[5, 2],
    )
    right = rrb.Vertical(*plots[:half]), rrb.Vertical(*plots[half:])
    events = rrb.TextLogView(
        origin=paths.EVENTS,
        name="events",
        columns=rrb.TextLogColumns(text_log_columns=["Body"]),
    )
    return rrb.Blueprint(
        rrb.Vertical(
            rrb.Horizontal(left, *right, column_shares=[5, 3, 3]), events, row_shares=[6, 1]
        ),
        rrb.TimePanel(
            timeline=paths.TIMELINE,
            state="collapsed",
            play_state="following" if live else "playing",
        ),
        rrb.BlueprintPanel(state="collapsed"),
        rrb.SelectionPanel(state="collapsed"),
    )


def space(framing: Framing) -> rrb.Spatial3DView:
    """Return the view of the top in space."""
    eye, target = WHOLE if framing.low else UPPER
    return rrb.Spatial3DView(
        origin=paths.SPACE,
        name="the top",
        background=GROUND,
        line_grid=False,
        eye_controls=rrb.EyeControls3D(position=eye, look_target=target, eye_up=(0, 0, 1)),
        overrides={paths.TRACE: _around_cursor(-framing.trail, 0.0)},
    )


def _plot(path: str, name: str, window: rrb.VisibleTimeRanges) -> rrb.TimeSeriesView:
    return rrb.TimeSeriesView(
        origin=path, name=name, plot_legend=rrb.Corner2D.RightTop, time_ranges=window
    )


def _around_cursor(first: float, last: float) -> rrb.VisibleTimeRanges:
    """From some seconds before the cursor to some after it."""
    return rrb.VisibleTimeRanges(
        timeline=paths.TIMELINE,
        start=rrb.TimeRangeBoundary.cursor_relative(seconds=first),
        end=rrb.TimeRangeBoundary.cursor_relative(seconds=last),
    )
