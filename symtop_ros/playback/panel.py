"""The panel below the 3D scene: the motion in a Markdown table."""

import math
from collections.abc import Mapping

from symtop_ros.physics import Motion, State, perrys_rule
from symtop_ros.simulation.segment import Segment


def describe_motion(
    segment: Segment, state: State, scales: dict[str, str], equations: Mapping[str, str]
) -> str:
    """Return the table for the segment that begins with an event."""
    motion = segment.motion
    top = motion.top
    low, high = motion.turning_angles
    rates = ", ".join(f"{rate:.4g}" for rate in perrys_rule(top, state).regular_rates) or "no"
    facts = {
        "motion": f"{motion.kind}, {f'speed {segment.factor:g}' if segment.running else 'paused'}",
        "theta": f"{low:.4f} .. {high:.4f} rad",
        "nutation": f"{_number(motion.nutation_period, 's')}, "
        f"{_number(motion.nutation_rate, 'rad/s')} "
        f"(p_psi/Ix: {_number(motion.fast_top_nutation_rate)})",
        "mean precession": f"{_number(motion.mean_precession_rate, 'rad/s')} "
        f"(Mgl/p_psi: {_number(motion.fast_top_precession_rate)})",
        "in a nutation": f"{_number(motion.precession_per_nutation, 'turns')}"
        + (", psi' changes sign" if motion.spin_reverses else ""),
        "regular precession": f"{rates} rad/s",
        "Ix, Iz; Mgl": f"{top.Ix:g}, {top.Iz:g} kg m\u00b2; {top.Mgl:g} J",
        **_added_torques(motion),
    }
    if scales:
        facts[f"1 unit of {', '.join(scales)}"] = ", ".join(scales.values())
    rows = [f"| {name} | **{value}** |" for name, value in {**facts, **equations}.items()]
    return "\n".join(["| | |", "|---|---|", *rows])


def _added_torques(motion: Motion) -> dict[str, str]:
    """Return friction and applied torque; angles, period and rates then hold at the event only."""
    if not motion.is_driven:
        return {}
    friction = motion.friction
    torque = " ".join(f"{part:g}" for part in motion.applied_torque)
    return {
        "friction axial, transverse": f"{friction.axial:g}, {friction.transverse:g} N m s",
        "applied torque": f"{torque} N m",
    }


def _number(value: float, unit: str = "") -> str:
    return f"{value:.5g} {unit}".rstrip() if math.isfinite(value) else "-"
