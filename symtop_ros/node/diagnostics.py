"""The statuses of /diagnostics: the motion, its pace, the log, balances and duplicate nodes."""

from __future__ import annotations

from typing import Any

from rclpy.node import Node

from symtop_ros.log.recorder import Recorder
from symtop_ros.physics import balance, perrys_rule
from symtop_ros.simulation.segment import Segment
from symtop_ros.simulation.simulation import Simulation
from symtop_ros.simulation.summary import constants_of_motion, summarize_motion
from symtop_ros.simulation.ticker import Ticker
from symtop_ros.wire.diagnostics import ERROR, OK, WARN, Status

MIN_BALANCE = 1e-3  # s of the motion over which balances are taken at its very start


class DuplicateNodes:
    """Counts the other nodes that have the name of this node."""

    def __init__(self, node: Node) -> None:
        self._node, self.name, self.count = node, node.get_fully_qualified_name(), 0

    def update(self) -> None:
        """Count them, and report once when they appear and when they are gone."""
        names = self._node.get_fully_qualified_node_names()
        before, self.count = self.count, max(0, names.count(self.name) - 1)
        if self.count and not before:
            self._node.get_logger().warning(self.sentence)
        elif before and not self.count:
            self._node.get_logger().info(self.sentence)

    @property
    def sentence(self) -> str:
        """Description of the duplicates, and what to do about them."""
        if not self.count:
            return f"no other node has the name {self.name}"
        others = "another node has" if self.count == 1 else f"{self.count} other nodes have"
        return (
            f"{others} the name {self.name}, and a request reaches any of them: rename this one "
            "with --ros-args -r __node:=NAME or -r __ns:=/NAME (a killed node is listed for 20 s)"
        )


def collect_statuses(
    simulation: Simulation, recorder: Recorder, duplicates: DuplicateNodes
) -> list[Status]:
    """Return the statuses of a simulation at its next stamp."""
    segment, stamp = simulation.segment, simulation.stamp
    statuses = [
        _motion_status(segment, stamp),
        _pace_status(segment, simulation.settings.real_time_factor, simulation.ticker),
        _log_status(recorder),
        _balance_status(segment, stamp),
        _name_status(duplicates),
    ]
    return [status._replace(stamp=stamp) for status in statuses]


def _motion_status(segment: Segment, stamp: int) -> Status:
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
    return _status("top: motion", OK, str(verdict), facts)


def _balance_status(segment: Segment, stamp: int) -> Status:
    """Return how exactly energy and angular momentum change by what acts on the top."""
    motion, state = segment.motion, segment.state_at(stamp)
    t = segment.time_at(stamp)
    found = balance(motion, t, longest=max(abs(t), MIN_BALANCE))
    added = motion.added_torque(state)
    facts = {
        "friction.axial": motion.friction.axial,
        "friction.transverse": motion.friction.transverse,
        "applied_torque": list(motion.applied_torque),
        "power": float(added @ state.to_world(state.angular_velocity)),
        "energy.balance": found.energy,
        "angular_momentum.balance": found.angular_momentum.tolist(),
    }
    integrated = motion.is_driven
    message = "friction or an applied torque acts" if integrated else "only gravity acts"
    return _status("top: balance", OK, message, facts)


def _pace_status(segment: Segment, asked: float, ticker: Ticker) -> Status:
    achieved = segment.factor if segment.running else 0.0
    facts = {
        "late": ticker.late,
        "missed": ticker.missed,
        "real_time_factor": asked,
        "real_time_factor.achieved": achieved,
    }
    if segment.factor < asked:
        message = (
            f"the motion is too fast for the compute budget: real-time factor {segment.factor:.3g} "
            f"instead of {asked:.3g}"
        )
    elif ticker.missed:
        message = f"{ticker.missed} ticks missed"
    else:
        return _status("top: pace", OK, "on time", facts)
    return _status("top: pace", WARN, message, facts)


def _log_status(recorder: Recorder) -> Status:
    facts = {"file": recorder.path or "", "dropped": recorder.dropped}
    if recorder.failure:
        return _status("top: log", ERROR, recorder.failure, facts)
    if recorder.dropped:
        message = f"{recorder.dropped} messages dropped: the disk is too slow"
        return _status("top: log", WARN, message, facts)
    message = "recording" if recorder.running else "not recording"
    return _status("top: log", OK, message, facts)


def _name_status(duplicates: DuplicateNodes) -> Status:
    facts = {"name": duplicates.name, "others": duplicates.count}
    return _status("top: name", WARN if duplicates.count else OK, duplicates.sentence, facts)


def _status(name: str, level: int, message: str, facts: dict[str, Any]) -> Status:
    return Status(0, level, name, message, {key: _text(value) for key, value in facts.items()})


def _text(value: Any) -> str:
    if isinstance(value, list):
        return " ".join(map(repr, value))
    return str(value).lower() if isinstance(value, bool) else str(value)
