"""The facts of a run that a page writes and plots, ready for JSON."""

import math
import re
from collections.abc import Mapping
from typing import Any
from urllib.parse import urlencode

import numpy as np

from symtop_ros.arrays import Real
from symtop_ros.drawing.chart import Chart, frame_potential
from symtop_ros.physics import EffectivePotential, Motion, State, regular_precession_rates
from symtop_ros.simulation.events import RESTARTS, Event
from symtop_ros.simulation.segment import Segment
from symtop_ros.web.run import SERIES, Moment, Run

TOP_PARAMETERS = ("top.Ix", "top.Iz", "top.Mgl", "friction.axial", "friction.transverse")
POINTS = 480  # of a plotted series in the window
CURVE = 241  # points of a potential
SAME_ANGLE = 1e-7  # rad: turning angles that differ by less are equal (physics/verdict.py)
LISTED = 10  # entries of the history
NUMBER = re.compile(r"-?\d+\.\d+(e[-+]?\d+)?")
PLOTTED = [0, *(1 + SERIES.index(name) for name in ("theta", "phi_dot", "psi_dot", "ghost theta"))]
CONSTANTS = {"energy": "J", "L_z": "N m s", "L_z'": "N m s"}
KINDS = {
    "regular": "The top precesses steadily, {range}.",
    "cusps": "The top falls and comes back to rest in cusps, {range}.",
    "looping": "The top precesses in loops, {range}.",
    "unidirectional": "The top precesses in a wave, {range}.",
    "sleeping": "The top sleeps: its axis stays on the vertical.",
}


def describe(run: Run) -> dict[str, Any]:
    """Return what holds for a motion as a whole; empty before the first event."""
    segment, moment = run.segment, run.announced
    if segment is None or moment is None:
        return {}
    motion = segment.motion
    since = next((each.time for each in reversed(run.moments) if _begins(each)), 0.0)
    return {
        "headline": write_headline(moment),
        "why": moment.event.verdict,
        "running": segment.running,
        "factor": segment.factor,
        "recording": run.is_recording,
        "top": top_parameters(motion),
        "start": _describe_start(motion.start),
        "roots": _find_roots(motion),
        "window": run.window,
        "since": since,
        "marks": [each.time for each in run.moments if each.event.name == "kick"],
        "potential": describe_potential(run, moment),
        "table": _list_rates(motion),
        "history": [(identify(event), _name(event)) for event in list_history(run)],
        "link": write_link(run),
    }


def list_history(run: Run) -> list[Event]:
    """Return the events that a page lists, the newest first."""
    return list(run.history)[: -LISTED - 1 : -1]


def identify(event: Event) -> str:
    """Return a text that no other event of the history has; some have the same stamp."""
    return str(id(event))


def describe_constants(run: Run) -> dict[str, tuple[float, float, str]]:
    """Return each constant of the motion, its change since the motion began, and its unit."""
    return {name: (*pair, CONSTANTS[name]) for name, pair in run.drifts().items()}


def thin(rows: Real, window: float) -> list[list[float | None]]:
    """Return time, theta, phi', psi' and theta of the ghost of the rows that a plot needs."""
    places = np.floor(rows[:, 0] * (POINTS / window))
    _, chosen = np.unique(places, return_index=True)
    return [round_row(row) for row in rows[np.sort(chosen)]]


def round_row(row: Real) -> list[float | None]:
    """Return what is plotted of a row, in the digits that a picture needs; nan becomes None."""
    time, *others = row[PLOTTED].tolist()
    return [round(time, 6), *(None if math.isnan(x) else float(f"{x:.6g}") for x in others)]


def write_headline(moment: Moment) -> str:
    """Return the consequence of a start, a kick or a change, in one sentence."""
    motion, event = moment.after.motion, moment.event
    if event.name == "kick" and moment.before is not None:
        was = Motion(motion.top, event.state_before()).turning_angles
        return _compare(was, motion.turning_angles, "axis" if motion.top.Mgl < 0 else "top")
    if event.name in RESTARTS:
        form = KINDS.get(str(motion.kind), "The motion is {kind}, {range}.")
        return form.format(kind=motion.kind, range=_write_range(motion.turning_angles))
    return f"The top has changed: {_write_range(motion.turning_angles)}."


def _compare(was: tuple[float, float], now: tuple[float, float], name: str) -> str:
    """Return what a kick changes at the highest and the lowest point."""
    highest, lowest = (
        before - after if abs(before - after) > SAME_ANGLE else 0.0
        for before, after in zip(was, now, strict=True)
    )
    most = max(abs(highest), abs(lowest))
    if most == 0:
        return f"The {name} swings as it would without the kick."
    if min(highest, lowest) >= 0:
        return f"The {name} rises by {most:.3f} rad: it moves higher than without the kick."
    if max(highest, lowest) <= 0:
        return f"The {name} falls by {most:.3f} rad: it moves lower than without the kick."
    width = "wider" if highest > 0 else "less"
    return f"The {name} swings {width} than without the kick: {_write_range(now)}."


def _write_range(angles: tuple[float, float]) -> str:
    low, high = (f"{angle:.3f}" for angle in angles)
    if low == high:
        return f"its tilt stays at {low} rad"
    return f"its tilt is between {low} and {high} rad"


def _begins(moment: Moment) -> bool:
    return moment.before is None or moment.event.name in RESTARTS


def top_parameters(motion: Motion) -> dict[str, float]:
    """Return moments and friction of a top by the names of their parameters."""
    friction = (motion.friction.axial, motion.friction.transverse)
    return dict(zip(TOP_PARAMETERS, (*motion.top.moments, *friction), strict=True))


def _describe_start(state: State) -> dict[str, float]:
    """Return tilt and rates; on the vertical phi' is undefined, and all of the spin is psi'."""
    angles, rates = state.euler_angles, state.euler_rates
    if state.is_vertical:
        spin = float(state.angular_velocity[2])
        return {"theta": float(angles.theta), "phi_dot": 0.0, "psi_dot": spin}
    return {
        "theta": float(angles.theta),
        "phi_dot": round(float(rates.phi), 6),
        "psi_dot": round(float(rates.psi), 6),
    }


def _find_roots(motion: Motion) -> list[float]:
    start = _describe_start(motion.start)
    return list(
        regular_precession_rates(motion.top, theta=start["theta"], psi_dot=start["psi_dot"])
    )


def _list_rates(motion: Motion) -> list[tuple[str, str]]:
    rows = [("motion", str(motion.kind))]
    if math.isfinite(motion.nutation_period):
        rows.append(("nutation period", f"{motion.nutation_period:.4g} s"))
    if math.isfinite(motion.mean_precession_rate):
        rows.append(("mean phi'", f"{motion.mean_precession_rate:.4g} rad/s"))
    return rows


def describe_potential(run: Run, moment: Moment) -> dict[str, Any]:
    """Return the box of the potential, its curve in it, and the curve before the last change."""
    segment: Segment = moment.after if run.segment is None else run.segment
    motion = segment.motion
    state = run.state if motion.is_driven and run.state is not None else motion.start
    potential = EffectivePotential.of(motion.top, state)
    angles = Motion(motion.top, state).turning_angles if motion.is_driven else motion.turning_angles
    chart = frame_potential(Motion(motion.top, state), potential)
    before = None
    if moment.before is not None and not _begins(moment):
        old = EffectivePotential.of(moment.before.motion.top, moment.event.state_before())
        before = _sample(old, chart, ())
    return {
        **dict(zip(("left", "right", "bottom", "top"), _edges(chart), strict=True)),
        **_sample(potential, chart, angles),
        "energy": potential.energy,
        "angles": list(angles),
        "before": before,
    }


def _edges(chart: Chart) -> tuple[float, float, float, float]:
    return tuple(map(float, (chart.left, chart.right, chart.bottom, chart.top)))  # type: ignore[return-value]


def _sample(
    potential: EffectivePotential, chart: Chart, angles: tuple[float, ...]
) -> dict[str, list[float]]:
    """Return points of a curve inside the box, the turning angles among them.

    Between two points a straight line is drawn: it must not pass the energy line where the curve
    does not.
    """
    tilts = np.unique([*np.linspace(chart.left, chart.right, CURVE), *angles])
    heights = potential.at(tilts)
    beyond = chart.top + (chart.top - chart.bottom)
    return {"theta": tilts.tolist(), "height": np.minimum(heights, beyond).tolist()}


def write_link(run: Run) -> str:
    """Return the query of a link that starts the motion of the last event; empty without one.

    Its numbers have six digits: a link is typed and read by people.
    """
    motion = run.motion
    if motion is None:
        return ""
    angles, rates = motion.start.euler_angles, motion.start.euler_rates
    values: Mapping[str, float] = {
        **{name.rpartition(".")[2]: value for name, value in top_parameters(motion).items()},
        **{name: getattr(angles, name) for name in ("theta", "phi", "psi")},
        **{f"{name}_dot": getattr(rates, name) for name in ("theta", "phi", "psi")},
    }
    return urlencode({name: f"{value:.6g}" for name, value in values.items()})


def _name(event: Event) -> str:
    asked = NUMBER.sub(lambda number: f"{float(number[0]):.3g}", event.values.get("request", ""))
    words = f"{event.name}: {asked}" if asked else event.name
    return words if len(words) <= 44 else f"{words[:41]}..."
