"""The motion in numbers and words, for `~/get_state`, and the statuses of `/diagnostics`."""

import math
from collections.abc import Iterable
from dataclasses import asdict
from typing import Any

from symtop_ros.base.counts import write_count
from symtop_ros.base.refusals import RefusedError
from symtop_ros.physics import (
    Angles,
    Ledger,
    Motion,
    State,
    Top,
    Verdict,
    balance,
    clamp_verdict,
    find_period,
    kernel_version,
    perrys_rule,
)
from symtop_ros.run.log.recorder import Recorder
from symtop_ros.run.simulation.block import GAP
from symtop_ros.run.simulation.changes.outcomes import Failure, Neglected
from symtop_ros.run.simulation.segment import Segment
from symtop_ros.run.simulation.simulation import Simulation
from symtop_ros.run.wire.diagnostics import ERROR, OK, WARN, Status, write_text
from symtop_ros.run.wire.layout import NANOSECONDS
from symtop_ros.words import write

MIN_BALANCE = 1e-3  # s of the motion over which balances are taken at its very start


def collect_statuses(simulation: Simulation, recorder: Recorder) -> list[Status]:
    """Return the statuses of a simulation at its next stamp."""
    return [
        motion_status(simulation.segment, simulation.stamp, simulation.event_number),
        pace_status(simulation),
        log_status(recorder),
        balance_status(simulation.segment, simulation.stamp),
    ]


def motion_status(segment: Segment, stamp: int, event: int) -> Status:
    """Return the state of the motion in numbers and words, and the number of the latest event.

    From a log in which messages are lost the number says whether an event is among them.
    """
    segment = segment.without_pushes(stamp)
    motion = segment.motion
    state = segment.state_at(stamp)
    now = constants_of_motion(motion.top, state)
    start = constants_of_motion(motion.top, motion.start)
    verdict = perrys_rule(motion.top, state)
    return make_status(
        "motion",
        OK,
        _say(motion, verdict),
        {
            **now,
            **{f"{name}.drift": value - start[name] for name, value in now.items()},
            **summarize_motion(motion, state),
            "regular_precession_rates": _list_rates(verdict),
            "running": segment.running,
            "event": event,
        },
    )


def failure_status(failure: Failure, event: int) -> Status:
    """Return why the motion has ended, and the number of the latest event."""
    return make_status("motion", ERROR, str(failure), {"running": False, "event": event})


def balance_status(segment: Segment, stamp: int) -> Status:
    """Return how exactly energy and angular momentum change by what acts on the top."""
    segment = segment.without_pushes(stamp)
    motion = segment.motion
    state = segment.state_at(stamp)
    t = segment.time_at(stamp)
    found = balance(motion, t, longest=max(abs(t), MIN_BALANCE))
    added = motion.added_torque(state)
    return make_status(
        "balance",
        OK,
        _name_forces(motion),
        {
            **{f"friction.{name}": each for name, each in asdict(motion.friction).items()},
            "applied_torque": list(motion.applied_torque),
            "power": float((added * state.to_world(state.angular_velocity)).sum()),
            "energy.balance": found.energy,
            "angular_momentum.balance": found.angular_momentum.tolist(),
        },
    )


def _say(motion: Motion, verdict: Verdict) -> str:
    """Return what follows from the present state, or from the clamp that holds the motion."""
    if motion.clamped:
        return str(clamp_verdict(motion.top, motion.start))
    neglected = Neglected.of(motion)
    said = {"neglected": neglected, "verdict": verdict, "decay": None}  # that is said of a start
    return write("driven", said) if neglected else str(verdict)


def _name_forces(motion: Motion) -> str:
    if motion.clamped:
        return "a hand holds the precession: L_z' is not constant"
    return "friction or an applied torque acts" if motion.is_driven else "only gravity acts"


def pace_status(simulation: Simulation) -> Status:
    """Return whether the samples come in time, and how fast the motion is."""
    asked = simulation.settings.real_time_factor
    kept = simulation.factor
    ticker, waits = simulation.ticker, simulation.waits
    is_slow = kept < asked or waits.latest >= GAP
    level = WARN if is_slow or ticker.missed >= GAP * ticker.rate else OK
    missed = simulation.gaps.whole
    message = f"{missed} since the start of the run" if missed.samples else "on time"
    if is_slow:
        reason = "the motion is too fast for the compute budget"
        if lack := simulation.lack:
            reason = f"the motion lacks CPU time: got {lack.got:.2g} % CPU, needs "
            reason += f"{lack.needed:.2g} % (one core)"
        if kept >= asked:
            reason = f"/clock waited {waits.latest:.3g} s for late samples"
        reached = kept * (1 - waits.share)
        message = f"{reason}: real-time factor {reached:.3g} instead of {asked:.3g}"
    return make_status(
        "pace",
        level,
        message,
        {
            "late": ticker.late,
            "missed": ticker.missed,
            "gaps": missed.gaps,
            "longest_gap": missed.longest,
            "waited": waits.total,
            "real_time_factor": asked,
            "real_time_factor.achieved": simulation.achieved,
            "kernel_version": kernel_version(),
        },
    )


def log_status(recorder: Recorder) -> Status:
    """Return whether the recording, if there is one, is complete."""
    level, message = OK, "recording" if recorder.running else "not recording"
    if recorder.failure:
        level, message = ERROR, recorder.failure
    elif recorder.dropped:
        dropped = write_count(recorder.dropped, "message")
        level, message = WARN, f"{dropped} dropped: the disk is too slow"
    return make_status(
        "log", level, message, {"file": recorder.path or "", "dropped": recorder.dropped}
    )


def make_status(name: str, level: int, message: str, facts: dict[str, Any]) -> Status:
    """Return a status of which the facts are written as text."""
    return Status(0, level, name, message, {key: write_text(value) for key, value in facts.items()})


def summarize_state(segment: Segment, stamp: int, since: str = "start") -> dict[str, Any]:
    """Return the state at a stamp (ns), the constants of motion and the verdict, ready for JSON.

    `since` names the event from which the time of the motion counts.
    """
    state = segment.state_at(stamp)
    motion = segment.without_pushes(stamp).motion
    top = motion.top
    verdict = perrys_rule(top, state)
    rates = motion.euler_rates(state)
    w, x, y, z = state.orientation.tolist()
    return {
        "stamp": stamp * 1e-9,  # a double: of a time since 1970 it is up to 128 ns off
        "sec": stamp // NANOSECONDS,
        "nanosec": stamp % NANOSECONDS,
        "time": segment.time_at(stamp),
        "time_since": since,
        "running": segment.running,
        "top": asdict(top),
        "orientation": {"x": x, "y": y, "z": z, "w": w},
        "angular_velocity_body": state.angular_velocity.tolist(),
        "angular_velocity": state.to_world(state.angular_velocity).tolist(),
        "angular_momentum": top.angular_momentum(state).tolist(),
        "torque": motion.total_torque(state).tolist(),
        "euler_angles": state.euler_angles._asdict(),
        "euler_rates": dict(zip(Angles._fields, rates, strict=True)),
        "constants": constants_of_motion(top, state),
        **summarize_motion(motion, state),
        "friction": asdict(motion.friction),
        "applied_torque": list(motion.applied_torque),
        "regular_precession_rates": _list_rates(verdict),
        "regular_precession_periods": _keep(map(find_period, _list_rates(verdict))),
        "seen_from_above": _name_way(0.0 if motion.clamped else verdict.reason.before or 0.0),
        "critical_spin": _keep([float(top.critical_spin)])[0],
        **_describe_pivot(segment, motion, state),
        "clamped": motion.clamped,
        "exchange": _say_exchange(segment, stamp),
        "verdict": _say(motion, verdict),
        "why": "" if motion.is_driven or motion.clamped else str(verdict.cause),
        "perrys_rule_holds": None if motion.clamped else verdict.rule_holds,
    }


def _name_way(phi_dot: float) -> str:
    """Return the direction of the precession as seen from above; empty without precession."""
    if phi_dot == 0:
        return ""
    return "counterclockwise" if phi_dot > 0 else "clockwise"


def _say_exchange(segment: Segment, stamp: int) -> str:
    """Return what gave energy and momentum since the motion began; empty under a drive."""
    motion = segment.motion
    is_integrated = bool(motion.friction) or any(motion.applied_torque)
    if is_integrated:
        return ""
    try:
        return str(Ledger.from_times(motion, 0.0, segment.time_at(stamp)))
    except RefusedError:  # the other facts of the state are answered without it
        return ""


def _describe_pivot(segment: Segment, motion: Motion, state: State) -> dict[str, Any]:
    """Return the force of the pivot on the top (world, N), and the mass (kg) that it is for.

    The mass is the parameter `mass`, or else that of the body that is chosen for the top; None if
    no body is such a top.
    """
    body = segment.rig.find_body(motion.top)
    force = body.pivot_force(motion, state).tolist() if body else [math.nan]
    is_known = body is not None and all(map(math.isfinite, force))
    return {
        "pivot_force": force if is_known else None,
        "pivot_force_of_mass": body.mass if body and is_known else None,
        "mass_is_assumed": not segment.rig.mass,
        "gravity": segment.rig.gravity,
    }


def _list_rates(verdict: Verdict) -> list[float]:
    """Return the rates of regular precession that there are, the slow one first."""
    return [rate for rate in verdict.regular_rates if not math.isnan(rate)]


def _keep(numbers: Iterable[float]) -> list[float | None]:
    """Return numbers that JSON has: None if infinite or undefined."""
    return [number if math.isfinite(number) else None for number in numbers]


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
        "precession_period": free.precession_period,
        "rounding_shows_at": free.rounding_shows_at,
        "mean_spin_rate": free.mean_spin_rate,
        "precession_per_nutation": free.precession_per_nutation,
        "nutation_rate": free.nutation_rate,
        "fast_top_precession_rate": free.fast_top_precession_rate,
        "fast_top_nutation_rate": free.fast_top_nutation_rate,
    }
    return {
        "kind": free.kind,
        "engine": motion.engine,
        "turning_angles": list(free.turning_angles),
        "spin_reverses": free.spin_reverses,
        **{name: value if math.isfinite(value) else None for name, value in numbers.items()},
    }
