"""The facts of a run that a page writes and plots, ready for JSON."""

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Literal
from urllib.parse import urlencode

import numpy as np

from symtop_ros.arrays import Real
from symtop_ros.drawing.chart import Chart, frame_potential
from symtop_ros.physics import (
    EffectivePotential,
    KickVerdict,
    Kind,
    Lift,
    Motion,
    State,
    kick_verdict,
    regular_precession_rates,
)
from symtop_ros.simulation.events import RESTARTS, Event
from symtop_ros.simulation.segment import Segment
from symtop_ros.web.run import SERIES, Moment, Run
from symtop_ros.wording import Variant, write

TOP_PARAMETERS = ("top.Ix", "top.Iz", "top.Mgl", "friction.axial", "friction.transverse")
POINTS = 480  # of a plotted series in the window
CURVE = 241  # points of a potential
LISTED = 10  # entries of the history
PLOTTED = [0, *(1 + SERIES.index(name) for name in ("theta", "phi_dot", "psi_dot", "ghost theta"))]
CONSTANTS = {"energy": "J", "L_z": "N m s", "L_z'": "N m s"}
HeadlineKind = Literal["start", "changed", "same", "higher", "lower", "wider", "narrower"]


@dataclass(frozen=True, slots=True)
class Headline:
    """The consequence of an event: after a kick compared with the motion without it."""

    kind: HeadlineKind
    subject: Literal["top", "axis"]
    driven: bool  # True under friction or an applied torque, without which the limits hold
    motion: Kind
    turning_angles: tuple[float, float]  # rad
    most: float  # rad; of the highest and the lowest point the larger rise or fall


def describe(run: Run) -> dict[str, Any]:
    """Return what holds for a motion as a whole; empty before the first event."""
    segment, moment = run.segment, run.announced
    if segment is None or moment is None:
        return {}
    motion = segment.motion
    since = next((each.time for each in reversed(run.moments) if _begins(each)), 0.0)
    return {
        **_write_sentences(moment, "radians"),
        "degrees": _write_sentences(moment, "degrees"),
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


def compare(moment: Moment) -> Headline:
    """Return the consequence of a start, a kick or a change."""
    motion, event = moment.after.motion, moment.event
    kind: HeadlineKind = "start" if event.name in RESTARTS else "changed"
    most = 0.0
    if event.name == "kick" and moment.before is not None:
        outcome = event.outcome()
        if not isinstance(outcome, KickVerdict):  # a log without fields
            outcome = kick_verdict(motion, event.state_before(), None)
        kind = _find_swing(outcome.highest, outcome.lowest)
        most = max(outcome.highest.amount, outcome.lowest.amount)
    subject: Literal["top", "axis"] = "axis" if motion.top.Mgl < 0 else "top"
    # What it would do without friction and torque, which is what the headline then says.
    free = Motion(motion.top, motion.start) if motion.is_driven else motion
    return Headline(kind, subject, motion.is_driven, free.kind, free.turning_angles, most)


def _find_swing(highest: Lift, lowest: Lift) -> HeadlineKind:
    """Return what a kick changed at the highest and the lowest point together."""
    kinds = {highest.kind, lowest.kind} - {"unchanged"}
    if len(kinds) == 2:
        return "wider" if highest.kind == "higher" else "narrower"
    return "same" if not kinds else "higher" if "higher" in kinds else "lower"


def _write_sentences(moment: Moment, variant: Variant) -> dict[str, str]:
    """Return the headline and the verdict of an event with angles in a unit."""
    event, outcome = moment.event, moment.event.outcome()
    why = write(event.name, outcome, variant) if outcome else event.verdict
    return {"headline": write("headline", compare(moment), variant), "why": why}


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
    angles = motion.start.euler_angles._asdict()
    rates = motion.start.euler_rates._asdict()
    values: Mapping[str, float] = {
        **{name.rpartition(".")[2]: value for name, value in top_parameters(motion).items()},
        **{name: angles[name] for name in ("theta", "phi", "psi")},
        **{f"{name}_dot": rates[name] for name in ("theta", "phi", "psi")},
    }
    return urlencode({name: f"{value:.6g}" for name, value in values.items()})


def _name(event: Event) -> str:
    asked = "; ".join(f"{name}={_shorten(text)}" for name, text in event.request.items())
    words = f"{event.name}: {asked}" if asked else event.name
    return words if len(words) <= 44 else f"{words[:41]}..."


def _shorten(text: str) -> str:
    """Return a number, or each of several, with three digits; other text as it is."""
    try:
        return " ".join(f"{float(part):.3g}" for part in text.split())
    except ValueError:
        return text
