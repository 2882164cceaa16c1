"""What /diagnostics and ~/get_state say about a run: the motion in numbers and in words."""

from __future__ import annotations

import math
from typing import Any

from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus, KeyValue

from symtop_ros.node.messages import header
from symtop_ros.node.ticker import Ticker
from symtop_ros.physics import Motion, State, Top, perry
from symtop_ros.recording.recorder import Recorder
from symtop_ros.run.segment import Segment


def state_report(segment: Segment, stamp: int) -> dict[str, Any]:
    """Return the full state, the constants and the verdict, ready for JSON."""
    state, path = segment.state_at(stamp), segment.path
    top = path.top
    verdict = perry(top, state)
    w, x, y, z = state.orientation.tolist()
    return {
        "stamp": stamp * 1e-9,
        "time": segment.time_at(stamp),
        "running": segment.running,
        "top": {"Ix": top.Ix, "Iz": top.Iz, "Mgl": top.Mgl},
        "orientation": {"x": x, "y": y, "z": z, "w": w},
        "angular_velocity_body": state.angular_velocity.tolist(),
        "angular_velocity": state.to_world(state.angular_velocity).tolist(),
        "angular_momentum": top.angular_momentum(state).tolist(),
        "torque": top.torque(state).tolist(),
        "euler_angles": state.euler_angles._asdict(),
        "euler_rates": state.euler_rates._asdict(),
        "constants": constants(top, state),
        **_motion(path),
        "regular_precession_rates": list(verdict.regular_rates),
        "verdict": str(verdict),
        "perrys_rule_holds": verdict.rule_holds,
    }


def constants(top: Top, state: State) -> dict[str, float]:
    """Constants of motion, SI."""
    return {
        "energy": float(top.energy(state)),
        "L_z": float(top.axial_momentum(state)),
        "L_z'": float(top.vertical_momentum(state)),
    }


def _motion(path: Motion) -> dict[str, Any]:
    """Facts of the motion; what is infinite or undefined is null in JSON."""
    numbers = {
        "nutation_period": path.nutation_period,
        "mean_precession_rate": path.mean_precession_rate,
        "mean_spin_rate": path.mean_spin_rate,
    }
    known = {name: value if math.isfinite(value) else None for name, value in numbers.items()}
    return {
        "kind": path.kind,
        "engine": path.engine,
        "turning_angles": list(path.turning_angles),
        **known,
    }


def diagnostics(
    frame: str, segment: Segment, stamp: int, ticker: Ticker, recorder: Recorder
) -> DiagnosticArray:
    """Return the message for /diagnostics."""
    status = [_motion_status(segment, stamp), _pace(ticker), _log(recorder)]
    return DiagnosticArray(header=header(stamp, frame), status=status)


def _motion_status(segment: Segment, stamp: int) -> DiagnosticStatus:
    top = segment.path.top
    now = constants(top, segment.state_at(stamp))
    drift = {
        f"{name}.drift": value - constants(top, segment.path.start)[name]
        for name, value in now.items()
    }
    verdict = perry(top, segment.state_at(stamp))
    facts = {
        **now,
        **drift,
        **_motion(segment.path),
        "regular_precession_rates": list(verdict.regular_rates),
        "running": segment.running,
        "real_time_factor": segment.factor,
    }
    return _status("top: motion", DiagnosticStatus.OK, str(verdict), facts)


def _pace(ticker: Ticker) -> DiagnosticStatus:
    level = DiagnosticStatus.WARN if ticker.missed else DiagnosticStatus.OK
    message = f"{ticker.missed} ticks missed" if ticker.missed else "on time"
    return _status("top: pace", level, message, {"late": ticker.late, "missed": ticker.missed})


def _log(recorder: Recorder) -> DiagnosticStatus:
    facts = {"file": recorder.path or "", "dropped": recorder.dropped}
    if recorder.failure:
        return _status("top: log", DiagnosticStatus.ERROR, recorder.failure, facts)
    if recorder.dropped:
        message = f"{recorder.dropped} messages were too many for the disk"
        return _status("top: log", DiagnosticStatus.WARN, message, facts)
    message = "recording" if recorder.running else "not recording"
    return _status("top: log", DiagnosticStatus.OK, message, facts)


def _status(name: str, level: bytes, message: str, facts: dict[str, Any]) -> DiagnosticStatus:
    values = [KeyValue(key=key, value=_text(value)) for key, value in facts.items()]
    return DiagnosticStatus(level=level, name=name, message=message, values=values)


def _text(value: Any) -> str:
    if isinstance(value, list):
        return " ".join(map(repr, value))
    return str(value).lower() if isinstance(value, bool) else str(value)
