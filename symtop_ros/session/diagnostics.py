"""The statuses of /diagnostics: the motion, its pace, the log and balances."""

from typing import Any

from symtop_ros.log.recorder import Recorder
from symtop_ros.physics import balance, describe_engine, perrys_rule
from symtop_ros.session.summary import constants_of_motion, summarize_motion
from symtop_ros.simulation.block import CATCH_UP
from symtop_ros.simulation.segment import Segment
from symtop_ros.simulation.simulation import Simulation
from symtop_ros.wire.diagnostics import ERROR, OK, WARN, Status

MIN_BALANCE = 1e-3  # s of the motion over which balances are taken at its very start


def collect_statuses(simulation: Simulation, recorder: Recorder) -> list[Status]:
    """Return the statuses of a simulation at its next stamp."""
    segment, stamp = simulation.segment, simulation.stamp
    return [
        motion_status(segment, stamp),
        _pace_status(simulation),
        _log_status(recorder),
        balance_status(segment, stamp),
    ]


def motion_status(segment: Segment, stamp: int) -> Status:
    """Return the state of the motion in numbers and words."""
    motion, state = segment.motion, segment.state_at(stamp)
    now = constants_of_motion(motion.top, state)
    start = constants_of_motion(motion.top, motion.start)
    verdict = perrys_rule(motion.top, state)
    facts = {
        **now,
        **{f"{name}.drift": value - start[name] for name, value in now.items()},
        **summarize_motion(motion, state),
        "regular_precession_rates": list(verdict.regular_rates),
        "running": segment.running,
    }
    return make_status("motion", OK, str(verdict), facts)


def balance_status(segment: Segment, stamp: int) -> Status:
    """Return how exactly energy and angular momentum change by what acts on the top."""
    motion, state = segment.motion, segment.state_at(stamp)
    t = segment.time_at(stamp)
    found = balance(motion, t, longest=max(abs(t), MIN_BALANCE))
    added = motion.added_torque(state)
    facts = {
        "friction.axial": motion.friction.axial,
        "friction.transverse": motion.friction.transverse,
        "applied_torque": list(motion.applied_torque),
        "power": float((added * state.to_world(state.angular_velocity)).sum()),
        "energy.balance": found.energy,
        "angular_momentum.balance": found.angular_momentum.tolist(),
    }
    message = "friction or an applied torque acts" if motion.is_driven else "only gravity acts"
    return make_status("balance", OK, message, facts)


def _pace_status(simulation: Simulation) -> Status:
    asked, kept, ticker = simulation.settings.real_time_factor, simulation.factor, simulation.ticker
    achieved = kept if simulation.segment.running else 0.0
    facts = {
        "late": ticker.late,
        "missed": ticker.missed,
        "real_time_factor": asked,
        "real_time_factor.achieved": achieved,
        "states_computed_by": describe_engine(),
    }
    if kept < asked:
        message = (
            f"the motion is too fast for the compute budget: real-time factor {kept:.3g} "
            f"instead of {asked:.3g}"
        )
    elif ticker.missed:
        message = f"{ticker.missed} ticks missed"
        if ticker.missed < CATCH_UP * ticker.rate:
            return make_status("pace", OK, message, facts)
    else:
        return make_status("pace", OK, "on time", facts)
    return make_status("pace", WARN, message, facts)


def _log_status(recorder: Recorder) -> Status:
    facts = {"file": recorder.path or "", "dropped": recorder.dropped}
    if recorder.failure:
        return make_status("log", ERROR, recorder.failure, facts)
    if recorder.dropped:
        message = f"{recorder.dropped} messages dropped: the disk is too slow"
        return make_status("log", WARN, message, facts)
    message = "recording" if recorder.running else "not recording"
    return make_status("log", OK, message, facts)


def make_status(name: str, level: int, message: str, facts: dict[str, Any]) -> Status:
    """Return a status of which the facts are written as text."""
    return Status(0, level, name, message, {key: _text(value) for key, value in facts.items()})


def _text(value: Any) -> str:
    if isinstance(value, list):
        return " ".join(map(repr, value))
    return str(value).lower() if isinstance(value, bool) else str(value)
