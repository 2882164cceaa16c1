"""The timeline of a run: what holds at a stamp, and what each command makes of it.

A command is an `Act`, and gives a `Change`: the timeline that follows, and the event that reports
it. Here are those that ask more than `follow` knows: settings, and what was held or started before.
Nothing here has a clock, a lock or a side effect; `simulation` decides at which stamp a change
takes effect.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Literal

from symtop_ros.base.arrays import Vector
from symtop_ros.base.refusals import refuse, vector
from symtop_ros.physics import State
from symtop_ros.run.simulation.budget import Shortfall
from symtop_ros.run.simulation.changes.follow import Act, Following, Request, demand_a_day, follow
from symtop_ros.run.simulation.changes.outcomes import Pace, Start, Torque
from symtop_ros.run.simulation.changes.requests import initial_state, start_motion
from symtop_ros.run.simulation.events import Event, do_nothing
from symtop_ros.run.simulation.segment import Segment
from symtop_ros.run.simulation.settings import MAX_MOMENT, NO_TORQUE, Settings
from symtop_ros.run.wire.layout import NANOSECONDS


@dataclass(frozen=True)
class Timeline:
    """A run from one change to the next."""

    settings: Settings
    segment: Segment  # the motion from the last change on
    start: State  # the last initial conditions
    since: str  # the event with which the motion of the segment began, and its stamp
    held_torque: Vector = NO_TORQUE  # from ~/applied_torque
    torque_end: int = 0  # stamp in ns at which the held torque ends

    @classmethod
    def begin(cls, settings: Settings, stamp: int) -> "Timeline":
        """Return the timeline that starts at a stamp (ns) from the initial conditions."""
        motion = start_motion(settings)
        # With publish_clock the clock has this factor.
        factor = 1.0 if settings.publish_clock else settings.real_time_factor
        segment = demand_a_day(Segment.begin(motion, stamp, factor, settings.rig(stamp)))
        return cls(settings, segment, motion.start, _describe_origin("start", stamp))

    def announce(self, stamp: int, scene: str) -> "Change":
        """Return the first event of a run, whose motion has begun."""
        act = Act("start", stamp, {"scene": scene})
        outcome = Start.of(self.segment.motion)
        return Change(self, act, Following(self.segment.state_at(stamp), self.segment, outcome))

    def follow(self, act: Act) -> "Change":
        """Return the change by an act."""
        found = follow(self.segment, act)
        since = self.since
        if found.segment.motion is not self.segment.motion:
            since = _describe_origin(act.name, act.stamp)
        is_new = found.segment is not self.segment
        return Change(replace(self, segment=found.segment, since=since), act, found, is_new)

    def restart(self, stamp: int, values: Request | None = None) -> "Change":
        """Restart from named initial conditions, or without them from the last ones."""
        clamped = self.settings.initial.clamped
        if values is None:
            return self.follow(Act("reset", stamp, {}, self.start, clamped=clamped))
        start = initial_state(self.settings.top, self.settings.initial, values)
        act = Act("start", stamp, values, start, clamped=clamped)
        return replace(self, start=start).follow(act)

    def move(self, stamp: int, now: int) -> "Change":
        """Continue the state of a stamp at the time (ns) to which the clock jumped."""
        moved = replace(self, torque_end=self.torque_end + now - stamp)
        return moved.follow(Act("clock", now, {"from": stamp, "to": now}))

    def slow_down(self, stamp: int, shortfall: Shortfall) -> "Change":
        """Continue at a real-time factor that can be kept, from the time that was reached."""
        reached, factor = shortfall
        told = Pace("slowed", self.segment.factor, factor)
        return self.follow(Act("pace", stamp, {"reached": reached}, factor=factor, told=told))

    def set_pace(self, stamp: int, current: float, factor: float) -> "Change":
        """Continue at another real-time factor than the current one."""
        told = Pace("slowed" if factor < current else "changed", current, factor)
        return self.follow(Act("pace", stamp, {}, factor=self._find_factor(factor), told=told))

    def _find_factor(self, factor: float) -> float:
        """Return the factor of a segment; with publish_clock the clock has it."""
        return self.segment.factor if self.settings.publish_clock else factor

    def hold_torque(self, stamp: int, torque: Sequence[float], frame: str = "") -> "Change":
        """Apply a torque (3,) in N m until its time-out."""
        world = self.settings.world_frame
        if frame not in ("", world):
            raise refuse("applied_torque frame_id", f'"{world}" or empty', frame)
        x, y, z = vector("applied_torque", torque, 3, MAX_MOMENT, "N m, world frame")
        end = stamp + round(self.settings.applied_torque_timeout * NANOSECONDS)
        return replace(self, held_torque=(x, y, z), torque_end=end)._apply_torque(stamp, "applied")

    def release_torque(self, stamp: int) -> "Change":
        """Continue without the held torque."""
        return replace(self, held_torque=NO_TORQUE)._apply_torque(stamp, "released")

    def _apply_torque(self, stamp: int, kind: Literal["applied", "released", "steady"]) -> "Change":
        a, b, c = self.settings.steady_torque
        x, y, z = self.held_torque
        total = (a + x, b + y, c + z)
        return self.follow(Act("torque", stamp, {"torque": total}, told=Torque(kind, total)))

    def change_settings(self, settings: Settings, stamp: int) -> list["Change"]:
        """Continue from the current state with other settings."""
        old, start = self.settings, self.start
        changes = {
            name: value for name, value in settings.values.items() if value != old.values[name]
        }
        if not changes:
            return []
        if settings.initial != old.initial:  # ~/reset then starts from them
            start = initial_state(settings.top, settings.initial, {})
        changed = replace(self, settings=settings, start=start)
        first = changed.follow(
            Act(
                "parameters",
                stamp,
                changes,
                factor=self._find_factor(settings.real_time_factor),
            )
        )
        torque = first.following._apply_torque(stamp, "steady")
        return [first, torque] if torque.is_new else [first]

    def fail(self, act: Act, before: Segment) -> "Change":
        """Return the event of an action that failed, whatever it has left of the segment before."""
        return Change(self, act, follow(before, replace(act, left=self.segment)))


@dataclass(frozen=True)
class Change:
    """A timeline that follows, and the event that says how it came about."""

    following: Timeline
    act: Act
    found: Following
    is_new: bool = False  # False if the motion is unchanged

    def event(self, number: int, between: Callable[[], object] = do_nothing) -> Event:
        """Return the event, with its number in the run; `between` is called between its parts."""
        outcome = self.found.outcome
        between()
        return Event.of(
            self.act.stamp,
            self.act.name,
            outcome,
            self.act.request,
            self.found.before,
            self.following.segment,
            self.following.settings.top_frame,
            number,
            self.found.pushes,
            between,
        )


def _describe_origin(name: str, stamp: int) -> str:
    return f"{name} at stamp {stamp / NANOSECONDS:.9f} s"
