"""The panel beside the scene: the motion in a table of Markdown."""

from __future__ import annotations

import math

from symtop_ros.physics import Motion, State, perry
from symtop_ros.run.segment import Segment


def panel(segment: Segment, state: State, scales: dict[str, str]) -> str:
    """Return what holds from an event on.

    Parameters
    ----------
    segment : Segment
    state : State
        Right after the event.
    scales : dict
        What one unit of the scene is, by the name of the arrow.
    """
    path = segment.path
    top = path.top
    low, high = path.turning_angles
    rates = ", ".join(f"{rate:.4g}" for rate in perry(top, state).regular_rates) or "none"
    facts = {
        "motion": f"{path.kind}, {f'speed {segment.factor:g}' if segment.running else 'paused'}",
        "theta": f"{low:.4f} .. {high:.4f} rad",
        "nutation period": _number(path.nutation_period, "s"),
        "mean precession": _number(path.mean_precession_rate, "rad/s"),
        "regular precession": f"{rates} rad/s",
        "Ix, Iz": f"{top.Ix:g}, {top.Iz:g} kg m\u00b2",
        "Mgl": f"{top.Mgl:g} J",
        **_driving(path),
        **{f"1 unit of {name}": scale for name, scale in scales.items()},
    }
    cells = [f"{name} | **{value}**" for name, value in facts.items()]
    rows = [f"| {' | '.join(cells[k : k + 2])} |" for k in range(0, len(cells), 2)]
    return "\n".join(["| | | | |", "|---|---|---|---|", *rows])


def _driving(path: Motion) -> dict[str, str]:
    """What drives or slows the top; then angles, period and rates are those at the event."""
    if not path.driven:
        return {}
    friction, torque = path.friction, " ".join(f"{part:g}" for part in path.applied_torque)
    return {
        "friction axial, transverse": f"{friction.axial:g}, {friction.transverse:g} N m s",
        "applied torque": f"{torque} N m",
    }


def _number(value: float, unit: str) -> str:
    return f"{value:.5g} {unit}" if math.isfinite(value) else "none"
