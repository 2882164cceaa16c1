"""The charts of the page: effective potential, series over time, and the constants of motion."""

import math
from html import escape

import numpy as np
from viser import ClientHandle, GuiHtmlHandle, GuiUplotHandle, ViserServer, uplot

from symtop_ros.drawing import chart as box
from symtop_ros.drawing.chart import TILTS, Chart, frame_potential
from symtop_ros.panel.run import SERIES, Run
from symtop_ros.physics import EffectivePotential, Motion, perrys_rule

WIDTH = 316  # px
POINTS = 320  # of a plotted series
PLOTTED = {"theta": "tilt theta (rad)", "phi_dot": "phi' (rad/s)", "psi_dot": "psi' (rad/s)"}
LINES = {"theta": "#d55e00", "phi_dot": "#2b78e4", "psi_dot": "#009e73"}
FONT = "10px sans-serif"
ACROSS, UP = 150.0, 108.0  # of the potential's box to units of the picture
UNITS = {"energy": "J", "L_z": "N m s", "L_z'": "N m s"}
NAMES = {"energy": "E", "L_z": "L<sub>z</sub>", "L_z'": "L<sub>z'</sub>"}


class Charts:
    """The panel on the right of the page."""

    def __init__(self, server: ViserServer) -> None:
        panel = server.gui.add_panel()
        with panel.add_tab("Why it moves so"):
            self._potential = PotentialChart(server.gui.add_html(""))
            self._plots = {name: _add_plot(server, name) for name in PLOTTED}
            self._constants = server.gui.add_html("")
        panel.dock_right()
        panel.set_width(WIDTH)
        self._panel = panel

    def stack(self, client: ClientHandle) -> None:
        """Put the charts below the controls on one page, which is higher than wide."""
        handle = client.gui.main_panel
        # Viser can place a panel on all pages, or the main panel on one of them. Both send one
        # message with the name of the panel.
        handle._placement_uuid = self._panel._placement_uuid
        handle.dock_below(client.gui.main_panel)

    def begin_motion(self, run: Run) -> None:
        """Draw what holds for a whole motion."""
        if run.motion:
            self._potential.begin_motion(
                run.motion, EffectivePotential.of(run.motion.top, run.motion.start)
            )

    def draw(self, run: Run) -> None:
        """Draw the plots and the dot in the potential."""
        self._potential.draw(run)
        rows = run.series()
        if len(rows) < 2:
            return
        rows = rows[np.searchsorted(rows[:, 0], rows[-1, 0] - run.window) :]
        rows = rows[:: max(1, math.ceil(len(rows) / POINTS))]
        for name, plot in self._plots.items():
            plot.data = (rows[:, 0], rows[:, 1 + SERIES.index(name)])

    def write(self, run: Run) -> None:
        """Write the table of the constants of motion."""
        if run.motion and run.state:
            self._constants.content = _table(run, run.motion)


class PotentialChart:
    """U_eff(theta), the energy line, the allowed angles, and the state as a dot."""

    def __init__(self, html: GuiHtmlHandle) -> None:
        self._html = html
        self._motion: Motion | None = None
        self._potential: EffectivePotential | None = None
        self._chart: Chart | None = None
        self._fixed = self._before = ""

    def begin_motion(self, motion: Motion, potential: EffectivePotential) -> None:
        """Draw the curve of a motion; the one before it stays as a thin line."""
        old, self._motion, self._potential = self._potential, motion, potential
        self._chart = frame_potential(motion, potential)
        self._before = ""
        if old and old != potential:
            self._before = _path(self._chart, old, "#8c94a2", 1.0, 'stroke-dasharray="4 3"')
        self._fixed = _fixed_part(self._chart, motion, potential)

    def draw(self, run: Run) -> None:
        """Move the dot; under friction or a torque the curve moves as well."""
        motion, potential, chart = self._motion, run.potential, self._chart
        if motion is None or potential is None or chart is None or run.state is None:
            return
        if motion.is_driven:
            self._fixed = _fixed_part(chart, Motion(motion.top, run.state), potential)
        theta = float(run.state.euler_angles.theta)
        (x, y), (_, bottom) = (
            _place(chart, theta, height)
            for height in (potential.energy, potential.at(theta).item())
        )
        self._html.content = (
            f'<div data-theta="{theta!r}" style="padding:0 8px">'
            f'<svg viewBox="-14 -22 {ACROSS * box.WIDTH + 28:g} {UP * box.HEIGHT + 44:g}" '
            'width="100%" style="display:block" role="img" aria-label="Effective potential">'
            f"{self._before}{self._fixed}"
            f'<line x1="{x:.1f}" y1="{y:.1f}" x2="{x:.1f}" y2="{bottom:.1f}" stroke="#d55e00" '
            'stroke-width="1.5" stroke-dasharray="2 2"/>'
            f'<circle cx="{x:.1f}" cy="{y:.1f}" r="5" fill="#d55e00"/></svg></div>'
        )


def _fixed_part(chart: Chart, motion: Motion, potential: EffectivePotential) -> str:
    """Return curve, energy line, allowed angles and names as elements of the picture."""
    low, high = motion.turning_angles
    (left, y), (right, _) = (_place(chart, angle, potential.energy) for angle in (low, high))
    width = ACROSS * box.WIDTH
    names = (
        (0, -12, "start", 1.0, "effective potential U(theta)"),
        (width, y - 5, "end", 0.75, "E'"),
        *_name_turning_angles(left, right, low, high),
    )
    texts = "".join(
        f'<text x="{x:.1f}" y="{height:.1f}" text-anchor="{anchor}" font-size="11" '
        f'fill="currentColor" opacity="{opacity}">{escape(text)}</text>'
        for x, height, anchor, opacity, text in names
    )
    return (
        f'<rect x="{left:.1f}" y="0" width="{max(right - left, 1.0):.1f}" '
        f'height="{UP * box.HEIGHT:g}" fill="#e69f00" opacity="0.16"/>'
        f'<path d="M0 0V{UP * box.HEIGHT:g}H{width:g}" fill="none" stroke="currentColor" '
        'opacity="0.4"/>'
        f'<line x1="0" x2="{width:g}" y1="{y:.1f}" y2="{y:.1f}" stroke="#e69f00" '
        f'stroke-width="2"/>{_path(chart, potential, "#2b78e4", 2.0)}{texts}'
    )


def _name_turning_angles(
    left: float, right: float, low: float, high: float
) -> list[tuple[float, float, str, float, str]]:
    """Return the names of both turning angles; if they are near each other, one for both."""
    y, edge = UP * box.HEIGHT + 14, ACROSS * box.WIDTH
    if right - left < 45:
        middle = min(max((left + right) / 2, 45.0), edge - 45.0)
        text = f"{low:.3f} rad" if high - low < 5e-4 else f"{low:.3f} .. {high:.3f} rad"
        return [(middle, y, "middle", 1.0, text)]
    return [
        (max(left, 12.0), y, "middle", 1.0, f"{low:.3f}"),
        (min(right, edge - 22.0), y, "middle", 1.0, f"{high:.3f} rad"),
    ]


def _path(
    chart: Chart, potential: EffectivePotential, color: str, width: float, more: str = ""
) -> str:
    """Return the curve of a potential as an element of the picture."""
    tilts = TILTS[::8]
    parts = []
    for strip in chart.cut(tilts, potential.at(tilts)):
        step = max(1, len(strip) // 160)
        points = np.concatenate([strip[::step], strip[-1:]]) * [ACROSS, UP] + [0, UP * box.HEIGHT]
        parts.append("M" + "L".join(f"{x:.1f} {y:.1f}" for x, y in points.tolist()))
    return (
        f'<path d="{"".join(parts)}" fill="none" stroke="{color}" stroke-width="{width:g}" {more}/>'
    )


def _place(chart: Chart, theta: float, height: float) -> tuple[float, float]:
    x, y = chart.place(theta, height).tolist()
    return ACROSS * x, UP * (y + box.HEIGHT)


def _add_plot(server: ViserServer, name: str) -> GuiUplotHandle:
    title = PLOTTED[name]
    return server.gui.add_uplot(
        (np.array([0.0, 1.0]), np.array([0.0, 0.0])),
        (uplot.Series(label="t (s)"), uplot.Series(label=title, stroke=LINES[name], width=1.5)),
        title=title,
        legend=uplot.Legend(show=False),
        # In the time of the motion: uPlot takes x for dates by default.
        scales={"x": uplot.Scale(time=False, auto=True)},
        axes=(uplot.Axis(size=24, font=FONT, space=60), uplot.Axis(size=44, font=FONT, space=26)),
        height=78,
        padding=(4, 12, 0, 0),
    )


def _table(run: Run, motion: Motion) -> str:
    """Return kind, rates and constants, each constant with its change since the motion began."""
    rates = ", ".join(f"{rate:.4g}" for rate in perrys_rule(motion.top, motion.start).regular_rates)
    facts = [
        ("motion", escape(str(motion.kind)), "change"),
        ("nutation period", _number(motion.nutation_period, "s"), ""),
        ("mean phi'", _number(motion.mean_precession_rate, "rad/s"), ""),
        ("regular phi'", f"{rates or 'none'} rad/s", ""),
        *(
            (NAMES[name], f"{value:.6g} {UNITS[name]}", f"{change:+.1e}")
            for name, (value, change) in run.drifts().items()
        ),
    ]
    rows = "".join(
        f'<tr><td class="panel-dim">{name}</td><td>{value}</td>'
        f'<td class="panel-dim" align="right">{change}</td></tr>'
        for name, value, change in facts
    )
    return f'<table class="panel-table">{rows}</table>'


def _number(value: float, unit: str) -> str:
    return f"{value:.4g} {unit}" if math.isfinite(value) else "-"
