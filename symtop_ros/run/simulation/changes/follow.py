"""The rule by which an act changes a motion, the same in a running node and in a check of a log.

An `Act` is what is done, and a `Change` what it led to; an event reports the change. A running node
follows what it is asked. A check follows what the events of a log say was asked, and
compares. Nothing here has a clock, a lock or a side effect.
"""

from collections.abc import Callable, Mapping
from dataclasses import astuple, dataclass, replace
from functools import partial
from typing import Any

from symtop_ros.base.refusals import Words, refuse, show
from symtop_ros.physics import KickVerdict, State, clamp_verdict, kick_verdict
from symtop_ros.run.simulation.changes.obstacles import FRICTIONS, demand_free, demand_held_start
from symtop_ros.run.simulation.changes.outcomes import (
    ClockJump,
    Outcome,
    Parameters,
    Pause,
    Pushed,
    Setting,
    Start,
    Step,
    Torque,
)
from symtop_ros.run.simulation.changes.requests import (
    plan_clamp,
    plan_kick,
    plan_pushes,
    plan_release,
    plan_unclamp,
)
from symtop_ros.run.simulation.changes.seen import Solved
from symtop_ros.run.simulation.segment import Segment
from symtop_ros.run.simulation.settings import list_body, read_body
from symtop_ros.run.wire.diagnostics import write_text

Request = Mapping[str, Any]
DAY = 86400.0  # s


@dataclass(frozen=True, slots=True)
class Act:
    """A change of a run at a stamp: the request, and what the program decided itself."""

    name: str  # of the event that reports it
    stamp: int  # ns, from which on it holds
    request: Request
    start: State | None = None  # of a restart: initial conditions may come from parameters
    factor: float | None = None  # real-time factor, which the clock has with publish_clock
    told: Outcome | None = None  # where no motion shows the outcome, as the path of a log
    left: Segment | None = None  # the segment that a failed action has left
    clamped: bool = False  # of a restart: whether a hand holds its precession
    solved: Solved | None = None  # of a restart from what is seen


@dataclass(frozen=True, slots=True)
class Change:
    """An act and what it led to: all that its event reports of the motion."""

    act: Act
    before: State  # right before the act
    segment: Segment  # that holds from the act on
    told: "Told" = None
    pushes: int | None = None  # that the motion before the act has got, if it was pushed

    @classmethod
    def begin(cls, segment: Segment, request: Request | None = None) -> "Change":
        """Return the change with which a run begins, by the first segment of its motion."""
        act = Act("start", segment.stamp, request or {})
        return cls(act, segment.state_at(act.stamp), segment, Start.of(segment.motion))

    @property
    def outcome(self) -> Outcome | None:
        """Return what is said of it; of a kick it is found now, after the first sample is sent."""
        return self.told() if isinstance(self.told, partial) else self.told


def follow(segment: Segment, act: Act, before: State | None = None) -> Change:
    """Return the change by an act on the motion of a segment.

    `before` is the state right before the act, where it is known.

    Raises
    ------
    ValueError
        If no program grants the request; RefusedError with the reason for a user.
    """
    before = before or state_before(segment, act)
    pushes = segment.count_pushes(_find_stamp(act))
    following, told = RULES[act.name](segment, act, before)
    return Change(act, before, following, told, pushes)


def state_before(segment: Segment, act: Act) -> State:
    """Return the state right before an act: it takes work if the motion is driven."""
    if "reached" in act.request:  # a motion that was slowed down, or that could not continue
        return segment.motion.at(float(act.request["reached"]))
    return segment.state_at(_find_stamp(act))


def _find_stamp(act: Act) -> int:
    """Return the stamp of the segment before an act at which the act happens."""
    return int(act.request["from"]) if act.name == "clock" else act.stamp


def demand_a_day(segment: Segment) -> Segment:
    """Refuse a motion that is so fast that it has no states after a day of the clock."""
    left = (segment.motion.farthest_time - segment.begin_time) / segment.factor
    if left < DAY:
        condition = "so slow that it stays within 1e15 turns for a day at this real-time factor"
        raise refuse("motion", condition, Words(f"{show(left)} s"))
    return segment


Told = Outcome | partial[KickVerdict] | None  # what is said of an act, or what will find it
Ruled = tuple[Segment, Told]  # the segment that follows, and what is said of it


def _restart(segment: Segment, act: Act, before: State) -> Ruled:
    start = act.start or before
    if act.clamped:
        demand_held_start(start, segment.motion.friction, segment.motion.applied_torque)
    segment = demand_a_day(segment.change(act.stamp, start, clamped=act.clamped))
    return segment, Start.of(segment.motion, act.solved)


def _kick(segment: Segment, act: Act, before: State) -> Ruled:
    motion, hold = plan_kick(segment.motion, before, act.request)
    segment = demand_a_day(segment.replace_motion(motion, act.stamp))
    return segment, partial(kick_verdict, motion, before, hold)


def _push(segment: Segment, act: Act, before: State) -> Ruled:
    motion, pushes = plan_pushes(segment.motion, before, act.request)
    segment = demand_a_day(segment.replace_motion(motion, act.stamp))
    return segment, Pushed.of(motion, pushes, before)


def _release(segment: Segment, act: Act, _: State) -> Ruled:
    segment, pushes = plan_release(segment, act.stamp)
    return segment, Pushed.of_given(segment.motion, pushes)


def _clamp(segment: Segment, act: Act, before: State) -> Ruled:
    motion = plan_clamp(segment.motion, before)
    segment = demand_a_day(segment.replace_motion(motion, act.stamp))
    return segment, clamp_verdict(motion.top, before)


def _unclamp(segment: Segment, act: Act, before: State) -> Ruled:
    motion = plan_unclamp(segment.motion, before)
    segment = demand_a_day(segment.replace_motion(motion, act.stamp))
    return segment, Start.of(motion)


def _pause(segment: Segment, act: Act, _: State) -> Ruled:
    if "reached" in act.request:
        reached = float(act.request["reached"])
        segment = segment.slow_down(reached, segment.factor, act.stamp)
    segment = segment.pause(act.stamp)
    return segment, Pause(segment.begin_time)


def _resume(segment: Segment, act: Act, _: State) -> Ruled:
    segment = segment.resume(act.stamp)
    return segment, Pause(segment.begin_time)


def _step(segment: Segment, act: Act, _: State) -> Ruled:
    if "to" in act.request:  # the motion runs together with its clock
        segment = segment.resume(act.stamp)
        return segment, Step("stepped", float(segment.time_at(int(act.request["to"]))))
    if not act.request:
        return segment, Step("none")
    duration = float(act.request["duration"])
    segment = segment.step(duration, act.stamp)
    if segment.begin_time >= segment.motion.farthest_time:
        raise refuse("duration", "within 1e15 turns of the motion", duration)
    return segment, Step("stepped", segment.begin_time)


def _move_clock(segment: Segment, act: Act, _: State) -> Ruled:
    left = act.request["from"]
    return segment.move(left, act.stamp), ClockJump(left, act.stamp)


def _change_pace(segment: Segment, act: Act, _: State) -> Ruled:
    factor = segment.factor if act.factor is None else act.factor
    if "reached" in act.request:
        return segment.slow_down(float(act.request["reached"]), factor, act.stamp), act.told
    if factor != segment.factor:
        segment = segment.set_factor(factor, act.stamp)
    return segment, act.told


def _change_torque(segment: Segment, act: Act, before: State) -> Ruled:
    x, y, z = torque = act.request["torque"]
    if torque != segment.motion.applied_torque:
        is_steady = isinstance(act.told, Torque) and act.told.kind == "steady"
        demand_free(segment.motion, "steady_torque" if is_steady else "~/applied_torque")
        segment = segment.change(act.stamp, before, torque=torque)
    told = replace(act.told, torque=(x, y, z)) if isinstance(act.told, Torque) else None
    return segment, told


def _change_parameters(segment: Segment, act: Act, before: State) -> Ruled:
    request = act.request
    following = segment
    motion = segment.motion
    values = list_body(motion)
    body = read_body(values | {name: float(request[name]) for name in values if name in request})
    rig = replace(
        segment.rig,
        gravity=float(request.get("gravity", segment.rig.gravity)),
        mass=float(request.get("mass", segment.rig.mass)),
    )
    if body != (motion.top, motion.friction) or rig != segment.rig:
        for name, value in zip(FRICTIONS, astuple(body[1]), strict=True):
            if value:
                demand_free(motion, name)
        following = replace(following.change(act.stamp, before, *body), rig=rig)
    if "real_time_factor" in request and act.factor != segment.factor:
        following = following.set_factor(float(request["real_time_factor"]), act.stamp)
    if following is not segment:
        demand_a_day(following)
    imu = following.rig.imu
    if "publish_rate" in request and imu:
        rate = float(request["publish_rate"])
        following = replace(following, rig=replace(following.rig, imu=replace(imu, rate=rate)))
    changes = (Setting(name, write_text(value)) for name, value in request.items())
    return following, Parameters(tuple(changes))


def _report(segment: Segment, act: Act, _: State) -> Ruled:
    return act.left or segment, act.told


RULES: dict[str, Callable[[Segment, Act, State], Ruled]] = {
    "start": _restart,
    "reset": _restart,
    "kick": _kick,
    "push": _push,
    "release": _release,
    "clamp": _clamp,
    "unclamp": _unclamp,
    "pause": _pause,
    "resume": _resume,
    "step": _step,
    "clock": _move_clock,
    "pace": _change_pace,
    "torque": _change_torque,
    "parameters": _change_parameters,
    "record": _report,
    "failure": _report,
}
