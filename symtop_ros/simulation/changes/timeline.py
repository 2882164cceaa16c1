"""The timeline of a run: what holds at a stamp, and what each command makes of it.

A command gives a `Change`: the timeline that follows, and the event that reports it. Nothing here
has a clock, a lock or a side effect; `simulation` decides at which stamp a change takes effect.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial
from typing import Any, Literal

from symtop_ros.arrays import Vector
from symtop_ros.physics import State, kick_verdict
from symtop_ros.simulation.budget import Shortfall
from symtop_ros.simulation.changes.initial import initial_state, start_motion
from symtop_ros.simulation.changes.kick import plan_kick
from symtop_ros.simulation.changes.outcomes import (
    ClockJump,
    Outcome,
    Pace,
    Parameters,
    Pause,
    Setting,
    Start,
    Step,
    Torque,
)
from symtop_ros.simulation.events import Event
from symtop_ros.simulation.segment import Segment
from symtop_ros.simulation.settings import MAX_MOMENT, NO_TORQUE, Settings
from symtop_ros.simulation.validation import reject, vector
from symtop_ros.wire.layout import NANOSECONDS

Request = Mapping[str, Any]
DAY = 86400.0  # s


@dataclass(frozen=True)
class Timeline:
    """A run from one change to the next."""

    settings: Settings
    segment: Segment  # the motion from the last change on
    start: State  # the last initial conditions
    since: str  # the event with which the motion of the segment began, and its stamp
    switched_on: int  # stamp in ns at which the biases of the sensor are zero
    held_torque: Vector = NO_TORQUE  # from ~/applied_torque
    torque_end: int = 0  # stamp in ns at which the held torque ends

    @classmethod
    def begin(cls, settings: Settings, stamp: int) -> "Timeline":
        """Return the timeline that starts at a stamp (ns) from the initial conditions."""
        motion = start_motion(settings)
        rig = settings.rig(stamp)
        # With publish_clock the clock has this factor.
        factor = 1.0 if settings.publish_clock else settings.real_time_factor
        segment = _demand_a_day(Segment.begin(motion, stamp, factor, rig))
        return cls(settings, segment, motion.start, _describe_origin("start", stamp), stamp)

    @property
    def verdict(self) -> Start:
        """Kind of the motion and what follows from its start."""
        return Start.of(self.segment.motion)

    def report(self, name: str, outcome: Outcome, request: Request, stamp: int) -> "Change":
        """Return a change of nothing: an event that only reports."""
        return self._follow(name, stamp, request, outcome)

    def restart(self, stamp: int, values: Request | None = None) -> "Change":
        """Restart from named initial conditions, or without them from the last ones."""
        start, name = self.start, "reset"
        if values is not None:
            start = initial_state(self.settings.top, self.settings.initial, values)
            name = "start"
        segment = _demand_a_day(self.segment.restart(start, stamp))
        verdict = partial(Start.of, segment.motion)
        return self._follow(name, stamp, values or {}, verdict, start=start, segment=segment)

    def kick(self, stamp: int, values: Request) -> "Change":
        """Kick by named values; see `plan_kick`."""
        before = self.segment.state_at(stamp)
        motion, hold = plan_kick(self.segment.motion, before, values)
        segment = _demand_a_day(self.segment.replace_motion(motion, stamp))
        verdict = partial(kick_verdict, motion, before, hold)
        return self._follow("kick", stamp, values, verdict, before, segment=segment)

    def pause(self, stamp: int, paused: bool) -> "Change":
        """Stop the motion, or continue it from where it stopped."""
        name = "pause" if paused else "resume"
        segment = (self.segment.pause if paused else self.segment.resume)(stamp)
        return self._follow(name, stamp, {}, Pause(segment.begin_time), segment=segment)

    def stop(self, stamp: int, reached: float) -> "Change":
        """Pause a motion that cannot continue, at the time in s that it has reached."""
        segment = self.segment.slow_down(reached, self.segment.factor, stamp).pause(stamp)
        outcome = Pause(segment.begin_time)
        before, request = segment.state_at(stamp), {"reached": reached}
        return self._follow("pause", stamp, request, outcome, before, segment=segment)

    def step(self, stamp: int, duration: float) -> "Change":
        """Advance a paused motion by a duration in s."""
        segment = self.segment.step(duration, stamp)
        if segment.begin_time >= segment.motion.farthest_time:
            raise reject("duration", "within 1e15 turns of the motion", duration)
        outcome = Step("stepped", segment.begin_time)
        return self._follow("step", stamp, {"duration": duration}, outcome, segment=segment)

    def step_clock(self, stamp: int, now: int) -> "Change":
        """Let a paused motion run together with its clock, to the stamp `now`."""
        segment = self.segment.resume(stamp)
        outcome = Step("stepped", segment.time_at(now))
        return self._follow("step", stamp, {"to": now}, outcome, segment=segment)

    def move(self, stamp: int, now: int) -> "Change":
        """Continue the state of a stamp at the time (ns) to which the clock jumped."""
        return self._follow(
            "clock",
            now,
            {"from": stamp, "to": now},
            ClockJump(stamp, now),
            self.segment.state_at(stamp),
            segment=self.segment.move(stamp, now),
            torque_end=self.torque_end + now - stamp,
        )

    def slow_down(self, stamp: int, shortfall: Shortfall) -> "Change":
        """Continue at a real-time factor that can be kept, from the time that was reached."""
        segment = self.segment.slow_down(shortfall.reached, shortfall.factor, stamp)
        outcome = Pace("slowed", self.segment.factor, shortfall.factor)
        before, request = segment.motion.at(shortfall.reached), {"reached": shortfall.reached}
        return self._follow("pace", stamp, request, outcome, before, segment=segment)

    def set_pace(self, stamp: int, current: float, factor: float) -> "Change":
        """Continue at another real-time factor than the current one."""
        outcome = Pace("slowed" if factor < current else "changed", current, factor)
        segment = self.segment
        if not self.settings.publish_clock:  # else the clock has this factor
            segment = segment.set_factor(factor, stamp)
        return self._follow("pace", stamp, {}, outcome, segment=segment)

    def hold_torque(self, stamp: int, torque: Sequence[float], frame: str = "") -> "Change":
        """Apply a torque (3,) in N m until its time-out."""
        world = self.settings.world_frame
        if frame not in ("", world):
            raise reject("applied_torque frame_id", f'"{world}" or empty', frame)
        x, y, z = vector("applied_torque", torque, 3, MAX_MOMENT, "N m, world frame")
        end = stamp + round(self.settings.applied_torque_timeout * NANOSECONDS)
        held = replace(self, held_torque=(x, y, z), torque_end=end)
        return held._apply_torque(stamp, "applied")

    def release_torque(self, stamp: int) -> "Change":
        """Continue without the held torque."""
        released = replace(self, held_torque=NO_TORQUE)
        return released._apply_torque(stamp, "released")

    def _apply_torque(self, stamp: int, kind: Literal["applied", "released", "steady"]) -> "Change":
        a, b, c = self.settings.steady_torque
        x, y, z = self.held_torque
        total, segment = (a + x, b + y, c + z), self.segment
        if total != segment.motion.applied_torque:
            segment = segment.change(stamp, torque=total)
        request = {"torque": total}
        return self._follow("torque", stamp, request, Torque(kind, total), segment=segment)

    def change_settings(self, settings: Settings, stamp: int) -> list["Change"]:
        """Continue from the current state with other settings."""
        old = self.settings
        changes = {
            name: value for name, value in settings.values.items() if value != old.values[name]
        }
        if not changes:
            return []
        start, segment = self.start, self.segment
        if settings.initial != old.initial:  # ~/reset then starts from them
            start = initial_state(settings.top, settings.initial, {})
        if (settings.top, settings.friction) != (old.top, old.friction):
            segment = segment.change(stamp, settings.top, settings.friction)
        if settings.real_time_factor != old.real_time_factor and not settings.publish_clock:
            segment = segment.set_factor(settings.real_time_factor, stamp)
        if segment is not self.segment:
            _demand_a_day(segment)
        if settings.publish_rate != old.publish_rate:
            segment = replace(segment, rig=settings.rig(self.switched_on))
        outcome = Parameters(tuple(Setting(name, str(value)) for name, value in changes.items()))
        first = self._follow(
            "parameters", stamp, changes, outcome, settings=settings, start=start, segment=segment
        )
        torque = first.following._apply_torque(stamp, "steady")
        return [first, torque] if torque.is_new else [first]

    def _follow(
        self,
        name: str,
        stamp: int,
        request: Request,
        outcome: Outcome | Callable[[], Outcome],
        before: State | None = None,
        **changes: Any,
    ) -> "Change":
        """Return the change to a timeline in which some fields differ."""
        following = replace(self, **changes)
        if following.segment.motion is not self.segment.motion:
            following = replace(following, since=_describe_origin(name, stamp))
        is_new = following.segment is not self.segment
        return Change(following, name, stamp, request, self.segment, is_new, outcome, before)


@dataclass(frozen=True)
class Change:
    """A timeline that follows, and the event that says how it came about."""

    following: Timeline
    name: str  # of the event
    stamp: int  # ns, from which on it holds
    request: Request
    previous: Segment
    is_new: bool  # False if the motion is unchanged
    # what it leads to; a verdict is computed late, because it takes a millisecond
    outcome: Outcome | Callable[[], Outcome]
    before: State | None = None  # the state before the change, if it is not the one at the stamp

    def event(self, number: int) -> Event:
        """Compute the outcome and return the event, with its number in the run."""
        before = self.before or self.previous.state_at(self.stamp)
        return Event.of(
            self.stamp,
            self.name,
            self.outcome() if callable(self.outcome) else self.outcome,
            self.request,
            before,
            self.following.segment,
            self.following.settings.top_frame,
            number,
        )


def _demand_a_day(segment: Segment) -> Segment:
    """Refuse a motion that is so fast that it has no states after a day of the clock."""
    left = (segment.motion.farthest_time - segment.begin_time) / segment.factor
    if left < DAY:
        condition = "so slow that it stays within 1e15 turns for a day at this real-time factor"
        raise reject("motion", condition, f"{left:.3g} s")
    return segment


def _describe_origin(name: str, stamp: int) -> str:
    return f"{name} at stamp {stamp / NANOSECONDS:.9f} s"
