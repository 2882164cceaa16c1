"""What /diagnostics and ~/get_state say about a run: the motion in numbers and in words."""

from __future__ import annotations

import math
from typing import Any

from symtop_ros.node.namesakes import Namesakes
from symtop_ros.node.parameters import Settings
from symtop_ros.node.ticker import Ticker
from symtop_ros.physics import Motion, State, Top, balance, motion, perry
from symtop_ros.recording.recorder import Recorder
from symtop_ros.run.segment import Segment
from symtop_ros.wire.diagnostics import ERROR, OK, WARN, Status

SHORTEST = 1e-3  # s of motion that the balances are taken over, at its very start


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
        "torque": path.torque(state).tolist(),
        "euler_angles": state.euler_angles._asdict(),
        "euler_rates": state.euler_rates._asdict(),
        "constants": constants(top, state),
        **_motion(path, state),
        "friction": {"axial": path.friction.axial, "transverse": path.friction.transverse},
        "applied_torque": list(path.applied_torque),
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


def _motion(path: Motion, state: State) -> dict[str, Any]:
    """Facts of the motion; what is infinite or undefined is null in JSON.

    Friction and applied torques change them from one moment to the next: then they are those of
    the motion that would go on from here without.
    """
    free = motion(path.top, state) if path.driven else path
    numbers = {
        "nutation_period": free.nutation_period,
        "mean_precession_rate": free.mean_precession_rate,
        "mean_spin_rate": free.mean_spin_rate,
    }
    known = {name: value if math.isfinite(value) else None for name, value in numbers.items()}
    return {
        "kind": free.kind,
        "engine": path.engine,
        "turning_angles": list(free.turning_angles),
        **known,
    }


def diagnostics(
    settings: Settings,
    segment: Segment,
    stamp: int,
    ticker: Ticker,
    recorder: Recorder,
    namesakes: Namesakes,
) -> list[Status]:
    """Return the statuses for /diagnostics."""
    found = [
        _motion_status(segment, stamp),
        _pace(segment, settings["real_time_factor"], ticker),
        _log(recorder),
        _balance(segment, stamp),
        _name(namesakes),
    ]
    return [each._replace(stamp=stamp) for each in found]


def _motion_status(segment: Segment, stamp: int) -> Status:
    path, state = segment.path, segment.state_at(stamp)
    now, start = constants(path.top, state), constants(path.top, path.start)
    verdict = perry(path.top, state)
    facts = {
        **now,
        **{f"{name}.drift": value - start[name] for name, value in now.items()},
        **_motion(path, state),
        "regular_precession_rates": list(verdict.regular_rates),
        "running": segment.running,
    }
    return _status("top: motion", OK, str(verdict), facts)


def _balance(segment: Segment, stamp: int) -> Status:
    """What friction and torque do, and how well dE/dt and dL/dt are what they make them."""
    path, state = segment.path, segment.state_at(stamp)
    t = segment.time_at(stamp)
    found = balance(path, t, longest=max(abs(t), SHORTEST))
    driving = path.driving_torque(state)
    facts = {
        "friction.axial": path.friction.axial,
        "friction.transverse": path.friction.transverse,
        "applied_torque": list(path.applied_torque),
        "power": float(driving @ state.to_world(state.angular_velocity)),
        "energy.balance": found.energy,
        "angular_momentum.balance": found.angular_momentum.tolist(),
    }
    message = "friction or an applied torque acts" if path.driven else "gravity alone acts"
    return _status("top: balance", OK, message, facts)


def _pace(segment: Segment, asked: float, ticker: Ticker) -> Status:
    achieved = segment.factor if segment.running else 0.0
    facts = {
        "late": ticker.late,
        "missed": ticker.missed,
        "real_time_factor": asked,
        "real_time_factor.achieved": achieved,
    }
    if segment.factor < asked:
        message = f"the engine keeps up with {segment.factor:.3g} of real time, not {asked:.3g}"
    elif ticker.missed:
        message = f"{ticker.missed} ticks missed"
    else:
        return _status("top: pace", OK, "on time", facts)
    return _status("top: pace", WARN, message, facts)


def _log(recorder: Recorder) -> Status:
    facts = {"file": recorder.path or "", "dropped": recorder.dropped}
    if recorder.failure:
        return _status("top: log", ERROR, recorder.failure, facts)
    if recorder.dropped:
        message = f"{recorder.dropped} messages were too many for the disk"
        return _status("top: log", WARN, message, facts)
    message = "recording" if recorder.running else "not recording"
    return _status("top: log", OK, message, facts)


def _name(namesakes: Namesakes) -> Status:
    facts = {"name": namesakes.name, "others": namesakes.count}
    return _status("top: name", WARN if namesakes.count else OK, namesakes.sentence, facts)


def _status(name: str, level: int, message: str, facts: dict[str, Any]) -> Status:
    return Status(0, level, name, message, {key: _text(value) for key, value in facts.items()})


def _text(value: Any) -> str:
    if isinstance(value, list):
        return " ".join(map(repr, value))
    return str(value).lower() if isinstance(value, bool) else str(value)
