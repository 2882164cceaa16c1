"""How the recording looks at first sight: the top on the left, the article's figures beside it."""

from __future__ import annotations

import rerun.blueprint as rrb

from symtop_ros.playback.scene import paths
from symtop_ros.playback.scene.colors import GROUND

# eye and what it looks at, in scene units: from the front, a little above
UPPER = ((1.55, -1.75, 1.05), (0.0, 0.0, 0.46))
WHOLE = ((2.1, -2.4, 1.0), (0.0, 0.0, 0.0))


def blueprint(trail: float | None, low: bool, live: bool = False) -> rrb.Blueprint:
    """Return the layout.

    Parameters
    ----------
    trail : float or None
        How long the trace of the axis stays, s; None for as long as the recording.
    low : bool
        Whether the axis goes below the pivot.
    live : bool
        Follow the newest data, and show the plots of the last ten seconds only.
    """
    recent = _before(10.0) if live else None
    plots = [_plot(path, name, recent) for path, name in paths.PLOTS.items()]
    half = (len(plots) + 1) // 2
    left = rrb.Vertical(
        space(trail, low),
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


def space(trail: float | None, low: bool) -> rrb.Spatial3DView:
    """Return the view of the top in space."""
    ranges = _everything() if trail is None else _before(trail)
    eye, target = WHOLE if low else UPPER
    return rrb.Spatial3DView(
        origin=paths.SPACE,
        name="the top",
        background=GROUND,
        line_grid=False,
        eye_controls=rrb.EyeControls3D(position=eye, look_target=target, eye_up=(0, 0, 1)),
        overrides={paths.TRACE: ranges},
    )


def _plot(path: str, name: str, recent: rrb.VisibleTimeRanges | None) -> rrb.TimeSeriesView:
    return rrb.TimeSeriesView(
        origin=path, name=name, plot_legend=rrb.Corner2D.RightTop, time_ranges=recent
    )


def _before(seconds: float) -> rrb.VisibleTimeRanges:
    """The time up to the cursor."""
    return rrb.VisibleTimeRanges(
        timeline=paths.TIMELINE,
        start=rrb.TimeRangeBoundary.cursor_relative(seconds=-seconds),
        end=rrb.TimeRangeBoundary.cursor_relative(seconds=0.0),
    )


def _everything() -> rrb.VisibleTimeRanges:
    return rrb.VisibleTimeRanges(
        timeline=paths.TIMELINE,
        start=rrb.TimeRangeBoundary.infinite(),
        end=rrb.TimeRangeBoundary.cursor_relative(seconds=0.0),
    )
