"""The current motion in numbers and words, as `~/get_state` and `/diagnostics` report it."""

import math
from typing import Any

from symtop_ros.physics import Motion, State, Top, perrys_rule
from symtop_ros.simulation.segment import Segment


def summarize_state(segment: Segment, stamp: int, since: str = "start") -> dict[str, Any]:
    """Return the state at a stamp (ns), the constants of motion and the verdict, ready for JSON.

    `since` names the event from which the time of the motion counts.
    """
    state, motion = segment.state_at(stamp), segment.motion
    top = motion.top
    verdict = perrys_rule(top, state)
    w, x, y, z = state.orientation.tolist()
    return {
        "stamp": stamp * 1e-9,
        "time": segment.time_at(stamp),
        "time_since": since,
        "running": segment.running,
        "top": {"Ix": top.Ix, "Iz": top.Iz, "Mgl": top.Mgl},
        "orientation": {"x": x, "y": y, "z": z, "w": w},
        "angular_velocity_body": state.angular_velocity.tolist(),
        "angular_velocity": state.to_world(state.angular_velocity).tolist(),
        "angular_momentum": top.angular_momentum(state).tolist(),
        "torque": motion.total_torque(state).tolist(),
        "euler_angles": state.euler_angles._asdict(),
        "euler_rates": state.euler_rates._asdict(),
        "constants": constants_of_motion(top, state),
        **summarize_motion(motion, state),
        "friction": {"axial": motion.friction.axial, "transverse": motion.friction.transverse},
        "applied_torque": list(motion.applied_torque),
        "regular_precession_rates": list(verdict.regular_rates),
        "verdict": str(verdict),
        "perrys_rule_holds": verdict.rule_holds,
    }


def constants_of_motion(top: Top, state: State) -> dict[str, float]:
    """Return energy (J) and the angular momenta about the axis and the vertical (N m s)."""
    return {
        "energy": float(top.energy(state)),
        "L_z": float(top.axial_momentum(state)),
        "L_z'": float(top.vertical_momentum(state)),
    }


def summarize_motion(motion: Motion, state: State) -> dict[str, Any]:
    """Return kind, turning angles, period and rates; None if infinite or undefined.

    The rates of the fast top are the approximations of textbooks, next to the exact ones.

    Under friction or an applied torque these change all the time. They are then given for the
    motion that would follow from `state` under gravity alone.
    """
    free = Motion(motion.top, state) if motion.is_driven else motion
    numbers = {
        "nutation_period": free.nutation_period,
        "mean_precession_rate": free.mean_precession_rate,
        "mean_spin_rate": free.mean_spin_rate,
        "precession_per_nutation": free.precession_per_nutation,
        "nutation_rate": free.nutation_rate,
        "fast_top_precession_rate": free.fast_top_precession_rate,
        "fast_top_nutation_rate": free.fast_top_nutation_rate,
    }
    finite = {name: value if math.isfinite(value) else None for name, value in numbers.items()}
    return {
        "kind": free.kind,
        "engine": motion.engine,
        "turning_angles": list(free.turning_angles),
        "spin_reverses": free.spin_reverses,
        **finite,
    }
